// Every fault names a key of the configuration that there is, and the configuration says what follows from it.
#include <algorithm>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "app/program.h"
#include "config/robot/robot_config.h"
#include "kadans/signal/fault.h"

namespace configuration_test {

using namespace kadans;

namespace {

const std::vector<std::string> types{"joint_pid", "dcm_balance", "stance", "dcm_walk", "stance_leg", "joint_impedance"};

const FieldInfo* field(const FieldInfo& in, const std::string& name) {
  // The elements of a map are described once, whatever their keys.
  const FieldInfo& holder = in.kind == FieldInfo::Kind::map ? in.fields.at(0) : in;
  const auto found =
      std::find_if(holder.fields.begin(), holder.fields.end(), [&](const FieldInfo& f) { return f.name == name; });
  return found == holder.fields.end() ? nullptr : &*found;
}

// What follows from the emergency stop is no matter of taste.
bool is_configured(std::size_t code) {
  const auto fault = static_cast<FaultCode>(code);
  return fault != FaultCode::emergency_stop && fault != FaultCode::emergency_input;
}

}  // namespace

TEST_CASE("The configuration key behind every fault is a key of the robot's configuration") {
  const FieldInfo robot = describe_robot_config();
  for (std::size_t code = 1; code < fault_codes; ++code) {
    std::string key = configuration_key(static_cast<FaultCode>(code));
    CAPTURE(key);
    const FieldInfo* at = &robot;
    while (at != nullptr && !key.empty()) {
      const std::size_t dot = key.find('.');
      at = field(*at, key.substr(0, dot));
      key = dot == std::string::npos ? "" : key.substr(dot + 1);
    }
    CHECK(at != nullptr);
  }
}

TEST_CASE("Entry, exit and latch of every fault's rung, for joint and robot, are keys of the configuration") {
  std::string reactions = "\"reactions\": { \"doc\": \"all\"";
  for (std::size_t code = 1; code < fault_codes; ++code) {
    if (!is_configured(code)) continue;
    reactions +=
        ", \"" + std::string(name(static_cast<FaultCode>(code))) +
        "\": { \"joint\": \"hold\", \"robot\": \"limited\", \"latch\": true, \"escalate\": true, \"exit_s\": 0.7 }";
  }
  const auto file = program::project_copy("reactions") / "config/tulip/robot.json";
  std::string text = program::read(file);
  const std::size_t from = text.find("\"reactions\": {"), to = text.find("\n    }", from);
  REQUIRE(to != std::string::npos);
  program::write(file, text.replace(from, to - from, reactions));
  const RobotConfig config = read_robot_config(file, types);
  for (std::size_t code = 1; code < fault_codes; ++code) {
    if (!is_configured(code)) continue;
    const Reaction& reaction = config.safety.reactions[code];
    CAPTURE(name(static_cast<FaultCode>(code)));
    CHECK(reaction.joint == SafetyLevel::hold);
    CHECK(reaction.robot == SafetyLevel::limited);
    CHECK(reaction.latch);
    CHECK(reaction.escalate);
    CHECK(reaction.exit_s == 0.7);
  }
}

TEST_CASE("A reaction of which the configuration names one key keeps its other defaults") {
  const auto file = program::project_copy("reaction") / "config/tulip/robot.json";
  REQUIRE(program::edit(file, "\"position_limit\": {", "\"fall\": { \"latch\": true }, \"position_limit\": {"));
  const RobotConfig config = read_robot_config(file, types);
  const Reactions defaults = default_reactions();
  for (std::size_t code = 1; code < fault_codes; ++code) {
    const bool changed = static_cast<FaultCode>(code) == FaultCode::fall;
    CHECK(config.safety.reactions[code].latch == (changed || defaults[code].latch));
    CHECK(config.safety.reactions[code].robot == defaults[code].robot);
    CHECK(config.safety.reactions[code].joint == defaults[code].joint);
    CHECK(config.safety.reactions[code].exit_s == defaults[code].exit_s);
  }
}

TEST_CASE("The configuration says nothing of the emergency stop") {
  const auto file = program::project_copy("no_reaction") / "config/tulip/robot.json";
  REQUIRE(
      program::edit(file, "\"position_limit\": {", "\"emergency_stop\": { \"latch\": false }, \"position_limit\": {"));
  CHECK_THROWS_WITH_AS(read_robot_config(file, types), doctest::Contains("emergency_stop"), InputError);
}

}  // namespace configuration_test
