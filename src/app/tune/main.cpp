// The program kadans-tune, by which `kadans tune` replaces itself.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/sweep/sweep_run.h"
#include "app/sweep/sweep_subjects.h"
#include "app/terminal.h"
#include "campaign/sweep/merged_sweep.h"
#include "campaign/sweep/parameter_edit.h"
#include "campaign/sweep/sweep_case.h"
#include "campaign/tuning/cma_es.h"
#include "config/json/foreign_json.h"
#include "config/json/json_value.h"
#include "kadans/campaign/shard.h"
#include "kadans/signal/content_hash.h"
#include "kadans/signal/random.h"
#include "program_tuning.h"
#include "signal/durable_file.h"

namespace kadans {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

TunePlan read_plan(const TuneOptions& options) {
  TunePlan plan = read_tune_plan(options.plan);
  plan.seed = options.seed.value_or(plan.seed);
  plan.generations = options.generations.value_or(plan.generations);
  plan.runs = options.runs.value_or(plan.runs);
  return plan;
}

std::uint64_t check_seed(const TunePlan& plan) { return RandomStream(plan.seed, "tune.check").next() >> 11U; }

// A hash of everything on which the search depends.
std::string hash_of(const TunePlan& plan, const std::vector<SweepCase>& runs) {
  ContentHash hash;
  for (const SweepCase& run : runs) hash.add(run.id);
  for (const TunedParameter& parameter : plan.tune) {
    hash.add(parameter.pattern.name);
    for (const double end : parameter.range.of) hash.add(number_text(end));
    hash.add(parameter.start ? number_text(*parameter.start) : "");
    hash.add(static_cast<std::uint64_t>(parameter.range.kind));
  }
  for (const double value :
       {plan.step, plan.failed_score, static_cast<double>(plan.population), plan.greatest ? 1.0 : 0.0})
    hash.add(number_text(value));
  hash.add(plan.score.name);
  hash.add(plan.seed);
  return hash.hex();
}

std::string generation_name(std::size_t generation) { return printed("generation-%03zu", generation); }

}  // namespace

CmaEs make_search(const TunePlan& plan, const std::vector<TunedAxis>& axes) {
  return CmaEs({.start = start_point(axes),
                .population = plan.population,
                .generations = plan.generations,
                .step = plan.step,
                .seed = plan.seed});
}

Json by_name(const std::vector<TunedAxis>& axes, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < axes.size(); ++i) json[axes[i].parameter.pattern.name] = values[i];
  return json;
}

void require_free(const TuneOptions& options) {
  if (!options.write.empty() && fs::exists(options.write) && !options.overwrite)
    refuse(options.write, "is there already; --overwrite replaces it");
}

void print_generation(const TunePlan& plan, const CmaEs& search, const std::vector<double>& scores) {
  const double sign = plan.greatest ? -1 : 1;
  std::printf("  %s  best %.5g, best so far %.5g\n", generation_name(search.generation() - 1).c_str(),
              sign * *std::ranges::min_element(scores), sign * search.best_score());
  std::fflush(stdout);
}

void print_found(const TunePlan& plan, const std::vector<TunedAxis>& axes, const std::vector<double>& values) {
  std::printf("%s%s%s\n", plan.name.c_str(), plan.doc.empty() ? "" : ": ", plan.doc.c_str());
  for (std::size_t i = 0; i < axes.size(); ++i)
    std::printf("  %s  %s -> %s\n", axes[i].parameter.pattern.name.c_str(), number_text(axes[i].start).c_str(),
                number_text(values[i]).c_str());
}

namespace {

// A tuning, from its plan to the configuration that it finds. All evaluated results are kept in files, one folder for
// each generation. So every process that shares the folder makes the same search and evaluates its part of each
// generation.
class Tuning {
 public:
  // Keeps a reference to the options.
  Tuning(const TuneOptions& options, TunePlan plan)
      : options_(options),
        plan_(std::move(plan)),
        version_(build_version()),
        robot_(tuned_robot(plan_)),
        subjects_(read_sweep_subjects(plan_)),
        axes_(tuned_axes(plan_, robot_)),
        runs_(common_runs(plan_, subjects_, plan_.runs, plan_.seed, version_)),
        search_(make_search(plan_, axes_)) {
    folder_ = options.out;
    if (folder_.empty()) folder_ = fs::path("tunings") / (plan_.name + "-" + hash_of(plan_, runs_).substr(0, 8));
    configuration_ = options.write.empty() ? folder_ / "robot.json" : fs::path(options.write);
    require_free(options);
    shard_ = options.shard.empty() ? slurm_shard().value_or(Shard{}) : parse_shard(options.shard);
  }

  int run() {
    Progress progress = search();
    std::vector<CaseRow> rows;
    const std::vector<double> best = values_at(axes_, search_.best());
    if (progress == Progress::complete) {
      const auto fresh = common_runs(plan_, subjects_, plan_.check_runs, check_seed(plan_), version_);
      progress = evaluate("check", candidate_cases(fresh, axes_, {{}, best}), rows);
    }
    if (progress == Progress::interrupted) return exit_interrupted;
    if (progress == Progress::others_missing) {
      print_error("the other parts of the generation did not come; run this again and it goes on");
      return exit_failed;
    }
    write_configuration(best);
    report(best, tuning_effect(plan_, rows));
    return exit_passed;
  }

 private:
  enum class Progress { complete, interrupted, others_missing };

  Progress search() {
    for (;;) {
      const std::vector<Point> points = search_.ask();
      if (points.empty()) return Progress::complete;
      std::vector<std::vector<double>> candidates;
      for (const Point& point : points) candidates.push_back(values_at(axes_, point));
      const std::string name = generation_name(search_.generation());
      note_candidates(name, candidates);
      std::vector<CaseRow> rows;
      const Progress progress = evaluate(name, candidate_cases(runs_, axes_, candidates), rows);
      if (progress != Progress::complete) return progress;
      const std::vector<double> scores = candidate_scores(plan_, rows, runs_.size());
      search_.tell(scores);
      if (!options_.json) print_generation(plan_, search_, scores);
    }
  }

  // Evaluates this process's part of the cases in a folder below the tuning's, and waits for the other processes'
  // parts.
  Progress evaluate(const std::string& name, const std::vector<SweepCase>& cases, std::vector<CaseRow>& rows) {
    SweepPlan sweep;
    static_cast<ExperimentConfig&>(sweep) = plan_;
    sweep.name = plan_.name + " " + name;
    const SweepResults results(folder_ / name, manifest_of(sweep, cases, version_));
    std::vector<SweepCase> own;
    std::ranges::copy_if(cases, std::back_inserter(own),
                         [&](const SweepCase& one) { return shard_.holds(one.index) && !results.has(one); });
    SweepRun(plan_, subjects_, results, std::move(own), false, JobProgress::Log::terminal_only).run(options_.jobs);
    const Progress progress = wait_for_others(results, cases);
    if (progress == Progress::complete) rows = merge({results}).rows;
    return progress;
  }

  Progress wait_for_others(const SweepResults& results, const std::vector<SweepCase>& cases) const {
    const auto began = std::chrono::steady_clock::now();
    const auto there = [&](const SweepCase& one) { return results.has(one); };
    while (!std::ranges::all_of(cases, there)) {
      if (interrupted()) return Progress::interrupted;
      if (std::chrono::steady_clock::now() - began > std::chrono::duration<double>(options_.wait_s))
        return Progress::others_missing;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return Progress::complete;
  }

  // Writes the candidates of a generation into a file, for people and other programs.
  void note_candidates(const std::string& name, const std::vector<std::vector<double>>& candidates) const {
    Json json = Json::array();
    for (const std::vector<double>& values : candidates) json.push_back(by_name(axes_, values));
    fs::create_directories(folder_ / name);
    write_durably(folder_ / name / "candidates.json", json_text(json, 1) + "\n");
  }

  void write_configuration(const std::vector<double>& values) const {
    std::vector<ParameterEdit> edits;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const std::string name = axes_[i].parameter.pattern.name.substr(std::string("control.").size());
      const std::size_t dot = name.find('.');
      ParameterEdit edit{
          .object = name.substr(0, dot), .pattern = name.substr(dot + 1), .matched = {}, .value = values[i]};
      for (const std::string& full : axes_[i].names)
        edit.matched.push_back(full.substr(std::string("control.").size() + dot + 1));
      edits.push_back(std::move(edit));
    }
    const std::string& file = robot_.config.file;
    write_durably(configuration_, edit_parameters(read_input_file(file), file, edits));
  }

  void report(const std::vector<double>& values, const TuningEffect& effect) const {
    if (options_.json) {
      Json json{{"tuning", plan_.name}, {"generations", plan_.generations}, {"parameters", by_name(axes_, values)}};
      json["before"] = {{"score", effect.before.mean}, {"passed", effect.passed_before}};
      json["after"] = {{"score", effect.after.mean}, {"passed", effect.passed_after}};
      json["change"] = {{"mean", effect.change.mean},
                        {"low", effect.change.mean_interval.low},
                        {"high", effect.change.mean_interval.high}};
      json["runs"] = effect.runs;
      json["configuration"] = configuration_.string();
      std::puts(json_text(json).c_str());
      return;
    }
    print_found(plan_, axes_, values);
    std::fputs(effect_text(plan_, effect).c_str(), stdout);
    std::printf("  configuration: %s\n", configuration_.c_str());
  }

  const TuneOptions& options_;
  TunePlan plan_;
  std::string version_;
  Robot robot_;
  std::vector<SweepSubject> subjects_;
  std::vector<TunedAxis> axes_;
  std::vector<SweepCase> runs_;
  CmaEs search_;
  Shard shard_;
  std::filesystem::path folder_, configuration_;
};

int run(int argc, char** argv) {
  CLI::App app("Kadans: the program behind `kadans tune`", "kadans");
  app.require_subcommand(1);
  TuneOptions options;
  add_tune_options(*app.add_subcommand("tune"), options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    print_error(error.what());
    return exit_usage;
  }
  catch_interrupts();
  TunePlan plan = read_plan(options);
  return plan.program.empty() ? Tuning(options, std::move(plan)).run() : tune_by_program(options, plan);
}

}  // namespace
}  // namespace kadans

int main(int argc, char** argv) {
  return kadans::ended_well([&] { return kadans::run(argc, argv); });
}
