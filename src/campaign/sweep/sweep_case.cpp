
#include "sweep_case.h"

#include <cstdlib>
#include <string_view>

#include "campaign/work/content_hash.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/random.h"
#include "signal/number_text.h"
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

namespace {

std::optional<std::size_t> variable(const char* name) {
  const char* const text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): before any thread is started
  if (text == nullptr || *text == '\0') return std::nullopt;
  const std::optional<std::size_t> value = number_of<std::size_t>(text);
  if (!value) throw InputError({.file = name, .message = "is '" + std::string(text) + "', must be a whole number"});
  return value;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::string_view all = text;
  const auto index = number_of<std::size_t>(all.substr(0, slash));
  const auto count = number_of<std::size_t>(slash == std::string::npos ? "" : all.substr(slash + 1));
  if (!index || !count || *count == 0) {
    throw InputError({.file = "--shard", .message = "'" + text + "' must be PART/PARTS, such as 0/4"});
  }
  const Shard shard{.index = *index, .count = *count};
  if (shard.index >= shard.count) {
    throw InputError({.file = "--shard",
                      .message = "'" + text + "': parts count from 0, the last of " + std::to_string(shard.count) +
                                 " is " + std::to_string(shard.count - 1) + "/" + std::to_string(shard.count)});
  }
  return shard;
}

std::optional<Shard> slurm_shard() {
  const auto id = variable("SLURM_ARRAY_TASK_ID");
  const auto count = variable("SLURM_ARRAY_TASK_COUNT");
  if (!id || !count) return std::nullopt;
  const std::size_t first = variable("SLURM_ARRAY_TASK_MIN").value_or(0);
  const std::size_t step = variable("SLURM_ARRAY_TASK_STEP").value_or(1);
  if (step == 0 || *id < first || (*id - first) % step != 0 || (*id - first) / step >= *count) {
    throw InputError({.file = "SLURM_ARRAY_TASK_ID",
                      .message = "is " + std::to_string(*id) + " in an array of " + std::to_string(*count) + " from " +
                                 std::to_string(first) + ": the array must be a range, such as --array=0-3"});
  }
  return Shard{(*id - first) / step, *count};
}

}  // namespace kadans
