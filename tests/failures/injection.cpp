#include <algorithm>
#include <array>

#include "injection_run.h"

namespace kadans::failures {

Outcome inject(Category category, std::uint64_t seed) { return Injection(category, seed).go(); }

Outcome Injection::go() {
  robot_.run(80 + static_cast<int>(pick(60)));
  if (category_ != Category::script) {
    robot_.move(pick(joints), random_.uniform(-0.8, 0.8), random_.uniform(0.25, 0.6));
    robot_.run(1 + static_cast<int>(pick(100)));
  }
  require(robot_.faults.empty(), "a fault before any was injected: " + robot_.codes());
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
    case Category::script:
      script();
      break;
  }
  require(robot_.broken_promise().empty(), robot_.broken_promise());
  outcome_.injected += " in tick " + std::to_string(onset_);
  return outcome_;
}

// Found within the promised ticks from `shows`, the first tick whose data show the fault.
void Injection::require_found(FaultCode code, std::int64_t shows) {
  require(robot_.in_time(code, shows), std::string(name(code)) + " was found in tick " +
                                           std::to_string(robot_.first(code)) + ", shown in " + std::to_string(shows));
}

void Injection::require_level(SafetyLevel level, SafetyLevel wanted, const char* whose) {
  require(level == wanted, std::string(whose) + " is on rung " + name(level) + ", promised was " + name(wanted));
}

// What was wrong is over: clearing brings every joint back. One that gave way stays where it is and does not go where
// it was to go before.
void Injection::recover() {
  robot_.run(20);
  robot_.clear_faults();
  std::array<double, joints> before_rad{}, coast_rad{};
  std::array<bool, joints> gave_way{};
  for (std::size_t i = 0; i < joints; ++i) {
    gave_way[i] = robot_.safety.joint_level(i) >= SafetyLevel::damp;
    before_rad[i] = robot_.position_rad(i);
    coast_rad[i] = 0.02 + 0.3 * std::abs(robot_.plant.truth().velocity_rad_s[i]);
  }
  robot_.run(700);
  require(robot_.safety.robot_level() <= SafetyLevel::limited, "the robot did not come back");
  for (std::size_t i = 0; i < joints; ++i) {
    require(robot_.safety.joint_level(i) <= SafetyLevel::limited, "a joint did not come back");
    const double moved_rad = std::abs(robot_.position_rad(i) - before_rad[i]);
    require(!gave_way[i] || moved_rad < coast_rad[i],
            "joint " + std::to_string(i) + " went " + std::to_string(moved_rad) + " rad after clearing");
  }
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
  if (which == 0) command.value = not_finite();
  if (which == 1) command.value = sign() * random_.uniform(1.6, 1e6);
  if (which == 2) command.index = 1000 + static_cast<std::uint32_t>(pick(1000000));
  if (which == 3) command = {.kind = CommandKind::set_parameter, .index = 0, .value = not_finite()};
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

// One field of what a control object computes, in one of the modes, is not finite or far beyond every limit.
void Injection::actuation() {
  constexpr std::array modes{ActuationMode::effort, ActuationMode::position, ActuationMode::velocity,
                             ActuationMode::impedance};
  constexpr std::array<const char*, 4> names{"effort", "position", "velocity", "impedance"};
  const std::size_t joint = pick(joints), mode = pick(modes.size());
  const bool finite = pick(3) == 0;
  // A field that its mode does not use does no harm while it is finite.
  const std::size_t field = !finite || mode == 1 || mode == 3 ? pick(3) : mode == 2 ? 2 * pick(2) : 0;
  const double value = finite ? sign() * std::pow(10, random_.uniform(2, 300)) : not_finite();
  JointActuation wrong{.position_rad = robot_.position_rad(joint), .mode = modes[mode]};
  (field == 0 ? wrong.effort_Nm : field == 1 ? wrong.position_rad : wrong.velocity_rad_s) = value;
  begin(std::string(names[field]) + " in mode " + names[mode] + " of joint " + std::to_string(joint) + ": " +
        std::to_string(value).substr(0, 12));
  robot_.saboteur->arm(joint, wrong);
  robot_.run(500);
  const SafetyLevel level = robot_.safety.joint_level(joint);
  if (finite) {
    constexpr std::array codes{FaultCode::effort_limit, FaultCode::soft_stop, FaultCode::soft_speed};
    require_found(codes[field], onset_ + 1);  // computed in one tick, to be written in the next
    const bool broke = robot_.first(FaultCode::velocity_limit) >= 0 || robot_.first(FaultCode::position_limit) >= 0;
    require_level(level, broke ? SafetyLevel::damp : SafetyLevel::limited, "the joint");
  } else {
    require_found(FaultCode::actuation_not_finite, onset_ + 1);
    require_level(level, SafetyLevel::damp, "the joint");
  }
  require_level(robot_.safety.robot_level(), SafetyLevel::normal, "the robot");
  robot_.saboteur->disarm();
  recover();
}

void Injection::timing() {
  const std::size_t which = pick(4);
  if (which == 3) return heartbeat_stop();
  if (which == 0) {
    begin("jitter");
    for (int i = 0; i < 300; ++i) robot_.tick(period_ns / 10 + static_cast<std::int64_t>(pick(2'500'000)));
    require(robot_.faults.empty(), "jitter is a fault");
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
  if (which == 2) recover();
}

void Injection::heartbeat_stop() {
  begin("no heartbeat");
  robot_.behaviors_alive = false;
  const std::int64_t last = robot_.exchange->heartbeat.newest() / period_ns;  // tick of the last heartbeat
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
  robot_.behaviors_alive = true;
  recover();
}

}  // namespace kadans::failures
