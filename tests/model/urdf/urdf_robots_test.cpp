// URDFs as robots have them: sensor frames on fixed joints, a gripper with a mimic, wheels, a lift, a bolted arm.
#include <cmath>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"
#include "kadans/model/urdf.h"

using namespace kadans;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

const std::string mobile_manipulator = R"(<?xml version="1.0" encoding="utf-8"?>
<!-- A cart with two driven wheels and a castor, a lift on it, a gripper of two fingers on the lift. -->
<robot name="carrier">
  <link name="base_footprint"/>
  <link name="base_link">
    <inertial><origin xyz="0 0 0.05"/><mass value="12"/><inertia ixx="0.2" iyy="0.3" izz="0.4" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="0 0 0.05"/><geometry><box size="0.5 0.4 0.15"/></geometry>
      <material name="blue"><color rgba="0.1 0.2 0.8 1"/></material></visual>
    <collision><origin xyz="0 0 0.05"/><geometry><box size="0.5 0.4 0.15"/></geometry></collision>
  </link>
  <joint name="base_joint" type="fixed">
    <parent link="base_footprint"/><child link="base_link"/><origin xyz="0 0 0.1"/>
  </joint>
  <link name="left_wheel">
    <inertial><mass value="0.8"/><inertia ixx="0.002" iyy="0.004" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.1" length="0.04"/></geometry></collision>
  </link>
  <joint name="left_wheel_joint" type="continuous">
    <parent link="base_link"/><child link="left_wheel"/><origin xyz="0 0.22 0"/><axis xyz="0 1 0"/>
    <limit effort="6" velocity="15"/><dynamics damping="0.02" friction="0.1"/>
  </joint>
  <link name="castor">
    <inertial><mass value="0.2"/><inertia ixx="0.0002" iyy="0.0002" izz="0.0002" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="castor_joint" type="continuous">
    <parent link="base_link"/><child link="castor"/><origin xyz="-0.2 0 -0.05"/><axis xyz="0 0 1"/>
  </joint>
  <link name="laser"><visual><geometry><cylinder radius="0.03" length="0.05"/></geometry><material name="blue"/></visual></link>
  <joint name="laser_joint" type="fixed">
    <parent link="base_link"/><child link="laser"/><origin xyz="0.2 0 0.15"/><axis xyz="0 0 0"/>
  </joint>
  <link name="carriage">
    <inertial><mass value="2"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="lift" type="prismatic">
    <parent link="base_link"/><child link="carriage"/><origin xyz="0.1 0 0.2"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.6" effort="200" velocity="0.3"/>
    <safety_controller soft_lower_limit="0.01" soft_upper_limit="0.59" k_position="10" k_velocity="100"/>
  </joint>
  <link name="camera_frame"/>
  <joint name="camera_joint" type="fixed"><parent link="carriage"/><child link="camera_frame"/><origin rpy="-1.5708 0 -1.5708"/></joint>
  <link name="finger">
    <inertial><mass value="0.05"/><inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="finger_joint" type="prismatic">
    <parent link="carriage"/><child link="finger"/><origin xyz="0.1 0.01 0"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="0.1"/>
  </joint>
  <link name="finger_mirror">
    <inertial><mass value="0.05"/><inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="finger_mirror_joint" type="prismatic">
    <parent link="carriage"/><child link="finger_mirror"/><origin xyz="0.1 -0.01 0"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="0.1"/><mimic joint="finger_joint"/>
  </joint>
  <transmission name="lift_transmission"><type>SimpleTransmission</type><joint name="lift"/></transmission>
  <gazebo reference="laser"><sensor type="ray" name="laser"><update_rate>40</update_rate></sensor></gazebo>
</robot>
)";

const std::string bolted_arm = R"(<robot name="pan_tilt">
  <link name="world"/>
  <link name="pan"><inertial><mass value="0.4"/><inertia ixx="5e-3" iyy="5e-3" izz="5e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="pan" type="revolute">
    <parent link="world"/><child link="pan"/><axis xyz="0 0 1"/><limit lower="-2.6" upper="2.6" effort="1" velocity="6"/>
  </joint>
  <link name="tilt"><inertial><mass value="0.2"/><inertia ixx="2e-3" iyy="2e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="tilt" type="revolute">
    <parent link="pan"/><child link="tilt"/><axis xyz="0 1 0"/><limit lower="-0.8" upper="0.8" effort="1" velocity="6"/>
  </joint>
</robot>
)";

}  // namespace

TEST_CASE("A cart with lift and gripper: frames merged, wheels endless, the second finger a mimic") {
  const RobotModel model = read_urdf_text(mobile_manipulator, "carrier.urdf");
  CHECK(model.joint_names() ==
        std::vector<std::string>{"left_wheel_joint", "castor_joint", "lift", "finger_joint", "finger_mirror_joint"});
  CHECK(model.links[0].name == "base_footprint");
  CHECK(model.links[0].merged == std::vector<std::string>{"base_link", "laser"});
  CHECK(model.links[3].merged == std::vector<std::string>{"camera_frame"});
  CHECK(model.mass_kg() == doctest::Approx(12 + 0.8 + 0.2 + 2 + 0.1));
  CHECK(model.links[0].inertia.com_m[2] == doctest::Approx(0.15));
  CHECK(model.links[0].visuals.at(1).pose.position_m[2] == doctest::Approx(0.25));  // the laser
  CHECK(model.links[0].visuals.at(1).color[2] == doctest::Approx(0.8));             // its material is named elsewhere

  const Joint &wheel = model.joints[0], &castor = model.joints[1], &lift = model.joints[2], &mirror = model.joints[4];
  CHECK(wheel.type == JointType::continuous);
  CHECK(wheel.lower_rad == -infinite);
  CHECK(wheel.upper_rad == infinite);
  CHECK(wheel.effort_max_Nm == 6);
  CHECK(wheel.damping_Nms_per_rad == 0.02);
  CHECK(wheel.friction_Nm == 0.1);
  CHECK(wheel.origin.position_m[2] == doctest::Approx(0.1));
  CHECK(castor.passive());
  CHECK(castor.velocity_max_rad_s == 1e6);
  CHECK(lift.type == JointType::prismatic);
  CHECK(lift.upper_rad == 0.6);
  REQUIRE(mirror.mimic);
  CHECK(mirror.mimic->joint == 3);
  CHECK(mirror.mimic->multiplier == 1);
}

TEST_CASE("The lift carries the gripper up, the fingers open apart") {
  const RobotModel model = read_urdf_text(mobile_manipulator, "carrier.urdf");
  Kinematics kinematics(model);
  kinematics.update(std::vector<double>{0, 0, 0.5, 0.03, 0.03});
  const Vec3 &finger = kinematics.link(4).position_m, &mirror = kinematics.link(5).position_m;
  CHECK(finger[2] == doctest::Approx(0.1 + 0.2 + 0.5));
  CHECK(finger[1] == doctest::Approx(0.04));
  CHECK(mirror[1] == doctest::Approx(-0.04));
}

TEST_CASE("A root without mass stays, for a base that is bolted to the world") {
  const RobotModel model = read_urdf_text(bolted_arm, "pan_tilt.urdf");
  REQUIRE(model.links.size() == 3);
  CHECK(model.links[0].inertia.mass_kg == 0);
  CHECK(model.mass_kg() == doctest::Approx(0.6));
}
