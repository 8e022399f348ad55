// Whether a foot bears, with what force, and where: from the pressure sensors under its sole.
//
// The foot is in contact from the tick where the sum of its forces reaches on_N until it falls below off_N; between the
// two it stays what it was. The centre of pressure is the mean of the sensors' places weighted by their forces; without
// contact it holds, and before the first contact it is the middle of the sole.
//
// One owner, the control thread. update neither allocates nor throws.
#pragma once

#include <array>

#include "kadans/signal/frames.h"

namespace kadans {

class ContactDetector {
 public:
  struct Config {
    double on_N = 8, off_N = 4;                      // 0 < off_N <= on_N
    std::array<Vec3, sensors_per_foot> sensors_m{};  // in the foot link's frame; order as in FootSample
  };
  struct State {
    bool contact = false;
    double force_N = 0;  // sum of the sensors
    Vec3 cop_m{};        // centre of pressure, in the foot link's frame
  };

  explicit ContactDetector(const Config& config);  // throws std::invalid_argument naming field, value and range

  // A force that is not finite leaves everything as it was.
  void update(const std::array<double, sensors_per_foot>& force_N) noexcept;

  const Config& config() const noexcept { return config_; }
  const State& state() const noexcept { return state_; }
  void pass_state(auto& bytes) noexcept { bytes(state_); }

 private:
  Config config_;
  State state_;
};

}  // namespace kadans
