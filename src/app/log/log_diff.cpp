#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "log_verbs.h"
#include "signal/number_text.h"
#include "telemetry/reading/record_comparison.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t shown_max = 12;

struct DiffFindings {
  const RecordOutline &a, &b;
  RecordDiff diff;
  std::vector<std::string> facts;
};

// What is not finite is written as null.
void print_json(const DiffFindings& found) {
  const RecordDiff& diff = found.diff;
  Json signals = Json::array();
  for (const SignalParting& p : diff.partings) {
    signals.push_back({{"name", p.name},
                       {"unit", p.unit},
                       {"rows", p.rows},
                       {"first", {{"time_s", seconds(p.first_ns)}, {"a", p.first_a}, {"b", p.first_b}}},
                       {"most", {{"time_s", seconds(p.most_ns)}, {"a", p.most_a}, {"b", p.most_b}, {"by", p.most}}}});
  }
  const Json json{{"a", found.a.file},
                  {"b", found.b.file},
                  {"same", diff.same()},
                  {"rows", diff.rows},
                  {"signals", diff.signals},
                  {"parted_s", diff.partings.empty() ? Json(nullptr) : Json(seconds(diff.partings.front().first_ns))},
                  {"partings", signals},
                  {"rows_only_a", diff.rows_only_a},
                  {"rows_only_b", diff.rows_only_b},
                  {"signals_only_a", diff.only_a},
                  {"signals_only_b", diff.only_b},
                  {"events_only_a", diff.events_only_a},
                  {"events_only_b", diff.events_only_b},
                  {"topics", diff.other_topics},
                  {"facts", found.facts},
                  {"complete", found.a.complete && found.b.complete}};
  std::puts(json_text(json).c_str());
}

std::string name_of(const SignalParting& parting) {
  return parting.name + (parting.unit.empty() ? "" : ", " + parting.unit);
}

void print_first(const RecordDiff& diff) {
  const SignalParting& first = diff.partings.front();
  const auto there = std::ranges::count(diff.partings, first.first_ns, &SignalParting::first_ns);
  std::printf("they part at %.3f s, in %s:\n  %-50s %18s %18s %12s\n", seconds(first.first_ns),
              plural(static_cast<std::uint64_t>(there), "signal").c_str(), "", "first", "second", "by");
  for (std::size_t i = 0; i < std::min(shown_max, static_cast<std::size_t>(there)); ++i) {
    const SignalParting& p = diff.partings[i];
    std::printf("  %-50s %18.12g %18.12g %12.3g\n", name_of(p).c_str(), p.first_a, p.first_b, p.first_b - p.first_a);
  }
  if (static_cast<std::size_t>(there) > shown_max)
    std::printf("  ... and %zu more\n", static_cast<std::size_t>(there) - shown_max);
}

// Units cannot be compared, so signals are sorted by their difference relative to their own size.
void print_greatest(const RecordDiff& diff) {
  std::vector<SignalParting> all = diff.partings;
  const auto share = [](const SignalParting& p) {
    return p.most / std::max({std::abs(p.most_a), std::abs(p.most_b), 1e-12});
  };
  std::ranges::stable_sort(all, std::ranges::greater{}, share);
  std::printf("the greatest differences, by their share of the value (%s differ):\n  %-50s %18s %18s %12s\n",
              plural(all.size(), "signal").c_str(), "", "first", "second", "at");
  for (std::size_t i = 0; i < std::min(shown_max, all.size()); ++i) {
    const SignalParting& p = all[i];
    std::printf("  %-50s %18.9g %18.9g %10.3f s\n", name_of(p).c_str(), p.most_a, p.most_b, seconds(p.most_ns));
  }
  if (all.size() > shown_max) std::printf("  ... and %zu more; --json lists all\n", all.size() - shown_max);
}

void print_list(const char* what, const std::string& where, const std::vector<std::string>& list) {
  if (list.empty()) return;
  std::printf("%s only in %s (%zu):\n", what, where.c_str(), list.size());
  for (std::size_t i = 0; i < std::min(shown_max, list.size()); ++i) std::printf("  %s\n", list[i].c_str());
  if (list.size() > shown_max) std::printf("  ... and %zu more\n", list.size() - shown_max);
}

void print_diff(const DiffFindings& found) {
  const RecordDiff& diff = found.diff;
  std::printf("%s, %s: %s; %s, %s compared\n", found.a.file.c_str(), found.b.file.c_str(),
              diff.same() ? "the same" : "not the same", plural(diff.rows, "row").c_str(),
              plural(diff.signals, "signal").c_str());
  if (!diff.partings.empty()) {
    print_first(diff);
    print_greatest(diff);
  }
  for (const auto& [record, rows, first_ns] : {std::tuple{&found.a, diff.rows_only_a, diff.row_only_a_ns},
                                               std::tuple{&found.b, diff.rows_only_b, diff.row_only_b_ns}}) {
    if (rows > 0)
      std::printf("%s only in %s, the first at %.3f s\n", plural(rows, "row").c_str(), record->file.c_str(),
                  seconds(first_ns));
  }
  print_list("signals", found.a.file, diff.only_a);
  print_list("signals", found.b.file, diff.only_b);
  print_list("transitions, faults and log lines", found.a.file, diff.events_only_a);
  print_list("transitions, faults and log lines", found.b.file, diff.events_only_b);
  for (const std::string& topic : diff.other_topics) std::printf("%s holds something else\n", topic.c_str());
  for (const std::string& fact : found.facts) std::printf("made with another %s\n", fact.c_str());
}

}  // namespace

int log_diff(const LogOptions& options) {
  const RecordOutline a = outline_of(options.file), b = outline_of(options.other);
  const DiffFindings found{a, b, diff_records(a, b, options.tolerance), differing_facts(a, b)};
  options.json ? print_json(found) : print_diff(found);
  tell_problem(a);
  tell_problem(b);
  return found.diff.same() ? exit_passed : exit_failed;
}

}  // namespace kadans
