#include "injection.h"

#include <algorithm>
#include <array>
#include <limits>

#include "kadans/safety/detection.h"
#include "light_robot.h"

namespace kadans::failures {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

class Injection {
 public:
  Injection(Category category, std::uint64_t seed) : category_(category), random_(seed, "injection"), robot_(seed) {}

  Outcome go() {
    robot_.run(80 + static_cast<int>(pick(60)));
    robot_.move(pick(joints), random_.uniform(-0.8, 0.8), random_.uniform(0.25, 0.6));
    robot_.run(1 + static_cast<int>(pick(100)));
    require(robot_.faults.empty(), "a fault before any was injected");
    switch (category_) {
      case Category::sensor:
        sensor();
        break;
      case Category::command:
        command();
        break;
      case Category::actuation:
        actuation();
        break;
      case Category::timing:
        timing();
        break;
    }
    require(robot_.broken_promise.empty(), robot_.broken_promise);
    outcome_.injected += " in tick " + std::to_string(onset_);
    return outcome_;
  }

 private:
  std::size_t pick(std::size_t count) { return static_cast<std::size_t>(random_.next() % count); }
  double sign() { return pick(2) == 0 ? -1 : 1; }
  void require(bool kept, const std::string& what) {
    if (!kept && outcome_.problem.empty()) outcome_.problem = what;
  }
  void begin(const std::string& what) {
    outcome_.injected = what;
    onset_ = robot_.ticks();
  }
  std::int64_t promised(FaultCode code) const { return detection_ticks(code, robot_.limits(), 0.001); }

  // Found within the promised ticks from `shows`, the first tick whose data show the fault.
  void require_found(FaultCode code, std::int64_t shows) {
    const std::int64_t found = robot_.first(code);
    require(found >= 0, std::string(name(code)) + " was not found");
    require(found >= shows && found < shows + promised(code), std::string(name(code)) + " was found in tick " +
                                                                  std::to_string(found) + ", shown in " +
                                                                  std::to_string(shows));
  }
  void require_level(SafetyLevel level, SafetyLevel wanted, const char* whose) {
    require(level == wanted, std::string(whose) + " is on rung " + name(level) + ", promised was " + name(wanted));
  }

  void sensor();
  void joint_sensor(SensorFaultKind kind);
  void imu_sensor(SensorFaultKind kind);
  void foot_sensor(SensorFaultKind kind);
  void plan(SensorFaultKind kind, SensorPlace place, std::size_t index, double size);
  void command();
  void flood();
  void actuation();
  void timing();
  void heartbeat_stop();

  Category category_;
  RandomStream random_;
  LightRobot robot_;
  Outcome outcome_;
  std::int64_t onset_ = 0;
};

void Injection::plan(SensorFaultKind kind, SensorPlace place, std::size_t index, double size) {
  constexpr std::array<const char*, 6> kinds{"silent", "stuck", "offset", "noise", "jump", "not finite"};
  constexpr std::array<const char*, 3> places{"joint", "imu", "foot"};
  begin(std::string(kinds[static_cast<std::size_t>(kind)]) + " " + places[static_cast<std::size_t>(place)] + " " +
        std::to_string(index) + " size " + std::to_string(size));
  robot_.plant.add({.kind = kind, .place = place, .index = index, .from_ns = robot_.time_ns + 1, .size = size});
}

void Injection::sensor() {
  const auto kind = static_cast<SensorFaultKind>(pick(6));
  switch (pick(3)) {
    case 0:
      return joint_sensor(kind);
    case 1:
      return imu_sensor(kind);
    default:
      return foot_sensor(kind);
  }
}

void Injection::joint_sensor(SensorFaultKind kind) {
  using enum SensorFaultKind;
  const std::size_t joint = pick(joints);
  plan(kind, SensorPlace::joint, joint, sign() * random_.uniform(0.15, 1.5));
  const double was_rad = robot_.plant.truth().position_rad[joint];
  robot_.move(joint, was_rad > 0 ? was_rad - 1 : was_rad + 1, 0.3);
  std::int64_t shows = onset_;
  for (int i = 0; i < 600; ++i) {
    // A reading that is stuck is wrong from when the motor has gone on.
    const double gone_rad = std::abs(robot_.plant.truth().position_rad[joint] - was_rad);
    if (kind == stuck && robot_.first(FaultCode::sensor_stuck) < 0 &&
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
  if (kind == stuck) {  // effort may tell sooner than motion
    require(found >= onset_ && found < std::max(shows, onset_) + promised(code) + 1,
            "stuck was found in tick " + std::to_string(found));
  } else {
    require_found(code, shows);
  }
  require_level(robot_.safety.joint_level(joint), SafetyLevel::off, "the joint");
  require_level(robot_.safety.robot_level(), SafetyLevel::normal, "the robot");
}

void Injection::imu_sensor(SensorFaultKind kind) {
  using enum SensorFaultKind;
  plan(kind, SensorPlace::imu, 0, sign() * random_.uniform(24, 60));
  robot_.run(1);
  const SafetyLevel at_once = robot_.safety.robot_level();
  robot_.run(400);
  switch (kind) {
    case silent:
      require_found(FaultCode::imu_silent, onset_);
      break;
    case stuck:
      require_found(FaultCode::imu_stuck, onset_ + 1);
      break;  // the first repetition
    case not_finite:
      require_found(FaultCode::imu_not_finite, onset_);
      break;
    default:
      require_found(FaultCode::imu_jump, onset_);
      require_level(at_once, SafetyLevel::limited, "the robot at once");
  }
  const bool lost = kind == silent || kind == stuck || kind == not_finite;
  const SafetyLevel rung = lost ? SafetyLevel::hold : kind == jump ? SafetyLevel::normal : SafetyLevel::limited;
  require_level(robot_.safety.robot_level(), rung, "the robot");
}

void Injection::foot_sensor(SensorFaultKind kind) {
  using enum SensorFaultKind;
  plan(kind, SensorPlace::foot, pick(2), sign() * random_.uniform(5e4, 1e6));
  robot_.run(1);
  const SafetyLevel at_once = robot_.safety.robot_level();
  robot_.run(200);
  switch (kind) {
    case silent:
      require_found(FaultCode::foot_silent, onset_);
      break;
    case stuck:
      require_found(FaultCode::foot_stuck, onset_ + 1);
      break;
    case not_finite:
      require_found(FaultCode::foot_not_finite, onset_);
      break;
    default:
      require_found(FaultCode::foot_jump, onset_);
      require_level(at_once, SafetyLevel::limited, "the robot at once");
  }
  const SafetyLevel rung = kind == jump ? SafetyLevel::normal : SafetyLevel::limited;
  require_level(robot_.safety.robot_level(), rung, "the robot");
}

void Injection::command() {
  const std::size_t which = pick(6);
  if (which == 5) return flood();
  constexpr std::array<const char*, 5> what{"a set-point that is not finite", "a set-point out of range",
                                            "an unknown set-point", "a parameter that is not finite",
                                            "an old set-point"};
  robot_.run(1200);  // to rest
  begin(what[which]);
  Command command{.kind = CommandKind::set_point, .index = static_cast<std::uint32_t>(pick(joints)), .value = 0.2};
  if (which == 0) command.value = pick(2) == 0 ? not_a_number : sign() * std::numeric_limits<double>::infinity();
  if (which == 1) command.value = sign() * random_.uniform(1.6, 1e6);
  if (which == 2) command.index = 1000 + static_cast<std::uint32_t>(pick(1000000));
  if (which == 3) command = {.kind = CommandKind::set_parameter, .index = 0, .value = not_a_number};
  const double before_rad = robot_.plant.truth().position_rad[0];
  robot_.send(command, which == 4 ? 100'000'000 + static_cast<std::int64_t>(pick(1'000'000'000)) : 0);
  robot_.run(200);
  require_found(which == 4 ? FaultCode::command_old : FaultCode::command_refused, onset_);
  require(robot_.control.inbox().state().refused == 1, "the refusal was not counted");
  require(std::abs(robot_.plant.truth().position_rad[0] - before_rad) < 1e-3, "a refused command moved a joint");
  require_level(robot_.safety.robot_level(), SafetyLevel::normal, "the robot");
}

// More than the queue holds: what does not fit is refused to the sender, what fits is applied, and no tick is late.
void Injection::flood() {
  begin("a flood");
  const auto count = 1000 + pick(3000);
  const auto applied = robot_.control.inbox().state().applied;
  for (std::size_t i = 0; i < count; ++i) robot_.move(pick(joints), random_.uniform(-0.5, 0.5), 0.5);
  const std::uint64_t refused = robot_.sender.refused();
  require(refused > 0, "the queue refused nothing");
  robot_.run(300);
  const auto done = robot_.control.inbox().state().applied - applied;
  require(done + refused == count, "commands were lost");
  require_level(robot_.safety.robot_level(), SafetyLevel::normal, "the robot");
}

void Injection::actuation() {
  const std::size_t joint = pick(joints);
  const std::size_t which = pick(3);
  const double huge_Nm = sign() * std::pow(10, random_.uniform(2, 300));
  const std::array<double, 3> values{not_a_number, sign() * std::numeric_limits<double>::infinity(), huge_Nm};
  begin("actuation " + std::to_string(values[which]).substr(0, 12) + " of joint " + std::to_string(joint));
  robot_.saboteur->arm(joint, values[which]);
  robot_.run(500);
  const SafetyLevel level = robot_.safety.joint_level(joint);
  if (which < 2) {
    require_found(FaultCode::actuation_not_finite, onset_ + 1);  // computed in one tick, to be written in the next
    require_level(level, SafetyLevel::damp, "the joint");
  } else {
    require_found(FaultCode::effort_limit, onset_ + 1);
    const bool broke = robot_.first(FaultCode::velocity_limit) >= 0 || robot_.first(FaultCode::position_limit) >= 0;
    require_level(level, broke ? SafetyLevel::damp : SafetyLevel::limited, "the joint");
  }
  require_level(robot_.safety.robot_level(), SafetyLevel::normal, "the robot");
}

void Injection::timing() {
  const std::size_t which = pick(4);
  if (which == 3) return heartbeat_stop();
  if (which == 0) {
    begin("jitter");
    for (int i = 0; i < 300; ++i) robot_.tick(period_ns / 10 + static_cast<std::int64_t>(pick(2'500'000)));
    require(robot_.faults.empty(), "jitter is no fault");
    return;
  }
  const int late = which == 1 ? 1 + static_cast<int>(pick(4)) : 5 + static_cast<int>(pick(20));
  begin(std::to_string(late) + " late ticks in a row");
  for (int i = 0; i < late; ++i) {
    const auto missed = static_cast<std::uint32_t>(1 + pick(5));
    robot_.tick(period_ns * (1 + missed), missed);
  }
  robot_.run(100);
  require_found(FaultCode::tick_overrun, onset_);
  if (which == 2) require_found(FaultCode::overruns, onset_);
  require_level(robot_.safety.robot_level(), which == 2 ? SafetyLevel::damp : SafetyLevel::normal, "the robot");
}

void Injection::heartbeat_stop() {
  begin("no heartbeat");
  robot_.behaviors_alive = false;
  const std::int64_t last = robot_.exchange->heartbeat.read() / period_ns;  // tick of the last heartbeat
  const double silent_s = random_.uniform(0.15, 3.6);
  robot_.run(static_cast<int>(1000 * silent_s));
  require_found(FaultCode::heartbeat_lost, last + 1);
  const double lost_s = 0.001 * static_cast<double>(robot_.ticks() - 1 - robot_.first(FaultCode::heartbeat_lost) + 1);
  const SafetySettings& s = robot_.limits();
  if (std::abs(lost_s - s.hold_s) < 0.003 || std::abs(lost_s - s.hold_s - s.damp_s) < 0.003) return;
  const SafetyLevel rung = lost_s < s.hold_s              ? SafetyLevel::hold
                           : lost_s < s.hold_s + s.damp_s ? SafetyLevel::damp
                                                          : SafetyLevel::off;
  require_level(robot_.safety.robot_level(), rung, "the robot");
}

}  // namespace

Outcome inject(Category category, std::uint64_t seed) { return Injection(category, seed).go(); }

}  // namespace kadans::failures
