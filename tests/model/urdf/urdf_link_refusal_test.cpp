// Links: masses, inertias, shapes, materials: each row a mistake, and the exact message it gives.
#include <doctest/doctest.h>

#include "broken_urdf.h"

using namespace kadans;

TEST_CASE("A link that is wrong or odd is told with its place, what is wrong and what was meant") {
  const std::vector<BrokenUrdf> table{
      {"mass with a comma", R"("2.5")", R"("2,5")",
       "duo.urdf:5:20: <mass> value '2,5' is not a number, did you mean '2.5'?"},
      {"negative mass", R"("2.5")", R"("-2.5")", "duo.urdf:5:20: <mass> value '-2.5' must be >= 0"},
      {"mass zero", R"("2.5")", R"("0")",
       "warning: duo.urdf:4:5: link 'base' has an <inertial> without mass, and counts as one without it"},
      {"mass with its unit", R"("2.5")", R"("2.5 kg")", "duo.urdf:5:20: <mass> value '2.5 kg' is not a number"},
      {"mass not a number", R"("2.5")", R"("nan")", "duo.urdf:5:20: <mass> value 'nan' is not finite"},
      {"mass infinite", R"("2.5")", R"("inf")", "duo.urdf:5:20: <mass> value 'inf' is not finite"},
      {"mass in hexadecimal", R"("2.5")", R"("0x2")", "duo.urdf:5:20: <mass> value '0x2' is not a number"},
      {"mass beyond doubles", R"("2.5")", R"("1e999")",
       "duo.urdf:5:20: <mass> value '1e999' is out of the range of numbers"},
      {"mass of a planet", R"("2.5")", R"("6e24")",
       "duo.urdf:5:20: <mass> value '6e24' is beyond 1e9, too large for a robot"},
      {"mass empty", R"("2.5")", R"("")", "duo.urdf:5:20: <mass> value '' is empty, a number was expected"},
      {"mass without value", R"(<mass value="2.5"/>)", "<mass/>", "duo.urdf:5:7: <mass> has no attribute 'value'"},
      {"mass attribute mistyped", R"(<mass value="2.5"/>)", R"(<mass vale="2.5"/>)",
       "duo.urdf:5:13: unknown attribute 'vale' of <mass>, did you mean 'value'?"},
      {"inertial without mass", R"(<mass value="2.5"/>
)",
       R"(
)",
       "warning: duo.urdf:4:5: link 'base' has an <inertial> without mass, and counts as one without it"},
      {"inertial without inertia", R"(<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/>)", "",
       "duo.urdf:4:5: the inertia of link 'base' is not positive definite: its principal moments are 0, 0, 0 kg m2, "
       "all must be > 0; compute it anew from the shape, about the centre of mass, in kg m2"},
      {"inertia without ixz", R"(<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/>)",
       R"(<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" iyz="0"/>)",
       "warning: duo.urdf:6:7: <inertia> has not all of ixy, ixz and iyz: what is missing is taken as 0"},
      {"inertia not positive definite", R"(<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/>)",
       R"(<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0.03" ixz="0" iyz="0"/>)",
       "duo.urdf:6:7: the inertia of link 'base' is not positive definite: its principal moments are -0.01, 0.02, 0.05 "
       "kg m2, all must be > 0; compute it anew from the shape, about the centre of mass, in kg m2"},
      {"inertia zero", R"(<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/>)",
       R"(<inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/>)",
       "duo.urdf:6:7: the inertia of link 'base' is not positive definite: its principal moments are 0, 0, 0 kg m2, "
       "all must be > 0; compute it anew from the shape, about the centre of mass, in kg m2"},
      {"inertia against the triangle inequality",
       R"(<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/>)",
       R"(<inertia ixx="0.02" iyy="0.02" izz="0.05" ixy="0" ixz="0" iyz="0"/>)",
       "duo.urdf:6:7: the inertia of link 'base' breaks the triangle inequality: of its principal moments 0.02, 0.02, "
       "0.05 kg m2 no one may exceed the sum of the other two, here 0.04; compute it anew from the shape, "
       "about the centre of mass, in kg m2"},
      {"mass twice", R"(<mass value="2.5"/>)", R"(<mass value="2.5"/><mass value="3"/>)",
       "warning: duo.urdf:5:26: a second <mass> in <inertial>: the first counts"},
      {"unknown geometry", R"(<sphere radius="0.1"/>)", R"(<capsule radius="0.1" length="1"/>)", "nothing"},
      {"geometry mistyped", R"(<sphere radius="0.1"/>)", R"(<spere radius="0.1"/>)",
       "warning: duo.urdf:8:23: unknown element <spere> in <geometry>, did you mean 'sphere'?; this <visual> is left "
       "out"},
      {"geometry empty", R"(<sphere radius="0.1"/>)", "",
       "warning: duo.urdf:8:5: <visual> has no shape that could be used, and is left out"},
      {"geometry with nothing but an element of others", R"(<sphere radius="0.1"/>)", R"(<drake:capsule/>)",
       R"(warning: duo.urdf:8:5: <visual> has no shape that could be used, and is left out
warning: duo.urdf:8:23: <drake:capsule> in <geometry> is not known to URDF, and not used)"},
      {"two shapes in a geometry", R"(<sphere radius="0.1"/>)", R"(<sphere radius="0.1"/><sphere radius="0.2"/>)",
       "warning: duo.urdf:8:45: a second shape in one <geometry>: the first counts"},
      {"no geometry", R"(<visual><geometry><sphere radius="0.1"/></geometry>)", "<visual>",
       "warning: duo.urdf:8:5: <visual> has no shape that could be used, and is left out"},
      {"sphere without radius", R"(<sphere radius="0.1"/>)", "<sphere/>",
       "warning: duo.urdf:8:23: <sphere> has no attribute 'radius'; this <visual> is left out"},
      {"sphere of radius zero", R"(<sphere radius="0.1"/>)", R"(<sphere radius="0"/>)",
       "warning: duo.urdf:8:5: <visual> has no shape that could be used, and is left out"},
      {"cylinder without length", R"(<sphere radius="0.1"/>)", R"(<cylinder radius="0.1"/>)",
       "warning: duo.urdf:8:23: <cylinder> has no attribute 'length'; this <visual> is left out"},
      {"box with two sizes", R"("0.1 0.2 0.3")", R"("0.1 0.2")",
       "duo.urdf:9:37: <box> size '0.1 0.2' has 2 numbers, 3 were expected"},
      {"box with a negative size", R"("0.1 0.2 0.3")", R"("0.1 -0.2 0.3")",
       "duo.urdf:9:37: <box> size '0.1 -0.2 0.3' must be >= 0 in every direction"},
      {"box with commas", R"("0.1 0.2 0.3")", R"("0.1, 0.2, 0.3")",
       "duo.urdf:9:37: <box> size '0.1, 0.2, 0.3' is not separated by spaces, did you mean '0.1 0.2 0.3'?"},
      {"box with a word", R"("0.1 0.2 0.3")", R"("0.1 O.2 0.3")",
       "duo.urdf:9:37: <box> size '0.1 O.2 0.3' has a part 'O.2' that is not a number"},
      {"collision mesh that is not there", R"(<box size="0.1 0.2 0.3"/>)", R"(<mesh filename="hull.stl"/>)",
       "warning: duo.urdf:9:42: mesh file 'hull.stl' is not there: link 'base' collides without it; its path starts "
       "from this file's folder"},
      {"visual mesh that is not there", R"(<sphere radius="0.1"/>)",
       R"(<mesh filename="package://duo/meshes/shell.stl"/>)",
       "warning: duo.urdf:8:39: mesh file 'package://duo/meshes/shell.stl' is not there: link 'base' is drawn with a "
       "marker in its place; --package duo=FOLDER or ROS_PACKAGE_PATH says where the package is"},
      {"mesh scaled to nothing", R"(<sphere radius="0.1"/>)", R"(<mesh filename="shell.stl" scale="1 1 0"/>)",
       "warning: duo.urdf:8:5: <visual> has no shape that could be used, and is left out"},
      {"material mistyped", R"(<material name="orange"/>)", R"(<material name="ornage"/>)",
       "warning: duo.urdf:8:72: material 'ornage' is not defined, and is grey, did you mean 'orange'?"},
      {"colour out of range", R"("1 0.5 0 1")", R"("255 128 0 1")",
       R"(warning: duo.urdf:2:3: material 'orange' has neither <color> nor <texture>, and is grey
warning: duo.urdf:2:40: <color> rgba '255 128 0 1' must be red, green, blue and opacity in 0..1; this colour is not used)"},
      {"material without colour", R"(<color rgba="1 0.5 0 1"/>)", "",
       "warning: duo.urdf:2:3: material 'orange' has neither <color> nor <texture>, and is grey"},
      {"unknown element in a link", "<collision>", "<colision>x</colision><collision>",
       "duo.urdf:9:5: unknown element <colision> in <link>, did you mean 'collision'?"},
      {"element mistyped that is needed", R"(<mass value="2.5"/>)", R"(<mas value="2.5"/>)",
       "duo.urdf:5:7: unknown element <mas> in <inertial>, did you mean 'mass'?"},
      {"axis-like size with commas only", R"("0.1 0.2 0.3")", R"("0.1,0.2,0.3")",
       "duo.urdf:9:37: <box> size '0.1,0.2,0.3' is not separated by spaces, did you mean '0.1 0.2 0.3'?"},
      {"visual mesh with an absolute path that is not there", R"(<sphere radius="0.1"/>)",
       R"(<mesh filename="file:///no/such/shell.stl"/>)",
       "warning: duo.urdf:8:39: mesh file 'file:///no/such/shell.stl' is not there: link 'base' is drawn with a marker "
       "in its place"},
      {"text in a link", "<collision>", "todo: collision <collision>",
       "warning: duo.urdf:9:5: text in <link>, which has none, is not used"},
  };
  for (const BrokenUrdf& broken : table) check_told(broken);
}
