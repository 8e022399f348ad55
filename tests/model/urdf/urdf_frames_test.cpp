#include <numbers>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"
#include "kadans/model/urdf.h"
#include "kadans/signal/input_error.h"

using namespace kadans;

namespace {

constexpr const char* arm = R"(<robot name="arm">
  <link name="table"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="post"/>
  <link name="upper"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="slide"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="stand" type="fixed"><parent link="table"/><child link="post"/><origin xyz="0 0 0.5"/></joint>
  <joint name="shoulder" type="revolute"><parent link="post"/><child link="upper"/><origin xyz=" 0.1	0 0"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="rail" type="prismatic"><parent link="upper"/><child link="slide"/><origin xyz="0 0 0.2"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
</robot>)";

}  // namespace

TEST_CASE("frames of a URDF keep what fixed joints carry, and chain to where its links are") {
  const RobotModel model = read_urdf_text(arm, "arm.urdf");
  const std::vector<UrdfFrame> frames = urdf_frames(model, arm);
  REQUIRE(frames.size() == 3);
  const std::vector<double> position{std::numbers::pi / 2, 0.3};
  Pose slide;
  for (const char* child : {"post", "upper", "slide"}) {
    const auto at = std::ranges::find(frames, child, &UrdfFrame::child);
    REQUIRE(at != frames.end());
    CHECK(at->joint.has_value() == (at->child != "post"));
    slide = compose(slide, frame_pose(*at, model, position));
  }
  CHECK(slide.position_m[0] == doctest::Approx(0.1));
  CHECK(slide.position_m[1] == doctest::Approx(0.3));  // along x of what turned by a quarter
  CHECK(slide.position_m[2] == doctest::Approx(0.7));
  Kinematics kinematics(model);
  kinematics.update(position);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(slide.position_m[i] == doctest::Approx(kinematics.link(*model.find_link("slide")).position_m[i]));
}

TEST_CASE("frames of a text that is no URDF are refused with its name") {
  const RobotModel model = read_urdf_text(arm, "arm.urdf");
  CHECK_THROWS_AS((void)urdf_frames(model, "<robot>"), InputError);
}
