// The shipped configuration of TULip, against its URDF and the control objects that it names.
#include <algorithm>
#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "config/robot/robot_config.h"
#include "kadans/model/kinematics.h"
#include "objects.h"

namespace kadans::tulip_config_test {
namespace {

const std::vector<std::string> types{"joint_pid", "dcm_balance", "stance", "dcm_walk", "stance_leg", "joint_impedance"};
const std::string robot_file = KADANS_SOURCE_DIR "/config/tulip/robot.json";

RobotConfig tulip() { return read_robot_config(robot_file, types); }

const PoseInfo& pose(const RobotConfig& config, const char* name) {
  const auto named = [&](const PoseInfo& one) { return one.name == name; };
  return *std::find_if(config.poses.begin(), config.poses.end(), named);
}

// Height of the hips over the left sole and the pitch of the sole, the base upright.
struct Footing {
  double height_m, sole_pitch_rad;
};
Footing footing(const RobotConfig& config, const char* name) {
  std::vector<double> position_rad(config.model.joints.size());
  for (const auto& [joint, value] : pose(config, name).position_rad) position_rad[joint] = value;
  Kinematics kinematics(config.model);
  kinematics.update(position_rad);
  const Pose& foot = kinematics.link(config.model.find_link("l_ankle_roll_link").value());
  return {-foot.position_m[2], roll_pitch_yaw(foot.orientation)[1]};
}

}  // namespace

TEST_CASE("TULip's configuration drives its twelve motors and leaves the ankle rolls to their springs") {
  const RobotConfig config = tulip();
  CHECK(config.name == "tulip");
  CHECK(config.model.joints.size() == 14);
  REQUIRE(config.objects.size() == 11);  // the last seven are those of walk_cycle
  CHECK(config.objects[0].joints.size() == 12);
  CHECK(config.objects[1].type.name == "dcm_balance");
  CHECK(config.objects[1].joints.size() == 8);
  CHECK(config.objects[2].type.name == "stance");
  CHECK(config.objects[2].joints.size() == 10);
  CHECK(config.objects[3].type.name == "dcm_walk");
  CHECK(config.objects[3].joints.size() == 10);
  const std::size_t ankle = config.model.find_joint("r_ankle_roll").value();
  const std::size_t knee = config.model.find_joint("r_knee").value();
  CHECK(config.plant.drives[ankle].torque_max_Nm == 0);
  CHECK(config.plant.drives[ankle].rotor_inertia_kg_m2 == 0);
  CHECK(config.plant.drives[ankle].parallel_spring_Nm_per_rad == 25);
  CHECK(config.plant.drives[knee].torque_max_Nm == 25);
  CHECK(config.plant.drives[knee].rotor_inertia_kg_m2 == 0.02);
  CHECK(config.plant.drives[knee].parallel_spring_Nm_per_rad == 0);
  CHECK(config.estimate.spring_Nm_per_rad[knee] == config.plant.drives[knee].spring_Nm_per_rad);
  CHECK(config.engine.behavior_divisor() == 10);
  CHECK(config.engine.control_period_ns() == 1'000'000);
}

TEST_CASE("TULip's squat sinks the hips by 0.10 m with flat feet") {
  const RobotConfig config = tulip();
  const Footing stand = footing(config, "stand");
  const Footing squat = footing(config, "squat");
  CHECK(stand.height_m - squat.height_m == doctest::Approx(0.10).epsilon(1e-5));
  CHECK(std::abs(stand.sole_pitch_rad) < 1e-9);
  CHECK(std::abs(squat.sole_pitch_rad) < 1e-6);
  CHECK(footing(config, "straight").height_m == doctest::Approx(0.258 + 0.55));
}

TEST_CASE("TULip starts in its standing pose") {
  const RobotConfig config = tulip();
  CHECK(config.plant.position_rad[config.model.find_joint("l_knee").value()] == 0.3);
  CHECK(config.plant.stand_on_ground);
}

TEST_CASE("TULip's gains and presets fit the parameters that joint_pid declares") {
  const RobotConfig config = tulip();
  ControlObjects objects(config);
  apply_parameters(config, objects.catalog);
  CHECK(objects.value("posture.l_knee.kp_Nm_per_rad") == 300);
  CHECK(objects.value("posture.r_shoulder_pitch.ki_Nm_per_rads") == 20);
  const std::vector<Preset>& presets = objects.catalog.objects[0].presets;
  REQUIRE(presets.size() == 5);
  CHECK(presets[0].name == "stiff");
  CHECK(presets[1].name == "get_up");
  CHECK(presets[2].name == "rise");
  CHECK(presets[3].name == "balance");
  CHECK(presets[4].name == "soft");
  CHECK(presets[4].values.size() == 24);
}

}  // namespace kadans::tulip_config_test
