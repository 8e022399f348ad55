// Robot configurations: what the parts mean, and what is said to wrong ones.
#include "config/robot/robot_config.h"

#include <algorithm>

#include <doctest/doctest.h>

#include "broken_robots.h"
#include "objects.h"
#include "right_texts.h"

namespace kadans::robot_config_test {
namespace {

const std::vector<std::string> types{"joint_pid"};
const std::string file = KADANS_SOURCE_DIR "/config/t.json";

RobotConfig read(const std::string& text) { return read_robot_config_text(text, file, types); }
RobotConfig read_with(const char* find, const char* replace) { return read(replaced(right_robot, find, replace)); }

std::string refusal_of(const std::string& text) {
  return refusal(file, KADANS_SOURCE_DIR, [&] {
    const RobotConfig config = read(text);
    ControlObjects objects(config);
    apply_parameters(config, objects.catalog);
  });
}

std::size_t joint(const RobotConfig& config, const char* name) { return config.model.find_joint(name).value(); }

}  // namespace

TEST_CASE("Every broken robot configuration is refused at its place, with what was meant") {
  CHECK(refusal_of(right_robot).empty());
  for (const Broken& broken : broken_robots) {
    CAPTURE(broken.replace);
    const std::string text = replaced(right_robot, broken.find, broken.replace);
    CHECK(text != right_robot);
    CHECK(refusal_of(text) == std::string(broken.message));
  }
}

TEST_CASE("A key that is left out keeps its default, torque and speed the URDF's") {
  const RobotConfig config = read(right_robot);
  const DriveSettings& knee = config.plant.drives[joint(config, "l_knee")];
  CHECK(knee.torque_max_Nm == 25);
  CHECK(knee.velocity_max_rad_s == 8);
  CHECK(knee.viscous_Nms_per_rad == 0);
  CHECK(config.safety.damp_s == SafetySettings{}.damp_s);
  CHECK(config.engine.command_age_max_s == EngineSettings{}.command_age_max_s);
  CHECK(config.engine.commands_per_tick_max == 300);
}

TEST_CASE("A behavior may take half of its period in a tick, or what the configuration says") {
  CHECK(read(right_robot).engine.behavior_time_max_ns() == 5'000'000);
  const RobotConfig config =
      read_with("\"behavior_period_s\": 0.01", "\"behavior_period_s\": 0.01, \"behavior_time_max_s\": 0.002");
  CHECK(config.engine.behavior_time_max_ns() == 2'000'000);
}

TEST_CASE("A joystick's axes are the usual ones, unless the configuration says so") {
  CHECK_FALSE(read(right_robot).engine.joystick);
  const RobotConfig config = read_with("\"name\": \"tulip\"",
                                       "\"name\": \"tulip\", \"joystick\": { \"dead_zone\": 0.2, \"axes\": { \"y\": { "
                                       "\"code\": 4, \"min\": 0, \"max\": 9 } } }");
  CHECK(config.engine.joystick);
  CHECK(config.joystick.dead_zone == 0.2);
  CHECK(config.joystick.axes[0].code == 0);
  CHECK(config.joystick.axes[1].code == 4);
  CHECK(config.joystick.axes[1].inverted);
  CHECK(config.joystick.axes[1].max == 9);
}

TEST_CASE("The bound of a switch and its fade are the configuration's, else 2 percent of the limit and 0.2 s") {
  const RobotConfig config = read(right_robot);
  CHECK(config.switching.step_max == 0.02);
  CHECK(config.switching.fade_s == 0.2);
  const RobotConfig changed =
      read_with("\"initial_set\": \"posture\"",
                "\"initial_set\": \"posture\", \"switch_step_max\": 0.01, \"switch_fade_s\": 0.5");
  CHECK(changed.switching.step_max == 0.01);
  CHECK(changed.switching.fade_s == 0.5);
}

TEST_CASE("A control set and a control object may demand a least time between switches, else they demand none") {
  CHECK(read(right_robot).sets.front().switch_dwell_s == 0);
  CHECK(read(right_robot).objects.front().switch_dwell_s == 0);
  CHECK(read_with("\"posture\": { \"objects\": [\"posture\"] }",
                  "\"posture\": { \"objects\": [\"posture\"], \"switch_dwell_s\": 0.3 }")
            .sets.front()
            .switch_dwell_s == 0.3);
  CHECK(read_with("\"name\": \"posture\",", "\"name\": \"posture\", \"switch_dwell_s\": 0.2,")
            .objects.front()
            .switch_dwell_s == 0.2);
}

TEST_CASE("A pattern speaks for all joints that it fits, and later entries override earlier ones field by field") {
  const RobotConfig config = read_with("\"*_ankle_roll\": { \"rotor_inertia_kg_m2\": 0,", "\"*_ankle_roll\": {");
  const DriveSettings& ankle = config.plant.drives[joint(config, "r_ankle_roll")];
  CHECK(ankle.rotor_inertia_kg_m2 == 0.02);
  CHECK(ankle.parallel_spring_Nm_per_rad == 25);
  CHECK(config.plant.drives[joint(config, "l_knee")].parallel_spring_Nm_per_rad == 0);
  CHECK(config.estimate.sample_divisor[joint(config, "l_shoulder_pitch")] == 10);
  CHECK(config.estimate.sample_divisor[joint(config, "l_knee")] == 1);
}

TEST_CASE("Coupled drives have names for their settings, and by default give both joints all that the URDF allows") {
  const std::string coupled =
      "\"name\": \"tulip\", \"transmissions\": [{ \"type\": \"differential\", \"joints\": [\"l_hip_yaw\", "
      "\"l_hip_roll\"],"
      "\"drives\": [\"fore\", \"aft\"], \"actuator_reduction\": [2, 1] }]";
  const std::string text = replaced(right_robot, "\"name\": \"tulip\"", coupled.c_str());
  const RobotConfig config = read(text);
  const std::size_t yaw = joint(config, "l_hip_yaw"), roll = joint(config, "l_hip_roll");
  REQUIRE(config.model.transmissions.size() == 1);
  CHECK(config.model.transmissions[0].joints() == std::vector<std::size_t>{yaw, roll});
  CHECK(config.model.drive_names()[roll] == "aft");
  CHECK(config.plant.drives[yaw].torque_max_Nm == (12 + 25) / 4.0);
  CHECK(config.plant.drives[roll].torque_max_Nm == (12 + 25) / 2.0);
  CHECK(config.plant.drives[yaw].velocity_max_rad_s == 2 * (6 + 6));
  CHECK(config.plant.drives[roll].rotor_inertia_kg_m2 == 0.02);  // "*" is all drives
  CHECK(config.safety.joints[yaw].drive_effort_max_Nm == (12 + 25) / 4.0);
  CHECK(config.safety.joints[yaw].drive_velocity_max_rad_s == 2 * (6 + 6));
  const RobotConfig named =
      read(replaced(text, "\"*_ankle_roll\": {", "\"aft\": { \"torque_max_Nm\": 5 }, \"*_ankle_roll\": {"));
  CHECK(named.plant.drives[roll].torque_max_Nm == 5);
  const auto refused = [&](const char* drive) {
    return refusal_of(replaced(text, "\"*_ankle_roll\": {", (std::string(drive) + ", \"*_ankle_roll\": {").c_str()));
  };
  CHECK(refused("\"l_hip_roll\": { \"torque_max_Nm\": 5 }").find("unknown joint 'l_hip_roll'") != std::string::npos);
  const RobotConfig elastic =
      read(replaced(text, "\"*_ankle_roll\": {", "\"aft\": { \"spring_Nm_per_rad\": 80 }, \"*_ankle_roll\": {"));
  CHECK(elastic.estimate.spring_Nm_per_rad[roll] == 80);
  CHECK(elastic.estimate.spring_Nm_per_rad[yaw] == 0);
  CHECK(elastic.safety.joints[roll].spring_Nm_per_rad == 80);
}

TEST_CASE("Limits may be narrowed for the safety layer, joint by joint") {
  const RobotConfig config = read(right_robot);
  CHECK(config.safety.joints[joint(config, "l_knee")].upper_rad == 2.0);
  CHECK(config.safety.joints[joint(config, "l_hip_yaw")].upper_rad == 0.7);
  CHECK(config.model.joints[joint(config, "l_knee")].upper_rad == 2.35);
}

TEST_CASE("Feet are the plant's and the estimator's alike, in the order of the file") {
  const RobotConfig config = read(right_robot);
  REQUIRE(config.plant.feet.size() == 1);
  REQUIRE(config.estimate.feet.size() == 1);
  CHECK(config.plant.feet[0].sensors_m[2] == Vec3{0.14, -0.05, -0.06});
  CHECK(config.estimate.feet[0].sensors_m == config.plant.feet[0].sensors_m);
  CHECK(config.estimate.feet[0].link == "l_ankle_roll_link");
}

TEST_CASE("Feet have names: two left and right unless named, others their links', each its own") {
  using Names = std::vector<std::string>;
  const auto with = [](const std::vector<std::pair<std::string, std::string>>& feet) {  // link, name
    std::string list, text = right_robot;
    for (const auto& [link, name] : feet) {
      std::string corners;
      for (const char* corner : {"heel_inner_m", "heel_outer_m", "toe_inner_m", "toe_outer_m"})
        corners += std::string(", \"") + corner + "\": [0, 0, 0]";
      list += (list.empty() ? "" : ", ") + std::string("{ \"link\": \"") + link + "\"" +
              (name.empty() ? "" : ", \"name\": \"" + name + "\"") + corners + " }";
    }
    const std::size_t from = text.find("\"feet\": [") + 8, last = text.find("toe_outer_m", from);
    const std::size_t to = text.find(']', text.find(']', last) + 1) + 1;  // behind the corner's, the list's
    return text.replace(from, to - from, "[" + list + "]");
  };
  const auto names = [&](const std::vector<std::pair<std::string, std::string>>& feet) {
    Names all;
    for (const EstimateFoot& foot : read(with(feet)).estimate.feet) all.push_back(foot.name);
    return all;
  };
  const std::string l = "l_ankle_roll_link", r = "r_ankle_roll_link", knee = "l_knee_link";
  CHECK(names({{l, ""}}) == Names{l});
  CHECK(names({{l, ""}, {r, ""}}) == Names{"left", "right"});
  CHECK(names({{l, "aft"}, {r, ""}}) == Names{"aft", r});
  CHECK(names({{l, ""}, {r, ""}, {knee, "third"}}) == Names{l, r, "third"});
  CHECK(refusal_of(with({{l, "one"}, {r, "one"}})).find("two feet are 'one'") != std::string::npos);
  CHECK(refusal_of(with({{l, ""}, {l, ""}})).find("two feet are 'right'") != std::string::npos);
  CHECK(refusal_of(with({{l, "a.b"}, {r, ""}})).find("a foot's name has no dot") != std::string::npos);
}

TEST_CASE("A control object drives the motor joints that its patterns fit, each once, in the order of the model") {
  const RobotConfig config = read_with("\"joints\": [\"*\"]", "\"joints\": [\"*_knee\", \"l_*\", \"l_knee\"]");
  const std::vector<std::size_t>& joints = config.objects[0].joints;
  CHECK(joints.size() == 7);  // six motors of the left side and the right knee
  CHECK(std::is_sorted(joints.begin(), joints.end()));
  CHECK(std::find(joints.begin(), joints.end(), joint(config, "l_ankle_roll")) == joints.end());
}

TEST_CASE("Sets number their control objects, and the initial one is found by name") {
  const RobotConfig config = read_with("\"initial_set\": \"posture\"", "\"initial_set\": \"wave\"");
  REQUIRE(config.sets.size() == 2);
  CHECK(config.sets[1].objects == std::vector<std::uint32_t>{1});
  CHECK(config.initial_sets == 0b10);
}

TEST_CASE("Several sets may be active first when they share no joint") {
  const auto first = [](const char* sets) {
    std::string text = right_robot;
    const auto put = [&](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    put("{ \"name\": \"arms\"",
        "{ \"name\": \"knee\", \"type\": \"joint_pid\", \"joints\": [\"l_knee\"] }, { \"name\": \"arms\"");
    put("\"wave\":", "\"step\": { \"objects\": [\"knee\"] }, \"wave\":");
    put("\"initial_set\": \"posture\"", std::string("\"initial_sets\": ") + sets);
    return text;
  };
  CHECK(read(first("[\"step\", \"wave\"]")).initial_sets == 0b110);
  CHECK_THROWS_WITH(read(first("[\"posture\", \"wave\"]")),
                    doctest::Contains("control sets that are active first share a joint"));
  CHECK_THROWS_WITH(read(first("[\"posture\", \"wav\"]")),
                    doctest::Contains("unknown control set 'wav', did you mean 'wave'?"));
}

TEST_CASE("A joint that no set holds damps as in safety, or does what its pattern says, one without a motor is off") {
  const RobotConfig plain = read(right_robot);
  CHECK(plain.unheld[joint(plain, "l_knee")].damping_Nms_per_rad == plain.safety.damping_Nms_per_rad);
  CHECK(plain.unheld[joint(plain, "l_knee")].stiffness_Nm_per_rad == 0);
  const RobotConfig held =
      read_with("\"initial_set\":", "\"unheld\": { \"*\": { \"stiffness_Nm_per_rad\": 80 } }, \"initial_set\":");
  CHECK(held.unheld[joint(held, "l_knee")].stiffness_Nm_per_rad == 80);
  CHECK(held.unheld[joint(held, "l_knee")].damping_Nms_per_rad == held.safety.damping_Nms_per_rad);
  CHECK(held.unheld[joint(held, "l_ankle_roll")].stiffness_Nm_per_rad == 0);
  CHECK(held.unheld[joint(held, "l_ankle_roll")].damping_Nms_per_rad == 0);
}

TEST_CASE("Objects of one set may share a joint when all but one of them compose") {
  const RobotConfig config =
      read_with("{ \"objects\": [\"posture\"] }", "{ \"objects\": [\"posture\", \"arms\"], \"sum\": [\"arms\"] }");
  CHECK(config.sets[0].objects == std::vector<std::uint32_t>{0, 1});
  CHECK(config.sets[0].compositions == std::vector<Composition>{Composition::set, Composition::sum});
}

TEST_CASE("A pose gives some joints their positions, the start pose the others too") {
  const RobotConfig config = read(right_robot);
  REQUIRE(config.poses.size() == 1);
  CHECK(config.poses[0].position_rad.size() == 4);
  CHECK(config.plant.position_rad[joint(config, "r_hip_pitch")] == -0.15);
  CHECK(config.plant.position_rad[joint(config, "r_hip_yaw")] == 0);
}

TEST_CASE("Parameters reach the tables by pattern, later entries override, presets are kept apart") {
  const RobotConfig config = read(right_robot);
  ControlObjects objects(config);
  apply_parameters(config, objects.catalog);
  CHECK(objects.value("posture.l_knee.kp_Nm_per_rad") == 200);
  CHECK(objects.value("posture.r_knee.kp_Nm_per_rad") == 100);
  CHECK(objects.value("arms.l_shoulder_pitch.kp_Nm_per_rad") != 100);
  REQUIRE(objects.catalog.objects[0].presets.size() == 1);
  CHECK(objects.catalog.objects[0].presets[0].name == "soft");
  CHECK(objects.catalog.objects[0].presets[0].values.size() == 12);
}

TEST_CASE("One wrong parameter leaves the tables as they were") {
  const RobotConfig config = read_with("\"l_knee.kp_Nm_per_rad\": 200", "\"l_knee.kp_Nm_per_rad\": -1");
  ControlObjects objects(config);
  const double before = objects.value("posture.r_knee.kp_Nm_per_rad");
  CHECK_THROWS_AS(apply_parameters(config, objects.catalog), InputError);
  CHECK(objects.value("posture.r_knee.kp_Nm_per_rad") == before);
}

TEST_CASE("What the URDF gets wrong is told beside what the configuration gets wrong") {
  const std::string text = replaced(right_robot, "models/tulip/tulip.urdf", "config/tulip/robot.json");
  const std::string message = refusal_of(replaced(text, "\"hold_s\": 1", "\"hold_s\": -1"));
  CHECK(message.starts_with("40:15: safety.hold_s is -1"));
  CHECK(message.find("\nROOT/config/tulip/robot.json") != std::string::npos);
}

}  // namespace kadans::robot_config_test
