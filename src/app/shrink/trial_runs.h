// Runs of smaller and smaller versions of a failing scenario, each in a copy of this process, several at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "app/run/run_choices.h"
#include "scenario/disturb/quantities.h"

namespace kadans {

// One thing that went wrong in a run.
struct TrialFailure {
  std::string what;  // "check stays up", "error ..." without its numbers, "signal 11": two failures are the same when
                     // this and `fault` are
  std::string fault{};  // of a check that looks at the safety layer: the first fault of the run, "motor_hot of l_knee"
  std::string told;     // for people: "stays up (plant.base.height_m > 0.7)"
  std::string check{};  // its name; "": it is none
  double at_s = 0;      // when it was certain

  bool same(const TrialFailure& other) const noexcept { return what == other.what && fault == other.fault; }
};

struct Trial {
  std::string text;                       // the scenario
  std::string file;                       // which the text stands for
  std::optional<RunChoices> whole{};      // in place of both: the run as it is, with checks of its behaviors
  std::optional<double> undisturbed_s{};  // from then on no push, fault or event is left
};

struct TrialResult {
  std::vector<std::string> refused;  // why it could not be run
  bool timed_out = false;
  std::string state_hash;
  double period_s = 0;                 // of the control engine
  std::vector<TrialFailure> failures;  // in the order of time
  std::vector<QuantityValue> quantities;

  const TrialFailure* find(const TrialFailure& wanted) const noexcept;
};

// All runs that were asked for have been made.
struct TrialsSpent : std::runtime_error {
  TrialsSpent() : std::runtime_error("--max-runs") {}
};
struct TrialsInterrupted : std::runtime_error {
  TrialsInterrupted() : std::runtime_error("interrupted") {}
};

class TrialRuns {
 public:
  // `jobs`: how many at once, 0: one for each core. A run that takes longer than wall_limit_s is killed.
  TrialRuns(std::size_t jobs, std::size_t runs_max, double wall_limit_s);

  // To its end, whatever happens. Throws TrialsInterrupted.
  TrialResult run(const Trial& trial);
  // From now on a run ends once this has happened.
  void look_for(TrialFailure wanted);
  // The first of these trials in which it happens, or, with `wanted` false, does not. A trial that cannot be run is
  // neither. Counts the runs that would have been made one after the other, and each trial once. Throws TrialsSpent.
  std::optional<std::size_t> first(const std::vector<Trial>& trials, bool wanted = true);

  std::size_t count() const noexcept { return count_; }
  const TrialResult& known(const Trial& trial) const;  // of a trial that first() has found

 private:
  using Key = std::pair<std::string, double>;
  void run_until_known(std::span<const Trial> trials, bool wanted);
  bool is(const TrialResult& result, bool wanted) const;

  std::size_t jobs_, runs_max_, count_ = 0;
  double wall_limit_s_;
  std::optional<TrialFailure> wanted_;
  std::map<Key, std::pair<TrialResult, bool>> known_;  // the result, and whether it was counted
};

}  // namespace kadans
