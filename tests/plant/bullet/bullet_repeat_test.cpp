#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "plant/small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

Robot falling_arm() {
  Robot robot = pendulum(1, 0.2, 0.06);
  robot.settings.fixed_base = false;
  robot.settings.gravity_m_s2 = {0, 0, -g};
  robot.settings.base.position_m = {0, 0, 0};
  robot.model.links[0].collisions.push_back({"base", "base", {}, Box{{0.1, 0.1, 0.1}}});
  robot.model.links[1].collisions.push_back({"arm", "arm", {{0, 0, -0.3}, {1, 0, 0, 0}}, Sphere{0.05}});
  robot.settings.drives = {{.torque_max_Nm = 3, .rotor_inertia_kg_m2 = 0.01, .spring_Nm_per_rad = 100}};
  robot.settings.position_rad = {1.2};
  robot.settings.encoders = {{.resolution_rad = 1e-4, .noise_rad = 1e-3}};
  robot.settings.imu.accelerometer_noise_m_s2 = 0.1;
  return robot;
}

std::uint64_t tumble(std::uint64_t seed) {
  Robot robot = falling_arm();
  BulletWorld plant(robot.model, robot.settings, seed);
  SensorFrame sensors;
  StateHash hash;
  for (int i = 0; i < 2000; ++i) {
    plant.read(sensors);
    plant.write(effort(-2 * sensors.joints[0].position_rad));
    plant.step(ms);
    plant.hash(hash);
  }
  return hash.value();
}

}  // namespace

TEST_CASE("The same seed repeats bit for bit in one process, another seed does not") {
  const std::uint64_t first = tumble(1);
  CHECK(tumble(1) == first);
  CHECK(tumble(2) != first);
}

TEST_CASE("Two plants stepped in turns do not disturb each other") {
  Robot robot = falling_arm();
  BulletWorld alone(robot.model, robot.settings, 1), a(robot.model, robot.settings, 1),
      b(robot.model, robot.settings, 2);
  run(alone, 500);
  for (int i = 0; i < 500; ++i) {
    b.step(ms);
    a.step(ms);
  }
  CHECK(state_hash(a) == state_hash(alone));
  CHECK(state_hash(b) != state_hash(alone));
}

TEST_CASE("An actuation that is not finite is as good as off") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.gravity_m_s2 = {0, 0, -g};
  robot.settings.position_rad = {1};
  robot.settings.drives = {{.torque_max_Nm = 5, .position_gain_Nm_per_rad = 100, .velocity_gain_Nms_per_rad = 5}};
  BulletWorld off(robot.model, robot.settings, 1);
  run(off, 200);
  for (const ActuationFrame& bad : {effort(nan), effort(infinite), position(nan), velocity(-infinite)}) {
    BulletWorld plant(robot.model, robot.settings, 1);
    plant.write(effort(3));
    plant.write(bad);
    run(plant, 200);
    CHECK(state_hash(plant) == state_hash(off));
  }
}

TEST_CASE("A frame with fewer joints than the robot leaves the rest off") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.drives = {{.torque_max_Nm = 5}};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(3));
  plant.write(ActuationFrame{});
  run(plant, 100);
  CHECK(plant.truth().velocity_rad_s[0] == 0);
}

TEST_CASE("A state that is not finite stops the run and names where") {
  Robot robot = pendulum(1, 0.1, 0.02);
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.push(1, {1e308, 0, 0}, {0, 0, -100});
  CHECK_THROWS_WITH_AS(
      run(plant, 3),
      "the model diverges at 0.000 s: joint 'swing' moves at nan rad/s; no drive shakes it: it was pushed "
      "by more than it can bear, or the world holds it where it cannot be",
      std::runtime_error);
}

TEST_CASE("A model that diverges ends the run early, and tells a gain beyond the delay from an inertia too small") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.drives = {{.torque_max_Nm = 1e9}};
  BulletWorld plant(robot.model, robot.settings, 1);
  double asked_Nm = 0.1, fastest = 0;
  const auto shaken = [&] {
    for (int i = 0; i < 1000; ++i) {
      plant.write(effort(asked_Nm));
      plant.step(ms);
      const double velocity = plant.truth().velocity_rad_s[0];
      fastest = std::max(fastest, std::abs(velocity));
      asked_Nm = -60 * velocity;  // three times the inertia in a step
    }
  };
  CHECK_THROWS_WITH(shaken(),
                    doctest::Contains("its gain is too high for its delay and for its inertia of 0.02 kg m2"));
  CHECK(fastest <= 1000);

  Robot light = pendulum(1e-6, 0.01, 2e-9);
  light.settings.drives = {{.torque_max_Nm = 5}};
  BulletWorld thrown(light.model, light.settings, 1);
  thrown.write(effort(5));
  CHECK_THROWS_WITH(run(thrown, 3), doctest::Contains("the inertia of 'swing' with what it carries is 2e-09 kg m2"));
}

TEST_CASE("A step of no time changes nothing") {
  Robot robot = falling_arm();
  BulletWorld plant(robot.model, robot.settings, 1);
  const std::uint64_t before = state_hash(plant);
  plant.step(0);
  CHECK(state_hash(plant) == before);
}
