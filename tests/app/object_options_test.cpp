#include <doctest/doctest.h>

#include "app/assembly/robot.h"

using namespace kadans;

namespace {

Robot left_leg(const std::string& type, std::vector<TextEntry> options) {
  Robot robot = read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json");
  robot.config.file = "robot.json";
  ObjectConfig& object = robot.config.objects.at(0);
  object.place = {3, 5};
  object.type.name = type;
  object.parameters.clear();
  object.presets.clear();
  object.options = std::move(options);
  object.joints.clear();
  for (std::size_t i = 0; i < robot.config.model.joints.size(); ++i) {
    const Joint& joint = robot.config.model.joints[i];
    if (joint.name.starts_with("l_") && joint.name != "l_shoulder_pitch" && !joint.passive())
      object.joints.push_back(i);
  }
  return robot;
}

std::string refusal(const std::string& type, std::vector<TextEntry> options) {
  try {
    make_control_system(left_leg(type, std::move(options)));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("A control object's options are refused at their place in the configuration") {
  CHECK(refusal("task_impedance", {{"link", "l_ankle_roll_link", {7, 2}, {7, 10}}}) == "accepted");
  CHECK(refusal("task_impedance", {}) ==
        "robot.json:3:5: control object 'posture': it needs the option 'link': the link at the limb's end");
  CHECK(refusal("task_impedance", {{"link", "l_ankle_rol_link", {7, 2}, {7, 10}}}) ==
        "robot.json:7:10: control object 'posture': there is no link 'l_ankle_rol_link', did you mean "
        "'l_ankle_roll_link'?");
  CHECK(refusal("task_impedance",
                {{"link", "l_ankle_roll_link", {7, 2}, {7, 10}}, {"lnk", "l_ankle_roll_link", {8, 2}, {8, 10}}}) ==
        "robot.json:8:2: unknown option 'lnk', did you mean 'link'?");
  CHECK(refusal("joint_pid", {{"link", "l_ankle_roll_link", {7, 2}, {7, 10}}}) ==
        "robot.json:7:2: control objects of type 'joint_pid' have no options");
}

TEST_CASE("Every point that TULip's foot reaches is within task_impedance's set-points") {
  const auto system = make_control_system(left_leg("task_impedance", {{"link", "l_ankle_roll_link", {}, {}}}));
  const SetpointTable& table = system->catalog.setpoints;
  const Setpoint& z = table[table.find("posture.z_m").value()];
  CHECK(z.joint == no_joint);
  CHECK(z.unit == "m");
  CHECK(z.min < -0.258 - 0.55);
  CHECK(z.max > -0.258 + 0.55);
}
