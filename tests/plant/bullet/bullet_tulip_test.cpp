#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"
#include "plant/tulip_robot.h"

using namespace kadans;
using namespace kadans::test;

namespace {

double tilt_rad(const PlantTruth& truth) {
  const Quat& q = truth.base.orientation;
  return 2 * std::asin(std::min(1.0, std::hypot(q[1], q[2])));
}

}  // namespace

TEST_CASE("TULip stands for 2 s on joint torques, with every kind of drive") {
  for (const Drives kind : {Drives::elastic, Drives::stiff_spring, Drives::rigid}) {
    CAPTURE(static_cast<int>(kind));
    const Robot robot = tulip(kind);
    BulletWorld plant(robot.model, robot.settings, 1);
    const Pose left = plant.truth().feet[0];
    JointHold hold(robot);
    double most_tilt_rad = 0;
    for (int i = 0; i < 2000; ++i) {
      hold.tick(plant);
      most_tilt_rad = std::max(most_tilt_rad, tilt_rad(plant.truth()));
    }
    const PlantTruth& truth = plant.truth();
    CHECK(most_tilt_rad < 0.12);
    CHECK(truth.base.position_m[2] > 0.8);
    CHECK(std::hypot(truth.feet[0].position_m[0] - left.position_m[0],
                     truth.feet[0].position_m[1] - left.position_m[1]) < 2e-4);
  }
}

TEST_CASE("TULip's feet creep less than 0.06 mm in 10 s of standing") {
  const Robot robot = tulip(Drives::rigid);
  BulletWorld plant(robot.model, robot.settings, 1);
  JointHold hold(robot);
  for (int i = 0; i < 1000; ++i) hold.tick(plant);
  const Vec3 at = plant.truth().feet[0].position_m;
  for (int i = 0; i < 10000; ++i) hold.tick(plant);
  const Vec3 now = plant.truth().feet[0].position_m;
  CHECK(std::hypot(now[0] - at[0], now[1] - at[1]) < 6e-5);
}

TEST_CASE("TULip's two feet carry its weight") {
  const Robot robot = tulip(Drives::rigid);
  BulletWorld plant(robot.model, robot.settings, 1);
  JointHold hold(robot);
  double sensors_N = 0, truth_N = 0;
  for (int i = 0; i < 4000; ++i) {
    hold.tick(plant);
    if (i < 3000) continue;
    for (std::size_t foot = 0; foot < 2; ++foot) {
      for (const double force_N : hold.sensors().feet[foot].force_N) sensors_N += force_N / 1000;
      truth_N += plant.truth().foot_force_N[foot][2] / 1000;
    }
  }
  CHECK(robot.model.mass_kg() == doctest::Approx(14));
  CHECK(sensors_N == doctest::Approx(14 * g).epsilon(1e-3));
  CHECK(truth_N == doctest::Approx(14 * g).epsilon(1e-3));
}

TEST_CASE("TULip stands on a box and on a ramp of 5 degrees as on the ground") {
  const double incline_rad = 5 * M_PI / 180;
  for (const bool ramp : {false, true}) {
    CAPTURE(ramp);
    Robot robot = tulip(Drives::rigid);
    WorldObject under{.name = "under", .shape = WorldBox{{1, 1, 0.3}}, .pose = {{0, 0, 0.15}, {1, 0, 0, 0}}};
    if (ramp) {
      under = {.name = "under", .shape = WorldRamp{2, 1, incline_rad}, .pose = {{-1, 0, 0}, {1, 0, 0, 0}}};
      for (std::size_t i = 0; i < robot.model.joints.size(); ++i) {  // toes up, so that the soles lie on it
        if (robot.model.joints[i].name.ends_with("ankle_pitch")) robot.settings.position_rad[i] -= incline_rad;
      }
    }
    robot.settings.world.objects = {under};
    BulletWorld plant(robot.model, robot.settings, 1);
    JointHold hold(robot);
    for (int i = 0; i < 2000; ++i) hold.tick(plant);
    const Vec3 at = plant.truth().feet[0].position_m;
    double weight_N = 0;
    for (int i = 0; i < 4000; ++i) {
      hold.tick(plant);
      for (std::size_t foot = 0; foot < 2; ++foot) weight_N += plant.truth().foot_force_N[foot][2] / 4000;
    }
    const Vec3 now = plant.truth().feet[0].position_m;
    CHECK(weight_N == doctest::Approx(14 * g).epsilon(1e-3));
    CHECK(std::hypot(now[0] - at[0], now[1] - at[1], now[2] - at[2]) < 6e-5);
    CHECK(plant.truth().touching_links.count() == 2);
    CHECK(plant.truth().objects[0].links == plant.truth().touching_links);
    CHECK(plant.truth().self_penetration_m == 0);
  }
}

TEST_CASE(
    "TULip's hips turn about one point without colliding, and its joints stay within their limits when it falls") {
  const Robot robot = tulip(Drives::elastic);
  BulletWorld plant(robot.model, robot.settings, 1);
  double worst_rad = 0;
  for (int i = 0; i < 3000; ++i) {
    plant.step(ms);  // no torque: it collapses
    for (std::size_t j = 0; j < robot.model.joints.size(); ++j) {
      const double at_rad = plant.truth().position_rad[j];
      worst_rad =
          std::max({worst_rad, robot.model.joints[j].lower_rad - at_rad, at_rad - robot.model.joints[j].upper_rad});
    }
  }
  CHECK(plant.truth().base.position_m[2] < 0.4);
  CHECK(worst_rad < 0.02);
}

TEST_CASE("TULip falls the same way twice") {
  const Robot robot = tulip(Drives::elastic);
  BulletWorld first(robot.model, robot.settings, 1), second(robot.model, robot.settings, 1);
  run(first, 3000);
  run(second, 3000);
  CHECK(state_hash(first) == state_hash(second));
}

TEST_CASE("A standing TULip's plant allocates nothing, neither in read and write nor in a step") {
  const Robot robot = tulip(Drives::elastic);
  BulletWorld plant(robot.model, robot.settings, 1);
  JointHold hold(robot);
  for (int i = 0; i < 1000; ++i) hold.tick(plant);
  const testing::AllocationCount heap;
  for (int i = 0; i < 1000; ++i) hold.tick(plant);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}
