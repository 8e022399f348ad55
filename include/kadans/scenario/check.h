// Judges one demand of a scenario, tick by tick: always, never, eventually, at the end, within a time after something
// happened, settled for good.
#pragma once

#include <limits>
#include <string>

#include "kadans/config/scenario_check.h"

namespace kadans {

struct CheckResult {
  std::string name;
  bool passed = false;
  // The worst seen (always, never), the one that fulfilled it (eventually), the last (at_end, within), the time that it
  // took in s (settles).
  double value = 0;
  double at_s = 0;       // when
  std::string note;      // what `value` cannot say: "its `when` never became true"
  std::string wanted{};  // "-0.01 .. 0.01", "never >= 0.6", "at the end joint.knee.position_rad > 0"
};

// What was wanted, with the note: "<= 0.05; never looked at".
inline std::string demand(const CheckResult& check) {
  return check.wanted + (check.wanted.empty() || check.note.empty() ? "" : "; ") + check.note;
}
// Behind the value that was found: ", wanted <= 0.05; never looked at".
inline std::string wanted_clause(const CheckResult& check) {
  return (check.wanted.empty() && check.note.empty() ? "" : ", wanted ") + demand(check);
}

class Check {
 public:
  // What a tick shows of the demand. `value` is the signal's, or that of the condition's first one; `excess` how far
  // outside the demand, at or below 0 when it holds.
  struct Observation {
    double value = 0;
    double excess = 0;
    bool when = true;
  };

  explicit Check(ScenarioCheck check) : check_(std::move(check)) {}

  // After each control tick, time never going back.
  void update(double time_s, const Observation& seen) noexcept;
  CheckResult result() const;
  const ScenarioCheck& config() const noexcept { return check_; }

 private:
  void keep_worst(double time_s, const Observation& seen, double badness) noexcept;
  void update_within(double time_s, const Observation& seen) noexcept;
  void update_settling(double time_s, const Observation& seen) noexcept;
  CheckResult settled() const;

  ScenarioCheck check_;
  bool seen_ = false;
  double worst_ = -std::numeric_limits<double>::infinity();
  double value_ = 0, excess_ = 0;
  double at_s_ = 0;
  // within, settles
  bool when_ = false;                                            // in the tick before
  bool started_ = false;                                         // `when` was true once
  bool waiting_ = false;                                         // it is not yet fulfilled ...
  double began_s_ = 0;                                           // ... since then
  double outside_s_ = -std::numeric_limits<double>::infinity();  // last time that it did not hold
  double last_s_ = 0;
  bool failed_ = false;
};

}  // namespace kadans
