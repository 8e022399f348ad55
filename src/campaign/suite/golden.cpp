#include "golden.h"

#include <algorithm>
#include <sstream>
#include <tuple>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "config/json/json_value.h"
#include "kadans/signal/machine_name.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t digits_each_s = 8;

std::string title(const std::string& scenario, std::uint64_t seed) {
  return scenario + " (seed " + std::to_string(seed) + ")";
}

GoldenRun golden_of(const RunOutcome& run) {
  GoldenRun golden{.scenario = run.scenario, .seed = run.seed, .hash = run.state_hash, .each_s = {}};
  for (const std::string& hash : run.hashes) golden.each_s.push_back(hash.substr(0, digits_each_s));
  return golden;
}

// "between 2 s and 3 s"
std::string parting(const GoldenRun& known, const GoldenRun& run) {
  const std::size_t both = std::min(known.each_s.size(), run.each_s.size());
  for (std::size_t i = 0; i < both; ++i) {
    if (known.each_s[i] != run.each_s[i])
      return "between " + std::to_string(i) + " s and " + std::to_string(i + 1) + " s";
  }
  if (known.each_s.size() != run.each_s.size())
    return "after " + std::to_string(both) + " s, they are not of one length";
  return known.hash == run.hash ? "" : "after " + std::to_string(both) + " s";
}

auto order(const GoldenRun& run) { return std::tie(run.scenario, run.seed); }

GoldenRun golden_from(const Json& json) {
  GoldenRun run{.scenario = json.at("scenario"), .seed = json.at("seed"), .hash = json.at("hash"), .each_s = {}};
  std::istringstream words(json.at("each_s").get<std::string>());
  for (std::string word; words >> word;) run.each_s.push_back(word);
  return run;
}

}  // namespace

fs::path golden_file(const fs::path& folder) {
  const fs::path whole = (folder / "").lexically_normal().parent_path();
  return whole.parent_path() / (whole.filename().string() + ".golden.json");
}

GoldenHashes::GoldenHashes(fs::path file, std::string bullet) : file_(std::move(file)), bullet_(std::move(bullet)) {
  if (!fs::exists(file_)) return;
  std::string of;
  try {
    const Json json = parse_foreign_json(read_input_file(file_), file_.string());
    of = json.at("machine");
    bullet_of_file_ = json.value("bullet", bullet_);
    for (const Json& run : json.at("runs")) runs_.push_back(golden_from(run));
  } catch (const Json::exception& error) {
    refuse(file_, std::string("is no list of golden hashes: ") + error.what());
  }
  if (of != machine_name()) {
    refuse(file_, "holds the hashes of " + of + ", this is " + machine_name() + ": they differ");
  }
}

const GoldenRun* GoldenHashes::find(const std::string& scenario, std::uint64_t seed) const noexcept {
  const auto found =
      std::ranges::find_if(runs_, [&](const GoldenRun& run) { return run.scenario == scenario && run.seed == seed; });
  return found == runs_.end() ? nullptr : &*found;
}

std::string GoldenHashes::difference(const RunOutcome& run) const {
  const GoldenRun* const known = find(run.scenario, run.seed);
  const bool other_seed = std::ranges::find(runs_, run.scenario, &GoldenRun::scenario) != runs_.end();
  if (known == nullptr && other_seed)
    return "no golden hash is known of this seed, only of those that the scenario says: leave out --seed and --repeat";
  if (known == nullptr) return "no golden hash is known of this run: kadans test --renew-golden takes it";
  const std::string where = parting(*known, golden_of(run));
  if (where.empty()) return {};
  if (bullet_of_file_ != bullet_)
    return "its state parts from the golden run's " + where + ": the golden hashes are those of " + bullet_of_file_ +
           ", this is " + bullet_;
  return "its state parts from the golden run's " + where + "; kadans test --renew-golden takes it when that is meant";
}

std::vector<std::string> GoldenHashes::take(const std::vector<RunOutcome>& runs, bool all) {
  std::vector<std::string> changes;
  std::vector<GoldenRun> taken;
  for (const RunOutcome& run : runs) {
    const GoldenRun* const known = find(run.scenario, run.seed);
    if (run.status != RunStatus::passed) {
      changes.push_back("left    " + title(run.scenario, run.seed) + ": " + name(run.status));
      if (known != nullptr) taken.push_back(*known);
      continue;
    }
    taken.push_back(golden_of(run));
    if (known == nullptr) changes.push_back("new     " + title(run.scenario, run.seed));
    const std::string where = known == nullptr ? "" : parting(*known, taken.back());
    if (!where.empty()) changes.push_back("changed " + title(run.scenario, run.seed) + ": " + where);
  }
  for (const GoldenRun& known : runs_) {
    const bool again = std::ranges::any_of(taken, [&](const GoldenRun& run) { return order(run) == order(known); });
    if (again) continue;
    if (all) {
      changes.push_back("gone    " + title(known.scenario, known.seed));
    } else {
      taken.push_back(known);
    }
  }
  std::ranges::sort(taken, {}, order);
  runs_ = std::move(taken);
  return changes;
}

void GoldenHashes::write() const {
  std::string text = "{\n  \"machine\": \"" + std::string(machine_name()) + "\",\n";
  if (!bullet_.empty()) text += "  \"bullet\": \"" + bullet_ + "\",\n";
  text += "  \"runs\": [\n";
  for (const GoldenRun& run : runs_) {
    const std::string each_s = listed(run.each_s, {}, " ");
    const Json json{{"scenario", run.scenario}, {"seed", run.seed}, {"hash", run.hash}, {"each_s", each_s}};
    text += "    " + json_text(json) + (&run == &runs_.back() ? "\n" : ",\n");
  }
  text += "  ]\n}\n";
  write_durably(file_, text);
}

}  // namespace kadans
