#include "control/balance/support_forces.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "control/tested_object.h"
#include "kadans/testing/allocation_count.h"

namespace support_forces_test {

using namespace kadans;
using kadans::test::TestedObject;

namespace {

constexpr double trunk_kg = 8, thigh_kg = 1, half_length_m = 0.25, half_width_m = 0.15, leg_m = 0.4;

// A trunk on four straight legs without knees, that turn about x and y at the hip.
RobotModel table() {
  RobotModel model;
  const auto link = [&](const std::string& name, double mass_kg, double com_z_m) {
    Link made;
    made.name = name;
    made.inertia = {.mass_kg = mass_kg, .com_m = {0, 0, com_z_m}, .xx = 0.01, .yy = 0.01, .zz = 0.01};
    model.links.push_back(made);
  };
  link("trunk", trunk_kg, 0);
  for (const double x : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) {
      const std::string name = std::string(x > 0 ? "f" : "r") + (y > 0 ? "l" : "r");
      for (const bool roll : {true, false}) {
        Joint joint;
        joint.name = name + (roll ? "_roll" : "_pitch");
        joint.parent = roll ? 0 : model.links.size() - 1;
        if (roll) joint.origin.position_m = {x * half_length_m, y * half_width_m, 0};
        joint.axis = roll ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        joint.lower_rad = -2;
        joint.upper_rad = 2;
        joint.effort_max_Nm = 60;
        joint.velocity_max_rad_s = 10;
        model.joints.push_back(joint);
        link(roll ? name + "_hip" : name, roll ? 0 : thigh_kg, roll ? 0 : -leg_m / 2);
      }
    }
  }
  return model;
}

const ObjectOptions feet{{{"feet", "fl fr rl rr"}}};
const std::vector<std::size_t> all{0, 1, 2, 3, 4, 5, 6, 7};
const double weight_N = 9.81 * (trunk_kg + 4 * thigh_kg);
const double com_over_feet_m = leg_m - 4 * thigh_kg * leg_m / 2 / (trunk_kg + 4 * thigh_kg);

struct Bench : TestedObject {
  Bench() {
    declare(object, 8);
    for (const std::string foot : {"fl", "fr", "rl", "rr"}) set(foot + ".z_m", -leg_m);
    set("share", 1);
  }
  void settle() {
    object.start(input());
    for (int i = 0; i < 300; ++i) object.step(input(), computed);
  }
  double on(const std::string& foot) { return signal(foot + ".force_z_N"); }

  RobotModel model = table();
  SupportForces object{{.model = model, .joints = all, .options = feet}};
};

Vec3 moment(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

TEST_CASE("Forces at four points make the force and the moment that are asked of them, and none pulls") {
  const std::array<Vec3, 4> points_m{
      {{0.2, 0.1, -0.3}, {0.25, -0.15, -0.31}, {-0.2, 0.12, -0.3}, {-0.22, -0.1, -0.28}}};
  const Vec3 force_N{8, -5, 120}, moment_Nm{3, -4, 1};
  std::array<Vec3, 4> forces_N{};
  distribute(points_m, force_N, moment_Nm, 1, forces_N);
  Vec3 sum_N{}, turns_Nm{};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(forces_N[i][2] > 0);
    const Vec3 turn = moment(points_m[i], forces_N[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      sum_N[k] += forces_N[i][k];
      turns_Nm[k] += turn[k];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(sum_N[k] == doctest::Approx(force_N[k]).epsilon(1e-3));
    CHECK(turns_Nm[k] == doctest::Approx(moment_Nm[k]).epsilon(1e-3));
  }
}

TEST_CASE("A foot that would have to pull bears nothing, and none slips out of its cone") {
  const std::array<Vec3, 4> points_m{{{0.2, 0.1, -0.3}, {0.2, -0.1, -0.3}, {-0.2, 0.1, -0.3}, {-0.2, -0.1, -0.3}}};
  std::array<Vec3, 4> forces_N{};
  distribute(points_m, {60, 0, 100}, {0, -18, 0}, 0.4, forces_N);  // as when its front feet alone could hold it
  for (const Vec3& force : forces_N) {
    CHECK(force[2] >= 0);
    CHECK(std::hypot(force[0], force[1]) <= 0.4 * force[2] + 1e-9);
  }
  distribute(points_m, {0, 0, 100}, {0, -30, 0}, 0.4, forces_N);
  CHECK(forces_N[0][2] + forces_N[1][2] > 90);
  CHECK(forces_N[2][2] == 0);
  CHECK(forces_N[3][2] == 0);
}

TEST_CASE("Each foot bears a quarter of the weight of a robot that stands level") {
  Bench bench;
  bench.settle();
  for (const char* foot : {"fl", "fr", "rl", "rr"})
    CHECK(bench.on(foot) == doctest::Approx(weight_N / 4).epsilon(1e-3));
  for (std::size_t joint = 0; joint < 8; ++joint) CHECK(std::abs(bench.effort_Nm(joint)) < 0.02);  // legs hang straight
}

TEST_CASE("The feet press where the robot is going, and the force pushes it back") {
  Bench bench;
  bench.set("pull", 2);
  bench.status.base.angular_velocity_rad_s = {0, 0.2, 0};  // it turns forward over its feet
  bench.settle();
  const double velocity_m_s = 0.2 * com_over_feet_m;
  const double dcm_m = velocity_m_s * std::sqrt(com_over_feet_m / 9.81);
  CHECK(bench.signal("dcm_x_m") == doctest::Approx(dcm_m).epsilon(1e-3));
  CHECK(bench.signal("cop_x_m") == doctest::Approx(2 * dcm_m).epsilon(1e-3));
  CHECK(bench.signal("force_x_N") == doctest::Approx(-weight_N * 2 * dcm_m / com_over_feet_m).epsilon(1e-3));
  CHECK(bench.on("fl") > bench.on("rl"));
  CHECK(bench.effort_Nm(1) < 0);  // a hip about y that pushes its foot forward
}

TEST_CASE("A leaning trunk is righted by the feet on the side to which it leans") {
  Bench bench;
  bench.set("pull", 0);
  bench.set("level_Nm_per_rad", 200);
  bench.status.base.roll_rad = 0.05;  // to the right
  bench.settle();
  CHECK(bench.signal("turn_x_Nm") == doctest::Approx(-10));
  CHECK(bench.on("fr") > bench.on("fl"));
  bench.set("share", 0);
  bench.settle();
  for (std::size_t joint = 0; joint < 8; ++joint) CHECK(bench.effort_Nm(joint) == 0);
}

TEST_CASE("SupportForces gives no torque when something is not measured, and never more than nine tenths") {
  Bench bench;
  bench.set("level_Nm_per_rad", 5000);
  bench.status.base.roll_rad = 0.4;
  bench.settle();
  for (std::size_t joint = 0; joint < 8; ++joint) CHECK(std::abs(bench.effort_Nm(joint)) <= 0.9 * 60);
  bench.joints.joints[3].position_rad = std::numeric_limits<double>::quiet_NaN();
  bench.object.step(bench.input(), bench.computed);
  for (std::size_t joint = 0; joint < 8; ++joint) CHECK(bench.effort_Nm(joint) == 0);
}

TEST_CASE("SupportForces does not allocate") {
  Bench bench;
  const ControlInput input = bench.input();
  const kadans::testing::AllocationCount heap;
  bench.object.start(input);
  bench.object.step(input, bench.computed);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

TEST_CASE("SupportForces says which of its feet are wrong") {
  const RobotModel model = table();
  const auto with = [&](const char* names) {
    return SupportForces({.model = model, .joints = all, .options = ObjectOptions{{{"feet", names}}}});
  };
  CHECK_THROWS_WITH_AS(SupportForces({.model = model, .joints = all}),
                       "it needs the option 'feet': the links that stand", OptionError);
  CHECK_THROWS_WITH_AS(with("fl fr"), "2 feet are named, 3 to 8 are needed; a robot on two has the type stance",
                       OptionError);
  CHECK_THROWS_WITH_AS(with("fl fr rl trunk"), "'trunk' is the base: no leg leads to it", OptionError);
  CHECK_THROWS_WITH_AS(with("fl fr rl fl"), "'fl' is named twice", OptionError);
  CHECK_THROWS_AS(with("fl fr rl rq"), OptionError);
  CHECK_THROWS_WITH_AS(SupportForces({.model = model, .joints = all, .options = ObjectOptions{{{"feet", "fl fr rl"}}}}),
                       "joint rr_roll has no part in support: no foot hangs on it", std::invalid_argument);
}

}  // namespace support_forces_test
