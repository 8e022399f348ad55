// What is measured during a run: the metrics, and the evidence of failed checks.
#pragma once

#include <string>
#include <vector>

#include "checks.h"
#include "config/scenario/scenario_check.h"
#include "scenario/disturb/quantities.h"
#include "scenario/run.h"
#include "script/bindings/signal_expressions.h"

namespace kadans {

using MetricValue = QuantityValue;  // NaN: the metric has no value

// Computes the metrics of a run (scenario_check.h) while it goes.
class Metrics final : public RunObserver {
 public:
  // Looks the signals up and compiles the expressions. Throws InputError with all mistakes; `file` is the file from
  // which the metrics were read. The table must outlive this object.
  Metrics(const SignalTable& signals, const std::vector<MetricConfig>& metrics, const std::string& file,
          std::span<const SignalState> states = {});

  void tick(double time_s, std::span<const double> row) override;
  std::vector<MetricValue> values() const;

 private:
  struct Gathered {
    MetricConfig config;
    std::size_t index = 0;  // of the signal or of the expression
    std::uint64_t ticks = 0;
    double value = 0;  // by kind: greatest, least, sum, sum of squares, last value, or the time
  };
  void add(Gathered& metric, double time_s, double value) const noexcept;

  SignalExpressions conditions_;
  std::vector<Gathered> metrics_;
  bool broken_ = false;  // an expression failed: then no metric with one has a value
};

// Evidence of failed checks: it keeps the signals of all checks during a run, and gives those of a failed check around
// the moment of its failure.
struct EvidenceTrace {
  std::string check;
  std::string signal, unit;
  double from_s = 0, to_s = 0;
  std::vector<double> values{};  // evenly spaced over that time
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
