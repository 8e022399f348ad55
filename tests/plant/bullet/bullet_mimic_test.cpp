// Joints that mimic another one: what the leader's motor gives moves both, and they stay together.
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <doctest/doctest.h>

#include "kadans/model/dynamics.h"
#include "kadans/plant/ideal_world.h"
#include "kadans/testing/allocation_count.h"
#include "plant/small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace bullet_mimic_test {
namespace {

constexpr double finger_kg = 0.3, thumb_kg = 0.5, ratio = -0.5, offset_m = 0.01;

// A palm with a finger and a thumb that slide along x; the thumb goes half as far the other way.
Robot gripper(ContactSolver solver) {
  Robot robot;
  Link palm, finger, thumb;
  palm.name = "palm", finger.name = "finger", thumb.name = "thumb";
  palm.inertia = {.mass_kg = 1, .xx = 0.1, .yy = 0.1, .zz = 0.1};
  finger.inertia = {.mass_kg = finger_kg, .xx = 1e-3, .yy = 1e-3, .zz = 1e-3};
  thumb.inertia = {.mass_kg = thumb_kg, .xx = 1e-3, .yy = 1e-3, .zz = 1e-3};
  robot.model.links = {palm, finger, thumb};
  Joint slide{.name = "slide", .type = JointType::prismatic, .lower_rad = -1, .upper_rad = 1, .effort_max_Nm = 10};
  Joint follow{.name = "follow", .type = JointType::prismatic, .lower_rad = -1, .upper_rad = 1};
  slide.origin.position_m = {0, 0.1, 0};
  follow.origin.position_m = {0, -0.1, 0};
  follow.mimic = Mimic{0, ratio, offset_m};
  robot.model.joints = {slide, follow};
  robot.settings.drives.resize(2);
  robot.settings.drives[0].torque_max_Nm = 10;
  robot.settings.encoders.resize(2);
  robot.settings.position_rad.resize(2);
  robot.settings.gravity_m_s2 = {0, 0, 0};
  robot.settings.fixed_base = true;
  robot.settings.solver = solver;
  robot.settings.solver_iterations = 300;
  return robot;
}

double apart(const auto& plant, const Mimic& mimic, std::size_t joint) {
  const auto& at = plant.truth().position_rad;
  return at[joint] - mimic.multiplier * at[mimic.joint] - mimic.offset;
}

TEST_CASE("Joints on two branches that are tied move as one mass, with either solver") {
  for (const ContactSolver solver : {ContactSolver::tree, ContactSolver::stock}) {
    const Robot robot = gripper(solver);
    BulletWorld plant(robot.model, robot.settings, 1);
    CHECK(plant.truth().position_rad[1] == doctest::Approx(offset_m));  // led there at the start
    plant.write(both({.effort_Nm = 0.4, .mode = ActuationMode::effort}, {}));
    run(plant, 100);
    const double velocity = 0.1 * 0.4 / (finger_kg + ratio * ratio * thumb_kg);
    CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(velocity).epsilon(1e-4));
    CHECK(plant.truth().velocity_rad_s[1] == doctest::Approx(ratio * velocity).epsilon(1e-4));
    CHECK(std::abs(apart(plant, *robot.model.joints[1].mimic, 1)) < 1e-6);
  }
}

TEST_CASE("A follower's end stop stops its leader") {
  Robot robot = gripper(ContactSolver::tree);
  robot.model.joints[1].lower_rad = -0.04;  // at 0.1 of the leader
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(both({.effort_Nm = 1, .mode = ActuationMode::effort}, {}));
  run(plant, 2000);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.1).epsilon(0.01));
  CHECK(std::abs(plant.truth().velocity_rad_s[0]) < 1e-3);
  CHECK(std::abs(apart(plant, *robot.model.joints[1].mimic, 1)) < 1e-4);
}

// M of all joints with q = T u: u'' = (T' M T)^-1 T' (tau - h), for the base's six and the leader.
TEST_CASE("A free robot with tied joints on one path accelerates as its equations with one joint less say") {
  Robot robot = tumbling_chain();
  robot.model.joints[1].mimic = Mimic{0, 0.7, 0};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(both({.effort_Nm = 0.8, .mode = ActuationMode::effort}, {}));
  plant.step(ms);  // from rest
  Dynamics dynamics(robot.model, {.base = Dynamics::Base::floating, .gravity_m_s2 = {0, 0, 0}});
  const std::vector<double> zero(2, 0.0);
  dynamics.update(zero, zero, {.pose = {.position_m = {0, 0, 5}}});
  const Eigen::MatrixXd& all = dynamics.mass_matrix();
  Eigen::MatrixXd tie = Eigen::MatrixXd::Zero(8, 7);
  tie.topLeftCorner(7, 7).setIdentity();
  tie(7, 6) = 0.7;
  Eigen::VectorXd effort = Eigen::VectorXd::Zero(8);
  effort[6] = 0.8;
  const Eigen::VectorXd change = 1e-3 * (tie.transpose() * all * tie).ldlt().solve(tie.transpose() * effort);
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(change[6]).epsilon(1e-5));
  CHECK(plant.truth().velocity_rad_s[1] == doctest::Approx(0.7 * change[6]).epsilon(1e-5));
}

TEST_CASE("Tied joints stay together through a long tumble, and nothing is allocated") {
  Robot robot = tumbling_chain();
  robot.model.joints[1].mimic = Mimic{0, -1.3, 0.2};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(both({.effort_Nm = 0.8, .mode = ActuationMode::effort}, {}));
  run(plant, 300);
  plant.write(both({}, {}));
  double worst = 0;
  const testing::AllocationCount heap;
  for (int i = 0; i < 3000; ++i) {
    plant.step(ms);
    worst = std::max(worst, std::abs(apart(plant, *robot.model.joints[1].mimic, 1)));
  }
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(std::abs(plant.truth().velocity_rad_s[0]) > 0.5);  // it tumbles
  CHECK(worst < 1e-4);
}

TEST_CASE("In the ideal plant a joint that mimics follows as well") {
  const Robot robot = gripper(ContactSolver::tree);
  IdealWorld plant(robot.model, robot.settings);
  plant.write(both({.position_rad = 0.3, .mode = ActuationMode::position}, {}));
  plant.step(ms);
  CHECK(plant.truth().position_rad[1] == doctest::Approx(0.3 * ratio + offset_m));
}

}  // namespace
}  // namespace bullet_mimic_test
