#include "sim_run.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "app/report/run_page.h"
#include "app/run/observers.h"
#include "app/services.h"
#include "app/terminal.h"
#include "config/plan/experiment_plans.h"
#include "input_files.h"
#include "kadans/signal/shell_word.h"
#include "played_behaviors.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

constexpr const char* height_signal = "plant.base.height_m";

// A run that was shortened on the command line says nothing about later times, so checks about them are left out.
std::vector<ScenarioCheck> reached_checks(const ScenarioConfig& scenario, double duration_s) {
  std::vector<ScenarioCheck> checks = scenario.checks;
  if (duration_s >= scenario.duration_s) return checks;
  std::erase_if(checks, [&](const ScenarioCheck& check) { return !judges_run_until(check, duration_s); });
  return checks;
}

RunInputs inputs_for(RunChoices choices, const ScenarioConfig& scenario, const Assembly& assembly, std::uint64_t seed,
                     double duration_s, bool watched) {
  choices.seed = seed;
  choices.duration_s = duration_s;
  RunInputs inputs = inputs_of(choices, scenario, assembly);
  if (watched) inputs.run["watched"] = "yes";
  return inputs;
}

ScenarioConfig scenario_of(const RunChoices& choices, const std::optional<SimContinuation>& continuation) {
  ScenarioConfig scenario = read_scenario(choices);
  if (continuation) add_ordered_events(continuation->from.inputs, "", scenario);
  return scenario;
}

std::vector<PlannedCheckpoint> checkpoints_of(const SimOptions& options) {
  std::vector<PlannedCheckpoint> planned;
  for (const std::string& text : options.checkpoints) planned.push_back(parse_checkpoint(text));
  return planned;
}

}  // namespace

SimRun::SimRun(const SimOptions& options, const RunChoices& choices, std::optional<SimContinuation> continuation)
    : options_(options),
      choices_(choices),
      scenario_(scenario_of(choices, continuation)),
      seed_(choices.seed.value_or(scenario_.seed)),
      duration_s_(choices.duration_s.value_or(scenario_.duration_s)),
      assembly_(scenario_, seed_, log_),
      checks_(assembly_.catalog().signals, reached_checks(scenario_, duration_s_), scenario_.file,
              assembly_.signal_states()),
      metrics_(assembly_.catalog().signals,
               options.metrics.empty() ? std::vector<MetricConfig>() : read_metrics(options.metrics), options.metrics,
               assembly_.signal_states()),
      height_("base height, m", assembly_.catalog().signals.find(height_signal).value(), duration_s_),
      record_plan_(record_plan(assembly_, options.recording, false)),
      continuation_(std::move(continuation)) {
  if (continuation_) {
    inputs_ = continuation_->from.inputs;
    const double at_s = 1e-9 * static_cast<double>(continuation_->from.at.time_ns);
    actions_.reserve(continuation_->branches.size());
    for (const RunBranch& branch : continuation_->branches) actions_.emplace_back(branch, scenario_, assembly_, at_s);
  } else {
    refuse_faulty_behaviors(assembly_);
    inputs_ = inputs_for(choices_, scenario_, assembly_, seed_, duration_s_, options_.watch);
    make_reachable();
  }
  if (options_.hash_every_s) trail_ = std::make_unique<HashTrail>(*options_.hash_every_s);
  if (!options_.checkpoints.empty())
    checkpoints_ = std::make_unique<CheckpointWriter>(inputs_, checkpoints_of(options_), assembly_, ordered_);
}

void SimRun::make_reachable() {
  const bool paced = options_.realtime || options_.live.wanted() || options_.ros2.wanted();
  ServiceOptions places = options_;
  places.ctl.wanted = places.ctl.wanted && (paced || !options_.ctl.folder.empty());
  if (!places.ctl.wanted && !places.live.wanted() && !places.ros2.wanted()) return;
  inputs_.run["ctl"] = "yes";
  remote_ =
      std::make_unique<SimRemote>(places, assembly_, RecordPlan{record_plan_.settings, {}, {}, nullptr}, log_, echo_);
  remote_->pace().speed = options_.speed;
}

int SimRun::run() {
  if (!continuation_) start_record();
  const bool alone = !continuation_ || continuation_->branches.size() == 1;
  ProgressBar progress(duration_s_, stderr_is_terminal() && !options_.json && alone);
  std::vector<RunObserver*> observers{&progress, &height_, &evidence_, &metrics_, this};
  LivePace wall_clock;
  std::optional<ViewerPacer> pacer;
  const bool viewed = (options_.live.wanted() || options_.ros2.wanted()) && remote_;
  if (viewed || options_.realtime) observers.push_back(&pacer.emplace(viewed ? remote_->pace() : wall_clock));
  if (trail_) observers.push_back(trail_.get());
  if (checkpoints_) observers.push_back(checkpoints_.get());
  if (remote_) {
    remote_->begin(recorder_.get(), record_.empty() ? "the flight recorder's" : record_);
    observers.push_back(remote_.get());
  }
  if (options_.watch) {
    assembly_.watch_behaviors();
    log_.add(stderr_sink(Shown::messages));
  }
  RunResult result = run_scenario(assembly_.parts(), duration_s_, checks_, observers);
  if (split_) return processes_.finish();
  if (parted_) return tell_parting();
  if (continuation_ && !reached_ && !result.interrupted) {
    print_error(options_.from + ": this run ended without coming to the tick of the checkpoint, " +
                std::to_string(continuation_->from.at.ticks));
    return exit_failed;
  }
  return report(result);
}

int SimRun::report(RunResult& result) {
  result.scenario = scenario_.name;
  result.seed = seed_;
  finish_record(result);
  if (const std::string why = remote_ ? remote_->end_record() : ""; !why.empty())
    tell_lost("the record is not complete: " + why);
  if (options_.report.wanted()) write_page(result);
  if (checkpoints_) {
    for (const PlannedCheckpoint& planned : checkpoints_->missed())
      tell_lost("the run was over before the checkpoint at " + number_text(planned.at_s) + " s");
  }
  print(result);
  if (result.interrupted) return exit_interrupted;
  return result.passed && lost_.empty() ? exit_passed : exit_failed;
}

void SimRun::tick(double, std::span<const double>) {
  if (!recorder_) return;
  // A failing disk is reported when the record is closed; the run goes on.
  (void)recorder_->drain();
  if (recorder_->flight() != nullptr && recorder_->flight()->due()) fly();
}

void SimRun::between_ticks(const RunMark& mark) {
  if (!continuation_) return;
  if (taken_ != nullptr) return taken_->between_ticks(mark);
  if (reached_) return;
  way_.between_ticks(mark);
  if (mark.ticks >= continuation_->from.at.ticks) reach_branch(mark);
}

void SimRun::reach_branch(const RunMark& mark) {
  reached_ = true;
  const RunMark& wanted = continuation_->from.at;
  parted_ = mark.state_hash != wanted.state_hash || mark.time_ns != wanted.time_ns;
  other_objects_ = differing_objects(continuation_->from.objects, object_states(assembly_));
  parted_ = parted_ || !other_objects_.empty();
  if (parted_) return;
  const std::size_t count = continuation_->branches.size();
  for (std::size_t i = 0; count > 1 && i < count; ++i) {
    if (processes_.split(std::max(1U, std::thread::hardware_concurrency()))) return take_branch(i, mark);
  }
  split_ = count > 1;
  if (!split_) take_branch(0, mark);
}

void SimRun::take_branch(std::size_t index, const RunMark& mark) {
  branch_ = continuation_->branches[index];
  taken_ = &actions_[index];
  inputs_.run["branch_tick"] = std::to_string(mark.ticks);
  inputs_.run["duration_s"] = exact_text(duration_s_);
  put_facts(branch_, inputs_.run);
  start_record();
  actions_[index].begin(mark);
  taken_->between_ticks(mark);
}

int SimRun::tell_parting() const {
  const Checkpoint& from = continuation_->from;
  const std::string where = where_parted(from.trail, way_.marks());
  const std::string what = change_text(changed_program(from.inputs));
  print_error(options_.from + ": this run is not the one of the checkpoint: they part " +
              (where.empty() ? "after its last hash" : where));
  if (!other_objects_.empty()) print_error("the state of these control objects differs: " + other_objects_);
  print_error(what.empty() ? "neither the program nor its libraries changed since" : "since it was left: " + what);
  return exit_failed;
}

std::string SimRun::record_name() const {
  namespace fs = std::filesystem;
  if (options_.no_record && options_.report.wanted()) {  // only for the report
    fs::create_directories(options_.report.folder);
    return (fs::path(options_.report.folder) / (report_file(scenario_.name, seed_) + ".mcap.part")).string();
  }
  const fs::path asked = options_.record.empty() ? fs::path(scenario_.name + ".mcap") : fs::path(options_.record);
  const bool several = continuation_ && continuation_->branches.size() > 1;
  if (!continuation_ || (!options_.record.empty() && !several)) return asked.string();
  const std::string branch = branch_.name.empty() ? "continued" : branch_.name;
  return (asked.parent_path() / (asked.stem().string() + "." + branch + asked.extension().string())).string();
}

// When the file was named and cannot be written, that is an error; for the default file it is not.
bool SimRun::open_record() {
  if (options_.no_record && !options_.report.wanted()) return false;
  record_ = record_name();
  if (recorder_->open(record_)) return true;
  const std::string why = recorder_->error();
  record_.clear();
  if (!options_.record.empty()) refuse(why);
  print_error(why + "; this run leaves no record");
  return false;
}

// Describes a record or a dump of the flight recorder.
void SimRun::describe(RecordWriter& record) const {
  (void)record.describe_run(inputs_);
  describe_robots(record, robot_texts(assembly_), 0);
}

void SimRun::start_record() {
  const bool flies = record_plan_.flight.kept_s > 0;
  if (options_.no_record && !options_.report.wanted() && !flies) return;
  recorder_ = std::make_unique<Recorder>(assembly_.catalog().signals, record_plan_.settings, record_plan_.flight,
                                         Recorder::Wait::in_place);
  if (open_record()) {
    describe(recorder_->file());
  } else if (!flies) {
    return recorder_.reset();
  }
  log_.add(recorder_->events());
  if (!remote_) assembly_.record_to(recorder_.get());
}

// To be called when a fault has latched: begins a dump of the flight recorder.
void SimRun::fly() {
  FlightRecorder& flight = *recorder_->flight();
  const std::string file = std::filesystem::path(record_name()).replace_extension(".flight.mcap").string();
  if (!flight.begin(file)) return tell_lost(flight.error());
  describe(flight.dump());
  (void)flight.dump().describe("fault_state", assembly_.control().fault_state().facts());
}

void SimRun::finish_record(const RunResult& result) {
  if (!recorder_) return;
  (void)recorder_->drain();
  if (FlightRecorder* flight = recorder_->flight(); flight != nullptr) {
    if (flight->due(true)) fly();
    flight->finish();
    if (!flight->error().empty()) tell_lost("the flight record is not complete: " + flight->error());
    if (flight->dumps() > 0) print_line("flight record: " + flight->file());
  }
  if (recorder_->is_open()) {
    const auto failed = std::ranges::count(result.checks, false, &CheckResult::passed);
    (void)recorder_->file().describe("result", {{"state_hash", hash_text(result.state_hash)},
                                                {"control_ticks", std::to_string(result.control_ticks)},
                                                {"passed", result.passed ? "yes" : "no"},
                                                {"checks", std::to_string(result.checks.size())},
                                                {"checks_failed", std::to_string(failed)}});
  }
  if (!recorder_->close()) tell_lost("the record is not complete: " + recorder_->error());
  if (recorder_->dropped() > 0) tell_lost(std::to_string(recorder_->dropped()) + " rows are missing in the record");
}

void SimRun::tell_lost(const std::string& what) {
  print_error(what);
  lost_.push_back(what);
}

std::string SimRun::repeat() const {
  if (!continuation_) return repeat_command(choices_, seed_);
  std::string command = "kadans sim --from " + shell_word(options_.from);
  if (options_.duration_s) command += " --duration " + number_text(*options_.duration_s);
  if (!branch_.name.empty()) return command + " --branch " + shell_quoted(branch_text(branch_));
  if (!branch_.play.empty()) command += " --play " + shell_quoted(branch_.play);
  for (const std::string& setting : branch_.set) command += " --set " + shell_quoted(setting);
  for (const std::string& push : branch_.push) command += " --push " + shell_word(push);
  return command;
}

RunReport SimRun::report_of(const RunResult& result) const {
  const std::string name = scenario_.name + (branch_.name.empty() ? "" : " (" + branch_.name + ")");
  return {.result = result,
          .log = log_,
          .title = name + (scenario_.doc.empty() ? "" : ": " + scenario_.doc),
          .record = record_,
          .repeat = repeat(),
          .traces = {height_.trace()},
          .quantities = assembly_.quantities(),
          .metrics = metrics_.values(),
          .evidence = evidence_.around(result.checks),
          .hashes = trail_ ? trail_->hashes() : std::vector<std::uint64_t>(),
          .branch = branch_.name,
          .lost = lost_};
}

// Writes the report's page. A record that only the page needed is removed.
void SimRun::write_page(const RunResult& result) {
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < checks_.size(); ++i) {
    if (result.checks[i].passed) continue;
    for (const SignalId signal : checks_.signals_of(i)) seen.push_back(assembly_.catalog().signals.info(signal).name);
  }
  const std::string record = record_;
  if (options_.no_record) record_.clear();
  const RunReport about = report_of(result);
  const std::filesystem::path file =
      write_run_page({.run = about,
                      .scenario = scenario_,
                      .robot = assembly_.robot().model.name,
                      .name = scenario_.name + (branch_.name.empty() ? "" : "." + branch_.name),
                      .record = record,
                      .check_signals = seen},
                     options_.report);
  if (options_.no_record) std::filesystem::remove(record);
  if (!options_.json) std::printf("  report: %s\n\n", file.c_str());
}

void SimRun::print(const RunResult& result) const {
  const RunReport report = report_of(result);
  if (options_.json) {
    std::puts(json_report(report).c_str());
    return;
  }
  const std::string text =
      text_report(report, {.color = stdout_takes_color(), .unicode = true, .verbose = options_.verbose});
  std::fputs(text.c_str(), stdout);
  for (const MetricValue& metric : report.metrics) std::printf("  %s = %.6g\n", metric.name.c_str(), metric.value);
}

}  // namespace kadans
