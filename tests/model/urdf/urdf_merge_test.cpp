// Fixed joints disappear: masses, shapes and names move into the link that they are fixed to.
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "broken_urdf.h"
#include "kadans/model/kinematics.h"
#include "kadans/model/urdf.h"

namespace urdf_merge_test {

using namespace kadans;

namespace {

RobotModel read(const std::string& text) { return read_urdf_text(text, "test.urdf"); }

std::string body(const std::string& name, const std::string& more = "") {
  return "<link name=\"" + name +
         "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" "
         "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>" +
         more + "</link>\n";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + more + "</joint>\n";
}

const std::string limit = "<limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"3\"/>";

}  // namespace

TEST_CASE("The small URDF of the refusal tests is sound") {
  CHECK(read_error(duo_urdf) == "no error");
  const RobotModel model = read(duo_urdf);
  CHECK(model.name == "duo");
  CHECK(model.file == "test.urdf");
  REQUIRE(model.joints.size() == 2);
  const Joint& shoulder = model.joints[0];
  CHECK(shoulder.origin.position_m == Vec3{0, 0, 0.2});
  CHECK(shoulder.axis == Vec3{0, 1, 0});
  CHECK(shoulder.lower_rad == -1);
  CHECK(shoulder.upper_rad == 1.5);
  CHECK(shoulder.effort_max_Nm == 5);
  CHECK(shoulder.velocity_max_rad_s == 3);
  CHECK(model.joints[1].axis == Vec3{1, 0, 0});  // URDF's default
  CHECK(std::abs(model.links[0].visuals.at(0).color[1] - 0.5) < 1e-6);
  CHECK(std::get<Box>(model.links[0].collisions.at(0).shape).size_m == Vec3{0.1, 0.2, 0.3});
}

TEST_CASE("A link fixed with a turn and an offset brings its mass, tensor and shapes into the parent's frame") {
  const RobotModel model = read(
      "<robot name=\"r\">" + body("base") +
      "<link name=\"tank\"><inertial><origin xyz=\"0.1 0 0\" rpy=\"0 0 0\"/><mass value=\"3\"/><inertia ixx=\"0.1\" "
      "iyy=\"0.2\" izz=\"0.25\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"
      "<collision name=\"shell\"><origin xyz=\"0 0 1\"/><geometry><cylinder radius=\"0.1\" length=\"0.5\"/></geometry>"
      "</collision></link>" +
      joint("weld", "fixed", "base", "tank", "<origin xyz=\"0 2 0\" rpy=\"0 0 1.5707963267948966\"/>") + "</robot>");
  REQUIRE(model.links.size() == 1);
  CHECK(model.joints.empty());
  const Link& base = model.links[0];
  CHECK(base.merged == std::vector<std::string>{"tank"});
  CHECK(*model.find_link("tank") == 0);
  // The tank's centre of mass: 0.1 along its x, which is the base's y, behind the offset of 2: (0, 2.1, 0).
  CHECK(base.inertia.mass_kg == 4);
  CHECK(base.inertia.com_m[0] == doctest::Approx(0));
  CHECK(base.inertia.com_m[1] == doctest::Approx(3 * 2.1 / 4));
  const double steiner = 1.0 * 3.0 / 4.0 * 2.1 * 2.1;              // reduced mass times distance squared
  CHECK(base.inertia.xx == doctest::Approx(0.1 + 0.2 + steiner));  // the tank's y turned into the base's x
  CHECK(base.inertia.yy == doctest::Approx(0.1 + 0.1));
  CHECK(base.inertia.zz == doctest::Approx(0.1 + 0.25 + steiner));
  REQUIRE(base.collisions.size() == 1);
  CHECK(base.collisions[0].name == "shell");
  CHECK(base.collisions[0].link == "tank");
  CHECK(base.collisions[0].pose.position_m[1] == doctest::Approx(2));
  CHECK(base.collisions[0].pose.position_m[2] == doctest::Approx(1));
  CHECK(rotate(base.collisions[0].pose.orientation, {1, 0, 0})[1] == doctest::Approx(1));
}

TEST_CASE("A moving joint below a fixed one starts from the merged link") {
  const RobotModel model =
      read("<robot name=\"r\">" + body("base") + "<link name=\"mount\"/>" + body("arm") +
           joint("weld", "fixed", "base", "mount", "<origin xyz=\"1 0 0\" rpy=\"0 0 1.5707963267948966\"/>") +
           joint("turn", "revolute", "mount", "arm", "<origin xyz=\"1 0 0\"/>" + limit) + "</robot>");
  REQUIRE(model.joints.size() == 1);
  CHECK(model.joints[0].parent == 0);
  CHECK(model.joints[0].origin.position_m[0] == doctest::Approx(1));
  CHECK(model.joints[0].origin.position_m[1] == doctest::Approx(1));
  CHECK(model.link_names() == std::vector<std::string>{"base", "mount", "arm"});
}

TEST_CASE("A root without mass, fixed to the first body, keeps its name and frame") {
  const RobotModel model = read("<robot name=\"r\"><link name=\"base_link\"/>" + body("torso") +
                                joint("root", "fixed", "base_link", "torso", "<origin xyz=\"0 0 0.5\"/>") + "</robot>");
  REQUIRE(model.links.size() == 1);
  CHECK(model.links[0].name == "base_link");
  CHECK(model.links[0].inertia.mass_kg == 1);
  CHECK(model.links[0].inertia.com_m == Vec3{0, 0, 0.5});
}

TEST_CASE("A moving link without mass is sound when a link fixed to it has some") {
  const RobotModel model = read("<robot name=\"r\">" + body("base") + "<link name=\"flange\"/>" + body("tool") +
                                joint("turn", "revolute", "base", "flange", limit) +
                                joint("weld", "fixed", "flange", "tool", "<origin xyz=\"0 0 0.3\"/>") + "</robot>");
  REQUIRE(model.links.size() == 2);
  CHECK(model.links[1].name == "flange");
  CHECK(model.links[1].inertia.com_m == Vec3{0, 0, 0.3});
}

TEST_CASE("Joints keep the order of the document, but none comes before the joint it hangs on") {
  const RobotModel model =
      read("<robot name=\"r\">" + body("d") + body("c") + body("b") + body("a") +
           joint("last", "revolute", "c", "d", limit) + joint("first", "revolute", "a", "b", limit) +
           joint("middle", "revolute", "a", "c", limit) + "</robot>");
  CHECK(model.joint_names() == std::vector<std::string>{"first", "middle", "last"});
  CHECK(model.link_names() == std::vector<std::string>{"a", "b", "c", "d"});
  CHECK(model.joints[0].parent == 0);
  CHECK(model.joints[1].parent == 0);
  CHECK(model.joints[2].parent == 2);
}

TEST_CASE("A chain of mimics is tied to the joint that leads them all") {
  const RobotModel model =
      read("<robot name=\"r\">" + body("a") + body("b") + body("c") + body("d") +
           joint("third", "revolute", "c", "d", limit + "<mimic joint=\"second\" multiplier=\"-2\" offset=\"0.5\"/>") +
           joint("first", "revolute", "a", "b", limit) +
           joint("second", "revolute", "b", "c", limit + "<mimic joint=\"first\" multiplier=\"3\" offset=\"0.1\"/>") +
           "</robot>");
  const Joint& third = model.joints[*model.find_joint("third")];
  REQUIRE(third.mimic);
  CHECK(third.mimic->joint == *model.find_joint("first"));
  CHECK(third.mimic->multiplier == doctest::Approx(-6));
  CHECK(third.mimic->offset == doctest::Approx(-2 * 0.1 + 0.5));
  CHECK_FALSE(model.joints[*model.find_joint("first")].mimic);
}

TEST_CASE("An axis within 0.001 of length 1 is made exactly 1") {
  const RobotModel model = read(duo_with("\"0 1 0\"", "\"0 0.6004 0.8\""));
  const Vec3& axis = model.joints[0].axis;
  CHECK(std::abs(length(axis) - 1) < 1e-15);
}

TEST_CASE("Elements of others, comments and odd spacing change nothing") {
  std::string text =
      duo_with("</robot>",
               "<gazebo reference=\"base\"><mu1>0.2</mu1></gazebo>\n<transmission name=\"t\"><type>x</type>"
               "</transmission>\n<!-- <link> --><drake:collision_filter_group name=\"g\"/></robot>");
  text.replace(text.find("0 0 0.2"), 7, " 0\n\t0  +0.2 ");
  const RobotModel odd = read(text), plain = read(duo_urdf);
  CHECK(odd.joints[0].origin.position_m == plain.joints[0].origin.position_m);
  CHECK(odd.link_names() == plain.link_names());
}

}  // namespace urdf_merge_test
