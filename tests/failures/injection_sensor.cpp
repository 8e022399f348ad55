// Sensors of joints, IMU and feet that fail in every way that a faulty plant knows.
#include <algorithm>
#include <array>

#include "injection_run.h"

namespace kadans::failures {

void Injection::plan(ScenarioFault::Kind kind, SensorKind place, std::size_t index, double size) {
  constexpr std::array<const char*, 6> kinds{"silent", "stuck", "offset", "noise", "jump", "not finite"};
  constexpr std::array<const char*, 3> places{"joint", "imu", "foot"};
  begin(std::string(kinds[static_cast<std::size_t>(kind)]) + " " + places[static_cast<std::size_t>(place)] + " " +
        std::to_string(index) + " size " + std::to_string(size));
  robot_.spoil(kind, place, index, size);
}

void Injection::sensor() {
  static_assert(!of_sensor(static_cast<ScenarioFault::Kind>(6)));
  const auto kind = static_cast<ScenarioFault::Kind>(pick(6));
  switch (pick(3)) {
    case 0:
      return joint_sensor(kind);
    case 1:
      return imu_sensor(kind);
    default:
      return foot_sensor(kind);
  }
}

void Injection::joint_sensor(ScenarioFault::Kind kind) {
  using enum ScenarioFault::Kind;
  const std::size_t joint = pick(joints);
  plan(kind, SensorKind::joint, joint, sign() * random_.uniform(0.15, 1.5));
  const double was_rad = robot_.plant.truth().position_rad[joint];
  robot_.move(joint, was_rad > 0 ? was_rad - 1 : was_rad + 1, 0.3);
  std::int64_t shows = onset_;
  for (int i = 0; i < 600; ++i) {
    // A reading that is stuck is wrong from when the motor has gone on.
    const double gone_rad = std::abs(robot_.plant.truth().position_rad[joint] - was_rad);
    if (kind == sensor_stuck && robot_.first(FaultCode::sensor_stuck) < 0 &&
        gone_rad < robot_.limits().sensors.stuck_motion_rad) {
      shows = std::max(shows, robot_.ticks() - promised(FaultCode::sensor_stuck) + 1);
    }
    robot_.tick();
  }
  constexpr std::array<FaultCode, 6> codes{FaultCode::sensor_silent, FaultCode::sensor_stuck,
                                           FaultCode::sensor_jump,   FaultCode::sensor_jump,
                                           FaultCode::sensor_jump,   FaultCode::sensor_not_finite};
  const FaultCode code = codes[static_cast<std::size_t>(kind)];
  const std::int64_t found = robot_.first(code);
  if (kind == sensor_stuck) {  // effort may tell sooner than motion
    require(found >= onset_ && found < std::max(shows, onset_) + promised(code) + 1,
            "stuck was found in tick " + std::to_string(found));
  } else {
    require_found(code, shows);
  }
  require_level(robot_.safety.joint_level(joint), SafetyLevel::off, "the joint");
  require_level(robot_.safety.robot_level(), SafetyLevel::normal, "the robot");
  robot_.heal();
  recover();
}

void Injection::imu_sensor(ScenarioFault::Kind kind) {
  using enum ScenarioFault::Kind;
  plan(kind, SensorKind::imu, 0, sign() * random_.uniform(24, 60));
  robot_.run(1);
  const SafetyLevel at_once = robot_.safety.robot_level();
  robot_.run(400);
  switch (kind) {
    case sensor_silent:
      require_found(FaultCode::imu_silent, onset_);
      break;
    case sensor_stuck:
      require_found(FaultCode::imu_stuck, onset_ + 1);
      break;  // the first repetition
    case sensor_not_finite:
      require_found(FaultCode::imu_not_finite, onset_);
      break;
    default:
      require_found(FaultCode::imu_jump, onset_);
      require_level(at_once, SafetyLevel::limited, "the robot at once");
  }
  const bool lost = kind == sensor_silent || kind == sensor_stuck || kind == sensor_not_finite;
  const SafetyLevel rung = lost ? SafetyLevel::hold : kind == sensor_jump ? SafetyLevel::normal : SafetyLevel::limited;
  require_level(robot_.safety.robot_level(), rung, "the robot");
}

void Injection::foot_sensor(ScenarioFault::Kind kind) {
  using enum ScenarioFault::Kind;
  plan(kind, SensorKind::foot, pick(2), sign() * random_.uniform(5e4, 1e6));
  robot_.run(1);
  const SafetyLevel at_once = robot_.safety.robot_level();
  robot_.run(200);
  switch (kind) {
    case sensor_silent:
      require_found(FaultCode::foot_silent, onset_);
      break;
    case sensor_stuck:
      require_found(FaultCode::foot_stuck, onset_ + 1);
      break;
    case sensor_not_finite:
      require_found(FaultCode::foot_not_finite, onset_);
      break;
    default:
      require_found(FaultCode::foot_jump, onset_);
      require_level(at_once, SafetyLevel::limited, "the robot at once");
  }
  const SafetyLevel rung = kind == sensor_jump ? SafetyLevel::normal : SafetyLevel::limited;
  require_level(robot_.safety.robot_level(), rung, "the robot");
}

}  // namespace kadans::failures
