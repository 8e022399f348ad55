// All checks of a scenario: looks at the row of signals of every tick and gives the results at the end.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "config/scenario/scenario_check.h"
#include "kadans/signal/signal.h"
#include "script/bindings/signal_expressions.h"

namespace kadans {

struct CheckResult {
  std::string name;
  bool passed = false;
  double value = 0;      // what CheckKind says of the kind
  double at_s = 0;       // time of that value
  std::string note{};    // what `value` cannot express: "its `when` never became true"
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

// Judges one check of a scenario tick by tick (scenario_check.h).
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
  // True once nothing that comes can let it pass.
  bool lost() const noexcept;
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
  // of kinds with `when`
  bool when_ = false;                                            // value of `when` in the tick before
  bool started_ = false;                                         // `when` was true once
  bool waiting_ = false;                                         // the demand is not yet fulfilled ...
  double began_s_ = 0;                                           // ... since this time
  double outside_s_ = -std::numeric_limits<double>::infinity();  // last time at which the demand did not hold
  double last_s_ = 0;
  bool met_ = false;  // the demand was fulfilled once
  bool failed_ = false;
};

class Checks {
 public:
  // Looks the signals up and compiles the conditions. Throws InputError with all mistakes. `file` is the file from
  // which the checks were read, for messages. The table and the states must outlive this object.
  explicit Checks(const SignalTable& signals, const std::vector<ScenarioCheck>& checks = {},
                  const std::string& file = {}, std::span<const SignalState> states = {});

  // To be called after each control tick.
  void update(double time_s, std::span<const double> row) noexcept;
  std::vector<CheckResult> results() const;
  bool lost(std::size_t index) const noexcept { return broken_ || judged_[index].check.lost(); }
  const std::string& error() const noexcept { return conditions_.error(); }  // of a condition that failed

  std::size_t size() const noexcept { return judged_.size(); }
  const ScenarioCheck& config(std::size_t index) const { return judged_.at(index).check.config(); }
  // The signals that the check uses, for pictures of a failure.
  std::vector<SignalId> signals_of(std::size_t index) const;

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  struct Judged {
    Check check;
    SignalId signal = 0;
    std::size_t that = none, when = none;  // conditions
  };
  std::size_t compile(const std::string& text, TextPlace place, Problems& problems);
  Check::Observation observe(const Judged& judged, std::span<const double> row) const;

  SignalExpressions conditions_;
  std::vector<Judged> judged_;
  bool broken_ = false;
};

}  // namespace kadans
