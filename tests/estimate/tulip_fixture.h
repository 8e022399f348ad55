// The TULip with what its sensors say, for tests of the estimator: change the frame, advance, look.
#pragma once

#include "estimate/estimator.h"
#include "kadans/model/kinematics.h"
#include "kadans/model/urdf.h"

namespace kadans::test {

inline const RobotModel& tulip() {
  static const RobotModel model = read_urdf(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf");
  return model;
}

inline EstimateSettings tulip_settings() {
  EstimateSettings settings;
  for (const char* link : {"l_ankle_roll_link", "r_ankle_roll_link"})
    settings.feet.push_back(
        {link, {{{-0.08, -0.05, -0.06}, {-0.08, 0.05, -0.06}, {0.14, -0.05, -0.06}, {0.14, 0.05, -0.06}}}});
  return settings;
}

inline std::size_t joint_of(const char* name) { return tulip().find_joint(name).value(); }

struct TulipFixture {
  explicit TulipFixture(const EstimateSettings& settings = tulip_settings(), double dt = 0.001)
      : estimator(tulip(), settings, dt), dt_s(dt) {
    sensors.joint_count = static_cast<std::uint32_t>(tulip().joints.size());
    sensors.foot_count = 2;
    sensors.imu.acceleration_m_s2 = {0, 0, 9.81};
    for (std::size_t foot = 0; foot < 2; ++foot) sensors.feet[foot].force_N.fill(17);
  }

  // One tick, with a new reading of every sensor.
  void advance() {
    for (JointSample& joint : sensors.joints) ++joint.sequence;
    for (FootSample& foot : sensors.feet) ++foot.sequence;
    ++sensors.imu.sequence;
    advance_in_silence();
  }
  void advance_in_silence() { estimator.update(sensors, dt_s, tick++, joints, status); }

  Estimator estimator;
  double dt_s;
  std::uint64_t tick = 0;
  SensorFrame sensors;
  JointStates joints;
  RobotStatus status;
};

}  // namespace kadans::test
