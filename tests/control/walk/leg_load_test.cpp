#include <array>

#include <doctest/doctest.h>

#include "biped.h"
#include "control/balance/stance.h"
#include "kadans/testing/allocation_count.h"

using namespace kadans;
using kadans::test::biped;
using kadans::test::biped_joint;
using kadans::test::biped_link;

namespace {

constexpr Vec3 point_in_foot_m{0.1, 0.02, -0.05};

// A leg that bends in every direction: hip yaw, hip roll, hip pitch, knee, ankle.
RobotModel leg() {
  RobotModel model;
  model.links = {biped_link("torso", 10, 0),     biped_link("yaw", 0.3, 0.01),    biped_link("roll", 0.4, -0.02),
                 biped_link("thigh", 1.3, -0.1), biped_link("shank", 0.8, -0.12), biped_link("foot", 0.4, -0.03)};
  model.joints = {biped_joint("yaw", 0, {0, 0.1, -0.2}, {0, 0, 1}), biped_joint("roll", 1, {}, {1, 0, 0}),
                  biped_joint("pitch", 2, {}), biped_joint("knee", 3, {0, 0, -0.3}),
                  biped_joint("ankle", 4, {0, 0, -0.3})};
  return model;
}

using Angles = std::array<double, 5>;
const Pose tilted{{}, from_roll_pitch_yaw(0.1, -0.2, 0)};

// Work that the ground and gravity do on the leg from one posture to another.
double work_J(const RobotModel& model, const Angles& from, const Angles& to, const Vec3& force_N) {
  Kinematics before(model), after(model);
  before.update(from, tilted);
  after.update(to, tilted);
  const Vec3 a = transform(before.link(5), point_in_foot_m), b = transform(after.link(5), point_in_foot_m);
  double work = 0;
  for (std::size_t k = 0; k < 3; ++k) work += force_N[k] * (b[k] - a[k]);
  for (std::size_t i = 1; i < model.links.size(); ++i) {
    const Inertia& inertia = model.links[i].inertia;
    const double rise_m = transform(after.link(i), inertia.com_m)[2] - transform(before.link(i), inertia.com_m)[2];
    work -= 9.81 * inertia.mass_kg * rise_m;
  }
  return work;
}

}  // namespace

TEST_CASE("LegLoad holds each joint against what the ground and gravity would do with it") {
  const RobotModel model = leg();
  const Angles bent{0.2, -0.15, -0.6, 0.9, -0.4};
  const Vec3 force_N{-20, 8, 70};
  Kinematics kinematics(model);
  kinematics.update(bent, tilted);
  LegLoad load(model, 5);
  load.update(kinematics, force_N, transform(kinematics.link(5), point_in_foot_m));

  REQUIRE(load.bearings().size() == 5);
  CHECK(load.bearings().front().joint == 4);  // the ankle
  for (const LegLoad::Bearing& bearing : load.bearings()) {
    const double step_rad = 1e-5;
    Angles back = bent, on = bent;
    back.at(bearing.joint) -= step_rad;
    on.at(bearing.joint) += step_rad;
    const double held_J = work_J(model, back, on, force_N) + 2 * step_rad * bearing.effort_Nm;
    CHECK(held_J / (2 * step_rad) == doctest::Approx(0).epsilon(1e-6));
  }
}

TEST_CASE("LegLoad bears nothing on a straight leg that is pressed right below its joints") {
  const RobotModel model = biped();
  Kinematics kinematics(model);
  LegLoad load(model, 2);
  load.update(kinematics, {0, 0, 60}, {0, 0.1, -0.75});
  for (const LegLoad::Bearing& bearing : load.bearings()) CHECK(bearing.effort_Nm == doctest::Approx(0));
  load.update(kinematics, {0, 0, 60}, {0.1, 0.1, -0.75});  // at the toes
  for (const LegLoad::Bearing& bearing : load.bearings()) CHECK(bearing.effort_Nm == doctest::Approx(6));
}

TEST_CASE("LegLoad does not allocate") {
  const RobotModel model = biped();
  Kinematics kinematics(model);
  LegLoad load(model, 2);
  const kadans::testing::AllocationCount heap;
  load.update(kinematics, {0, 0, 60}, {0, 0.1, -0.75});
  const long allocations = heap.count();
  CHECK(allocations == 0);
}
