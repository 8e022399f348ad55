#include "program_tuning.h"

#include <cstdio>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "app/sweep/sweep_run.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "config/json/json_value.h"
#include "config/robot/project_root.h"
#include "kadans/campaign/job_pool.h"
#include "signal/durable_file.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

constexpr double wall_limit_s = 3600;  // of one candidate

// What the program said of each candidate.
struct Judged {
  Json metrics = Json::object();
  std::string failure;
};

Judged judge(const JobOutcome& outcome) {
  Judged judged;
  std::string_view text = outcome.out;
  while (text.ends_with('\n')) text.remove_suffix(1);
  if (outcome.timed_out) {
    judged.failure = "took too long";
  } else if (outcome.signal != 0) {
    judged.failure = "was ended by signal " + std::to_string(outcome.signal);
  } else if (outcome.exit_code != 0) {
    judged.failure = "ended with exit code " + std::to_string(outcome.exit_code);
    if (!outcome.err.empty()) judged.failure += ": " + outcome.err.substr(0, 500);
  } else if (auto json = read_foreign_json(text.substr(text.rfind('\n') + 1)); json && json->is_object()) {
    judged.metrics = std::move(*json);
  } else {
    judged.failure = "printed no JSON object in its last line";
  }
  return judged;
}

class Judges final : public JobWatcher {
 public:
  explicit Judges(std::size_t candidates) : progress_(candidates, true), all_(candidates) {}

  void ended(const JobOutcome& outcome) override {
    all_[outcome.job] = judge(outcome);
    progress_.ended();
  }
  void passed_time(std::size_t running) override { progress_.draw(running); }
  bool stop_asked() const override { return interrupted(); }

  std::vector<Judged> take() {
    progress_.clear();
    return std::move(all_);
  }

 private:
  JobProgress progress_;
  std::vector<Judged> all_;
};

class ProgramTuning {
 public:
  ProgramTuning(const TuneOptions& options, const TunePlan& plan)
      : options_(options), plan_(plan), axes_(tuned_axes(plan)), search_(make_search(plan, axes_)) {}

  int run() {
    if (!plan_.check_program.empty()) (void)path_of(plan_.check_program);  // missed now, not after the search
    for (std::vector<Point> points; points = search_.ask(), !points.empty();) {
      std::vector<std::vector<double>> candidates;
      for (const Point& point : points) candidates.push_back(values_at(axes_, point));
      const std::vector<Judged> judged = judge_all(plan_.program, candidates);
      if (interrupted()) return exit_interrupted;
      const bool first = search_.generation() == 0;
      std::vector<double> scores;
      for (const Judged& one : judged) scores.push_back(score_of(one, first));
      search_.tell(scores);
      if (!options_.json) print_generation(plan_, search_, scores);
    }
    const std::vector<double> found = values_at(axes_, search_.best());
    std::vector<double> start;
    for (const TunedAxis& axis : axes_) start.push_back(axis.start);
    const std::vector<Judged> judged =
        judge_all(plan_.check_program.empty() ? plan_.program : plan_.check_program, {start, found});
    if (interrupted()) return exit_interrupted;
    for (const Judged& one : judged) (void)score_of(one, true);
    if (!options_.write.empty()) write_durably(options_.write, json_text(by_name(axes_, found), 1) + "\n");
    report(found, judged);
    return exit_passed;
  }

 private:
  std::vector<Judged> judge_all(const std::vector<PlacedName>& program,
                                const std::vector<std::vector<double>>& candidates) const {
    std::vector<Job> jobs;
    for (const std::vector<double>& values : candidates) {
      Job job{{}, wall_limit_s};
      for (const PlacedName& argument : program) job.arguments.push_back(argument.name);
      job.arguments.front() = path_of(program);
      for (std::size_t i = 0; i < values.size(); ++i) {
        job.arguments.push_back(axes_[i].parameter.pattern.name + "=" + number_text(values[i]));
      }
      jobs.push_back(std::move(job));
    }
    Judges judges(jobs.size());
    run_jobs(jobs, options_.jobs, judges);
    return judges.take();
  }

  std::string path_of(const std::vector<PlacedName>& program) const {
    Problems problems(plan_.file);
    std::string path = resolve_file(program.front().name, program.front().place, "program", problems).string();
    problems.throw_if_any();
    return path;
  }

  // Of a candidate for which the program fails, failed_score; `must` be one for which it does not.
  double score_of(const Judged& judged, bool must) const {
    const auto metric = judged.metrics.find(plan_.score.name);
    std::string failure = judged.failure;
    if (failure.empty() && (metric == judged.metrics.end() || !metric->is_number()))
      failure = "gave no number " + plan_.score.name;
    if (!failure.empty() && must) refuse(plan_.program.front().name, failure);
    const double value = failure.empty() ? metric->get<double>() : plan_.failed_score;
    return plan_.greatest ? -value : value;
  }

  void report(const std::vector<double>& found, const std::vector<Judged>& judged) const {
    if (options_.json) {
      const Json json{{"tuning", plan_.name},
                      {"generations", plan_.generations},
                      {"parameters", by_name(axes_, found)},
                      {"before", judged[0].metrics},
                      {"after", judged[1].metrics}};
      std::puts(json_text(json).c_str());
      return;
    }
    print_found(plan_, axes_, found);
    std::printf("  before  %s\n  after   %s\n", json_text(judged[0].metrics).c_str(),
                json_text(judged[1].metrics).c_str());
  }

  static std::vector<TunedAxis> tuned_axes(const TunePlan& plan) {
    std::vector<TunedAxis> axes;
    for (const TunedParameter& parameter : plan.tune) {
      axes.push_back({.parameter = parameter, .names = {}, .start = parameter.start.value_or(0)});
    }
    return axes;
  }

  const TuneOptions& options_;
  const TunePlan& plan_;
  std::vector<TunedAxis> axes_;
  CmaEs search_;
};

}  // namespace

int tune_by_program(const TuneOptions& options, const TunePlan& plan) {
  const auto refuse_option = [&](bool given, const char* option) {
    if (given) refuse(plan.file, std::string(option) + " is for tunings of scenarios");
  };
  refuse_option(options.runs.has_value(), "--runs");
  refuse_option(!options.shard.empty(), "--shard");
  refuse_option(!options.out.empty(), "--out");
  require_free(options);
  return ProgramTuning(options, plan).run();
}

}  // namespace kadans
