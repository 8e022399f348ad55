// A safety layer with a motor joint and a passive one, whose sensors live as long as nobody tells otherwise.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "safety/safety.h"

namespace kadans::safety_bench {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double dt_s = 0.001;

inline RobotModel robot() {
  RobotModel model;
  model.links.resize(3);
  model.joints.resize(2);
  model.joints[0].name = "knee";
  model.joints[1].name = "toe";
  return model;
}

inline SafetySettings settings() {
  SafetySettings settings;
  settings.joints = {{.lower_rad = 0, .upper_rad = 2, .velocity_max_rad_s = 8, .effort_max_Nm = 25},
                     {.lower_rad = -0.4, .upper_rad = 0.4, .velocity_max_rad_s = 20, .effort_max_Nm = 0}};
  return settings;
}

struct Bench {
  std::unique_ptr<Safety> safety;
  SensorFrame sensors;
  JointStates joints;
  BaseStatus base;
  SensorHealth health;
  ActuationFrame asked, written;
  SafetyStatus status;
  double heartbeat_age_s = 0;
  std::uint32_t missed_ticks = 0;
  double since_last_s = dt_s;  // of the next tick
  std::uint64_t tick = 0;
  bool knee_noise = true, imu_noise = true, foot_noise = true;
  double place_rad = 0;
  std::vector<Fault> faults{};

  explicit Bench(const SafetySettings& with = settings(), const RobotModel& model = robot())
      : safety(std::make_unique<Safety>(with, model)) {
    joints.count = asked.joint_count = sensors.joint_count = health.joint_count = 2;
    sensors.foot_count = health.foot_count = 1;
    sensors.imu.acceleration_m_s2 = {0, 0, 9.81};
    place(1);
    ask(5);
  }
  // The knee stands here, read and estimated.
  void place(double position_rad, double velocity_rad_s = 0) {
    joints.joints[0].position_rad = position_rad;
    joints.joints[0].velocity_rad_s = velocity_rad_s;
    sensors.joints[0].position_rad = sensors.joints[0].motor_position_rad = place_rad = position_rad;
  }
  void ask(double effort_Nm) { asked.joints[0] = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort}; }

  const JointActuation& check() {
    const auto noise = static_cast<double>(tick % 5);
    if (knee_noise) sensors.joints[0].position_rad = place_rad + 1e-7 * noise;
    if (imu_noise) sensors.imu.angular_velocity_rad_s[1] = 1e-3 * noise;
    if (foot_noise) sensors.feet[0].force_N.fill(20 + 0.1 * noise);
    written = asked;
    safety->check({tick++, since_last_s, missed_ticks, heartbeat_age_s, sensors, joints, base, health}, written,
                  status);
    Fault fault;
    while (safety->log().try_pop(fault)) faults.push_back(fault);
    return written.joints[0];
  }
  void check_for(double time_s) {
    for (int i = 0; i < std::lround(time_s / dt_s); ++i) check();
  }
  // Checks until the fault comes; how many it took, 0 when it does not come within `most`.
  int ticks_until(FaultCode code, int most = 1000) {
    for (int i = 1; i <= most; ++i) {
      check();
      if (count(code) > 0) return i;
    }
    return 0;
  }
  std::size_t count(FaultCode code) const {
    std::size_t n = 0;
    for (const Fault& fault : faults) n += fault.code == code ? 1 : 0;
    return n;
  }
  // Codes in the order they came: "sensor_jump joints_lost".
  std::string codes() const {
    std::string text;
    for (const Fault& fault : faults) text += (text.empty() ? "" : " ") + std::string(name(fault.code));
    return text;
  }
};

}  // namespace kadans::safety_bench
