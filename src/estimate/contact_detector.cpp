#include "contact_detector.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace kadans {

ContactDetector::ContactDetector(const Config& config) : config_(config) {
  if (!(config.off_N > 0 && config.off_N <= config.on_N && std::isfinite(config.on_N)))
    throw std::invalid_argument("contact_on_N = " + std::to_string(config.on_N) + ", contact_off_N = " +
                                std::to_string(config.off_N) + ": must be 0 < contact_off_N <= contact_on_N");
  for (const Vec3& sensor_m : config.sensors_m)
    for (std::size_t i = 0; i < 3; ++i) {
      if (!std::isfinite(sensor_m[i])) throw std::invalid_argument("sensors_m must be finite");
      state_.cop_m[i] += sensor_m[i] / sensors_per_foot;
    }
}

void ContactDetector::update(const std::array<double, sensors_per_foot>& force_N) noexcept {
  double sum_N = 0;
  for (const double force : force_N) sum_N += force;
  if (!std::isfinite(sum_N)) return;
  state_.force_N = sum_N;
  state_.contact = sum_N >= (state_.contact ? config_.off_N : config_.on_N);
  if (!state_.contact) return;
  const double scale_per_N = 1 / sum_N;
  for (std::size_t i = 0; i < 3; ++i) {
    double moment_Nm = 0;
    for (std::size_t s = 0; s < sensors_per_foot; ++s) moment_Nm += force_N[s] * config_.sensors_m[s][i];
    state_.cop_m[i] = moment_Nm * scale_per_N;
  }
}

}  // namespace kadans
