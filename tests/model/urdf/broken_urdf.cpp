#include "broken_urdf.h"

#include <stdexcept>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/model/urdf.h"
#include "kadans/signal/input_error.h"

namespace kadans {

const std::string duo_urdf = R"(<robot name="duo">
  <material name="orange"><color rgba="1 0.5 0 1"/></material>
  <link name="base">
    <inertial>
      <mass value="2.5"/>
      <inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/>
    </inertial>
    <visual><geometry><sphere radius="0.1"/></geometry><material name="orange"/></visual>
    <collision><geometry><box size="0.1 0.2 0.3"/></geometry></collision>
  </link>
  <link name="upper_arm">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="fore_arm">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="shoulder" type="revolute">
    <origin xyz="0 0 0.2" rpy="0 0 0"/>
    <parent link="base"/><child link="upper_arm"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
  </joint>
  <joint name="elbow" type="revolute">
    <parent link="upper_arm"/><child link="fore_arm"/>
    <limit lower="0" upper="2" effort="5" velocity="3"/>
  </joint>
</robot>
)";

std::string read_error(const std::string& text) {
  try {
    (void)read_urdf_text(text, "duo.urdf");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string duo_with(const std::string& from, const std::string& to) {
  const std::size_t at = duo_urdf.find(from);
  if (at == std::string::npos) throw std::invalid_argument("not in the URDF: " + from);
  std::string text = duo_urdf;
  return text.replace(at, from.size(), to);
}

std::string read_told(const std::string& text) {
  std::vector<InputProblem> warnings;
  std::string told;
  try {
    (void)read_urdf_text(text, "duo.urdf", {}, &warnings);
  } catch (const InputError& error) {
    return error.what();
  }
  for (const InputProblem& warning : warnings) told += (told.empty() ? "warning: " : "\nwarning: ") + warning.text();
  return told.empty() ? "nothing" : told;
}

void check_told(const BrokenUrdf& broken) {
  CAPTURE(broken.what);
  CHECK(read_told(duo_with(broken.from, broken.to)) == broken.message);
}

}  // namespace kadans
