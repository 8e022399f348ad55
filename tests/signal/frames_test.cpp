// The frames cross threads, and later processes and word sizes, as bytes: their layout is part of the contract.
#include "kadans/signal/frames.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>

#include <doctest/doctest.h>

#include "kadans/signal/command.h"
#include "kadans/signal/status.h"

namespace kadans {
namespace {

template <typename T>
constexpr bool crosses = std::is_trivially_copyable_v<T>&& std::is_standard_layout_v<T> && alignof(T) == 8 &&
                         sizeof(T) % 8 == 0;
static_assert(crosses<SensorFrame> && crosses<JointStates> && crosses<ActuationFrame> && crosses<RobotStatus>);
static_assert(crosses<Snapshot> && crosses<Command> && crosses<Fault>);

TEST_CASE("the frames have the same layout on every machine") {
  CHECK(sizeof(SensorFrame) == 4000);
  CHECK(offsetof(SensorFrame, joints) == 16);
  CHECK(offsetof(SensorFrame, imu) == 3088);
  CHECK(offsetof(SensorFrame, feet) == 3152);
  CHECK(offsetof(ImuSample, time_ns) == 56);
  CHECK(sizeof(JointStates) == 1544);
  CHECK(sizeof(ActuationFrame) == 3208);
  CHECK(offsetof(JointActuation, mode) == 40);
  CHECK(sizeof(Command) == 56);
  CHECK(offsetof(Command, value) == 24);
  CHECK(offsetof(Snapshot, status) == 1576);
  CHECK(sizeof(CommandQueue) == 128 + sizeof(Command) * command_capacity);
}

TEST_CASE("what is used of a frame is copied, what is not stays") {
  SensorFrame sensors;
  sensors.time_ns = 5;
  sensors.joint_count = 2;
  sensors.foot_count = 1;
  for (JointSample& joint : sensors.joints) joint = {1, 2, 3, 4};
  sensors.imu = {{1, 2, 3}, {4, 5, 6}, 7};
  for (FootSample& foot : sensors.feet) foot = {{1, 2, 3, 4}, 5};
  SensorFrame sampled;
  copy_used(sensors, sampled);
  CHECK(sampled.time_ns == 5);
  CHECK(sampled.joint_count == 2);
  CHECK(sampled.foot_count == 1);
  CHECK(sampled.joints[1].motor_effort_Nm == 3);
  CHECK(sampled.joints[1].sequence == 4);
  CHECK(sampled.joints[2].sequence == 0);
  CHECK(sampled.imu.acceleration_m_s2[2] == 6);
  CHECK(sampled.imu.sequence == 7);
  CHECK(sampled.feet[0].sequence == 5);
  CHECK(sampled.feet[1].sequence == 0);

  ActuationFrame actuation;
  actuation.joint_count = 2;
  for (JointActuation& joint : actuation.joints) joint = {1, 2, 3, 4, 5, ActuationMode::velocity};
  ActuationFrame written;
  copy_used(actuation, written);
  CHECK(written.joint_count == 2);
  CHECK(written.joints[1].velocity_rad_s == 3);
  CHECK(written.joints[1].mode == ActuationMode::velocity);
  CHECK(written.joints[2].mode == ActuationMode::off);
  actuation.joint_count = 1000;  // never, but if it were
  copy_used(actuation, written);
  CHECK(written.joints[max_joints - 1].effort_Nm == 1);
}

TEST_CASE("what is used of a snapshot is copied, what is not stays") {
  Snapshot from;
  from.tick = 1;
  from.time_ns = 2;
  from.transactions_applied = 3;
  from.commands_refused = 4;
  from.control_sets = 5;
  from.transactions_refused = 6;
  from.joints.count = 2;
  for (JointState& joint : from.joints.joints) joint = {7, 8, 9};
  from.status.base.height_m = 10;
  from.status.support.cop_y_m = 11;
  from.object_count = 2;
  for (ObjectStatus& object : from.objects) object = {true, 3, 12};
  from.setpoint_count = 2;
  for (SetpointStatus& setpoint : from.setpoints) setpoint = {13, 14};
  for (Refusal& refusal : from.refusals) refusal.sequence = 15;
  from.joystick.axes[3] = 0.5;
  Snapshot to;
  copy_used(from, to);
  CHECK(to.tick == 1);
  CHECK(to.time_ns == 2);
  CHECK(to.transactions_applied == 3);
  CHECK(to.commands_refused == 4);
  CHECK(to.control_sets == 5);
  CHECK(to.transactions_refused == 6);
  CHECK(to.joints.count == 2);
  CHECK(to.joints.joints[1].effort_Nm == 9);
  CHECK(to.joints.joints[2].effort_Nm == 0);
  CHECK(to.status.base.height_m == 10);
  CHECK(to.status.support.cop_y_m == 11);
  CHECK(to.object_count == 2);
  CHECK(to.objects[1].dwell_s == 3);
  CHECK(to.objects[1].motion_remaining_s == 12);
  CHECK_FALSE(to.objects[2].active);
  CHECK(to.setpoint_count == 2);
  CHECK(to.setpoints[1].velocity == 14);
  CHECK(std::isnan(to.setpoints[2].velocity));
  CHECK(to.refusals[7].sequence == 15);
  CHECK(to.joystick.axes[3] == 0.5);
}

TEST_CASE("a command queue takes the largest transaction") {
  static_assert(max_transaction <= command_capacity);
  CHECK(CommandQueue::capacity() == command_capacity);
}

TEST_CASE("a frame that nobody filled asks for nothing and knows nothing") {
  const ActuationFrame actuation;
  CHECK(actuation.joint_count == 0);
  for (const JointActuation& joint : actuation.joints) {
    CHECK(joint.mode == ActuationMode::off);
    CHECK(joint.effort_Nm == 0);
  }
  const Snapshot snapshot;
  CHECK(snapshot.tick == 0);
  CHECK(snapshot.status.safety.level == SafetyLevel::normal);
  CHECK(snapshot.status.safety.first_fault.code == FaultCode::none);
  CHECK(snapshot.status.safety.first_fault.joint == no_joint);
  CHECK(snapshot.status.base.orientation == Quat{1, 0, 0, 0});
}

TEST_CASE("every fault code and every rung of the ladder has a name of its own") {
  CHECK(std::string(name(FaultCode::none)) == "none");
  CHECK(std::string(name(FaultCode::position_limit)) == "position_limit");
  CHECK(std::string(name(FaultCode::command_refused)) == "command_refused");
  CHECK(std::string(name(static_cast<FaultCode>(9999))) == "unknown");
  CHECK(std::string(name(SafetyLevel::normal)) == "normal");
  CHECK(std::string(name(SafetyLevel::off)) == "off");
  CHECK(std::string(name(static_cast<SafetyLevel>(99))) == "unknown");
  CHECK(SafetyLevel::normal < SafetyLevel::limited);
  CHECK(SafetyLevel::limited < SafetyLevel::hold);
  CHECK(SafetyLevel::hold < SafetyLevel::damp);
  CHECK(SafetyLevel::damp < SafetyLevel::off);
}

}  // namespace
}  // namespace kadans
