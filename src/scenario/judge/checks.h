// All checks of a scenario: looks at the row of signals of every tick and gives the results at the end.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "check.h"
#include "kadans/signal/signal.h"
#include "script/bindings/signal_expressions.h"

namespace kadans {

class Checks {
 public:
  // Looks the signals up and compiles the conditions. Throws InputError with all mistakes. `file` is the file from
  // which the checks were read, for messages. The table must outlive this object.
  explicit Checks(const SignalTable& signals, const std::vector<ScenarioCheck>& checks = {},
                  const std::string& file = {});

  // To be called after each control tick.
  void update(double time_s, std::span<const double> row) noexcept;
  std::vector<CheckResult> results() const;
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
