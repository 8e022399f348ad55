#include "experiment_config.h"

#include <limits>

#include "config/robot/project_root.h"
#include "config/scenario/based_on.h"

namespace kadans {

void experiment_fields(Fields& f, ExperimentConfig& experiment, Problems& problems) {
  std::string schema, base;
  f.string("$schema", schema, "the schema of this file, for editors");
  f.string("based_on", base, "another plan; this file says only what is different");
  f.string("name", experiment.name, "the plan's name", Need::required);
  f.string("doc", experiment.doc, "what it shows, one or two sentences");
  std::vector<PlacedName> scenarios;
  f.strings("scenarios", scenarios, {1, 1000}, "files, from the project root; the cases use them in turn",
            Need::required);
  for (const PlacedName& scenario : scenarios) {
    experiment.scenarios.push_back(
        {scenario.name, resolve_file(scenario.name, scenario.place, "scenarios", problems).string(), scenario.place});
  }
  f.integer("seed", experiment.seed, {0, std::numeric_limits<std::uint64_t>::max()},
            "seed of the sample and of the seeds of all runs");
  f.boolean("sample_randomise", experiment.sample_randomise,
            "the sample also chooses what the scenarios randomise (default: each run's seed draws it)");
  f.map("vary", "quantities that differ from case to case, by a pattern of their names", [&](Fields& e) {
    ExperimentAxis axis{.variation = {.pattern = {e.key(), e.key_place()}, .distribution = {}}};
    distribution_fields(e, axis.variation.distribution, problems);
    e.integer("steps", axis.steps, {1, 10'000},
              "number of points in a grid, including both ends; not for values, each of which is a point");
    if (e.reading()) experiment.vary.push_back(std::move(axis));
  });
  metrics_fields(f, experiment.metrics, problems);
}

void verify_metric(const PlacedName& name, const ExperimentConfig& experiment, Problems& problems) {
  if (name.name.empty()) return;
  std::vector<std::string> names;
  for (const MetricConfig& metric : experiment.metrics) {
    if (metric.name == name.name) return;
    names.push_back(metric.name);
  }
  problems.add_unknown(name.place, "metric", name.name, names);
}

std::vector<MetricConfig> read_metrics(const std::string& file) {
  std::vector<MetricConfig> metrics;
  Problems problems(file);
  const JsonValue json = parse_based_json(read_input_file(file), file).value;
  const JsonMember* const member = json.find("metrics");
  if (member == nullptr) problems.add(json.place, "there are no metrics in this file");
  JsonValue only{.kind = JsonValue::Kind::object, .place = json.place};
  if (member != nullptr) only.members.push_back(*member);
  read_fields(only, problems, [&](Fields& f) { metrics_fields(f, metrics, problems); });
  problems.throw_if_any();
  return metrics;
}

}  // namespace kadans
