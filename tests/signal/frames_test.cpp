// The frames cross threads, and later processes and word sizes, as bytes: their layout is part of the contract.
#include "kadans/signal/frames.h"

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
  CHECK(sizeof(SensorFrame) == 2280);
  CHECK(offsetof(SensorFrame, joints) == 16);
  CHECK(offsetof(SensorFrame, imu) == 2064);
  CHECK(offsetof(SensorFrame, feet) == 2120);
  CHECK(sizeof(JointStates) == 1544);
  CHECK(sizeof(ActuationFrame) == 2056);
  CHECK(offsetof(JointActuation, mode) == 24);
  CHECK(sizeof(Command) == 56);
  CHECK(offsetof(Command, value) == 24);
  CHECK(offsetof(Snapshot, status) == 1576);
  CHECK(sizeof(CommandQueue) == 128 + sizeof(Command) * command_capacity);
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
