#include "trial_runs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <list>
#include <thread>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/assembly/assembly.h"
#include "app/sim/played_behaviors.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "kadans/plant/emulated_drives.h"
#include "realtime/machine/child_process.h"
#include "scenario/judge/checks.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

// Two errors that differ in a number are the same.
std::string without_numbers(std::string text) {
  std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; });
  return text;
}

// Sees when each check is lost and each error is told, and takes the disturbances away at their time.
class TrialWatch final : public RunObserver {
 public:
  TrialWatch(const Trial& trial, const TrialFailure* wanted, const Checks& checks, RunParts& parts)
      : trial_(trial), wanted_(wanted), checks_(checks), parts_(parts), lost_s_(checks.size(), HUGE_VAL) {
    between_ticks({});
  }

  void tick(double time_s, std::span<const double>) override {
    for (std::size_t i = 0; i < lost_s_.size(); ++i) {
      if (lost_s_[i] < HUGE_VAL || !checks_.lost(i)) continue;
      lost_s_[i] = time_s;
      over_ = over_ || (wanted_ != nullptr && wanted_->check == checks_.config(i).name);
    }
    if (wanted_ == nullptr || !parts_.log.has_errors()) return;
    over_ = over_ || std::ranges::any_of(parts_.log.lines(), [&](const LogLine& line) {
              return line.severity == BehaviorLog::Severity::error && error(line).same(*wanted_);
            });
  }
  void between_ticks(const RunMark& mark) override {
    if (!trial_.undisturbed_s || 1e-9 * static_cast<double>(mark.time_ns) < *trial_.undisturbed_s - 1e-9) return;
    end_disturbances(parts_);
    for (RunParts& other : parts_.others) end_disturbances(other);
  }
  bool stop_asked() const override { return over_ || interrupted(); }

  std::vector<TrialFailure> failures(const RunResult& result, const SignalTable& signals) const {
    std::vector<TrialFailure> all;
    for (std::size_t i = 0; i < lost_s_.size(); ++i) {
      const CheckResult& check = result.checks[i];
      const bool lost = lost_s_[i] < HUGE_VAL;
      if (check.passed || (over_ && !lost)) continue;
      const bool of_safety = std::ranges::any_of(checks_.signals_of(i), [&](SignalId signal) {
        return signals.info(signal).name.find("safety.") != std::string::npos;
      });
      all.push_back({.what = "check " + check.name,
                     .fault = of_safety && !result.faults.empty() ? fault_name(result.faults.front().told) : "",
                     .told = check.name + " (" + demand(check) + ")",
                     .check = check.name,
                     .at_s = lost ? lost_s_[i] : result.duration_s});
    }
    for (const LogLine& line : parts_.log.lines()) {
      if (line.severity == BehaviorLog::Severity::error) all.push_back(error(line));
    }
    if (!result.error.empty())
      all.push_back(
          {.what = "error " + without_numbers(result.error), .told = result.error, .at_s = result.duration_s});
    std::ranges::stable_sort(all, {}, &TrialFailure::at_s);
    return all;
  }

 private:
  static void end_disturbances(RunParts& robot) {
    if (robot.disturbances == nullptr) return;
    robot.disturbances = nullptr;
    robot.lockstep.silence(robot.behaviors, {});
  }
  static TrialFailure error(const LogLine& line) {
    return {.what = "error " + without_numbers(line.text),
            .told = line.text,
            .at_s = 1e-9 * static_cast<double>(line.time_ns)};
  }

  const Trial& trial_;
  const TrialFailure* wanted_;
  const Checks& checks_;
  RunParts& parts_;
  std::vector<double> lost_s_;
  bool over_ = false;
};

// "cable_out:io@2+0.5" until then.
std::string ended_at(double time_s, const std::string& bus_fault) {
  const EmulatedFault fault = emulated_fault(bus_fault);
  if (fault.until_s <= time_s) return bus_fault;
  const std::size_t equals = std::min(bus_fault.find('='), bus_fault.size());
  return bus_fault.substr(0, std::min(bus_fault.find('+'), equals)) + "+" + number_text(time_s - fault.from_s) +
         bus_fault.substr(equals);
}

// Pushes, silence of behaviors and missed ticks are taken away while the run goes.
void end_at(double time_s, ScenarioConfig& scenario) {
  std::erase_if(scenario.events, [&](const ScenarioEvent& event) { return event.at_s >= time_s; });
  std::erase_if(scenario.faults, [&](const ScenarioFault& fault) { return fault.from_s >= time_s; });
  for (ScenarioFault& fault : scenario.faults) {
    if (fault.kind != ScenarioFault::Kind::clock_missed) fault.until_s = std::min(fault.until_s, time_s);
  }
  std::erase_if(scenario.bus.faults,
                [&](const PlacedName& fault) { return emulated_fault(fault.name).from_s >= time_s; });
  for (PlacedName& fault : scenario.bus.faults) fault.name = ended_at(time_s, fault.name);
  for (ScenarioConfig& robot : scenario.robots) end_at(time_s, robot);
}

Json to_json(const TrialFailure& failure) {
  return {{"what", failure.what},
          {"fault", failure.fault},
          {"told", failure.told},
          {"check", failure.check},
          {"at_s", failure.at_s}};
}

Json run_here(const Trial& trial, const TrialFailure* wanted) {
  ScenarioConfig scenario =
      trial.whole ? read_scenario(*trial.whole) : read_scenario_config_text(trial.text, trial.file);
  if (trial.whole) scenario.seed = trial.whole->seed.value_or(scenario.seed);
  if (trial.undisturbed_s) end_at(*trial.undisturbed_s, scenario);
  RunLog log;
  Assembly assembly(scenario, scenario.seed, log);
  const SignalTable& signals = assembly.catalog().signals;
  Checks checks(signals, scenario.checks, scenario.file, assembly.signal_states());
  if (trial.whole) refuse_faulty_behaviors(assembly);
  RunParts parts = assembly.parts();
  TrialWatch watch(trial, wanted, checks, parts);
  const RunResult result = run_scenario(parts, scenario.duration_s, checks, {&watch});
  Json json{{"state_hash", hash_text(result.state_hash)},
            {"period_s", assembly.robot().engine.control_period_s},
            {"failures", Json::array()},
            {"quantities", Json::array()}};
  for (const TrialFailure& failure : watch.failures(result, signals)) json["failures"].push_back(to_json(failure));
  for (const QuantityValue& one : assembly.quantities()) json["quantities"].push_back({one.name, one.value});
  return json;
}

// In the copy of the process.
[[noreturn]] void answer_trial(const Trial& trial, const TrialFailure* wanted, const MemoryFile& file) {
  die_with_parent();
  Json json;
  try {
    json = run_here(trial, wanted);
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) json["refused"].push_back(InputError(problem).what());
  } catch (const std::exception& error) {
    json["refused"].push_back(error.what());
  }
  const std::string text = json_text(json);
  const bool whole = write(file.descriptor(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
  _exit(whole ? exit_passed : exit_internal);  // without the ends of what the first process holds
}

TrialResult result_of(const std::string& text) {
  const Json json = parse_foreign_json(text);
  TrialResult result;
  if (json.contains("refused")) {
    json.at("refused").get_to(result.refused);
    return result;
  }
  json.at("state_hash").get_to(result.state_hash);
  json.at("period_s").get_to(result.period_s);
  for (const Json& one : json.at("failures"))
    result.failures.push_back({.what = one.at("what"),
                               .fault = one.at("fault"),
                               .told = one.at("told"),
                               .check = one.at("check"),
                               .at_s = one.at("at_s")});
  for (const Json& one : json.at("quantities")) result.quantities.push_back({one.at(0), one.at(1)});
  return result;
}

struct RunningTrial {
  std::size_t index;
  MemoryFile said;
  ChildProcess process;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

  double wall_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); }
  TrialResult result(bool timed_out) const {
    TrialResult result;
    result.timed_out = timed_out;
    if (timed_out) return result;
    if (process.exit_code() == exit_passed) return result_of(said.text());
    const std::string what = process.signal() != 0 ? "signal " + std::to_string(process.signal()) : "a broken process";
    result.failures.push_back({.what = what, .told = "the process is ended by " + what, .at_s = 0});
    return result;
  }
};

}  // namespace

const TrialFailure* TrialResult::find(const TrialFailure& wanted) const noexcept {
  const auto found = std::ranges::find_if(failures, [&](const TrialFailure& one) { return one.same(wanted); });
  return found == failures.end() ? nullptr : &*found;
}

TrialRuns::TrialRuns(std::size_t jobs, std::size_t runs_max, double wall_limit_s)
    : jobs_(jobs > 0 ? jobs : std::max(1U, std::thread::hardware_concurrency())),
      runs_max_(runs_max),
      wall_limit_s_(wall_limit_s) {}

void TrialRuns::look_for(TrialFailure wanted) {
  wanted_ = std::move(wanted);
  known_.clear();
}

bool TrialRuns::is(const TrialResult& result, bool wanted) const {
  return result.refused.empty() && !result.timed_out && (result.find(*wanted_) != nullptr) == wanted;
}

TrialResult TrialRuns::run(const Trial& trial) {
  const std::optional<TrialFailure> wanted = std::exchange(wanted_, std::nullopt);
  const auto known = std::exchange(known_, {});
  run_until_known({&trial, 1}, true);
  ++count_;
  TrialResult result = known_.begin()->second.first;
  wanted_ = wanted;
  known_ = known;
  return result;
}

const TrialResult& TrialRuns::known(const Trial& trial) const {
  return known_.at({trial.text, trial.undisturbed_s.value_or(HUGE_VAL)}).first;
}

std::optional<std::size_t> TrialRuns::first(const std::vector<Trial>& trials, bool wanted) {
  run_until_known(trials, wanted);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    auto& [result, counted] = known_.at({trials[i].text, trials[i].undisturbed_s.value_or(HUGE_VAL)});
    if (!counted && count_ >= runs_max_) throw TrialsSpent();
    if (!counted) ++count_;
    counted = true;
    if (is(result, wanted)) return i;
  }
  return std::nullopt;
}

// Until all before the first that answers have been run.
void TrialRuns::run_until_known(std::span<const Trial> trials, bool wanted) {
  std::list<RunningTrial> running;
  std::size_t next = 0, enough = trials.size();
  const auto key = [&](std::size_t i) { return Key{trials[i].text, trials[i].undisturbed_s.value_or(HUGE_VAL)}; };
  const auto take = [&](std::size_t index) {
    if (wanted_ && is(known_.at(key(index)).first, wanted)) enough = std::min(enough, index);
  };
  for (;;) {
    for (; next < enough && running.size() < jobs_; ++next) {
      if (known_.contains(key(next))) {
        take(next);
        continue;
      }
      MemoryFile said;
      std::optional<ChildProcess> process = ChildProcess::copy();
      if (!process) answer_trial(trials[next], wanted_ ? &*wanted_ : nullptr, said);
      running.push_back(RunningTrial{next, std::move(said), std::move(*process)});
    }
    std::erase_if(running, [&](const RunningTrial& one) { return one.index > enough; });  // and kills it
    if (running.empty() && next >= enough) return;
    std::vector<const ChildProcess*> processes;
    for (const RunningTrial& one : running) processes.push_back(&one.process);
    ChildProcess::wait_for_one(processes, 100);
    if (interrupted()) throw TrialsInterrupted();
    for (RunningTrial& one : running) {
      const bool ended = one.process.ended(), late = one.wall_s() > wall_limit_s_;
      if (!ended && !late) continue;
      known_.insert_or_assign(key(one.index), std::pair(one.result(!ended), false));
      take(one.index);
    }
    std::erase_if(running, [&](const RunningTrial& one) { return known_.contains(key(one.index)); });
  }
}

}  // namespace kadans
