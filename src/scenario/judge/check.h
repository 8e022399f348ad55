// Judges one check of a scenario tick by tick: always, never, eventually, at_end, within, settles (scenario_check.h).
#pragma once

#include <limits>
#include <string>

#include "config/scenario/scenario_check.h"

namespace kadans {

struct CheckResult {
  std::string name;
  bool passed = false;
  // always, never: the worst value; eventually: the value nearest to or deepest in the demand; at_end, within: the last
  // value; settles: the time in s until it settled.
  double value = 0;
  double at_s = 0;       // time of that value
  std::string note;      // what `value` cannot express: "its `when` never became true"
  std::string wanted{};  // "-0.01 .. 0.01", "never >= 0.6", "at the end joint.knee.position_rad > 0"
};

// The demand with the note: "<= 0.05; never looked at".
inline std::string demand(const CheckResult& check) {
  return check.wanted + (check.wanted.empty() || check.note.empty() ? "" : "; ") + check.note;
}
// The text to put after the value that was found: ", wanted <= 0.05; never looked at".
inline std::string wanted_clause(const CheckResult& check) {
  return (check.wanted.empty() && check.note.empty() ? "" : ", wanted ") + demand(check);
}

class Check {
 public:
  // What one tick shows. `value` is the value of the signal, or of the condition's first signal. `excess` is the
  // distance outside the demand; it is 0 or negative when the demand holds.
  struct Observation {
    double value = 0;
    double excess = 0;
    bool when = true;
  };

  explicit Check(ScenarioCheck check) : check_(std::move(check)) {}

  // To be called after each control tick; time must not run backwards.
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
  bool when_ = false;                                            // value of `when` in the tick before
  bool started_ = false;                                         // `when` was true once
  bool waiting_ = false;                                         // the demand is not yet fulfilled ...
  double began_s_ = 0;                                           // ... since this time
  double outside_s_ = -std::numeric_limits<double>::infinity();  // last time at which the demand did not hold
  double last_s_ = 0;
  bool failed_ = false;
};

}  // namespace kadans
