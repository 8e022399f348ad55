// The committed TULip model against what is known of the robot, and against its own mirror image.
#include <algorithm>
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"
#include "kadans/model/urdf.h"

namespace tulip_test {

using namespace kadans;

namespace {

const RobotModel& tulip() {
  static const RobotModel model = read_urdf(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf");
  return model;
}

// Half the height of a shape along the world's z: the distance from its centre to its highest and lowest points.
double half_height_m(const Shape& shape, const Quat& orientation) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius_m;
  const auto& box = std::get<Box>(shape);  // TULip collides as boxes and spheres
  const Vec3 up = rotate_inverse(orientation, {0, 0, 1});
  double half = 0;
  for (std::size_t k = 0; k < 3; ++k) half += std::abs(up[k]) * box.size_m[k] / 2;
  return half;
}

struct Extent {
  double low_m = 1e9, high_m = -1e9;
};

Extent extent(const RobotModel& model, const Kinematics& kinematics) {
  Extent z;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Geometry& geometry : model.links[i].collisions) {
      const Pose pose = compose(kinematics.link(i), geometry.pose);
      const double half = half_height_m(geometry.shape, pose.orientation);
      z.low_m = std::min(z.low_m, pose.position_m[2] - half);
      z.high_m = std::max(z.high_m, pose.position_m[2] + half);
    }
  }
  return z;
}

// The name of the same thing on the other side: l_knee_link -> r_knee_link.
std::string mirrored(std::string name) {
  if (name.starts_with("l_")) name[0] = 'r';
  return name;
}

void check_mirrored(const Vec3& left, const Vec3& right) {
  CHECK(left[0] == right[0]);
  CHECK(left[1] == -right[1]);
  CHECK(left[2] == right[2]);
}

}  // namespace

TEST_CASE("TULip weighs 14.000 kg and has 14 joints, 12 of them with motors") {
  CHECK(std::abs(tulip().mass_kg() - 14.0) < 1e-9);
  REQUIRE(tulip().joints.size() == 14);
  REQUIRE(tulip().links.size() == 15);
  CHECK(std::count_if(tulip().joints.begin(), tulip().joints.end(), [](const Joint& j) { return !j.passive(); }) == 12);
  CHECK(tulip().joints[*tulip().find_joint("l_ankle_roll")].passive());
  CHECK(tulip().joints[*tulip().find_joint("r_ankle_roll")].passive());
}

TEST_CASE("TULip's joints come in the order of the file, left before right, and each moves the link after it") {
  const std::vector<std::string> order{"hip_yaw",     "hip_roll",   "hip_pitch",     "knee",
                                       "ankle_pitch", "ankle_roll", "shoulder_pitch"};
  for (std::size_t i = 0; i < 14; ++i) {
    const std::string name = (i < 7 ? "l_" : "r_") + order[i % 7];
    CHECK(tulip().joints[i].name == name);
    CHECK(tulip().links[i + 1].name == name + "_link");
  }
  CHECK(tulip().links[0].name == "torso");
  CHECK(tulip().joints[6].parent == 0);
  CHECK(tulip().joints[13].parent == 0);
}

TEST_CASE("TULip standing straight with its soles on the ground is 1.20 m high, its centre of mass at 0.623 m") {
  Kinematics kinematics(tulip());
  kinematics.update(std::vector<double>(14, 0.0), {{0, 0, 0.868}, {1, 0, 0, 0}});
  const Extent z = extent(tulip(), kinematics);
  CHECK(std::abs(z.low_m) < 1e-12);
  CHECK(std::abs(z.high_m - 1.20) < 1e-12);
  const Vec3 com_m = kinematics.com_m();
  CHECK(std::abs(com_m[2] - 0.623) < 0.0005);
  CHECK(std::abs(com_m[1]) < 1e-12);
}

TEST_CASE("TULip's right side mirrors its left: masses, inertias, joints, shapes") {
  const std::size_t n = 7;
  for (std::size_t i = 0; i < n; ++i) {
    const Joint &left = tulip().joints[i], &right = tulip().joints[i + n];
    CAPTURE(left.name);
    CHECK(mirrored(left.name) == right.name);
    check_mirrored(left.origin.position_m, right.origin.position_m);
    CHECK(left.axis == right.axis);
    CHECK(left.effort_max_Nm == right.effort_max_Nm);
    CHECK(left.velocity_max_rad_s == right.velocity_max_rad_s);
    CHECK(left.lower_rad == right.lower_rad);  // roll and yaw limits are symmetric, so they mirror too
    CHECK(left.upper_rad == right.upper_rad);
    const Link &a = tulip().links[i + 1], &b = tulip().links[i + 1 + n];
    CHECK(a.inertia.mass_kg == b.inertia.mass_kg);
    check_mirrored(a.inertia.com_m, b.inertia.com_m);
    CHECK(a.inertia.xx == b.inertia.xx);
    CHECK(a.inertia.zz == b.inertia.zz);
    REQUIRE(a.collisions.size() == b.collisions.size());
    REQUIRE(a.visuals.size() == b.visuals.size());
    for (std::size_t k = 0; k < a.collisions.size(); ++k) {
      CHECK(mirrored(a.collisions[k].name) == b.collisions[k].name);
      check_mirrored(a.collisions[k].pose.position_m, b.collisions[k].pose.position_m);
    }
  }
}

TEST_CASE("TULip's foot reaches from 0.08 m behind the ankle to 0.14 m before it, its sole 0.06 m below") {
  const Link& foot = tulip().links[*tulip().find_link("l_ankle_roll_link")];
  REQUIRE(foot.collisions.size() == 1);
  const auto& box = std::get<Box>(foot.collisions[0].shape);
  const Vec3& centre_m = foot.collisions[0].pose.position_m;
  CHECK(centre_m[0] - box.size_m[0] / 2 == doctest::Approx(-0.08));
  CHECK(centre_m[0] + box.size_m[0] / 2 == doctest::Approx(0.14));
  CHECK(centre_m[2] - box.size_m[2] / 2 == doctest::Approx(-0.06));
  CHECK(box.size_m[1] == 0.10);
}

TEST_CASE("TULip's links that touch the ground when it falls all have shapes, and everything visible has a colour") {
  for (const char* link : {"torso", "l_hip_pitch_link", "l_knee_link", "l_ankle_roll_link", "l_shoulder_pitch_link"}) {
    CHECK_MESSAGE(!tulip().links[*tulip().find_link(link)].collisions.empty(), link);
  }
  const std::array<double, 4> unpainted = Geometry{}.color;
  for (const Link& link : tulip().links) {
    CHECK_MESSAGE(!link.visuals.empty(), link.name);
    for (const Geometry& visual : link.visuals) CHECK_MESSAGE(visual.color != unpainted, visual.name);
  }
}

}  // namespace tulip_test
