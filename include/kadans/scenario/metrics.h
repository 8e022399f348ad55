// The numbers that a run is judged by beyond its checks, gathered while it goes.
#pragma once

#include <string>
#include <vector>

#include "kadans/config/metric_config.h"
#include "kadans/scenario/run.h"
#include "kadans/script/signal_expressions.h"

namespace kadans {

struct MetricValue {
  std::string name;
  double value = 0;  // NaN: there is none
};

class Metrics final : public RunObserver {
 public:
  // Looks the signals up and compiles the conditions; throws InputError with everything that is wrong in `file`. The
  // table must outlive this.
  Metrics(const SignalTable& signals, const std::vector<MetricConfig>& metrics, const std::string& file);

  void tick(double time_s, std::span<const double> row) override;
  std::vector<MetricValue> values() const;

 private:
  struct Gathered {
    MetricConfig config;
    std::size_t index = 0;  // signal, or condition
    std::uint64_t ticks = 0;
    double value = 0;  // greatest, least, sum, sum of squares, last; of times: when
  };
  void add(Gathered& metric, double time_s, double value) const noexcept;

  SignalExpressions conditions_;
  std::vector<Gathered> metrics_;
  bool broken_ = false;  // a condition went wrong: no metric of a condition has a value
};

}  // namespace kadans
