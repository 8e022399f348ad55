// Joints: types, limits, axes, origins, mimics: each row a mistake, and the exact message it gives.
#include <doctest/doctest.h>

#include "broken_urdf.h"

using namespace kadans;

TEST_CASE("A joint that is wrong or odd is told with its place, what is wrong and what was meant") {
  const std::vector<BrokenUrdf> table{
      {"unknown joint type", R"(name="elbow" type="revolute")", R"(name="elbow" type="revolut")",
       "duo.urdf:23:29: unknown joint type 'revolut', did you mean 'revolute'?"},
      {"joint type hinge", R"(name="elbow" type="revolute")", R"(name="elbow" type="ball")",
       "duo.urdf:23:29: joint 'elbow' is ball, a joint of several axes: write it as three revolute joints, with a link "
       "of a small mass between two"},
      {"joint without type", R"(name="elbow" type="revolute")", R"(name="elbow")",
       "duo.urdf:23:3: <joint> has no attribute 'type'"},
      {"floating joint", R"(name="elbow" type="revolute")", R"(name="elbow" type="floating")",
       "duo.urdf:23:3: joint 'elbow' is floating; only a joint below a root without mass, shape and other joints may "
       "be: write it as three prismatic and three revolute joints, with a link of a small mass between two"},
      {"planar joint", R"(name="elbow" type="revolute")", R"(name="elbow" type="planar")",
       "duo.urdf:23:29: joint 'elbow' is planar, a joint of several axes: write it as two prismatic joints and a "
       "continuous one, with a link of a small mass between two"},
      {"revolute without limit", R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       "", "warning: duo.urdf:23:3: revolute joint 'elbow' has no <limit>: it has no end stops and no motor"},
      {"prismatic without limit", R"(name="elbow" type="revolute">
    <parent link="upper_arm"/><child link="fore_arm"/>
    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       R"(name="elbow" type="prismatic">
    <parent link="upper_arm"/><child link="fore_arm"/>
)",
       "warning: duo.urdf:23:3: prismatic joint 'elbow' has no <limit>: it has no end stops and no motor"},
      {"limit without effort", R"(    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
)",
       R"(    <limit lower="-1" upper="1.5" velocity="3"/>
)",
       "warning: duo.urdf:21:5: joint 'shoulder' has a <limit> without 'effort': it has no motor"},
      {"limit without velocity", R"(    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
)",
       R"(    <limit lower="-1" upper="1.5" effort="5"/>
)",
       "warning: duo.urdf:21:5: joint 'shoulder' has a <limit> without 'velocity': its speed has no limit"},
      {"limit without lower and upper", R"(    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
)",
       R"(    <limit effort="5" velocity="3"/>
)",
       "warning: duo.urdf:21:5: joint 'shoulder' has a <limit> without 'lower' and 'upper': it turns without end "
       "stops"},
      {"lower above upper", R"(lower="-1" upper="1.5")", R"(lower="1" upper="-1.5")",
       "duo.urdf:21:5: joint 'shoulder' has its lower limit 1 above its upper -1.5"},
      {"upper left out below lower", R"(lower="-1" upper="1.5")", R"(lower="1")",
       "duo.urdf:21:5: joint 'shoulder' has its lower limit 1 above its upper 0"},
      {"negative effort", R"(    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
)",
       R"(    <limit lower="-1" upper="1.5" effort="-5" velocity="3"/>
)",
       "warning: duo.urdf:21:43: joint 'shoulder' has a negative 'effort': it has no motor"},
      {"negative velocity", R"(    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
)",
       R"(    <limit lower="-1" upper="1.5" effort="5" velocity="-3"/>
)",
       "warning: duo.urdf:21:56: joint 'shoulder' has a 'velocity' that is not above 0: its speed has no limit"},
      {"limit attribute mistyped", R"(    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
)",
       R"(    <limit lower="-1" upper="1.5" efort="5" velocity="3"/>
)",
       "duo.urdf:21:35: unknown attribute 'efort' of <limit>, did you mean 'effort'?"},
      {"axis not of length one", R"("0 1 0")", R"("0 1 1")",
       "warning: duo.urdf:20:16: the axis of joint 'shoulder' has the length 1.41421 instead of 1: '0 0.707107 "
       "0.707107' is used"},
      {"axis zero", R"("0 1 0")", R"("0 0 0")",
       "duo.urdf:20:16: the axis of joint 'shoulder' is zero: it has no direction"},
      {"axis with NaN", R"("0 1 0")", R"("0 nan 0")",
       "duo.urdf:20:16: <axis> xyz '0 nan 0' has a part 'nan' that is not finite"},
      {"axis with four numbers", R"("0 1 0")", R"("0 1 0 0")",
       "duo.urdf:20:16: <axis> xyz '0 1 0 0' has 4 numbers, 3 were expected"},
      {"origin with two numbers", R"(xyz="0 0 0.2")", R"(xyz="0 0.2")",
       "duo.urdf:18:18: <origin> xyz '0 0.2' has 2 numbers, 3 were expected"},
      {"origin with an unknown attribute", R"(rpy="0 0 0")", R"(rpz="0 0 0")",
       "duo.urdf:18:27: unknown attribute 'rpz' of <origin>, did you mean 'rpy'?"},
      {"joint element mistyped", R"(<axis xyz="0 1 0"/>)", R"(<axes xyz="0 1 0"/>)",
       "duo.urdf:20:5: unknown element <axes> in <joint>, did you mean 'axis'?"},
      {"joint attribute mistyped", R"(name="elbow" type)", R"(nam="elbow" type)",
       "duo.urdf:23:10: unknown attribute 'nam' of <joint>, did you mean 'name'?"},
      {"mimic of a missing joint", R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
    <mimic joint="sholder"/>
)",
       "duo.urdf:26:19: joint 'elbow' mimics joint 'sholder', which does not exist, did you mean 'shoulder'?"},
      {"mimic of itself", R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
    <mimic joint="elbow"/>
)",
       "duo.urdf:26:19: joints mimic each other in a ring: elbow -> elbow"},
      {"mimic without joint", R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
    <mimic multiplier="2"/>
)",
       "duo.urdf:26:5: <mimic> has no attribute 'joint'"},
      {"mimic with a factor that is no number", R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
    <mimic joint="shoulder" multiplier="twice"/>
)",
       "duo.urdf:26:41: <mimic> multiplier 'twice' is not a number"},
      {"dynamics with negative damping", R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
    <dynamics damping="-0.1"/>
)",
       "duo.urdf:26:24: <dynamics> damping '-0.1' must be >= 0"},
      {"dynamics without anything", R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
    <dynamics/>
)",
       "nothing"},
      {"two limits", R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
    <limit lower="0" upper="2" effort="5" velocity="3"/>
)",
       "warning: duo.urdf:26:5: a second <limit> in <joint>: the first counts"},
  };
  for (const BrokenUrdf& broken : table) check_told(broken);
}

TEST_CASE("Joints that mimic each other in a ring are refused, once") {
  std::string text = duo_with(R"(    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
)",
                              R"(    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
    <mimic joint="elbow"/>
)");
  const std::string elbow = R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
)";
  text.replace(text.find(elbow), elbow.size(), R"(    <limit lower="0" upper="2" effort="5" velocity="3"/>
    <mimic joint="shoulder"/>
)");
  CHECK(read_error(text) == "duo.urdf:22:19: joints mimic each other in a ring: shoulder -> elbow -> shoulder");
}
