// What the snapshot and people are told of a transaction that the control engine refuses.
#include <limits>

#include <doctest/doctest.h>

#include "bench.h"
#include "engine/refusal_text.h"
#include "engine/transaction.h"

using namespace kadans;

namespace {

// A set of its own for each motor beside those of both.
std::vector<std::unique_ptr<ControlObject>> single_joints(Catalog& catalog, const RobotModel& model) {
  auto objects = bench::posture(catalog, model);
  for (std::size_t joint = 0; joint < 2; ++joint) {
    const std::string name = model.joints[joint].name + "_alone";
    objects.push_back(make_joint_pid(ObjectSetup{model, {joint}}));
    const auto index = static_cast<std::uint32_t>(objects.size() - 1);
    Declaration declaration(name, index, catalog.parameters, catalog.setpoints, catalog.signals);
    objects.back()->declare(declaration);
    catalog.objects.push_back({.name = name, .type = "joint_pid", .joints = {joint}});
    catalog.sets.push_back({name, {index}});
  }
  return objects;
}

struct Rig {
  EngineSettings settings;
  RobotModel model = bench::robot();
  Catalog catalog;
  Safety safety;
  ControlSets sets{catalog, single_joints(catalog, model)};
  std::unique_ptr<EngineExchange> exchange = std::make_unique<EngineExchange>();
  CommandInbox inbox{exchange->commands, catalog, sets, 256, 100'000'000};
  CommandSender sender{exchange->commands};
  Snapshot snapshot;
  ActuationFrame written;

  static SafetySettings gentle() {
    SafetySettings settings = bench::safety_settings();
    settings.reactions[static_cast<std::size_t>(FaultCode::sensor_not_finite)] = {.joint = SafetyLevel::hold,
                                                                                  .latch = true};
    return settings;
  }
  Rig() : safety(gentle(), model) {}

  // The transaction's number.
  std::uint32_t send(const std::vector<Command>& commands, std::int64_t age_ns = 0) {
    sender.begin(0);
    for (const Command& command : commands) REQUIRE(sender.add(command));
    const std::uint32_t sequence = sender.commit();
    inbox.apply(1, {snapshot.joints, snapshot.status, written, age_ns, 0.001}, safety);
    inbox.fill(snapshot);
    return sequence;
  }
  std::string refusal(const std::vector<Command>& commands, std::int64_t age_ns = 0) {
    const std::uint32_t sequence = send(commands, age_ns);
    const Refusal& newest = snapshot.refusals[(snapshot.transactions_refused - 1) % refusals_shown];
    return snapshot.transactions_refused > 0 && newest.sequence == sequence ? refusal_text(newest, catalog) : "taken";
  }
  Command set(const char* setpoint, double value, double duration_s = 0) const {
    return {.kind = CommandKind::set_point,
            .index = catalog.setpoints.find(setpoint).value(),
            .value = value,
            .duration_s = duration_s};
  }
  void hold(std::size_t joint) {
    SensorFrame sensors;
    JointStates states;
    states.count = 2;
    SensorHealth health;
    health.joint_count = 2;
    health.joints[joint].finite = false;
    safety.check({.tick = 1,
                  .dt_s = 0.001,
                  .missed_ticks = 0,
                  .heartbeat_age_s = 0,
                  .sensors = sensors,
                  .joints = states,
                  .base = snapshot.status.base,
                  .health = health},
                 written, snapshot.status.safety);
  }
};

Command switch_to(std::uint32_t set) { return {.kind = CommandKind::switch_set, .index = set}; }

}  // namespace

TEST_CASE("A refusal names the parameter or set-point and its range") {
  Rig rig;
  const Command kp{.kind = CommandKind::set_parameter,
                   .index = rig.catalog.parameters.find("posture.knee.kp_Nm_per_rad").value(),
                   .value = -1};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(rig.refusal({kp}).find("posture.knee.kp_Nm_per_rad = -1 is outside its range 0..") == 0);
  CHECK(rig.refusal({rig.set("posture.hip.position_rad", 0.1), rig.set("posture.knee.position_rad", 3)}) ==
        "posture.knee.position_rad = 3 is outside its range -2..2 rad");
  CHECK(rig.refusal({rig.set("posture.hip.position_rad", nan)}).find("posture.hip.position_rad = nan is outside") == 0);
  CHECK(rig.refusal({rig.set("posture.hip.position_rad", 0, -1)}) ==
        "posture.hip.position_rad: it cannot be moved with this duration and these limits");
  CHECK(rig.refusal({switch_to(9)}) == "number 9 is unknown");
  CHECK(rig.refusal({{.kind = CommandKind::transaction}}) == "a command of no known kind");
  CHECK(rig.refusal({switch_to(1)}, 100'000'001) == "the commands were too old");
  CHECK(rig.refusal({rig.set("posture.hip.position_rad", 0.1)}) == "taken");
}

TEST_CASE("The odometry of a robot without feet cannot be reset, that of one with feet is, also while it is held") {
  Rig rig;
  const Command reset{.kind = CommandKind::reset_odometry};
  CHECK(rig.refusal({reset}) == "the robot has no feet, so it has no odometry");
  CHECK_FALSE(rig.inbox.odometry_resets());
  rig.catalog.feet.push_back({.name = "left", .link = "left_foot"});
  CHECK(rig.refusal({reset}) == "taken");
  CHECK(rig.inbox.odometry_resets());
  CHECK_FALSE(rig.inbox.odometry_resets());  // told once
}

TEST_CASE("Each refused transaction stands in the snapshot until eight more were") {
  Rig rig;
  const std::uint32_t first = rig.send({switch_to(9)});
  for (int i = 0; i < 7; ++i) (void)rig.send({switch_to(10)});
  CHECK(rig.snapshot.transactions_refused == 8);
  CHECK(rig.snapshot.refusals[0].sequence == first);
  CHECK(rig.snapshot.refusals[0].index == 9);
  (void)rig.send({switch_to(11)});
  CHECK(rig.snapshot.refusals[0].index == 11);
}

TEST_CASE("A held joint refuses a switch that concerns it, by its name, and no other") {
  Rig rig;
  CHECK(rig.refusal({switch_to(2), switch_to(3)}) == "taken");  // hip_alone and knee_alone
  CHECK(rig.sets.active() == 0b1100);
  rig.hold(1);
  REQUIRE(rig.safety.joint_level(1) == SafetyLevel::hold);
  REQUIRE(rig.safety.robot_level() < SafetyLevel::hold);
  CHECK(rig.refusal({switch_to(0)}) == "control set posture: joint knee is held");
  CHECK(rig.refusal({rig.set("knee_alone.knee.position_rad", 0.1)}) ==
        "knee_alone.knee.position_rad: joint knee is held");
  CHECK(rig.refusal({rig.set("hip_alone.hip.position_rad", 0.1)}) == "taken");
  CHECK(rig.refusal({switch_to(2)}) == "taken");
  CHECK(rig.refusal({{.kind = CommandKind::clear_faults}, switch_to(0)}) == "taken");
  CHECK(rig.sets.active() == 0b1);
}

TEST_CASE(
    "What was armed for a joint that is held when its condition comes is refused with the joint, and another acts") {
  Rig rig;
  const Command now{.kind = CommandKind::condition, .count = static_cast<std::uint32_t>(ConditionKind::after)};
  const Command arm{.kind = CommandKind::arm, .index = 1, .count = 2, .duration_s = 10};
  const std::uint32_t held = rig.send({arm, now, rig.set("knee_alone.knee.position_rad", 0.1)});
  const std::uint32_t free = rig.send({arm, now, rig.set("hip_alone.hip.position_rad", 0.1)});
  rig.hold(1);
  rig.inbox.carry_out_armed(2, {rig.snapshot.joints, rig.snapshot.status, rig.written, 0, 0.001}, rig.safety);
  rig.inbox.fill(rig.snapshot);
  REQUIRE(rig.snapshot.transactions_refused == 1);
  CHECK(rig.snapshot.refusals[0].sequence == held);
  CHECK(refusal_text(rig.snapshot.refusals[0], rig.catalog) == "knee_alone.knee.position_rad: joint knee is held");
  for (const ArmedStatus& status : rig.snapshot.armed) {
    if (status.sequence == free) CHECK(status.state == ArmedState::done);
    if (status.sequence == held) CHECK(status.reason == RefusalReason::joint_held);
  }
}
