// Computes the metrics of a run (metric_config.h) while it goes.
#pragma once

#include <string>
#include <vector>

#include "config/scenario/metric_config.h"
#include "scenario/run.h"
#include "script/bindings/signal_expressions.h"

namespace kadans {

struct MetricValue {
  std::string name;
  double value = 0;  // NaN: the metric has no value
};

class Metrics final : public RunObserver {
 public:
  // Looks the signals up and compiles the conditions. Throws InputError with all mistakes; `file` is the file from
  // which the metrics were read. The table must outlive this object.
  Metrics(const SignalTable& signals, const std::vector<MetricConfig>& metrics, const std::string& file);

  void tick(double time_s, std::span<const double> row) override;
  std::vector<MetricValue> values() const;

 private:
  struct Gathered {
    MetricConfig config;
    std::size_t index = 0;  // of the signal or of the condition
    std::uint64_t ticks = 0;
    double value = 0;  // by kind: greatest, least, sum, sum of squares, last value, or the time
  };
  void add(Gathered& metric, double time_s, double value) const noexcept;

  SignalExpressions conditions_;
  std::vector<Gathered> metrics_;
  bool broken_ = false;  // a condition failed: then no metric with a condition has a value
};

}  // namespace kadans
