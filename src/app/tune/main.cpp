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

#include "app/commands.h"
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

// A tuning, from its plan to the configuration that it finds. All evaluated results are kept in files, one folder for
// each generation. So every process that shares the folder makes the same search and evaluates its part of each
// generation.
class Tuning {
 public:
  Tuning(const TuneOptions& options, TunePlan plan);  // keeps a reference to the options

  int run();

 private:
  enum class Progress { complete, interrupted, others_missing };
  // Evaluates this process's part of the cases in a folder below the tuning's, and waits for the other processes'
  // parts.
  Progress evaluate(const std::string& name, const std::vector<SweepCase>& cases, std::vector<CaseRow>& rows);
  Progress wait_for_others(const SweepResults& results, const std::vector<SweepCase>& cases) const;
  Progress search();
  void note_candidates(const std::string& name, const std::vector<std::vector<double>>& candidates) const;
  void tell_generation(const std::vector<double>& scores) const;
  void write_configuration(const std::vector<double>& values) const;
  void report(const std::vector<double>& values, const TuningEffect& effect) const;

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

std::string generation_name(std::size_t generation) {
  char text[32];
  std::snprintf(text, sizeof text, "generation-%03zu", generation);
  return text;
}

}  // namespace

CmaEs make_search(const TunePlan& plan, const std::vector<TunedAxis>& axes) {
  return CmaEs({.start = start_point(axes),
                .population = plan.population,
                .generations = plan.generations,
                .step = plan.step,
                .seed = plan.seed});
}

Tuning::Tuning(const TuneOptions& options, TunePlan plan)
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
  if (!options.write.empty() && fs::exists(configuration_) && !options.overwrite)
    throw InputError(InputProblem{.file = options.write, .message = "is there already; --overwrite replaces it"});
  shard_ = options.shard.empty() ? slurm_shard().value_or(Shard{}) : parse_shard(options.shard);
}

int Tuning::run() {
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

Tuning::Progress Tuning::search() {
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
    tell_generation(scores);
  }
}

Tuning::Progress Tuning::evaluate(const std::string& name, const std::vector<SweepCase>& cases,
                                  std::vector<CaseRow>& rows) {
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

Tuning::Progress Tuning::wait_for_others(const SweepResults& results, const std::vector<SweepCase>& cases) const {
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
void Tuning::note_candidates(const std::string& name, const std::vector<std::vector<double>>& candidates) const {
  Json json = Json::array();
  for (const std::vector<double>& values : candidates) {
    Json candidate = Json::object();
    for (std::size_t i = 0; i < values.size(); ++i) candidate[axes_[i].parameter.pattern.name] = values[i];
    json.push_back(std::move(candidate));
  }
  fs::create_directories(folder_ / name);
  write_durably(folder_ / name / "candidates.json", json_text(json, 1) + "\n");
}

void Tuning::tell_generation(const std::vector<double>& scores) const {
  if (options_.json) return;
  const double sign = plan_.greatest ? -1 : 1;
  std::printf("  %s  best %.5g, best so far %.5g\n", generation_name(search_.generation() - 1).c_str(),
              sign * *std::ranges::min_element(scores), sign * search_.best_score());
  std::fflush(stdout);
}

void Tuning::write_configuration(const std::vector<double>& values) const {
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

void Tuning::report(const std::vector<double>& values, const TuningEffect& effect) const {
  if (options_.json) {
    Json json{{"tuning", plan_.name}, {"generations", plan_.generations}, {"parameters", Json::object()}};
    for (std::size_t i = 0; i < axes_.size(); ++i) json["parameters"][axes_[i].parameter.pattern.name] = values[i];
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
  std::printf("%s%s%s\n", plan_.name.c_str(), plan_.doc.empty() ? "" : ": ", plan_.doc.c_str());
  for (std::size_t i = 0; i < axes_.size(); ++i)
    std::printf("  %s  %s -> %s\n", axes_[i].parameter.pattern.name.c_str(), number_text(axes_[i].start).c_str(),
                number_text(values[i]).c_str());
  std::fputs(effect_text(plan_, effect).c_str(), stdout);
  std::printf("  configuration: %s\n", configuration_.c_str());
}

namespace {

int run(int argc, char** argv) {
  CLI::App app("Kadans: the program behind `kadans tune`", "kadans");
  app.require_subcommand(1);
  TuneOptions options;
  add_tune(app, options);
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
