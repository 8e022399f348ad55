// Repeated records that are judged by checks. `kadans sim` and `kadans test` of a scenario that repeats a record: what
// the robot saw then is given to this program. `kadans replay --then-simulate`: from a time on the engines go on in the
// world of a scenario.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>

#include "app/commands.h"
#include "app/run/observers.h"
#include "app/terminal.h"
#include "hash_trail.h"
#include "kadans/signal/shell_word.h"
#include "repeated_run.h"
#include "scenario/report/report.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

RunInputs read_run(const std::string& record) {
  RunInputs inputs = read_front(record);
  if (inputs.fact("clock") != clock_of_threads)
    refuse(record, "was simulated, so it is simulated again: with its own scenario");
  return inputs;
}

// The repeated run of a record, and how it is told.
class JudgedRun : public RunObserver {
 public:
  // `judge`: the scenario with the checks.
  JudgedRun(const std::string& record, bool any_plugins, const std::vector<std::string>& with,
            const ScenarioConfig& judge)
      : judge_(judge),
        inputs_(read_run(record)),
        files_(inputs_, record, any_plugins, with),
        recorded_(unpacked_scenario(inputs_, record, files_)),
        run_(record, recorded_, files_, inputs_.fact("root"),
             played_elsewhere(inputs_) ? RepeatedRun::Behaviors::none : RepeatedRun::Behaviors::tested) {}

  void tick(double time_s, std::span<const double> row) override {
    time_s_ = time_s;
    checks_->update(time_s, row);
  }

 protected:
  // Of the signals that are judged, which must outlive this object.
  void judge(const SignalTable& signals, std::span<const SignalState> states) {
    checks_.emplace(signals, judge_.checks, judge_.file, states);
    evidence_.emplace(*checks_, signals);
  }

  RunResult result(const std::string& error) const {
    RunResult result;
    result.scenario = judge_.name;
    result.seed = recorded_.seed;
    result.interrupted = interrupted();
    result.error = error;
    result.checks = checks_->results();
    result.duration_s = time_s_;
    result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    result.realtime_factor = result.wall_s > 0 ? result.duration_s / result.wall_s : 0;
    result.control_ticks = run_.ticks();
    result.behavior_ticks = run_.behavior_ticks();
    result.state_hash = run_.state_hash();
    result.commands_sent = run_.commands();
    result.faults = run_.faults();
    result.passed = std::ranges::all_of(result.checks, &CheckResult::passed) && result.error.empty() &&
                    !result.interrupted && !run_.log().has_errors();
    return result;
  }

  int print(const RunResult& result, bool json, bool verbose, const std::string& repeat, const HashTrail* trail) {
    const RunReport report{.result = result,
                           .log = run_.log(),
                           .title = judge_.name + (judge_.doc.empty() ? "" : ": " + judge_.doc),
                           .record = "",
                           .repeat = repeat,
                           .evidence = evidence_->around(result.checks),
                           .hashes = trail == nullptr ? std::vector<std::uint64_t>() : trail->hashes()};
    if (json) {
      std::puts(json_report(report).c_str());
    } else {
      const std::string text =
          text_report(report, {.color = stdout_takes_color(), .unicode = true, .verbose = verbose});
      std::fputs(text.c_str(), stdout);
      for (const std::string& differs : {run_.parting(), run_.decided_otherwise()}) {
        if (!differs.empty()) std::printf("  differs from the record %s\n", differs.c_str());
      }
    }
    if (result.interrupted) return exit_interrupted;
    return result.passed ? exit_passed : exit_failed;
  }

  const ScenarioConfig& judge_;
  RunInputs inputs_;
  UnpackedInputs files_;
  ScenarioConfig recorded_;
  RepeatedRun run_;
  std::optional<Checks> checks_;
  std::optional<Evidence> evidence_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  double time_s_ = 0;
};

class RecordTest final : public JudgedRun {
 public:
  explicit RecordTest(const ScenarioConfig& test) : JudgedRun(test.record, false, test.with, test) {
    judge(run_.assembly().catalog().signals, run_.assembly().signal_states());
  }

  int run(const SimOptions& options) {
    std::optional<HashTrail> trail;
    std::vector<RunObserver*> observers{this, &*evidence_};
    if (options.hash_every_s) observers.push_back(&trail.emplace(*options.hash_every_s));
    const double end_ns = 1e9 * judge_.duration_s;
    const std::int64_t period_ns = run_.assembly().robot().engine.control_period_ns();
    run_.go([&] { return interrupted() || static_cast<double>(run_.time_ns() + period_ns) >= end_ns; }, observers);
    const std::string error = run_.ticks() == 0 ? "it holds no tick" : run_.shortened();
    return print(result(error.empty() ? "" : "the record is not whole: " + error), options.json, options.verbose,
                 "kadans sim " + shell_word(options.scenario), trail ? &*trail : nullptr);
  }

  std::size_t checks() const noexcept { return checks_->size(); }
};

class ThenSimulation final : public JudgedRun {
 public:
  ThenSimulation(const ReplayOptions& options, ScenarioConfig& scenario)
      : JudgedRun(options.record, options.allow_plugins, options.with, scenario),
        options_(options),
        scenario_(scenario) {
    if (played_elsewhere(inputs_))
      refuse(options.record, "its behaviors played in a process of their own, so they cannot go on");
    if (!scenario.robots.empty()) refuse(options.then_simulate, "has further robots: a record goes on alone");
    if (!scenario.bus.type.name.empty())
      refuse(options.then_simulate, "has a bus: a record goes on in its world itself");
    const char* const alone = ": a record goes on in its world, with its quantities and checks alone";
    if (!(scenario.events.empty() && scenario.pushes.empty() && scenario.faults.empty() && scenario.carried.empty()))
      refuse(options.then_simulate, std::string("has events, pushes, faults or a robot that is carried") + alone);
    if (scenario.supervisor.given || !scenario.perception.empty() || !scenario.sight.ball.name.empty() ||
        !scenario.joystick.recording.empty())
      refuse(options.then_simulate, std::string("has a supervisor, perception, sight or a joystick") + alone);
    if (read_robot(scenario.robot, scenario.plugins).config.model.joint_names() !=
        run_.assembly().robot().model.joint_names())
      refuse(options.then_simulate, "is of another robot than the record");
  }

  int run() {
    const auto recorded_s = [this] { return 1e-9 * static_cast<double>(run_.time_ns()); };
    run_.go([&] { return interrupted() || recorded_s() >= options_.at_s; });
    if (!(recorded_s() >= options_.at_s) && !interrupted())
      refuse(options_.record, printed("ends at %.3f s, before --at", recorded_s()) +
                                  (run_.shortened().empty() ? "" : ": " + run_.shortened()));
    const Snapshot& state = run_.assembly().control().state();
    scenario_.placed.orientation = state.status.base.orientation;
    for (std::size_t i = 0; i < state.joints.count; ++i)
      scenario_.placed.position_rad.push_back(state.joints.joints[i].position_rad);
    RunLog silence;
    Assembly model(scenario_, scenario_.seed, silence);
    judge(model.catalog().signals, model.signal_states());
    std::string error;
    try {
      run_.go_on_in(model, [&] { return interrupted() || time_s_ >= scenario_.duration_s; }, {this, &*evidence_});
    } catch (const std::runtime_error& failed) {
      error = failed.what();  // of the model
    }
    return print(result(error), options_.json, false, repeat(), nullptr);
  }

 private:
  std::string repeat() const {
    std::string command = "kadans replay " + shell_word(options_.record);
    if (options_.allow_plugins) command += " --allow-plugins";
    for (const std::string& file : options_.with) command += " --with " + shell_word(file);
    return command + " --then-simulate " + shell_word(options_.then_simulate) + printed(" --at %g", options_.at_s);
  }

  const ReplayOptions& options_;
  ScenarioConfig& scenario_;
};

}  // namespace

std::size_t count_record_checks(const ScenarioConfig& test) { return RecordTest(test).checks(); }

int run_record_test(const SimOptions& options, const ScenarioConfig& test) {
  RecordTest run(test);
  catch_interrupts();
  return run.run(options);
}

int run_then_simulation(const ReplayOptions& options) {
  ScenarioConfig scenario = read_scenario_config(options.then_simulate);
  ThenSimulation run(options, scenario);
  catch_interrupts();
  return run.run();
}

}  // namespace kadans
