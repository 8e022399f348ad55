#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "commands.h"
#include "kadans/app/assembly.h"
#include "kadans/config/experiment_config.h"
#include "kadans/scenario/report.h"
#include "kadans/telemetry/recorder.h"
#include "observers.h"
#include "terminal.h"
#include "version.h"

namespace kadans {
namespace {

constexpr const char* height_signal = "plant.base.height_m";

std::string repeat_command(const ScenarioConfig& scenario, const SimOptions& options, std::uint64_t seed) {
  std::string command = "kadans sim " + scenario.file + " --seed " + std::to_string(seed);
  if (!options.play.empty()) command += " --play '" + options.play + "'";
  for (const std::string& setting : options.set) command += " --set '" + setting + "'";
  if (options.duration_s) command += " --duration " + number_text(*options.duration_s);
  return command;
}

// "ground.friction=0.3"
NumberEntry parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  NumberEntry setting{.key = text.substr(0, equals)};
  const char* const end = text.data() + text.size();
  const char* const begin = equals == std::string::npos ? end : text.data() + equals + 1;
  const auto [stop, error] = std::from_chars(begin, end, setting.value);
  if (error != std::errc{} || stop != end)
    throw InputError({.file = "--set", .message = "'" + text + "' must be NAME=NUMBER, such as ground.friction=0.3"});
  return setting;
}

ScenarioConfig read_scenario(const SimOptions& options) {
  ScenarioConfig scenario = read_scenario_config(options.scenario);
  if (!options.play.empty()) scenario.behaviors = read_play_items(options.play, "--play", folders_of(scenario));
  for (const std::string& setting : options.set) scenario.set_last.push_back(parse_setting(setting));
  return scenario;
}

std::string read_all(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Events go to the recorder only when it exists, and it exists only when the signals are known: this lets the log be
// made first.
class LateLog final : public BehaviorLog {
 public:
  void set(BehaviorLog* log) noexcept { log_ = log; }
  void show() noexcept { shown_ = true; }  // messages at once on stderr, for somebody who edits while it runs
  void transition(const Transition& transition) override {
    if (log_ != nullptr) log_->transition(transition);
  }
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override {
    if (log_ != nullptr) log_->message(time_ns, severity, behavior, text);
    if (shown_)
      std::fprintf(stderr, "\r\033[K%8.2f s  %s: %s\n", 1e-9 * static_cast<double>(time_ns), behavior.c_str(),
                   text.c_str());
  }

 private:
  BehaviorLog* log_ = nullptr;
  bool shown_ = false;
};

// A run that was asked to be short says nothing about what was to come later: such checks are not judged.
std::vector<ScenarioCheck> reached_checks(const ScenarioConfig& scenario, double duration_s) {
  std::vector<ScenarioCheck> checks = scenario.checks;
  if (duration_s >= scenario.duration_s) return checks;
  std::erase_if(checks, [&](const ScenarioCheck& c) {
    const bool about_later = c.kind == CheckKind::at_end || c.kind == CheckKind::settles ||
                             (c.kind == CheckKind::eventually && c.until_s > duration_s);
    return c.from_s >= duration_s || about_later;
  });
  return checks;
}

class Sim {
 public:
  explicit Sim(const SimOptions& options)
      : options_(options),
        scenario_(read_scenario(options)),
        seed_(options.seed.value_or(scenario_.seed)),
        duration_s_(options.duration_s.value_or(scenario_.duration_s)),
        assembly_(scenario_, seed_, log_),
        checks_(assembly_.catalog().signals, reached_checks(scenario_, duration_s_), scenario_.file),
        metrics_(assembly_.catalog().signals,
                 options.metrics.empty() ? std::vector<MetricConfig>() : read_metrics(options.metrics),
                 options.metrics) {}

  int run() {
    const std::string record = start_record();
    ProgressBar progress(duration_s_, stderr_is_terminal() && !options_.json);
    std::vector<RunObserver*> observers{&progress};
    TraceObserver height("base height, m", assembly_.catalog().signals.find(height_signal).value(), duration_s_);
    observers.push_back(&height);
    observers.push_back(&evidence_);
    observers.push_back(&metrics_);
    Pace pace;
    if (options_.realtime) observers.push_back(&pace);
    if (options_.watch) {
      assembly_.watch_behaviors();
      late_log_.show();
    }
    std::unique_ptr<RecordDrain> drain;
    if (recorder_) observers.push_back((drain = std::make_unique<RecordDrain>(*recorder_)).get());
    RunResult result = [&] {
      const RunParts parts = assembly_.parts();
      return run_scenario(parts, duration_s_, checks_, observers);
    }();
    result.scenario = scenario_.name;
    result.seed = seed_;
    finish_record();
    print(result, height.trace(), record);
    if (result.interrupted) return exit_interrupted;
    return result.passed ? exit_passed : exit_failed;
  }

 private:
  // The file that is written, or "". A file that was asked for and cannot be written is an error; the usual one is not.
  std::string start_record() {
    if (options_.no_record) return {};
    std::string file = options_.record.empty() ? scenario_.name + ".mcap" : options_.record;
    recorder_ = std::make_unique<Recorder>(assembly_.catalog().signals);
    if (!recorder_->open(file)) {
      const std::string why = recorder_->error();
      recorder_.reset();
      if (!options_.record.empty()) throw InputError({.message = why});
      print_error(why + "; this run leaves no record");
      return {};
    }
    const RobotModel& model = assembly_.robot().model;
    (void)recorder_->describe_run({{"scenario", scenario_.file}, {"seed", std::to_string(seed_)}, {"kadans", version}});
    (void)recorder_->describe_robot(model.name, read_all(model.file), 0);
    late_log_.set(&recorder_->events());
    assembly_.record_to(recorder_.get());
    return file;
  }

  void finish_record() {
    if (!recorder_) return;
    if (!recorder_->close()) print_error("the record is not complete: " + recorder_->error());
    if (recorder_->dropped() > 0) print_error(std::to_string(recorder_->dropped()) + " rows are missing in the record");
  }

  void print(const RunResult& result, const ReportTrace& height, const std::string& record) const {
    if (options_.json) {
      const ReportContext context{.log = log_,
                                  .model = assembly_.robot().model,
                                  .quantities = assembly_.quantities(),
                                  .metrics = metrics_.values(),
                                  .evidence = evidence_.around(result.checks),
                                  .record = record};
      std::puts(json_report(result, context).c_str());
      return;
    }
    std::vector<ScenarioCheck> wanted;
    for (std::size_t i = 0; i < checks_.size(); ++i) wanted.push_back(checks_.config(i));
    const std::vector<ReportTrace> traces{height};
    const ReportSubject subject{.result = result,
                                .log = log_,
                                .model = assembly_.robot().model,
                                .checks = wanted,
                                .traces = traces,
                                .title = scenario_.name + (scenario_.doc.empty() ? "" : ": " + scenario_.doc),
                                .record = record,
                                .repeat = repeat_command(scenario_, options_, seed_)};
    const std::string text =
        text_report(subject, {.color = stdout_takes_color(), .unicode = true, .verbose = options_.verbose});
    std::fputs(text.c_str(), stdout);
    for (const MetricValue& metric : metrics_.values()) std::printf("  %s = %.6g\n", metric.name.c_str(), metric.value);
  }

  const SimOptions& options_;
  ScenarioConfig scenario_;
  std::uint64_t seed_;
  double duration_s_;
  LateLog late_log_;
  RunLog log_{&late_log_};
  Assembly assembly_;
  Checks checks_;
  Evidence evidence_{checks_, assembly_.catalog().signals};
  Metrics metrics_;
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace

int run_sim(const SimOptions& options) {
  Sim sim(options);
  catch_interrupts();
  return sim.run();
}

}  // namespace kadans
