#include "sweep_plan.h"

#include <array>

#include "config/scenario/based_on.h"

namespace kadans {
namespace {

const std::array<std::string, 3> sampling_names{"grid", "random", "latin_hypercube"};

void placed_string(Fields& f, const char* key, PlacedName& name, const char* doc) {
  f.string(key, name.name, doc);
  name.place = f.place(key);
}

void verify(const Fields& f, const SweepPlan& plan, Problems& problems) {
  if (plan.sampling != Sampling::grid && plan.cases == 0)
    problems.add(f.place("cases"),
                 "cases is missing: how many runs a " + std::string(name(plan.sampling)) + " sample has");
  if (plan.sampling == Sampling::grid && plan.vary.empty())
    problems.add(f.place("vary"), "vary is missing: a grid needs something to vary");
  if (plan.sampling == Sampling::grid && plan.sample_randomise)
    problems.add(f.place("sample_randomise"), "sample_randomise: a grid varies only what vary names");
  verify_metric(plan.first_try, plan, problems);
  verify_metric(plan.time, plan, problems);
  verify_metric(plan.worst, plan, problems);
  verify_metric(plan.heat_map.metric, plan, problems);
}

void plan_fields(Fields& f, SweepPlan& plan, Problems& problems) {
  experiment_fields(f, plan, problems);
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
  if (f.reading()) verify(f, plan, problems);
}

}  // namespace

const char* name(Sampling sampling) noexcept { return sampling_names[static_cast<std::size_t>(sampling)].c_str(); }

SweepPlan read_sweep_plan_text(const std::string& text, const std::string& file) {
  SweepPlan plan;
  plan.file = file;
  const BasedJson json = parse_based_json(text, file);
  if (!json.bases.empty()) (void)read_sweep_plan(json.bases.front());
  Problems problems(file);
  read_fields(json.value, problems, [&](Fields& f) { plan_fields(f, plan, problems); });
  problems.throw_if_any();
  return plan;
}

SweepPlan read_sweep_plan(const std::filesystem::path& file) {
  return read_sweep_plan_text(read_input_file(file), file.string());
}

FieldInfo describe_sweep_plan() {
  SweepPlan plan;
  Problems problems("");
  return describe_fields([&](Fields& f) { plan_fields(f, plan, problems); });
}

}  // namespace kadans
