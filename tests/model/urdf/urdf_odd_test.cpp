// What URDFs of the world have beside URDF: each row an oddity, and the warning that says what was made of it.
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "broken_urdf.h"
#include "kadans/model/urdf.h"
#include "kadans/signal/input_error.h"

using namespace kadans;

namespace {

const std::string opening = R"(<robot name="duo">)", end = "</robot>",
                  elbow = R"(<joint name="elbow" type="revolute">)";
const std::string limit = R"(<limit lower="0" upper="2" effort="5" velocity="3"/>)";

// A link that is fixed to the base.
std::string fixed(const std::string& link, const std::string& in_joint = "") {
  return "<link name=\"tip\">" + link + "</link><joint name=\"tip\" type=\"fixed\"><parent link=\"base\"/>" +
         "<child link=\"tip\"/>" + in_joint + "</joint></robot>";
}

std::string inertia(const std::string& izz) {
  return R"(<inertia ixx="0.02" iyy="0.02" izz=")" + izz + R"(" ixy="0" ixz="0" iyz="0"/>)";
}

// The text of a link, and that between it and the axis of its joint.
const std::string bare_upper_arm = "<link name=\"upper_arm\"/>\n";
std::string from_to(const std::string& from, const std::string& to) {
  const std::size_t at = duo_urdf.find(from);
  return duo_urdf.substr(at, duo_urdf.find(to, at) - at);
}
std::string upper_arm() { return from_to("<link name=\"upper_arm\">", "  <link name=\"fore_arm\">"); }
std::string between() { return from_to("  <link name=\"fore_arm\">", "0 1 0"); }

std::string transmission(const std::string& type, const std::string& joint, const std::string& reduction = "") {
  return "<transmission name=\"t\"><type>" + type + "</type><joint name=\"" + joint + "\"/><actuator name=\"m\">" +
         reduction + "</actuator></transmission></robot>";
}

}  // namespace

TEST_CASE("What is not URDF is told once, and the robot is read without it") {
  const std::vector<BrokenUrdf> table{
      {"xacro's name space", opening, R"(<robot name="duo" xmlns:xacro="http://www.ros.org/wiki/xacro">)",
       "warning: duo.urdf:1:19: attribute 'xmlns:xacro' of <robot> is not known to URDF, and not used"},
      {"gazebo", end, R"(<gazebo reference="base"/></robot>)",
       "warning: duo.urdf:27:1: <gazebo> in <robot> is not known to URDF, and not used"},
      {"contact in a link", R"(<link name="fore_arm">)", R"(<link name="fore_arm"><contact/>)",
       "warning: duo.urdf:14:25: <contact> in <link> is not known to URDF, and not used"},
      {"self_collide in a collision", "<collision>", R"(<collision><max_contacts/>)",
       "warning: duo.urdf:9:16: <max_contacts> in <collision> is not known to URDF, and not used"},
      {"dont_collapse", elbow, R"(<joint name="elbow" type="revolute" dont_collapse="true">)",
       "warning: duo.urdf:23:39: attribute 'dont_collapse' of <joint> is not known to URDF, and not used"},
      {"type of a link", R"(<link name="fore_arm">)", R"(<link name="fore_arm" type="virtual">)",
       "warning: duo.urdf:14:25: attribute 'type' of <link> is not known to URDF, and not used"},
      {"K and D", limit, limit + R"(<dynamics D="1" K="7000"/>)",
       R"(warning: duo.urdf:25:67: attribute 'D' of <dynamics> is not known to URDF, and not used
warning: duo.urdf:25:73: attribute 'K' of <dynamics> is not known to URDF, and not used)"},
      {"Drake's elements", R"(<sphere radius="0.1"/>)", R"(<sphere radius="0.1"/><drake:hydro/>)",
       "warning: duo.urdf:8:45: <drake:hydro> in <geometry> is not known to URDF, and not used"},
      {"name beside the right one", R"(<mass value="2.5"/>)", R"(<mass value="2.5" vale="3"/>)",
       "warning: duo.urdf:5:25: attribute 'vale' of <mass> is not known to URDF, and not used"},
      {"calibration", limit, limit + R"(<calibration rising="0"/>)",
       "warning: duo.urdf:25:57: <calibration> is not used"},
      {"gains of a safety controller", limit, limit + R"(<safety_controller k_velocity="10"/>)",
       "warning: duo.urdf:25:57: 'k_position' and 'k_velocity' of <safety_controller> are not used: the safety layer "
       "slows a joint down before its limit"},
      {"a limit, an axis and a mimic of a fixed joint", end,
       fixed("", R"(<axis xyz="0 0 0"/><limit effort="-1"/><mimic joint="elbow"/>)"),
       "warning: duo.urdf:27:135: joint 'tip' is fixed: its <mimic> is not used"},
      {"a mimic of a fixed joint", limit,
       limit + R"(<mimic joint="tip" offset="0.1"/></joint>)" + fixed("").substr(0, fixed("").find("</joint>")),
       "warning: duo.urdf:25:57: joint 'elbow' mimics the fixed joint 'tip', and is fixed"},
      {"a floating joint below a bare root", end,
       R"(<link name="world"/><joint name="free" type="floating"><parent link="world"/><child link="base"/></joint></robot>)",
       "warning: duo.urdf:27:21: joint 'free' is floating, as every robot is here: it and link 'world' are left out"},
      {"no name of a robot", opening, "<robot>",
       "warning: duo.urdf:1:1: this <robot> has no name that can be used, and gets its file's"},
      {"another version", opening, R"(<robot name="duo" version="1.1">)",
       "warning: duo.urdf:1:28: URDF version '1.1' is read as '1.0'"},
  };
  for (const BrokenUrdf& broken : table) check_told(broken);
}

TEST_CASE("Masses and inertias that rounding or welding makes good are told") {
  const std::vector<BrokenUrdf> table{
      {"mass 0 on a fixed joint", end, fixed(R"(<inertial><mass value="0"/></inertial>)"),
       "warning: duo.urdf:27:18: link 'tip' has an <inertial> without mass, and counts as one without it"},
      {"a point on a fixed joint", end, fixed(R"(<inertial><mass value="0.1"/></inertial>)"),
       "warning: duo.urdf:27:18: link 'tip' has a mass but no <inertia>: it is a point"},
      {"an impossible part of a possible body", end,
       fixed(R"(<inertial><mass value="0.1"/><inertia ixx="1e-5" iyy="1e-5" izz="1e-4"/></inertial>)"),
       R"(warning: duo.urdf:27:47: <inertia> has not all of ixy, ixz and iyz: what is missing is taken as 0
warning: duo.urdf:27:47: the inertia of link 'tip' breaks the triangle inequality: of its principal moments 1e-05, 1e-05, 0.0001 kg m2 no one may exceed the sum of the other two, here 2e-05; with what is fixed to it, it makes a possible body)"},
      {"the triangle inequality missed by rounding", inertia("0.02"), inertia("0.041"),
       "warning: duo.urdf:6:7: the inertia of link 'base' breaks the triangle inequality: of its principal moments "
       "0.02, 0.02, 0.041 kg m2 no one may exceed the sum of the other two, here 0.04; by so little that it is "
       "rounding"},
      {"the triangle inequality missed by more", inertia("0.02"), inertia("0.043"),
       "duo.urdf:6:7: the inertia of link 'base' breaks the triangle inequality: of its principal moments 0.02, 0.02, "
       "0.043 kg m2 no one may exceed the sum of the other two, here 0.04; compute it anew from the shape, about the "
       "centre of mass, in kg m2"},
      {"a link without mass that carries one with mass", upper_arm(), bare_upper_arm,
       "warning: duo.urdf:11:3: link 'upper_arm' moves on joint 'shoulder' and has no mass: what hangs on it gives it "
       "all "
       "its inertia"},
      {"two axes in a line with no mass between", upper_arm() + between() + "0 1 0",
       bare_upper_arm + between() + "1 0 0",
       R"(duo.urdf:11:3: link 'upper_arm' has no mass, and nothing resists when joints 'shoulder' and 'elbow' move against each other: give one of them a rotor inertia (<dynamics armature=...>, in MJCF armature), or the link an <inertial>)"},
      {"two axes in a line, one with a rotor", upper_arm() + between() + "0 1 0\"/>",
       bare_upper_arm + between() + "1 0 0\"/><dynamics armature=\"0.1\"/>",
       "warning: duo.urdf:11:3: link 'upper_arm' moves on joint 'shoulder' and has no mass: what hangs on it gives it "
       "all "
       "its inertia"},
      {"an inertial without a mass", end, fixed("<inertial/>"),
       "warning: duo.urdf:27:18: link 'tip' has an <inertial> without mass, and counts as one without it"},
  };
  for (const BrokenUrdf& broken : table) check_told(broken);
}

TEST_CASE("Limits that are none are told and taken as none") {
  const std::vector<BrokenUrdf> table{
      {"1e9 everywhere", limit, R"(<limit lower="-1e9" upper="1e9" effort="1e9" velocity="1e9"/>)",
       R"(warning: duo.urdf:25:5: joint 'elbow' has a limit of 1e6 or more: it is taken as no end stop
warning: duo.urdf:25:45: joint 'elbow' has an 'effort' of 1e6 or more, which no motor has: torque_max_Nm in the robot's plant.drives gives the true one
warning: duo.urdf:25:60: joint 'elbow' has a 'velocity' of 1e6 or more: its speed has no limit)"},
      {"1e16", limit, R"(<limit lower="-1e+16" upper="1e+16" effort="5" velocity="3"/>)",
       "warning: duo.urdf:25:5: joint 'elbow' has a limit of 1e6 or more: it is taken as no end stop"},
      {"inf", limit, R"(<limit lower="-inf" upper="inf" effort="5" velocity="inf"/>)",
       R"(warning: duo.urdf:25:5: joint 'elbow' has a limit of 1e6 or more: it is taken as no end stop
warning: duo.urdf:25:58: joint 'elbow' has a 'velocity' of 1e6 or more: its speed has no limit)"},
      {"-1", limit, R"(<limit lower="0" upper="2" effort="-1" velocity="-1"/>)",
       R"(warning: duo.urdf:25:40: joint 'elbow' has a negative 'effort': it has no motor
warning: duo.urdf:25:54: joint 'elbow' has a 'velocity' that is not above 0: its speed has no limit)"},
      {"no speed", limit, R"(<limit lower="0" upper="2" effort="5" velocity="0"/>)",
       "warning: duo.urdf:25:53: joint 'elbow' has a 'velocity' that is not above 0: its speed has no limit"},
      {"no way", limit, R"(<limit lower="0" upper="0" effort="5" velocity="3"/>)",
       "warning: duo.urdf:25:5: joint 'elbow' cannot move: its lower and its upper limit are 0"},
      {"soft limits that leave no room", limit,
       limit + R"(<safety_controller soft_lower_limit="3" soft_upper_limit="4"/>)",
       "duo.urdf:23:3: joint 'elbow' has soft limits that leave it no room"},
  };
  for (const BrokenUrdf& broken : table) check_told(broken);
}

TEST_CASE("Transmissions that are not understood are told and not used") {
  const std::vector<BrokenUrdf> table{
      {"a type of its own", end, transmission("robot/WristPushrodTransmission", "elbow"),
       "warning: duo.urdf:27:1: transmission 't' has the type 'robot/WristPushrodTransmission', which is not known; it "
       "is not used"},
      {"a joint that does not exist", end, transmission("a/SimpleTransmission", "elbo"),
       "warning: duo.urdf:27:1: transmission 't' is of joint 'elbo', which does not exist, did you mean 'elbow'?; it "
       "is not used"},
      {"a differential of one joint", end, transmission("a/DifferentialTransmission", "elbow"),
       "warning: duo.urdf:27:1: transmission 't' has 1 joints and 1 actuators: this type takes 2; it is not used"},
      {"a reduction that is none", end,
       transmission("a/SimpleTransmission", "elbow", "<mechanicalReduction>much</mechanicalReduction>"),
       "warning: duo.urdf:27:97: <mechanicalReduction> 'much' is not a number; 1 is taken"},
      {"a reduction of 0", end,
       transmission("a/SimpleTransmission", "elbow", "<mechanicalReduction>0</mechanicalReduction>"),
       "warning: duo.urdf:27:1: transmission 't' cannot be: actuator_reduction must be 1e-6..1e6 or -1e6..-1e-6: with "
       "0 a drive would move no joint; it is not used"},
  };
  for (const BrokenUrdf& broken : table) check_told(broken);
}
