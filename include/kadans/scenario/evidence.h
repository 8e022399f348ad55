// What a failed check looked like: keeps the signals of all checks while a run goes, and gives those of a failed one
// around its moment.
#pragma once

#include <string>
#include <vector>

#include "kadans/scenario/checks.h"
#include "kadans/scenario/run.h"

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
  // A second before and after the moment at which each failed check was at its worst, three signals at most.
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
