// MJCF: what each of its ways to write a robot means, judged by libmujoco where that is installed, and what is refused.
#include "kadans/model/mjcf.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/random.h"
#include "temporary_folder.h"
#ifdef KADANS_MUJOCO
#include "mjcf_judge.h"
#endif

namespace kadans {
namespace {

// Every way to give a pose, a shape and a mass; classes in classes; a free base; scenery and an object.
constexpr const char* walker = R"(<mujoco model="walker">
  <compiler angle="degree" eulerseq="zyx"/>
  <default>
    <joint damping="0.1" armature="0.01"/>
    <geom rgba="0.1 0.2 0.3 1"/>
    <motor ctrllimited="true" ctrlrange="-4 5"/>
    <default class="leg">
      <joint axis="0 1 0" limited="true" range="-90 45"/>
      <default class="shank"><joint armature="0.02" frictionloss="0.3" range="0 120"/></default>
    </default>
    <default class="seen"><geom contype="0" conaffinity="0" mass="0"/></default>
  </default>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <light pos="0 0 3"/>
    <body name="ball" pos="2 0 0.1"><freejoint/><geom size="0.1"/></body>
    <body name="trunk" pos="0.1 0.2 1" euler="10 20 30" childclass="leg">
      <freejoint name="root"/>
      <geom type="box" size="0.1 0.15 0.2" density="300"/>
      <geom type="ellipsoid" size="0.05 0.06 0.07" pos="0 0 0.3" euler="5 0 0"/>
      <geom class="seen" type="sphere" size="0.2"/>
      <body name="left" pos="0 0.2 -0.2" axisangle="0 0 1 15">
        <joint name="left_hip" pos="0.01 0.02 0.03" axis="0 1 1"/>
        <geom type="capsule" fromto="0 0 0 0.1 0 -0.4" size="0.04"/>
        <body name="left_shank" pos="0.1 0 -0.4" xyaxes="1 0 0.1 0 1 0">
          <joint class="shank" name="left_knee" ref="10"/>
          <inertial pos="0.01 0 -0.2" quat="0.9 0.1 0.2 0.3" mass="1.5" diaginertia="0.02 0.025 0.01"/>
          <geom type="cylinder" size="0.03 0.2" pos="0 0 -0.2"/>
          <body name="left_foot" pos="0 0 -0.4"><geom type="box" size="0.1 0.05 0.02" mass="0.4"/></body>
        </body>
      </body>
      <body name="right" pos="0 -0.2 -0.2" zaxis="0.1 0 1">
        <joint name="right_slide" type="slide" axis="0 0 1" range="-0.2 0.1"/>
        <inertial pos="0 0 -0.1" mass="2" fullinertia="0.03 0.02 0.015 0.001 -0.002 0.003"/>
        <geom type="sphere" size="0.05" pos="0 0 -0.3"/>
      </body>
    </body>
  </worldbody>
  <equality><joint joint1="right_slide" joint2="left_hip" polycoef="0.1 0.5 0 0 0"/></equality>
  <actuator>
    <motor name="hip" joint="left_hip" gear="10"/>
    <position name="knee" joint="left_knee" kp="30" forcelimited="true" forcerange="-20 20"/>
    <motor name="slide" joint="right_slide" ctrllimited="false"/>
  </actuator>
  <keyframe><key name="home" qpos="9 9 9 1 0 0 0  0 0 1 1 0 0 0  0.2 0.5 0.05"/></keyframe>
</mujoco>
)";

// A root that slides twice and turns, a head on two axes apart from each other, and one body more.
constexpr const char* many_axes = R"(<mujoco><compiler angle="radian"/><worldbody>
  <body name="hip" pos="0 0 1" euler="0.1 0.2 0.3">
    <joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide" axis="0 0 1"/>
    <joint name="pitch" axis="0 1 0" pos="0.1 0 0"/>
    <geom type="box" size="0.1 0.2 0.3"/>
    <body name="head" pos="0 0.1 0.5" euler="0 0.3 0">
      <joint name="pan" axis="0 0 1" pos="0.02 0 0"/>
      <joint name="tilt" axis="0.1 1 0" pos="0.02 0 0.1" ref="0.2" armature="0.01"/>
      <geom type="capsule" fromto="0 0 0 0.1 0.1 0.3" size="0.05"/>
      <body pos="0.1 0 0.2"><joint axis="1 0 0"/><geom type="box" size="0.1 0.05 0.02"/></body>
    </body>
  </body></worldbody>
  <actuator><motor joint="tilt" ctrllimited="true" ctrlrange="-3 3"/></actuator></mujoco>
)";

RobotModel model_of(const RobotDescription& robot) { return read_urdf_text(robot.urdf, "made.urdf"); }

std::string error_of(const test::TemporaryFolder& files, const std::string& text) {
  try {
    (void)read_mjcf(files.write("robot.xml", text));
  } catch (const InputError& error) {
    const InputProblem& first = error.problems().front();
    return std::to_string(first.line) + ": " + first.message;
  }
  return "accepted";
}

// A base on a slider, and what is put into it.
std::string with(const std::string& inside, const std::string& beside = "") {
  return "<mujoco>\n<worldbody><body name=\"base\">\n<joint name=\"way\" type=\"slide\" axis=\"1 0 0\"/>\n<geom "
         "size=\"0.1\"/>\n" +
         inside + "\n</body></worldbody>\n" + beside + "\n</mujoco>";
}

}  // namespace

TEST_CASE("An MJCF becomes a URDF with its links, joints, motors and shapes") {
  const test::TemporaryFolder files;
  std::vector<InputProblem> warnings;
  const RobotDescription robot = read_mjcf(files.write("walker.xml", walker), {}, &warnings);
  const RobotModel model = model_of(robot);
  CHECK(model.name == "walker");
  REQUIRE(model.joint_names() == std::vector<std::string>{"left_hip", "left_knee", "right_slide"});
  const Joint &hip = model.joints[0], &knee = model.joints[1], &slide = model.joints[2];
  CHECK(hip.axis[1] == doctest::Approx(std::sqrt(0.5)));
  CHECK(hip.lower_rad == doctest::Approx(-M_PI / 2));
  CHECK(hip.effort_max_Nm == 50);  // the larger side of ctrlrange times the gear
  CHECK(hip.rotor_inertia_kg_m2 == 0.01);
  CHECK(knee.effort_max_Nm == 20);
  CHECK(knee.rotor_inertia_kg_m2 == 0.02);  // of the inner class
  CHECK(knee.damping_Nms_per_rad == 0.1);   // of the outer one
  CHECK(knee.friction_Nm == 0.3);
  CHECK(knee.lower_rad == doctest::Approx(-10 * M_PI / 180));  // 0 is where `ref` says
  CHECK(knee.upper_rad == doctest::Approx(110 * M_PI / 180));
  CHECK(slide.type == JointType::prismatic);
  CHECK(slide.lower_rad == -0.2);  // a way is in metres, whatever angles are in
  REQUIRE(slide.mimic);
  CHECK(slide.mimic->joint == 0);
  CHECK(slide.mimic->multiplier == 0.5);
  CHECK(slide.mimic->offset == 0.1);
  CHECK(slide.effort_max_Nm == 0);  // it mimics: its leader moves it
  const Link& trunk = model.links[0];
  REQUIRE(trunk.visuals.size() == 1);
  CHECK(std::get<Sphere>(trunk.visuals[0].shape).radius_m == 0.2);
  CHECK(trunk.visuals[0].color[2] == doctest::Approx(0.3));
  REQUIRE(trunk.collisions.size() == 2);
  CHECK(std::get<Box>(trunk.collisions[0].shape).size_m == Vec3{0.2, 0.3, 0.4});
  CHECK(trunk.inertia.mass_kg == doctest::Approx(300 * 0.2 * 0.3 * 0.4 + 1000 * 4.0 / 3 * M_PI * 0.05 * 0.06 * 0.07));
  CHECK(model.links[1].collisions.size() == 3);  // a capsule is a cylinder and two balls
  CHECK(model.links[2].merged == std::vector<std::string>{"left_foot"});
  CHECK(model.links[2].visuals.size() == 2);  // what collides is drawn where nothing else is
  REQUIRE(robot.poses.size() == 1);
  CHECK(robot.poses[0].name == "home");
  const std::vector<std::pair<std::string, double>> home{
      {"left_hip", 0.2}, {"left_knee", 0.5 - 10 * M_PI / 180}, {"right_slide", 0.05}};
  REQUIRE(robot.poses[0].position.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(robot.poses[0].position[i].first == home[i].first);
    CHECK(robot.poses[0].position[i].second == doctest::Approx(home[i].second));
  }
  std::string told;
  for (const InputProblem& warning : warnings) told += warning.text() + "\n";
  for (const char* const part :
       {"'ball' is no part of the robot", "an ellipsoid", "100 Nm are assumed", "no limit of speed"})
    CHECK(told.find(part) != std::string::npos);
}

TEST_CASE("What is bolted down hangs on a link of the name world, and several arms are one robot") {
  const test::TemporaryFolder files;
  const std::string arms = R"(<mujoco><compiler angle="radian"/><worldbody>
    <body name="a" pos="0 1 0"><geom size="0.1"/><body name="b"><joint name="j1" range="-1 2"/><geom size="0.1" pos="1 0 0"/></body></body>
    <body name="c" pos="0 -1 0"><joint name="j2"/><geom size="0.1" pos="1 0 0"/></body>
    </worldbody></mujoco>)";
  const RobotModel model = model_of(read_mjcf(files.write("arms.xml", arms)));
  CHECK(model.links[0].name == "world");
  CHECK(model.links[0].merged == std::vector<std::string>{"a"});
  CHECK(model.joint_names() == std::vector<std::string>{"j1", "j2"});
  CHECK(model.joints[0].upper_rad == 2);
  CHECK(model.joints[1].type == JointType::continuous);
  CHECK(model.joints[1].origin.position_m == Vec3{0, -1, 0});
}

TEST_CASE("An MJCF without actuators has the motors that its joints' ranges of force say") {
  const test::TemporaryFolder files;
  const std::string body = R"(<mujoco><compiler angle="radian"/><worldbody>
    <body><joint name="j1" actuatorfrcrange="-3 4"/><geom size="0.1" pos="1 0 0"/>
    <body><joint name="j2"/><geom size="0.1" pos="1 0 0"/></body></body></worldbody>)";
  const RobotModel model = model_of(read_mjcf(files.write("bare.xml", body + "</mujoco>")));
  CHECK(model.joints[0].effort_max_Nm == 4);
  CHECK(model.joints[1].effort_max_Nm == 0);
  const std::string motor = "<actuator><motor joint=\"j2\" ctrlrange=\"-1 1\"/></actuator></mujoco>";
  CHECK(model_of(read_mjcf(files.write("driven.xml", body + motor))).joints[0].effort_max_Nm == 0);
}

TEST_CASE("A body with several joints hangs on links without mass, one a joint, in one warning") {
  const test::TemporaryFolder files;
  std::vector<InputProblem> warnings;
  const RobotDescription robot = read_mjcf(files.write("many.xml", many_axes), {}, &warnings);
  const RobotModel model = model_of(robot);
  CHECK(model.joint_names() == std::vector<std::string>{"x", "z", "pitch", "pan", "tilt", "body_6_joint"});
  const std::vector<std::string> names{"world", "hip_x", "hip_z", "hip", "head_pan", "head", "body_6"};
  for (std::size_t i = 0; i < names.size(); ++i) CHECK(model.links[i].name == names[i]);
  for (const std::size_t between : {1U, 2U, 4U}) CHECK(model.links[between].inertia.mass_kg == 0);
  CHECK(model.joints[4].effort_max_Nm == 3);
  const Vec3& apart = model.joints[4].origin.position_m;  // tilt is 0.1 above pan
  CHECK(apart[2] == doctest::Approx(0.1));
  std::string told;
  for (const InputProblem& warning : warnings) told += warning.text() + "\n";
  CHECK(told.find("body 'hip' moves on 3 joints of its own: it hangs on links without mass, one a joint, named "
                  "'hip_JOINT' (2 such: also in line") != std::string::npos);
  CHECK(told.find("and has no mass") == std::string::npos);
}

TEST_CASE("Slides along x, y and z and a ball let a root float as a free joint does") {
  const test::TemporaryFolder files;
  const std::string text =
      "<mujoco><worldbody><body name=\"base\"><joint type=\"slide\" axis=\"1 0 0\"/><joint type=\"slide\" axis=\"0 1 "
      "0\"/><joint type=\"slide\" axis=\"0 0 1\"/><joint type=\"ball\"/><geom size=\"1\"/><body><joint/><geom "
      "size=\"1\"/></body></body></worldbody><keyframe><key qpos=\"1 2 3 1 0 0 0 0.5\"/></keyframe></mujoco>";
  const RobotDescription robot = read_mjcf(files.write("free.xml", text));
  CHECK(model_of(robot).links[0].name == "base");
  CHECK(model_of(robot).joints.size() == 1);
  REQUIRE(robot.poses.size() == 1);
  CHECK(robot.poses[0].position[0].second == 0.5);
}

TEST_CASE("What a file includes is read in its place, and problems are told of the file that they stand in") {
  const test::TemporaryFolder files;
  files.write("parts.xml", "<mujocoinclude>\n<default>\n  <geom density=\"-x\"/>\n</default>\n</mujocoinclude>");
  const std::string file =
      files.write("robot.xml",
                  "<mujoco>\n  <include file=\"parts.xml\"/> <worldbody>\n<body><joint nme=\"a\"/>\n"
                  "<geom size=\"0.1\"/></body></worldbody></mujoco>");
  try {
    (void)read_mjcf(file);
    FAIL_CHECK("accepted");
  } catch (const InputError& error) {
    const std::string text = error.what();
    CHECK(text.find("parts.xml:3:18: 'density' of <geom> has a part '-x' that is not a number") != std::string::npos);
  }
  files.write("parts.xml", "<mujocoinclude><asset><mesh name=\"m\" file=\"none.stl\"/></asset></mujocoinclude>");
  CHECK(model_of(read_mjcf(file)).joints.size() == 1);
  files.write("parts.xml", "<mujoco>\n <include file=\"robot.xml\"/></mujoco>");
  CHECK(error_of(files, "<mujoco><include file=\"parts.xml\"/></mujoco>") ==
        "2: <include> of 'robot.xml', which includes this file");
  CHECK(error_of(files, "<mujoco>\n<include file=\"no.xml\"/></mujoco>") ==
        "2: <include> of 'no.xml', which is not there");
}

TEST_CASE("What would be another robot is refused, with its line and what to do") {
  const test::TemporaryFolder files;
  const std::vector<std::pair<std::string, std::string>> table{
      {"<robot/>", "1: the first element is <robot>, an MJCF's is <mujoco>"},
      {"<mujoco><worldbody><geom size=\"1\"/></worldbody></mujoco>", "1: this MJCF has no body with a joint"},
      {with("<joint name=\"b\" type=\"slide\" axis=\"1 0 0\"/>"),
       "3: link 'base_way' has no mass, and nothing resists when joints 'way' and 'b' move against each other: give "
       "one"},
      {with("<freejoint/>"), "3: body 'base' is free, and has another joint"},
      {with("<body><joint type=\"ball\"/><geom size=\"1\"/></body>"), "5: joint 'body_2_joint' is a ball"},
      {with("<body><joint type=\"hing\"/><geom size=\"1\"/></body>"),
       "5: joint 'body_2_joint' has the unknown type 'hing', did you mean 'hinge'?"},
      {with("<body><joint/></body>"), "5: link 'body_2' moves on joint 'body_2_joint' but has no mass"},
      {with("<body><joint axis=\"0 0 0\"/><geom size=\"1\"/></body>"), "5: the axis of joint 'body_2_joint' is zero"},
      {with("<body><joint range=\"1 0\"/><geom size=\"1\"/></body>"),
       "5: joint 'body_2_joint' has its lower limit 1 above"},
      {with("<body><freejoint/><geom size=\"1\"/></body>"), "5: body 'body_2' is free inside of another body"},
      {with("<geom type=\"box\" size=\"0.1 0.1\"/>"), "5: a geom of type box needs sizes above 0"},
      {with("<geom type=\"box\" size=\"0.1,0.1,0.1\"/>"),
       "5: 'size' of <geom> has a part '0.1,0.1,0.1' that is not a number"},
      {with("<geom class=\"big\" size=\"1\"/>"), "5: class 'big' is in no <default>"},
      {with("<geom mesh=\"foot\"/>"), "5: mesh 'foot' is in no <asset>"},
      {with("<replicate count=\"3\"/>"), "5: <replicate> makes bodies that are not written down"},
      {with("<inertial pos=\"0 0 0\" mass=\"1\" fullinertia=\"1 1 1\"/>"),
       "5: 'fullinertia' of <inertial> has 3 numbers, 6 were expected"},
      {with("<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 3\"/>"),
       "5: the inertia of link 'base' breaks the triangle inequality"},
      {with("", "<equality><connect body1=\"base\" body2=\"world\" anchor=\"0 0 0\"/></equality>"),
       "7: <connect> closes a loop"},
      {with("", "<actuator><motor joint=\"ways\"/></actuator>"),
       "7: <motor> is of joint 'ways', which does not exist, did you mean 'way'?"},
      {with("", "<compiler angle=\"grad\"/>"), "7: 'angle' is 'grad'"},
      {with("", "<compiler eulerseq=\"abc\"/>"), "7: 'eulerseq' is 'abc'"},
      {with("", "<compiler coordinate=\"global\"/>"), "7: global coordinates"},
      {with("<body><joint/><geom mesh=\"m\"/></body>", "<asset><mesh name=\"m\" file=\"m.stl\"/></asset>"),
       "5: link 'body_2' has no <inertial>, and its mesh would give it one"},
      {"<mujoco><worldbody><body><freejoint/><geom size=\"1\"/><body><joint/><geom "
       "size=\"1\"/></body></body>\n<body><freejoint/><body><joint/><geom "
       "size=\"1\"/></body></body></worldbody></mujoco>",
       "2: several robots stand in this MJCF"},
  };
  for (const auto& [given, message] : table) {
    const std::string& text = given;  // clang 14 hands on no names of a structured binding
    CAPTURE(text);
    const std::string said = error_of(files, text);
    CHECK_MESSAGE(said.starts_with(message), said);
  }
  CHECK(error_of(files, with("")) == "accepted");
  CHECK(is_mjcf("<mujoco/>"));
  CHECK(!is_mjcf("<robot/>"));
}

TEST_CASE("A damaged MJCF is read or refused, and what was made of it is a URDF that is read") {
  RandomStream random(7, "damage");
  int taken = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = walker;
    for (int change = 0; change < 3; ++change) {
      const auto at = static_cast<std::size_t>(random.uniform(0, static_cast<double>(text.size() - 8)));
      const auto from = static_cast<std::size_t>(random.uniform(0, static_cast<double>(text.size() - 8)));
      text.replace(at, static_cast<std::size_t>(random.uniform(0, 4)), text, from,
                   static_cast<std::size_t>(random.uniform(0, 4)));
    }
    try {
      taken += model_of(read_mjcf_text(text, "damaged.xml")).joints.empty() ? 0 : 1;
    } catch (const InputError& error) {
      CHECK(error.problems().front().file == "damaged.xml");
    }
  }
  CHECK(taken > 20);
  CHECK(taken < 1500);
}

#ifdef KADANS_MUJOCO
TEST_CASE(
    "Masses, forces, accelerations and Jacobians of an MJCF are those that libmujoco computes, in 400 states of "
    "motion") {
  const test::TemporaryFolder files;
  std::string named = many_axes;
  named.replace(named.find("<joint axis=\"1 0 0\"/>"), 6, "<joint name=\"body_6_joint\"");
  for (const std::string& text : {std::string(walker), named}) {
    const test::JudgedRobot judged = test::judge(files.write("judged.xml", text), 400);
    REQUIRE_MESSAGE(judged.judged, judged.why);
    CHECK(judged.mass < 1e-9);
    CHECK(judged.mass_matrix < 1e-9);
    CHECK(judged.bias < 1e-9);
    CHECK(judged.acceleration < 1e-9);
    CHECK(judged.jacobian < 1e-9);
  }
  // Files of somebody else: KADANS_MJCF names a list of them, a line each.
  const char* const list = std::getenv("KADANS_MJCF");
  std::ifstream others(list == nullptr ? "" : list);
  for (std::string file; std::getline(others, file);) {
    CAPTURE(file);
    try {
      const test::JudgedRobot robot = test::judge(file, 400);
      if (!robot.judged) {
        MESSAGE(file, " is not judged: ", robot.why);
        continue;
      }
      MESSAGE(file, " differs by ", robot.mass, ", ", robot.mass_matrix, ", ", robot.bias, ", ", robot.acceleration,
              ", ", robot.jacobian);
      CHECK(robot.mass < 1e-9);
      CHECK(robot.mass_matrix < 1e-9);
      CHECK(robot.bias < 1e-6);
      CHECK(robot.acceleration < 1e-6);
      CHECK(robot.jacobian < 1e-9);
    } catch (const InputError& error) {
      MESSAGE(error.what());
    }
  }
}
#endif

}  // namespace kadans
