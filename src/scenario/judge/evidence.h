// Evidence of failed checks: it keeps the signals of all checks during a run, and gives those of a failed check around
// the moment of its failure.
#pragma once

#include <string>
#include <vector>

#include "checks.h"
#include "scenario/run.h"

namespace kadans {

struct EvidenceTrace {
  std::string check;
  std::string signal, unit;
  double from_s = 0, to_s = 0;
  std::vector<double> values;  // evenly spaced over that time
};

class Evidence final : public RunObserver {
 public:
  Evidence(const Checks& checks, const SignalTable& signals);

  void tick(double time_s, std::span<const double> row) override;
  // For each failed check, at most three of its signals from one second before to one second after CheckResult::at_s.
  std::vector<EvidenceTrace> around(const std::vector<CheckResult>& results) const;

 private:
  static constexpr double period_s = 0.01;
  std::size_t column(SignalId signal) const;

  const Checks& checks_;
  const SignalTable& signals_;
  std::vector<SignalId> kept_;
  std::vector<float> values_;  // row by row
  double next_s_ = 0;
};

}  // namespace kadans
