#include "sweep_results.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "config/json/json_value.h"
#include "kadans/signal/content_hash.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* manifest_file = "sweep.json";

// Both ways: `visit` gets the key and the member.
template <typename Manifest, typename Visit>
void visit_facts(Manifest& manifest, Visit visit) {
  visit("sweep", manifest.sweep);
  visit("doc", manifest.doc);
  visit("plan", manifest.plan);
  visit("version", manifest.version);
  visit("sampling", manifest.sampling);
  visit("seed", manifest.seed);
  visit("cases", manifest.cases);
  visit("metrics", manifest.metrics);
  visit("first_try", manifest.first_try);
  visit("time", manifest.time);
  visit("worst", manifest.worst);
  visit("map_x", manifest.map_x);
  visit("map_y", manifest.map_y);
  visit("map_metric", manifest.map_metric);
  visit("passed_min", manifest.passed_min);
}

Json to_json(const SweepManifest& manifest) {
  Json json;
  visit_facts(manifest, [&json](const char* key, const auto& value) { json[key] = value; });
  return json;
}

SweepManifest read_manifest(const fs::path& folder) {
  const fs::path file = folder / manifest_file;
  if (!fs::exists(file)) refuse(folder, "holds no results of a sweep: there is no sweep.json");
  try {
    const Json json = parse_foreign_json(read_input_file(file), file.string());
    SweepManifest manifest;
    visit_facts(manifest, [&json](const char* key, auto& value) { json.at(key).get_to(value); });
    return manifest;
  } catch (const Json::exception& error) {
    refuse(file, std::string("cannot be read: ") + error.what());
  }
}

CaseRow row_from(const Json& json) {
  CaseRow row{.index = json.at("case"),
              .id = json.at("id"),
              .scenario = json.at("scenario"),
              .seed = json.at("seed"),
              .state_hash = json.value("state_hash", ""),
              .simulated_s = json.value("duration_s", 0.0),
              .quantities = named_numbers(json, "quantities"),
              .metrics = named_numbers(json, "metrics"),
              .repeat = json.at("repeat")};
  const std::string status = json.at("status");
  for (const RunStatus one : {RunStatus::passed, RunStatus::failed, RunStatus::refused, RunStatus::timed_out}) {
    if (status == name(one)) row.status = one;
  }
  double first_s = HUGE_VAL;
  for (const Json& check : json.value("checks", Json::array())) {
    if (check.at("passed").get<bool>()) continue;
    const auto check_name = check.at("name").get<std::string>();
    const Json at_s = check.value("at_s", Json());  // null for a check that had nothing to look at
    const double time_s = at_s.is_number() ? at_s.get<double>() : HUGE_VAL;
    if (row.failed.empty() || time_s < first_s) {
      row.first_failed = check_name;
      first_s = time_s;
    }
    row.failed += (row.failed.empty() ? "" : "; ") + check_name;
  }
  return row;
}

}  // namespace

SweepManifest manifest_of(const SweepPlan& plan, const std::vector<SweepCase>& cases, const std::string& version) {
  SweepManifest manifest{.sweep = plan.name,
                         .doc = plan.doc,
                         .version = version,
                         .sampling = name(plan.sampling),
                         .seed = plan.seed,
                         .cases = cases.size(),
                         .first_try = plan.first_try.name,
                         .time = plan.time.name,
                         .worst = plan.worst.name,
                         .map_x = plan.heat_map.x.name,
                         .map_y = plan.heat_map.y.name,
                         .map_metric = plan.heat_map.metric.name,
                         .passed_min = plan.passed_min};
  for (const MetricConfig& metric : plan.metrics) manifest.metrics.push_back(metric.name);
  ContentHash hash;
  hash.add(plan.name);
  for (const SweepCase& one : cases) hash.add(one.id);
  manifest.plan = hash.hex();
  return manifest;
}

bool CaseRow::operator==(const CaseRow& other) const {
  const auto same = [](const auto& a, const auto& b) {
    return a.name == b.name && number_text(a.value) == number_text(b.value);
  };
  return index == other.index && id == other.id && scenario == other.scenario && seed == other.seed &&
         status == other.status && failed == other.failed && state_hash == other.state_hash && repeat == other.repeat &&
         std::ranges::equal(quantities, other.quantities, same) && std::ranges::equal(metrics, other.metrics, same);
}

SweepResults::SweepResults(fs::path folder, const SweepManifest& manifest)
    : folder_(std::move(folder)), manifest_(manifest) {
  fs::create_directories(folder_ / "cases");
  if (fs::exists(folder_ / manifest_file)) {
    const std::string other = difference(read_manifest(folder_), manifest_);
    if (!other.empty())
      refuse(folder_, "holds the results of another sweep: " + other + "; name another folder with --out");
    return;
  }
  write_durably(folder_ / manifest_file, json_text(to_json(manifest_), 2) + "\n");
}

SweepResults::SweepResults(fs::path folder) : folder_(std::move(folder)), manifest_(read_manifest(folder_)) {}

fs::path SweepResults::file_of(const SweepCase& one) const {
  return folder_ / "cases" / printed("%06zu-%s.json", one.index, one.id.c_str());
}

// A run that took too long says something of the machine on that day: it is run again.
bool SweepResults::has(const SweepCase& one) const {
  const fs::path file = file_of(one);
  if (!fs::exists(file)) return false;
  const std::optional<Json> json = read_foreign_json(read_input_file(file));
  return !json || !json->is_object() || json->value("status", "") != name(RunStatus::timed_out);
}

void SweepResults::store(const SweepCase& one, const std::string& json) const { write_durably(file_of(one), json); }

std::string case_json(const SweepManifest& manifest, const SweepCase& one, const RunOutcome& run) {
  Json json{{"plan", manifest.plan}, {"case", one.index}, {"id", one.id}};
  json.update(parse_foreign_json(run_json(run)));
  json.erase("evidence");
  if (!json.contains("quantities")) {  // the run left no report
    json["quantities"] = Json::object();
    for (const QuantityValue& setting : one.quantities) json["quantities"][setting.name] = setting.value;
  }
  return json_text(json) + "\n";
}

std::vector<CaseRow> SweepResults::rows() const {
  std::vector<CaseRow> rows;
  if (!fs::is_directory(folder_ / "cases")) return rows;
  for (const auto& entry : fs::directory_iterator(folder_ / "cases")) {
    const fs::path& file = entry.path();
    if (file.filename().string().starts_with('.') || file.extension() != ".json") continue;
    try {
      const Json json = parse_foreign_json(read_input_file(file), file.string());
      if (json.at("plan") != manifest_.plan) refuse(file, "is a result of another sweep than sweep.json beside it");
      rows.push_back(row_from(json));
    } catch (const Json::exception& error) {
      refuse(file, std::string("is no result of a case: ") + error.what() + "; remove it and run the sweep again");
    }
  }
  std::ranges::sort(rows, {}, &CaseRow::index);
  return rows;
}

std::string difference(const SweepManifest& a, const SweepManifest& b) {
  const Json one = to_json(a), other = to_json(b);
  std::string text;
  for (const auto& [key, value] : one.items()) {
    if (key == "doc" || value == other.at(key)) continue;
    text += (text.empty() ? "" : ", ") + key + " " + json_text(value) + " and " + json_text(other.at(key));
  }
  return text;
}

}  // namespace kadans
