#include "sweep_case.h"

#include "campaign/work/content_hash.h"
#include "kadans/signal/random.h"
#include "signal/shell_word.h"

namespace kadans {
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
