// The tree of links and joints, names, xacro: each row a mistake, and the exact message it gives.
#include <doctest/doctest.h>

#include "broken_urdf.h"

using namespace kadans;

TEST_CASE("Names that do not fit and links that are no tree are refused with their places") {
  const std::vector<BrokenUrdf> table{
      {"link name twice", R"(<link name="fore_arm">)", R"(<link name="upper_arm">)",
       R"(duo.urdf:14:15: link 'upper_arm' is defined twice, first in line 11
duo.urdf:24:44: child link 'fore_arm' of joint 'elbow' does not exist)"},
      {"joint name twice", R"(<joint name="elbow")", R"(<joint name="shoulder")",
       "duo.urdf:23:16: joint 'shoulder' is defined twice, first in line 17"},
      {"child that does not exist", R"(<child link="fore_arm"/>)", R"(<child link="forearm"/>)",
       "duo.urdf:24:44: child link 'forearm' of joint 'elbow' does not exist, did you mean 'fore_arm'?"},
      {"parent that does not exist", R"(<parent link="upper_arm"/>)", R"(<parent link="head"/>)",
       "duo.urdf:24:19: parent link 'head' of joint 'elbow' does not exist"},
      {"joint without child", R"(<child link="fore_arm"/>)", "", "duo.urdf:23:3: <joint> has no <child>"},
      {"two parents", "</robot>",
       R"(  <joint name="strut" type="fixed"><parent link="base"/><child link="fore_arm"/></joint>
</robot>)",
       "duo.urdf:27:70: link 'fore_arm' hangs on two joints, 'elbow' (line 23) and 'strut': a URDF is a tree, so leave "
       "out the joint that closes the loop"},
      {"two roots", "</robot>", R"(  <link name="camera"/>
</robot>)",
       "duo.urdf:27:3: two roots: link 'camera' hangs on no joint, nor does link 'base' (line 3)"},
      {"joint from a link to itself", R"(<parent link="upper_arm"/>)", R"(<parent link="fore_arm"/>)",
       "duo.urdf:23:3: joint 'elbow' joins link 'fore_arm' to itself"},
      {"loop beside a sound tree", "</robot>", R"(  <link name="a"/><link name="b"/>
  <joint name="ab" type="fixed"><parent link="a"/><child link="b"/></joint>
  <joint name="ba" type="fixed"><parent link="b"/><child link="a"/></joint>
</robot>)",
       "duo.urdf:29:3: joints in a loop: a -> b -> a; a URDF is a tree with one root"},
      {"loop and no root", "</robot>",
       R"(  <joint name="back" type="fixed"><parent link="fore_arm"/><child link="base"/></joint>
</robot>)",
       "duo.urdf:27:3: joints in a loop: base -> upper_arm -> fore_arm -> base; a URDF is a tree with one root"},
      {"moving link without mass", R"(  <link name="fore_arm">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
)",
       R"(  <link name="fore_arm">
)",
       "duo.urdf:14:3: link 'fore_arm' moves on joint 'elbow' but has no mass: it, or a link fixed to it, needs an "
       "<inertial>; or make the joint fixed"},
      {"robot without name", R"(<robot name="duo">)", "<robot>",
       "warning: duo.urdf:1:1: this <robot> has no name that can be used, and gets its file's"},
      {"robot of another version", R"(<robot name="duo">)", R"(<robot name="duo" version="2.0">)",
       "warning: duo.urdf:1:28: URDF version '2.0' is read as '1.0'"},
      {"link without name", R"(<link name="fore_arm">)", "<link>",
       R"(duo.urdf:14:3: <link> has no attribute 'name'
duo.urdf:24:44: child link 'fore_arm' of joint 'elbow' does not exist)"},
      {"link with an empty name", R"(<link name="fore_arm">)", R"(<link name="">)",
       R"(duo.urdf:14:15: <link> name '' is empty
duo.urdf:24:44: child link 'fore_arm' of joint 'elbow' does not exist)"},
      {"link name with a blank", R"(<link name="fore_arm">)", R"(<link name="fore_arm ">)",
       R"(duo.urdf:14:15: <link> name 'fore_arm ' has blanks around it
duo.urdf:24:44: child link 'fore_arm' of joint 'elbow' does not exist, did you mean 'fore_arm '?)"},
      {"top-level element mistyped", "</robot>", R"(  <lnik name="camera"/>
</robot>)",
       "duo.urdf:27:3: unknown element <lnik> in <robot>, did you mean 'link'?"},
      {"xacro name space", R"(<robot name="duo">)", R"(<robot name="duo" xmlns:xacro="http://www.ros.org/wiki/xacro">)",
       "warning: duo.urdf:1:19: attribute 'xmlns:xacro' of <robot> is not known to URDF, and not used"},
      {"xacro property", R"("2.5")", R"("${base_mass}")",
       "duo.urdf:5:20: '${base_mass}': this is xacro, expand it first (xacro FILE.xacro > FILE.urdf)"},
      {"xacro macro", "</robot>", R"(  <xacro:arm side="left"/>
</robot>)",
       "duo.urdf:27:3: <xacro:arm>: this is xacro, expand it first (xacro FILE.xacro > FILE.urdf)"},
      {"xacro path", R"(<sphere radius="0.1"/>)", R"(<mesh filename="$(find duo)/shell.stl"/>)",
       "duo.urdf:8:39: '$(find duo)/shell.stl': this is xacro, expand it first (xacro FILE.xacro > FILE.urdf)"},
  };
  for (const BrokenUrdf& broken : table) check_told(broken);
}
