
#include "experiment_plans.h"

#include <array>
#include <limits>

#include "config/robot/project_root.h"
#include "config/scenario/based_on.h"
#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

void experiment_fields(Fields& f, ExperimentConfig& experiment, Need need_scenarios) {
  std::string schema, base;
  f.string("$schema", schema, "the schema of this file, for editors");
  f.string("based_on", base, "another plan; this file says only what is different");
  f.string("name", experiment.name, "the plan's name", Need::required);
  f.string("doc", experiment.doc, "what it shows, one or two sentences");
  std::vector<PlacedName> scenarios;
  f.strings("scenarios", scenarios, {1, 1000}, "files, from the project root; the cases use them in turn",
            need_scenarios);
  for (const PlacedName& scenario : scenarios) {
    experiment.scenarios.push_back({scenario.name,
                                    resolve_file(scenario.name, scenario.place, "scenarios", f.problems()).string(),
                                    scenario.place});
  }
  f.integer("seed", experiment.seed, {0, std::numeric_limits<std::uint64_t>::max()},
            "seed of the sample and of the seeds of all runs");
  f.boolean("sample_randomise", experiment.sample_randomise,
            "the sample also chooses what the scenarios randomise (default: each run's seed draws it)");
  f.map("vary", "quantities that differ from case to case, by a pattern of their names", [&](Fields& e) {
    ExperimentAxis axis{.variation = {.pattern = {e.key(), e.key_place()}, .distribution = {}}};
    distribution_fields(e, axis.variation.distribution);
    e.integer("steps", axis.steps, {1, 10'000},
              "number of points in a grid, including both ends; not for values, each of which is a point");
    if (e.reading()) experiment.vary.push_back(std::move(axis));
  });
  metrics_fields(f, experiment.metrics);
}

// An empty name is allowed: no metric is wanted.
void verify_metric(const PlacedName& name, const ExperimentConfig& experiment, Problems& problems) {
  if (!name.name.empty()) (void)problems.known(name, "metric", names_of(experiment.metrics));
}

}  // namespace

std::vector<MetricConfig> read_metrics(const std::string& file) {
  std::vector<MetricConfig> metrics;
  Problems problems(file);
  const JsonValue json = parse_based_json(read_input_file(file), file).value;
  const JsonMember* const member = json.find("metrics");
  if (member == nullptr) problems.add(json.place, "there are no metrics in this file");
  JsonValue only{.kind = JsonValue::Kind::object, .place = json.place};
  if (member != nullptr) only.members.push_back(*member);
  read_fields(only, problems, [&](Fields& f) { metrics_fields(f, metrics); });
  problems.throw_if_any();
  return metrics;
}

namespace {

const std::array<std::string, 3> sampling_names{"grid", "random", "latin_hypercube"};

void placed_string(Fields& f, const char* key, PlacedName& name, const char* doc) {
  f.string(key, name.name, doc);
  name.place = f.place(key);
}

void verify(const Fields& f, const SweepPlan& plan) {
  if (plan.sampling != Sampling::grid && plan.cases == 0)
    f.refuse("cases", " is missing: how many runs a " + std::string(name(plan.sampling)) + " sample has");
  if (plan.sampling == Sampling::grid && plan.vary.empty())
    f.refuse("vary", " is missing: a grid needs something to vary");
  if (plan.sampling == Sampling::grid && plan.sample_randomise)
    f.refuse("sample_randomise", ": a grid varies only what vary names");
  verify_metric(plan.first_try, plan, f.problems());
  verify_metric(plan.time, plan, f.problems());
  verify_metric(plan.worst, plan, f.problems());
  verify_metric(plan.heat_map.metric, plan, f.problems());
}

void plan_fields(Fields& f, SweepPlan& plan) {
  experiment_fields(f, plan, Need::required);
  f.choice("sampling", plan.sampling, sampling_names, "how the points are chosen");
  f.integer("cases", plan.cases, {0, sweep_cases_max},
            "number of runs of all scenarios together; a grid without it runs each point once, with it uses the points "
            "in turn");
  f.boolean("same_seeds", plan.same_seeds,
            "all points in one round of a grid, or all scenarios of one sample, have the same seed");
  f.number("passed_min", plan.passed_min, {0, 1}, "share of the cases that must pass for the sweep to pass");
  placed_string(f, "first_try", plan.first_try, "metric that is not 0 when a passed run succeeded at its first try");
  placed_string(f, "time", plan.time, "metric in seconds whose median over the passed runs is reported");
  placed_string(f, "worst", plan.worst, "metric whose greatest values are shown as the worst cases");
  f.object("heat_map", "two quantities over which the results are drawn", [&](Fields& e) {
    placed_string(e, "x", plan.heat_map.x, "quantity on the horizontal axis");
    placed_string(e, "y", plan.heat_map.y, "quantity on the vertical axis");
    placed_string(e, "metric", plan.heat_map.metric,
                  "metric whose mean is drawn (default: the share of runs that passed)");
  });
  if (f.reading()) verify(f, plan);
}

}  // namespace

const char* name(Sampling sampling) noexcept { return sampling_names[static_cast<std::size_t>(sampling)].c_str(); }

SweepPlan read_sweep_plan_text(const std::string& text, const std::string& file) {
  SweepPlan plan;
  plan.file = file;
  read_based_fields(text, file, read_sweep_plan, [&](Fields& f) { plan_fields(f, plan); });
  return plan;
}

SweepPlan read_sweep_plan(const std::filesystem::path& file) {
  return read_sweep_plan_text(read_input_file(file), file.string());
}

FieldInfo describe_sweep_plan() {
  SweepPlan plan;
  return describe_fields([&](Fields& f) { plan_fields(f, plan); });
}

namespace {

void parameter_fields(Fields& e, bool of_program, TunedParameter& parameter) {
  double min = 0, max = 0, start = 0;
  bool log = false;
  e.number("min", min, {}, "least value, in the parameter's unit", Need::required);
  e.number("max", max, {}, "greatest value", Need::required);
  e.boolean("log", log, "the search is on a logarithmic scale, for a range of several decades");
  if (e.number("start", start, {}, "value at which the search begins (default: the one in the robot's configuration)"))
    parameter.start = start;
  if (!e.reading()) return;
  parameter.range = {.kind = log ? Distribution::Kind::log_uniform : Distribution::Kind::uniform, .of = {min, max}};
  if (!(min < max)) e.refuse("max", " must be above min, " + number_text(min));
  if (log && !(min > 0)) e.refuse("min", " must be above 0 for log");
  if (parameter.start && !(start >= min && start <= max)) e.refuse("start", " must be between min and max");
  const std::string& name = parameter.pattern.name;
  if (of_program) {
    if (!parameter.start) e.refuse("start", " is missing: a program has no configuration");
    return;
  }
  if (!name.starts_with("control.") || name.ends_with("_scale") || name.find('.', 8) == std::string::npos ||
      name.substr(8, name.find('.', 8) - 8).find('*') != std::string::npos) {
    e.refuse(parameter.pattern.place,
             in_quotes(name) +
                 " cannot be written to a robot's configuration: it must be control.OBJECT.PARAMETER, "
                 "such as control.posture.*_knee.kp_Nm_per_rad");
  }
}

// What a program scores has nothing of scenarios.
void verify_program(const Fields& f, const TunePlan& plan) {
  if (plan.program.empty()) {
    if (plan.scenarios.empty()) f.refuse("scenarios", " is missing: what is scored, if it is not a program");
    if (!plan.check_program.empty()) f.refuse("check_program", " needs program");
    verify_metric(plan.score, plan, f.problems());
    return;
  }
  for (const char* key : {"scenarios", "vary", "metrics", "runs", "check_runs", "sample_randomise"}) {
    if (f.has(key)) f.refuse(key, " means nothing beside program");
  }
}

void plan_fields(Fields& f, TunePlan& plan) {
  experiment_fields(f, plan, Need::optional);
  f.strings(
      "program", plan.program, {1, 100},
      "in place of scenarios: a program and its arguments; NAME=VALUE of each parameter follows them, and the last "
      "line that it prints is a JSON object of metrics");
  f.strings("check_program", plan.check_program, {1, 100},
            "the program that judges the values found, in the same way (default: the same program)");
  f.map("tune", "parameters to be tuned, by a pattern of their names", [&](Fields& e) {
    TunedParameter parameter{.pattern = {e.key(), e.key_place()}, .range = {}, .start = {}};
    parameter_fields(e, !plan.program.empty(), parameter);
    if (e.reading()) plan.tune.push_back(std::move(parameter));
  });
  f.integer("runs", plan.runs, {1, 10'000},
            "number of runs of each candidate; all candidates have the same seeds and points");
  f.integer("check_runs", plan.check_runs, {2, 100'000},
            "number of runs with the old and with the new values, with seeds that the search did not use");
  f.integer("population", plan.population, {5, 1000}, "number of candidates in a generation");
  f.integer("generations", plan.generations, {1, 10'000}, "number of generations");
  f.number("step", plan.step, {1e-3, 1}, "spread of the first candidates, as a share of the ranges");
  f.string("score", plan.score.name, "metric whose mean over the runs is minimised", Need::required);
  plan.score.place = f.place("score");
  f.boolean("greatest", plan.greatest, "the score is maximised instead");
  f.number("failed_score", plan.failed_score, {}, "score of a run that did not pass or has no value", Need::required);
  if (!f.reading()) return;
  if (plan.tune.empty()) f.refuse("tune", " is missing: the parameters that are sought");
  verify_program(f, plan);
}

}  // namespace

TunePlan read_tune_plan_text(const std::string& text, const std::string& file) {
  TunePlan plan;
  plan.file = file;
  read_based_fields(text, file, read_tune_plan, [&](Fields& f) { plan_fields(f, plan); });
  return plan;
}

TunePlan read_tune_plan(const std::filesystem::path& file) {
  return read_tune_plan_text(read_input_file(file), file.string());
}

FieldInfo describe_tune_plan() {
  TunePlan plan;
  return describe_fields([&](Fields& f) { plan_fields(f, plan); });
}

}  // namespace kadans
