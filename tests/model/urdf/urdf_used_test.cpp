// What URDFs say of drives and limits beyond joints, and where their meshes are: used as they mean it.
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <stdlib.h>

#include "broken_urdf.h"
#include "kadans/model/urdf.h"
#include "kadans/signal/input_error.h"
#include "temporary_folder.h"

using namespace kadans;

namespace {

namespace fs = std::filesystem;
const std::string elbow_limit = R"(<limit lower="0" upper="2" effort="5" velocity="3"/>)";

RobotModel read(const std::string& text, std::vector<InputProblem>* warnings = nullptr) {
  return read_urdf_text(text, "duo.urdf", {}, warnings);
}

}  // namespace

TEST_CASE("A simple transmission brings its gear, and its motor's inertia behind the gear") {
  const std::string with_rotor =
      "<transmission name=\"t\"><type>transmission_interface/SimpleTransmission</type>"
      "<joint name=\"elbow\"/><actuator name=\"m\"><mechanicalReduction>-50"
      "</mechanicalReduction><motorInertia>2e-6</motorInertia></actuator></transmission>";
  const RobotModel model = read(duo_with("</robot>", with_rotor + "</robot>"));
  REQUIRE(model.transmissions.size() == 1);
  CHECK(model.transmissions[0].joints() == std::vector<std::size_t>{1});
  CHECK(model.transmissions[0].drive_per_joint(0, 0) == -50);
  CHECK(model.joints[1].rotor_inertia_kg_m2 == doctest::Approx(2e-6 * 2500));
  CHECK(model.drive_names() == model.joint_names());

  const RobotModel drake =
      read(duo_with("</robot>",
                    "<transmission name=\"t\"><joint name=\"elbow\"/><actuator name=\"m\"><drake:gear_ratio "
                    "value=\"100\"/><drake:rotor_inertia value=\"1e-6\"/></actuator></transmission></robot>"));
  CHECK(drake.transmissions.empty());
  CHECK(drake.joints[1].rotor_inertia_kg_m2 == doctest::Approx(1e-2));
  const RobotModel mujoco = read(duo_with(elbow_limit, elbow_limit + "<dynamics armature=\"0.03\"/>"));
  CHECK(mujoco.joints[1].rotor_inertia_kg_m2 == 0.03);
}

TEST_CASE("Forms of PR2 and of ros2_control say the same") {
  const std::string pr2 =
      "<transmission type=\"pr2_mechanism_model/SimpleTransmission\" name=\"t\"><actuator name=\"m\"/>"
      "<joint name=\"elbow\"/><mechanicalReduction>79.2</mechanicalReduction></transmission></robot>";
  CHECK(read(duo_with("</robot>", pr2)).transmissions.at(0).drive_per_joint(0, 0) == 79.2);
  const std::string ros2 =
      "<ros2_control name=\"c\" type=\"system\"><transmission name=\"t\"><plugin>"
      "transmission_interface/SimpleTransmission</plugin><actuator name=\"m\" role=\"actuator1\"/>"
      "<joint name=\"elbow\" role=\"joint1\"><mechanical_reduction>12</mechanical_reduction><offset>"
      "0.5</offset></joint></transmission></ros2_control></robot>";
  const RobotModel model = read(duo_with("</robot>", ros2));
  CHECK(model.transmissions.at(0).drive_position_rad({1.5, 0})[0] == 12);
}

TEST_CASE("A differential couples its joints in the order of their roles") {
  const std::string text =
      "<transmission name=\"t\"><type>transmission_interface/DifferentialTransmission</type>"
      "<actuator name=\"b\"><role>actuator2</role></actuator><actuator name=\"a\"><role>actuator1"
      "</role></actuator><joint name=\"elbow\"><role>joint2</role></joint><joint name=\"shoulder\">"
      "<role>joint1</role></joint></transmission></robot>";
  const RobotModel model = read(duo_with("</robot>", text));
  REQUIRE(model.transmissions.size() == 1);
  CHECK(model.transmissions[0].joints() == std::vector<std::size_t>{0, 1});
  CHECK(model.drive_names() == std::vector<std::string>{"a", "b"});
  CHECK(model.transmissions[0].drive_per_joint(1, 1) == -1);
}

TEST_CASE("Soft limits stand beside the end stops") {
  const Joint soft = read(duo_with(elbow_limit, elbow_limit + "<safety_controller soft_lower_limit=\"0.1\" "
                                                              "soft_upper_limit=\"1.9\" k_velocity=\"5\"/>"))
                         .joints[1];
  CHECK(soft.lower_rad == 0);
  CHECK(soft.soft_lower_rad == 0.1);
  CHECK(soft.soft_upper_rad == 1.9);
  CHECK(read(duo_urdf).joints[1].soft_upper_rad == std::numeric_limits<double>::infinity());
}

TEST_CASE("A capsule collides as a cylinder with a ball at each end") {
  const RobotModel model = read(duo_with(R"(<box size="0.1 0.2 0.3"/>)", R"(<capsule radius="0.1" length="0.4"/>)"));
  REQUIRE(model.links[0].collisions.size() == 3);
  CHECK(std::get<Cylinder>(model.links[0].collisions[0].shape).length_m == 0.4);
  CHECK(std::get<Sphere>(model.links[0].collisions[1].shape).radius_m == 0.1);
  CHECK(model.links[0].collisions[1].pose.position_m == Vec3{0, 0, -0.2});
  CHECK(model.links[0].collisions[2].pose.position_m == Vec3{0, 0, 0.2});
}

TEST_CASE("Who mimics a fixed joint stays where the offset has it") {
  const std::string tip = R"(<link name="tip"/><joint name="tip" type="fixed"><parent link="base"/><child link="tip"/>)"
                          R"(</joint></robot>)";
  std::string text = duo_with("</robot>", tip);
  text.replace(text.find(elbow_limit), elbow_limit.size(), elbow_limit + R"(<mimic joint="tip" offset="0.5"/>)");
  const RobotModel model = read(text);
  REQUIRE(model.joints.size() == 1);
  CHECK(model.links[1].merged == std::vector<std::string>{"fore_arm"});
}

TEST_CASE("Oddities of one kind are one line, with their number and the first places") {
  std::string gazebos;
  for (int i = 0; i < 40; ++i) gazebos += "<gazebo/>\n";
  CHECK(
      read_told(duo_with("</robot>", gazebos + "</robot>")) ==
      "warning: duo.urdf:27:1: <gazebo> in <robot> is not known to URDF, and not used (40 such: also in lines 28, 29, "
      "30 ...)");
  std::string shells =
      duo_with("<collision>", R"(<visual><geometry><mesh filename="b.stl"/></geometry></visual><collision>)");
  shells.replace(shells.find(R"(<sphere radius="0.1"/>)"), 22, R"(<mesh filename="a.stl"/>)");
  CHECK(read_told(shells) ==
        "warning: duo.urdf:8:39: mesh file 'a.stl' is not there: link 'base' is drawn with a marker in its place; its "
        "path "
        "starts from this file's folder (2 such: also in line 9)");
}

TEST_CASE("When warnings are mistakes, they are told with them by place") {
  std::string text = duo_with("</robot>", "<gazebo/></robot>");
  std::string error;
  try {
    (void)read_urdf_text(text, "duo.urdf", {.strict = true});
  } catch (const InputError& told) {
    error = told.what();
  }
  CHECK(error == "duo.urdf:27:1: <gazebo> in <robot> is not known to URDF, and not used");
  CHECK_NOTHROW((void)read_urdf_text(duo_urdf, "duo.urdf", {.strict = true}));
}

TEST_CASE("A package is where it is said to be, where ROS says, or where a package.xml up the folders says") {
  const test::TemporaryFolder place;
  const std::string mesh = place.write("elsewhere/shell/meshes/a.stl", "solid");
  const std::string urdf = place.write("robot/urdf/a.urdf", "");
  const std::string name = "package://shell/meshes/a.stl";
  CHECK_FALSE(find_urdf_file(name, urdf));
  CHECK(find_urdf_file(name, urdf, {{"shell", place.path().string() + "/elsewhere/shell"}}) == mesh);
  CHECK_FALSE(find_urdf_file(name, urdf, {{"shell", place.path().string()}}));
  setenv("ROS_PACKAGE_PATH", ("/nowhere:" + place.path().string() + "/elsewhere").c_str(), 1);
  CHECK(find_urdf_file(name, urdf) == mesh);
  setenv("ROS_PACKAGE_PATH", place.path().string().c_str(), 1);  // a folder above it
  CHECK(find_urdf_file(name, urdf) == mesh);
  unsetenv("ROS_PACKAGE_PATH");
  CHECK_FALSE(find_urdf_file(name, urdf));

  const std::string own = place.write("robot/meshes/a.stl", "solid");
  place.write("robot/package.xml", "<package>\n  <name> shell </name>\n</package>");
  CHECK(find_urdf_file(name, urdf) == own);
  CHECK(find_urdf_file("model://shell/meshes/a.stl", urdf) == own);
  CHECK(find_urdf_file("package:///shell/meshes/a.stl", urdf) == own);
  CHECK_FALSE(find_urdf_file("package://other/meshes/a.stl", urdf));
  const std::string cloned = place.write("clone/meshes/b.stl", "solid");  // under a name that is not the package's
  CHECK(find_urdf_file("package://other/meshes/b.stl", place.write("clone/urdf/b.urdf", "")) == cloned);
  // Exporters that were told no package write none.
  const std::string beside = place.write("bare/c.stl", "solid"), below = place.write("bare/meshes/d.stl", "solid");
  const std::string bare = place.write("bare/b.urdf", "");
  CHECK(find_urdf_file("package:///c.stl", bare) == beside);
  CHECK(find_urdf_file("package://c.stl", bare) == beside);
  CHECK(find_urdf_file("package:///meshes/d.stl", bare) == below);
}

TEST_CASE("A file that a package has not is not told as a package that is not there, and its name is told to its end") {
  const test::TemporaryFolder place;
  place.write("robot/package.xml", "<package><name>shell</name></package>");
  const auto told = [&](const std::string& mesh) {
    std::string text = duo_urdf;
    const std::string sphere = R"(<sphere radius="0.1"/>)";
    text.replace(text.find(sphere), sphere.size(), "<mesh filename=\"" + mesh + "\"/>");
    std::vector<InputProblem> warnings;
    (void)read_urdf_text(text, place.path().string() + "/robot/urdf/duo.urdf", {}, &warnings);
    REQUIRE(warnings.size() == 1);
    return warnings[0].message;
  };
  const std::string there = told("package://shell/meshes/of/the/robot/that/we/built/in/2008/left_foot_plate.stl");
  CHECK_MESSAGE(there.find("that/we/built/in/2008/left_foot_plate.stl' is not there") != std::string::npos, there);
  CHECK_MESSAGE(there.find("; package 'shell' is at '") != std::string::npos, there);
  CHECK_MESSAGE(there.find("and has no such file") != std::string::npos, there);
  CHECK(told("package:///left.stl").find("; it names no package, so its path starts from this file's folder") !=
        std::string::npos);
}

TEST_CASE(
    "An SRDF says which links need not collide, tells links that are not there, and is refused with the place of a "
    "mistake") {
  const test::TemporaryFolder folder;
  const RobotModel model = read(duo_with("", ""));
  const auto read_pairs = [&](const std::string& body, std::vector<InputProblem>* warnings = nullptr) {
    return read_srdf(folder.write("duo.srdf", "<robot name=\"duo\">\n" + body + "\n</robot>\n"), model, warnings);
  };
  std::vector<InputProblem> warnings;
  const auto pairs = read_pairs(
      "<group name=\"arm\"><chain base_link=\"base\" tip_link=\"fore_arm\"/></group>\n"
      "<disable_collisions link1=\"base\" link2=\"fore_arm\" reason=\"Never\"/>\n"
      "<disable_collisions link1=\"base\" link2=\"camera\" reason=\"Adjacent\"/>",
      &warnings);
  CHECK(pairs == std::vector<LinkPair>{{"base", "fore_arm"}});
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].line == 4);
  CHECK(warnings[0].message == "the robot has no link 'camera': this pair is not used");
  CHECK_THROWS_WITH_AS((void)read_pairs("<disable_collisions link1=\"base\"/>"),
                       doctest::Contains("duo.srdf:2:1: <disable_collisions> has no attribute 'link2'"), InputError);
  CHECK_THROWS_WITH_AS((void)read_srdf(folder.write("list.srdf", "<links/>"), model),
                       doctest::Contains("list.srdf:1:1: the root element is <links>, an SRDF's is <robot>"),
                       InputError);
}
