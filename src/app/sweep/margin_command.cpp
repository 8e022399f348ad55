// `kadans margin`: how far quantities may go until a scenario fails. Each value that is tried is a sweep of its own
// over the same seeds, with its results in a folder, so a search that is started again goes on where it was.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "campaign/margin/margin_search.h"
#include "campaign/margin/margin_table.h"
#include "campaign/suite/scenario_search.h"
#include "config/json/problems.h"
#include "config/robot/project_root.h"
#include "kadans/signal/nearest_name.h"
#include "scenario/disturb/quantities.h"
#include "signal/number_text.h"
#include "sweep_run.h"
#include "sweep_subjects.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// `kadans margin`: how far quantities may go from their nominal values until a scenario of the robot fails, by
// bisection over the same seeds.
struct MarginOptions {
  std::string robot;
  std::vector<std::string> scenarios;   // files, folders, tags, names; none: those with the tag "margin"
  std::vector<std::string> quantities;  // "delay", "ground.friction=0.02"; none: the usual ones
  std::uint32_t seeds = 8;
  std::uint64_t seed = 1;
  unsigned jobs = 0;  // 0: one for each core
  std::string out;    // "": margins in the working directory
  bool json = false;
};

// What is measured without --quantity. An end that a quantity's own range does not reach is that range's end.
struct KnownMargin {
  const char* name;
  std::vector<std::string> patterns;
  double step;  // 0: a control tick
  double low, high;
};

const std::vector<KnownMargin>& known_margins() {
  static const std::vector<KnownMargin> all{
      {"delay", {"actuation.delay_s"}, 0, 0, 1},
      {"gain", {"control.*.kp_*_scale", "control.*.kd_*_scale"}, 0.05, 0, 4},
      {"mass", {"link.*.mass_scale"}, 0.05, 0, 4},
      {"torque", {"joint.*.torque_scale"}, 0.05, 0, 1},
      {"friction", {"ground.friction"}, 0.05, 0, 4},
      {"dry_friction", {"joint.*.coulomb_Nm"}, 0.1, 0, 100},
  };
  return all;
}

// A quantity, or several that get the same value, in both directions.
struct Asked : Margin {
  double low = -HUGE_VAL, high = HUGE_VAL;
};

Asked asked_of(const std::string& text, double tick_s) {
  const std::size_t equals = text.find('=');
  Asked asked;
  asked.name = text.substr(0, equals);
  asked.patterns = {asked.name};
  for (const KnownMargin& known : known_margins()) {
    if (known.name != asked.name) continue;
    asked.patterns = known.patterns;
    asked.step = known.step > 0 ? known.step : tick_s;
    asked.low = known.low;
    asked.high = known.high;
  }
  if (equals == std::string::npos) return asked;
  const auto step = number_of<double>(std::string_view(text).substr(equals + 1));
  if (!step || !(*step >= 1e-6 && *step <= 1e6))
    refuse("--quantity",
           "'" + text + "': the step behind '=' must be a number from 1e-6 to 1e6, such as ground.friction=0.02");
  asked.step = *step;
  return asked;
}

[[noreturn]] void refuse_name(const std::string& name, const std::vector<std::string>& quantities) {
  std::vector<std::string> names;
  for (const KnownMargin& known : known_margins()) names.emplace_back(known.name);
  std::ranges::copy(quantities, std::back_inserter(names));
  refuse_unknown("--quantity", {.name = name, .place = {}}, "quantity", names);
}

// The values of a scenario's quantities as its runs have them.
class Nominal {
 public:
  explicit Nominal(const ScenarioConfig& scenario)
      : scenario_(scenario), robot_(read_robot(scenario.robot)), system_(make_control_system(robot_)) {
    Problems problems(scenario.file);
    std::vector<QuantityValue> done;
    for (const NumberEntry& entry : scenario.set) quantities_.set(entry, done, problems);
    problems.throw_if_any();
  }
  double tick_s() const { return robot_.config.engine.control_period_s; }

  // False when no quantity has these names. Throws InputError when they have different values, or when no step is
  // known.
  bool complete(Asked& asked) const {
    std::size_t found = 0;
    for (const std::string& pattern : asked.patterns) {
      for (const std::size_t index : matching(pattern, quantities_.names())) add(index, found++ == 0, asked);
    }
    if (found == 0) return false;
    if (asked.step == 0) asked.step = std::abs(asked.nominal) / 20;
    if (!(asked.step > 0))
      refuse("--quantity", asked.name + " is 0: say in which steps it shall grow, such as " + asked.name + "=0.01");
    return true;
  }
  const std::vector<std::string>& names() const { return quantities_.names(); }

 private:
  // The middle of what the scenario draws, for a quantity that differs in each of its runs.
  double value(std::size_t index) const {
    double value = quantities_.value(index);
    for (const Variation& drawn : scenario_.randomise) {
      if (matches(drawn.pattern.name, quantities_.names()[index])) value = drawn.distribution.at(0.5);
    }
    return value;
  }
  void add(std::size_t index, bool first, Asked& asked) const {
    const NumberRange& range = quantities_.range(index);
    if (first) {
      asked.nominal = value(index);
      asked.unit = range.unit;
    }
    if (asked.nominal != value(index))
      refuse("--quantity", asked.name + " chooses quantities of different values, " + number_text(asked.nominal) +
                               " and " + number_text(value(index)) + " (" + quantities_.names()[index] +
                               "): choose one, or their factors (_scale)");
    asked.low = std::max(asked.low, range.min);
    asked.high = std::min(asked.high, range.max);
  }

  const ScenarioConfig& scenario_;
  Robot robot_;
  std::unique_ptr<ControlSystem> system_;
  PlantVariant variant_ = plant_variant(scenario_, robot_.config);
  Quantities quantities_{variant_, system_->catalog};
};

// The runs of one scenario.
class MarginRuns {
 public:
  MarginRuns(const MarginOptions& options, const ScenarioConfig& scenario) : options_(options) {
    plan_.file = scenario.file;
    plan_.scenarios = {{.written = shown_path(scenario.file), .file = scenario.file, .place = {}}};
    plan_.seed = options.seed;
    plan_.cases = options.seeds;
    subjects_ = read_sweep_subjects(plan_);
    plan_.name = "margin of " + subjects_.front().name;
  }

  // The first run that fails with this value; nothing when all hold, or when interrupted.
  std::optional<CaseRow> first_failure(const std::vector<std::string>& patterns, double value) {
    plan_.vary.clear();
    for (const std::string& pattern : patterns) {
      Distribution always{.kind = Distribution::Kind::values, .of = {}, .values = {value}, .together = true};
      plan_.vary.push_back({.variation = {.pattern = {pattern, {}}, .distribution = std::move(always)}});
    }
    const std::vector<SweepCase> each = sweep_cases(plan_, subjects_, build_);
    const SweepManifest manifest = manifest_of(plan_, each, build_);
    const SweepResults results(fs::path(options_.out.empty() ? "margins" : options_.out) / manifest.plan, manifest);
    if (auto known = failure_in(results)) return known;
    std::vector<SweepCase> rest = each;
    std::erase_if(rest, [&](const SweepCase& one) { return results.has(one); });
    SweepRun run(plan_, subjects_, results, std::move(rest), false, JobProgress::Log::terminal_only);
    run.stop_at_failure();
    run.run(options_.jobs);
    return failure_in(results);
  }
  const SweepSubject& subject() const { return subjects_.front(); }

 private:
  // The path within the working directory, as a person would write it.
  static std::string shown_path(const fs::path& file) {
    const fs::path near = file.lexically_proximate(fs::current_path());
    return near.native().starts_with("..") ? file.string() : near.string();
  }
  // Of results that have every case before it.
  static std::optional<CaseRow> failure_in(const SweepResults& results) {
    std::size_t expected = 0;
    for (CaseRow& row : results.rows()) {
      if (row.index != expected++) return std::nullopt;
      if (row.status == RunStatus::refused) refuse(row.scenario, "refuses a run; this tells why: " + row.repeat);
      if (row.status != RunStatus::passed) return std::move(row);
    }
    return std::nullopt;
  }

  const MarginOptions& options_;
  SweepPlan plan_;
  std::vector<SweepSubject> subjects_;
  std::string build_ = build_version();
};

Margin measured(MarginRuns& runs, const Asked& asked, double end) {
  Margin margin = asked;
  margin.end = end;
  MarginSearch search(asked.nominal, asked.step, end);
  for (auto value = search.next(); value && !interrupted(); value = search.next()) {
    const std::optional<CaseRow> failure = runs.first_failure(asked.patterns, *value);
    if (failure) margin.failure = *failure;
    if (!interrupted()) search.tell(!failure);
  }
  margin.held = search.held();
  margin.failed = search.failed();
  return margin;
}

// All that is asked of this scenario, complete. Throws InputError before anything runs.
std::vector<Asked> asked_of(const MarginOptions& options, const Nominal& nominal) {
  std::vector<Asked> all;
  if (options.quantities.empty()) {
    for (const KnownMargin& known : known_margins()) {
      Asked asked = asked_of(known.name, nominal.tick_s());
      if (nominal.complete(asked)) all.push_back(std::move(asked));
    }
  }
  for (const std::string& text : options.quantities) {
    Asked asked = asked_of(text, nominal.tick_s());
    if (!nominal.complete(asked)) refuse_name(asked.name, nominal.names());
    all.push_back(std::move(asked));
  }
  return all;
}

ScenarioMargins measure(const MarginOptions& options, const ScenarioConfig& scenario) {
  const std::vector<Asked> all = asked_of(options, Nominal(scenario));
  MarginRuns runs(options, scenario);
  ScenarioMargins found{.scenario = runs.subject().name,
                        .file = runs.subject().scenario.written,
                        .seeds = options.seeds,
                        .failure = runs.first_failure({}, 0),
                        .margins = {}};
  if (interrupted()) return found;
  if (!options.json) std::fputs(margin_head(found).c_str(), stdout);
  for (const Asked& asked : all) {
    for (const double end : {asked.low, asked.high}) {
      if (found.failure || end == asked.nominal) continue;
      found.margins.push_back(measured(runs, asked, end));
      if (interrupted()) return found;
      if (!options.json) std::fputs(margin_row(found.margins.back()).c_str(), stdout);
      std::fflush(stdout);
    }
  }
  if (!options.json) std::fputs(margin_legend(found).c_str(), stdout);
  return found;
}

// The scenarios that are chosen, of this robot.
std::vector<ScenarioConfig> scenarios_of(const MarginOptions& options) {
  const fs::path folder = project_root(options.robot) / "config" / "scenarios";
  const bool named = !options.scenarios.empty();
  std::vector<ScenarioConfig> own;
  std::string other;
  for (ScenarioConfig& scenario : find_scenarios(folder, options.scenarios)) {
    if (!scenario.record.empty()) continue;
    if (!fs::equivalent(scenario.robot, options.robot)) {
      other = scenario.name + " is of " + scenario.robot;
    } else if (named || std::ranges::find(scenario.tags, "margin") != scenario.tags.end()) {
      own.push_back(std::move(scenario));
    }
  }
  if (own.empty())
    refuse(options.robot, named ? "none of the scenarios is of this robot: " + other
                                : "no scenario of this robot in " + folder.string() +
                                      " has the tag 'margin': name a scenario in which its margins are measured");
  return own;
}

int run_margin(const MarginOptions& options) {
  (void)read_robot(options.robot);
  const std::vector<ScenarioConfig> scenarios = scenarios_of(options);
  catch_interrupts();
  std::vector<ScenarioMargins> all;
  for (const ScenarioConfig& scenario : scenarios) {
    all.push_back(measure(options, scenario));
    if (interrupted()) return exit_interrupted;
  }
  if (options.json) std::fputs(margins_json(options.robot, all).c_str(), stdout);
  const bool held = std::ranges::none_of(all, [](const ScenarioMargins& one) { return one.failure.has_value(); });
  return held ? exit_passed : exit_failed;
}

}  // namespace

void add_margin(CommandLine& line) {
  const auto [margin, options] =
      line.add<MarginOptions>("margin", "Measure how far quantities may go until a scenario fails", run_margin);
  margin->add_option("robot", options.robot, "The robot's configuration (JSON)")->required()->type_name("FILE");
  margin
      ->add_option("scenarios", options.scenarios,
                   "Scenarios of this robot (default: those in config/scenarios with the tag 'margin')")
      ->type_name("PATH|TAG|NAME...");
  margin
      ->add_option("--quantity", options.quantities,
                   "What varies, and in which steps: delay, gain, mass, torque, friction, dry_friction, or a quantity "
                   "or pattern over quantities (default: these six). Can be given several times")
      ->type_name("NAME[=STEP]")
      ->allow_extra_args(false);
  add_whole(*margin, "--seeds", options.seeds, 1, 10'000, "Runs with different seeds that must all pass (default: 8)");
  add_seed(*margin, options.seed, "Seed from which theirs come (default: 1)");
  add_jobs(*margin, options.jobs);
  margin
      ->add_option("--out", options.out,
                   "Folder of the results; runs that have a result there are not run again (default: margins)")
      ->type_name("FOLDER");
  margin->add_flag("--json", options.json, "Print one JSON object instead of text");
}

}  // namespace kadans
