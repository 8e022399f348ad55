// What a scenario demands of a signal: always or never within bounds, at some time, or at the end.
#pragma once

#include <limits>
#include <span>
#include <string>

#include "kadans/config/scenario_config.h"
#include "kadans/signal/signal.h"

namespace kadans {

struct CheckResult {
  std::string name;
  bool passed = false;
  double value = 0;  // the worst seen (always, never), the one that fulfilled it (eventually), the last (at_end)
  double at_s = 0;   // when
};

class Check {
 public:
  // `signal` has been looked up by the caller.
  Check(const ScenarioCheck& check, SignalId signal) : check_(check), signal_(signal) {}

  // After each control tick, and once with last = true at the end of the run.
  void update(double time_s, std::span<const double> row) noexcept;
  CheckResult result() const;
  const ScenarioCheck& config() const noexcept { return check_; }

 private:
  double excess(double value) const noexcept;

  ScenarioCheck check_;
  SignalId signal_;
  bool seen_ = false;
  double worst_excess_ = -std::numeric_limits<double>::infinity();
  double value_ = 0;
  double at_s_ = 0;
};

}  // namespace kadans
