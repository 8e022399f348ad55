#include "kadans/model/kinematics.h"

#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/model/urdf.h"
#include "kadans/signal/random.h"
#include "kadans/testing/allocation_count.h"

namespace kinematics_test {

using namespace kadans;

namespace {

const RobotModel& tulip() {
  static const RobotModel model = read_urdf(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf");
  return model;
}

void check_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  CAPTURE(a[0]);
  CAPTURE(a[1]);
  CAPTURE(a[2]);
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(a[k] - b[k]) <= tolerance);
}

std::size_t joint(const char* name) { return *tulip().find_joint(name); }
std::size_t link(const char* name) { return *tulip().find_link(name); }

}  // namespace

TEST_CASE("At zero pose every link's frame is parallel to the base and lies where the table says") {
  Kinematics kinematics(tulip());
  kinematics.update(std::vector<double>(14, 0.0), {{0, 0, 0.868}, {1, 0, 0, 0}});
  for (std::size_t i = 0; i < tulip().links.size(); ++i) CHECK(kinematics.link(i).orientation == Quat{1, 0, 0, 0});
  check_near(kinematics.link(link("l_hip_pitch_link")).position_m, {0, 0.085, 0.61});
  check_near(kinematics.link(link("r_knee_link")).position_m, {0, -0.085, 0.335});
  check_near(kinematics.link(link("l_ankle_roll_link")).position_m, {0, 0.085, 0.06});
  check_near(kinematics.link(link("r_shoulder_pitch_link")).position_m, {0, -0.17, 1.0});
}

TEST_CASE("A squat: the thigh forward, the shank back, the foot level under the hip") {
  std::vector<double> q(14, 0.0);
  const double bend_rad = 0.6;
  for (const char* side : {"l", "r"}) {
    q[joint((std::string(side) + "_hip_pitch").c_str())] = -bend_rad;
    q[joint((std::string(side) + "_knee").c_str())] = 2 * bend_rad;
    q[joint((std::string(side) + "_ankle_pitch").c_str())] = -bend_rad;
  }
  Kinematics kinematics(tulip());
  kinematics.update(q);
  const double drop = 0.275 * std::cos(bend_rad), forward = 0.275 * std::sin(bend_rad);
  check_near(kinematics.link(link("l_knee_link")).position_m, {forward, 0.085, -0.258 - drop});
  check_near(kinematics.link(link("l_ankle_roll_link")).position_m, {0, 0.085, -0.258 - 2 * drop});
  check_near(rotate(kinematics.link(link("l_ankle_roll_link")).orientation, {1, 0, 0}), {1, 0, 0});
}

TEST_CASE("Hip yaw turns before roll, roll before pitch") {
  std::vector<double> q(14, 0.0);
  q[joint("l_hip_yaw")] = 0.5;
  q[joint("l_hip_roll")] = 0.3;
  q[joint("l_hip_pitch")] = -0.7;
  Kinematics kinematics(tulip());
  kinematics.update(q);
  // The knee hangs at (0, 0, -0.275) in the thigh: pitched to (s, 0, -c), then rolled, then yawed.
  const double s = 0.275 * std::sin(0.7), c = 0.275 * std::cos(0.7);
  const Vec3 rolled{s, c * std::sin(0.3), -c * std::cos(0.3)};
  const Vec3 yawed{rolled[0] * std::cos(0.5) - rolled[1] * std::sin(0.5),
                   rolled[0] * std::sin(0.5) + rolled[1] * std::cos(0.5), rolled[2]};
  check_near(kinematics.link(link("l_knee_link")).position_m, {yawed[0], 0.085 + yawed[1], -0.258 + yawed[2]});
}

TEST_CASE("The base's pose moves everything with it, the centre of mass too") {
  std::vector<double> q(14, 0.0);
  RandomStream random(3, "kinematics test");
  for (double& position : q) position = random.uniform(-0.5, 0.5);
  Kinematics at_origin(tulip()), moved(tulip());
  const Pose base{{1, -2, 3}, from_roll_pitch_yaw(0.4, -0.9, 2.0)};
  at_origin.update(q);
  moved.update(q, base);
  for (std::size_t i = 0; i < tulip().links.size(); ++i) {
    check_near(moved.link(i).position_m, transform(base, at_origin.link(i).position_m));
  }
  check_near(moved.com_m(), transform(base, at_origin.com_m()));
}

TEST_CASE("A link's velocity by finite differences is axis x lever of each joint above it") {
  RandomStream random(5, "finite differences");
  std::vector<double> q(14, 0.0);
  for (double& position : q) position = random.uniform(-0.5, 0.5);
  const Pose base{{0.1, 0.2, 0.3}, from_roll_pitch_yaw(0.4, -0.9, 2.0)};
  Kinematics here(tulip()), before(tulip()), after(tulip());
  here.update(q, base);
  const std::size_t foot = link("l_ankle_roll_link");
  constexpr double step_rad = 1e-6;
  for (std::size_t i = 0; i < q.size(); ++i) {
    std::vector<double> less = q, more = q;
    less[i] -= step_rad;
    more[i] += step_rad;
    before.update(less, base);
    after.update(more, base);
    const Vec3 &a = before.link(foot).position_m, &b = after.link(foot).position_m;
    const Vec3 slope{(b[0] - a[0]) / (2 * step_rad), (b[1] - a[1]) / (2 * step_rad), (b[2] - a[2]) / (2 * step_rad)};
    const Pose& moved = here.link(i + 1);
    const Vec3 axis = rotate(moved.orientation, tulip().joints[i].axis);
    const Vec3& tip = here.link(foot).position_m;
    const Vec3 lever{tip[0] - moved.position_m[0], tip[1] - moved.position_m[1], tip[2] - moved.position_m[2]};
    CAPTURE(tulip().joints[i].name);
    check_near(slope, i < 6 ? cross(axis, lever) : Vec3{}, 1e-8);
  }
}

TEST_CASE("The centre of mass rises with a raised arm by the arm's share of the mass") {
  std::vector<double> q(14, 0.0);
  Kinematics kinematics(tulip());
  kinematics.update(q);
  const double hanging_m = kinematics.com_m()[2];
  q[joint("l_shoulder_pitch")] = -M_PI;
  kinematics.update(q);
  CHECK(kinematics.com_m()[2] - hanging_m == doctest::Approx(2 * 0.18 * 0.5 / 14.0));
}

TEST_CASE("A prismatic joint slides along its axis in its own frame") {
  RobotModel model;
  model.links.resize(2);
  Joint lift;
  lift.type = JointType::prismatic;
  lift.axis = {0, 0, 1};
  lift.origin = {{1, 0, 0}, from_axis_angle({0, 1, 0}, M_PI / 2)};  // its z is the base's x
  model.joints.push_back(lift);
  Kinematics kinematics(model);
  kinematics.update(std::vector<double>{0.25});
  check_near(kinematics.link(1).position_m, {1.25, 0, 0});
  check_near(rotate(kinematics.link(1).orientation, {0, 0, 1}), {1, 0, 0});
}

TEST_CASE("Forward kinematics keep their quaternions of length 1 through a long chain") {
  RandomStream random(11, "long chain");
  RobotModel model;
  model.links.resize(max_joints + 1);
  std::vector<double> q;
  for (std::size_t i = 0; i < max_joints; ++i) {
    Joint bend;
    bend.parent = i;
    bend.origin = {{0, 0, 0.1},
                   from_roll_pitch_yaw(random.uniform(-3, 3), random.uniform(-1, 1), random.uniform(-3, 3))};
    model.joints.push_back(bend);
    q.push_back(random.uniform(-3, 3));
  }
  Kinematics kinematics(model);
  kinematics.update(q);
  const Quat& last = kinematics.link(max_joints).orientation;
  CHECK(std::abs(last[0] * last[0] + last[1] * last[1] + last[2] * last[2] + last[3] * last[3] - 1) < 1e-13);
}

TEST_CASE("Updating and reading forward kinematics does not allocate") {
  Kinematics kinematics(tulip());
  const std::vector<double> q(14, 0.1);
  const testing::AllocationCount heap;
  kinematics.update(q);
  const Vec3 com_m = kinematics.com_m();
  const auto allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(com_m[2] != 0);
}

}  // namespace kinematics_test
