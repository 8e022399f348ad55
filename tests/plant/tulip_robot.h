// TULip with drives and feet, and what holds its joints.
#pragma once

#include <array>

#include "small_robots.h"

namespace kadans::test {

enum class Drives : std::uint8_t { elastic, stiff_spring, rigid };

// Slightly crouched.
Robot tulip(Drives kind);

// Joint PD on the motors' side, one tick of delay, as a control object would do it.
class JointHold {
 public:
  explicit JointHold(const Robot& robot) : target_rad_(robot.settings.position_rad) {}

  void act(Plant& plant);
  void tick(BulletWorld& plant) {
    act(plant);
    plant.step(ms);
  }
  void aim(std::size_t joint, double position_rad) { target_rad_[joint] = position_rad; }
  const SensorFrame& sensors() const { return sensors_; }

 private:
  std::vector<double> target_rad_;
  SensorFrame sensors_;
  ActuationFrame actuation_;
  std::array<double, max_joints> last_rad_{};
  bool started_ = false;
};

}  // namespace kadans::test
