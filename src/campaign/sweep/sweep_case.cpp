
#include "sweep_case.h"

#include <algorithm>
#include <numeric>
#include <string_view>

#include "kadans/signal/content_hash.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/nearest_name.h"
#include "kadans/signal/random.h"
#include "kadans/signal/shell_word.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

std::uint32_t steps_of(const ExperimentAxis& axis) {
  const Distribution& distribution = axis.variation.distribution;
  return distribution.kind == Distribution::Kind::values ? static_cast<std::uint32_t>(distribution.values.size())
                                                         : axis.steps;
}

void add_axes(const ExperimentAxis& axis, bool one, const std::vector<std::string>& quantities,
              std::vector<SampleAxis>& axes, Problems& problems) {
  const auto& [pattern, distribution] = axis.variation;
  std::vector<std::string> names;
  for (const std::size_t index : matching(pattern.name, quantities)) names.push_back(quantities[index]);
  if (names.empty()) problems.add_unknown(pattern.place, "quantity", pattern.name, quantities);
  if (one || distribution.together) {
    axes.push_back({pattern.name, names, distribution, steps_of(axis)});
    return;
  }
  for (const std::string& name : names) axes.push_back({name, {name}, distribution, steps_of(axis)});
}

// The ends of a range are points of a grid; of a normal distribution, whose ends are far out, the middles of its parts.
double grid_u(const SampleAxis& axis, std::size_t step) {
  const auto k = static_cast<double>(step), n = static_cast<double>(axis.steps);
  const bool ranged = axis.distribution.kind == Distribution::Kind::uniform ||
                      axis.distribution.kind == Distribution::Kind::log_uniform;
  return ranged && axis.steps > 1 ? k / (n - 1) : (k + 0.5) / n;
}

std::vector<std::vector<double>> grid(const std::vector<SampleAxis>& axes, std::size_t points) {
  std::vector<std::vector<double>> sample(points, std::vector<double>(axes.size()));
  for (std::size_t point = 0; point < points; ++point) {
    std::size_t rest = point;
    for (std::size_t i = axes.size(); i-- > 0; rest /= axes[i].steps)  // the last axis goes round fastest
      sample[point][i] = grid_u(axes[i], rest % axes[i].steps);
  }
  return sample;
}

// Which n-th part each of n points takes: a shuffle (Fisher and Yates).
std::vector<std::size_t> shuffled(std::size_t n, RandomStream& random) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = n; i > 1; --i) {
    const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(i));
    std::swap(order[i - 1], order[std::min(k, i - 1)]);
  }
  return order;
}

}  // namespace

std::vector<SampleAxis> sample_axes(const SweepPlan& plan, const std::vector<Variation>& randomise,
                                    const std::vector<std::string>& quantities, Problems& problems) {
  std::vector<SampleAxis> axes;
  if (plan.sample_randomise) {
    for (const Variation& variation : randomise) add_axes({variation}, false, quantities, axes, problems);
  }
  for (const ExperimentAxis& axis : plan.vary)
    add_axes(axis, plan.sampling == Sampling::grid, quantities, axes, problems);
  return axes;
}

std::size_t grid_points(const std::vector<SampleAxis>& axes) {
  std::size_t points = 1;
  for (const SampleAxis& axis : axes) points = std::min<std::size_t>(points * axis.steps, sweep_cases_max + 1);
  return points;
}

std::vector<std::vector<double>> sample(Sampling sampling, const std::vector<SampleAxis>& axes, std::size_t points,
                                        std::uint64_t seed, const std::string& stream) {
  if (sampling == Sampling::grid) return grid(axes, points);
  std::vector<std::vector<double>> sample(points, std::vector<double>(axes.size()));
  for (std::size_t i = 0; i < axes.size(); ++i) {
    RandomStream random(seed, stream + "." + axes[i].name);
    std::vector<std::size_t> parts;
    if (sampling == Sampling::latin_hypercube) parts = shuffled(points, random);
    for (std::size_t point = 0; point < points; ++point) {
      const double u = random.uniform();
      sample[point][i] = parts.empty() ? u : (static_cast<double>(parts[point]) + u) / static_cast<double>(points);
    }
  }
  return sample;
}

std::vector<QuantityValue> settings_at(const std::vector<SampleAxis>& axes, const std::vector<double>& point) {
  std::vector<QuantityValue> settings;
  for (std::size_t i = 0; i < axes.size(); ++i) settings.push_back({axes[i].name, axes[i].distribution.at(point[i])});
  return settings;
}

std::vector<QuantityValue> quantities_at(const std::vector<SampleAxis>& axes, const std::vector<double>& point) {
  std::vector<QuantityValue> settings;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double value = axes[i].distribution.at(point[i]);
    for (const std::string& name : axes[i].names) put_value(settings, name, value);
  }
  return settings;
}

namespace {

// Seeds of different sweeps have nothing to do with each other.
std::uint64_t seed_of(const SweepPlan& plan, std::size_t number) {
  return RandomStream(plan.seed, "sweep.case." + std::to_string(number)).next() >> 11U;
}

std::string id_of(const SweepPlan& plan, const SweepSubject& subject, const SweepCase& one,
                  const std::string& version) {
  ContentHash hash;
  hash.add(version);
  hash.add(subject.scenario.written);
  hash.add(subject.content);
  hash.add(one.seed);
  for (const QuantityValue& setting : one.settings) {
    hash.add(setting.name);
    hash.add(number_text(setting.value));
  }
  for (const MetricConfig& metric : plan.metrics) hash.add(definition(metric));
  return hash.hex();
}

// The points that each scenario is run at.
struct Points {
  std::vector<SampleAxis> axes;
  std::vector<std::vector<double>> at;
};

std::vector<Points> points_of(const SweepPlan& plan, const std::vector<SweepSubject>& subjects) {
  Problems problems(plan.file);
  std::vector<Points> all;
  for (const SweepSubject& subject : subjects) {
    Points points{.axes = sample_axes(plan, subject.randomise, subject.quantities, problems), .at = {}};
    const std::size_t a_scenario = (plan.cases + subjects.size() - 1) / subjects.size();
    const std::size_t count = plan.sampling == Sampling::grid ? grid_points(points.axes) : a_scenario;
    if (count * subjects.size() > sweep_cases_max) {
      problems.add({}, "the grid has more than " + std::to_string(sweep_cases_max) + " points");
    } else {
      points.at = sample(plan.sampling, points.axes, count, plan.seed, "sweep." + std::to_string(all.size()));
    }
    all.push_back(std::move(points));
  }
  problems.throw_if_any();
  return all;
}

}  // namespace

// Case i: scenarios go round fastest, then the points, then the rounds over all points.
std::vector<SweepCase> sweep_cases(const SweepPlan& plan, const std::vector<SweepSubject>& subjects,
                                   const std::string& version) {
  const std::vector<Points> points = points_of(plan, subjects);
  std::size_t all_points = 0;
  for (const Points& of_one : points) all_points = std::max(all_points, of_one.at.size());
  const std::size_t round = all_points * subjects.size();
  const std::size_t count = plan.cases > 0 ? plan.cases : round;
  std::vector<SweepCase> cases;
  for (std::size_t i = 0; i < count; ++i) {
    SweepCase one{.index = i, .subject = i % subjects.size(), .settings = {}, .quantities = {}, .id = {}};
    const Points& own = points[one.subject];
    const std::vector<double>& point = own.at[i / subjects.size() % own.at.size()];
    one.settings = settings_at(own.axes, point);
    one.quantities = quantities_at(own.axes, point);
    const std::size_t shared = plan.sampling == Sampling::grid ? i / round : i / subjects.size();
    one.seed = seed_of(plan, plan.same_seeds ? shared : i);
    one.id = id_of(plan, subjects[one.subject], one, version);
    cases.push_back(std::move(one));
  }
  return cases;
}

std::vector<std::string> run_arguments(const SweepCase& one, const std::string& file) {
  std::vector<std::string> arguments{"sim", file, "--seed", std::to_string(one.seed)};
  for (const QuantityValue& setting : one.settings) {
    arguments.emplace_back("--set");
    arguments.push_back(setting.name + "=" + number_text(setting.value));
  }
  return arguments;
}

std::string repeat_command(const SweepCase& one, const SweepSubject& subject) {
  std::string command = "kadans";
  for (const std::string& argument : run_arguments(one, subject.scenario.written))
    command += " " + shell_word(argument);
  return command;
}

}  // namespace kadans
