#include "tune_plan.h"

#include "config/scenario/based_on.h"

namespace kadans {
namespace {

void parameter_fields(Fields& e, TunedParameter& parameter, Problems& problems) {
  double min = 0, max = 0, start = 0;
  bool log = false;
  e.number("min", min, {}, "least value, in the parameter's unit", Need::required);
  e.number("max", max, {}, "greatest value", Need::required);
  e.boolean("log", log, "the search is on a logarithmic scale, for a range of several decades");
  if (e.number("start", start, {}, "value at which the search begins (default: the one in the robot's configuration)"))
    parameter.start = start;
  if (!e.reading()) return;
  parameter.range = {.kind = log ? Distribution::Kind::log_uniform : Distribution::Kind::uniform, .of = {min, max}};
  if (!(min < max)) problems.add(e.place("max"), e.path("max") + " must be above min, " + number_text(min));
  if (log && !(min > 0)) problems.add(e.place("min"), e.path("min") + " must be above 0 for log");
  if (parameter.start && !(start >= min && start <= max))
    problems.add(e.place("start"), e.path("start") + " must be between min and max");
  const std::string& name = parameter.pattern.name;
  if (!name.starts_with("control.") || name.ends_with("_scale") || name.find('.', 8) == std::string::npos ||
      name.substr(8, name.find('.', 8) - 8).find('*') != std::string::npos) {
    problems.add(parameter.pattern.place,
                 in_quotes(name) +
                     " cannot be written to a robot's configuration: it must be control.OBJECT.PARAMETER, "
                     "such as control.posture.*_knee.kp_Nm_per_rad");
  }
}

void plan_fields(Fields& f, TunePlan& plan, Problems& problems) {
  experiment_fields(f, plan, problems);
  f.map("tune", "parameters to be tuned, by a pattern of their names", [&](Fields& e) {
    TunedParameter parameter{.pattern = {e.key(), e.key_place()}, .range = {}, .start = {}};
    parameter_fields(e, parameter, problems);
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
  if (plan.tune.empty()) problems.add(f.place("tune"), "tune is missing: the parameters that are sought");
  verify_metric(plan.score, plan, problems);
}

}  // namespace

TunePlan read_tune_plan_text(const std::string& text, const std::string& file) {
  TunePlan plan;
  plan.file = file;
  Problems problems(file);
  read_fields(parse_based_json(text, file).value, problems, [&](Fields& f) { plan_fields(f, plan, problems); });
  problems.throw_if_any();
  return plan;
}

TunePlan read_tune_plan(const std::filesystem::path& file) {
  return read_tune_plan_text(read_input_file(file), file.string());
}

FieldInfo describe_tune_plan() {
  TunePlan plan;
  Problems problems("");
  return describe_fields([&](Fields& f) { plan_fields(f, plan, problems); });
}

}  // namespace kadans
