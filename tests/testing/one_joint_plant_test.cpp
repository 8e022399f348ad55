#include "kadans/testing/one_joint_plant.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <doctest/doctest.h>

using namespace kadans;
using kadans::testing::OneJointPlant;

namespace {

constexpr std::int64_t tick_ns = 1'000'000;

ActuationFrame asked(JointActuation actuation) {
  ActuationFrame frame;
  frame.joint_count = 1;
  frame.joints[0] = actuation;
  return frame;
}
ActuationFrame effort(double effort_Nm) { return asked({.effort_Nm = effort_Nm, .mode = ActuationMode::effort}); }

void run(OneJointPlant& plant, int ticks) {
  for (int i = 0; i < ticks; ++i) plant.step(tick_ns);
}

}  // namespace

TEST_CASE("A free joint under a constant torque moves by t^2 torque / 2 inertia") {
  OneJointPlant plant({.inertia_kg_m2 = 0.3, .rotor_inertia_kg_m2 = 0.2});
  plant.write(effort(2));
  run(plant, 1000);
  CHECK(plant.state().velocity_rad_s == doctest::Approx(4.0));
  CHECK(plant.state().position_rad == doctest::Approx(2.0).epsilon(1e-4));
}

TEST_CASE("Viscous friction lets the velocity reach torque / friction with the time constant inertia / friction") {
  OneJointPlant plant({.inertia_kg_m2 = 0.1, .viscous_Nms_per_rad = 0.5});
  plant.write(effort(1));
  run(plant, 200);
  CHECK(plant.state().velocity_rad_s == doctest::Approx(2 * (1 - std::exp(-1.0))).epsilon(1e-3));
}

TEST_CASE("Coulomb friction holds the joint below its torque and takes it from what is above") {
  OneJointPlant plant({.inertia_kg_m2 = 0.1, .coulomb_Nm = 1});
  plant.write(effort(0.99));
  run(plant, 1000);
  CHECK(plant.state().position_rad == 0);
  plant.write(effort(-1.5));
  run(plant, 1000);
  CHECK(plant.state().velocity_rad_s == doctest::Approx(-5.0));
  plant.write(effort(0));
  run(plant, 2000);
  CHECK(plant.state().velocity_rad_s == 0);
}

TEST_CASE("A pendulum swings with the period of its gravity and inertia") {
  OneJointPlant plant({.inertia_kg_m2 = 0.5, .gravity_Nm = 8, .position_rad = 0.01});
  const double period_s = 2 * std::numbers::pi * std::sqrt(0.5 / 8);
  run(plant, static_cast<int>(std::lround(1000 * period_s)));
  CHECK(plant.state().position_rad == doctest::Approx(0.01).epsilon(1e-3));
  run(plant, static_cast<int>(std::lround(500 * period_s)));
  CHECK(plant.state().position_rad == doctest::Approx(-0.01).epsilon(1e-3));
}

TEST_CASE("An elastic drive lets the link swing on its spring while friction holds the rotor") {
  OneJointPlant plant(
      {.inertia_kg_m2 = 0.1, .rotor_inertia_kg_m2 = 0.02, .coulomb_Nm = 50, .load_Nm = 1, .spring_Nm_per_rad = 100});
  const double period_s = 2 * std::numbers::pi * std::sqrt(0.1 / 100);
  run(plant, static_cast<int>(std::lround(500 * period_s)));
  CHECK(plant.state().motor_position_rad == 0);
  CHECK(plant.state().position_rad == doctest::Approx(0.02).epsilon(0.01));  // twice the static deflection
}

TEST_CASE("An elastic drive gives in the long run to rotor and link the motion of their sum") {
  OneJointPlant plant(
      {.inertia_kg_m2 = 0.1, .rotor_inertia_kg_m2 = 0.1, .spring_Nm_per_rad = 3000, .spring_damping_Nms_per_rad = 5});
  plant.write(effort(2));
  run(plant, 1000);
  CHECK(plant.state().velocity_rad_s == doctest::Approx(10).epsilon(0.01));
}

TEST_CASE("An actuation acts as many steps later as the delay says, and holds") {
  for (const std::uint32_t delay : {0U, 1U, 5U, OneJointPlant::max_delay_ticks}) {
    CAPTURE(delay);
    OneJointPlant plant({.delay_ticks = delay});
    plant.write(effort(1));
    for (std::uint32_t i = 0; i < delay; ++i) {
      plant.step(tick_ns);
      REQUIRE(plant.state().torque_Nm == 0);
    }
    for (int i = 0; i < 200; ++i) {
      plant.step(tick_ns);
      REQUIRE(plant.state().torque_Nm == doctest::Approx(1));
    }
  }
}

TEST_CASE("The drive saturates and says so, its own modes reach what they are asked for") {
  OneJointPlant plant(
      {.inertia_kg_m2 = 0.1, .torque_max_Nm = 3, .position_gain_Nm_per_rad = 50, .velocity_gain_Nms_per_rad = 4});
  plant.write(effort(10));
  plant.step(tick_ns);
  CHECK(plant.state().torque_Nm == doctest::Approx(3));
  CHECK(plant.state().saturated);
  plant.write(asked({.position_rad = 0.4, .mode = ActuationMode::position}));
  run(plant, 3000);
  CHECK(plant.state().position_rad == doctest::Approx(0.4));
  CHECK_FALSE(plant.state().saturated);
  plant.write(asked({.velocity_rad_s = 1.5, .mode = ActuationMode::velocity}));
  run(plant, 1000);
  CHECK(plant.state().velocity_rad_s == doctest::Approx(1.5));
}

TEST_CASE("The encoder rounds, a push lasts one step, and what is not finite is not obeyed") {
  OneJointPlant plant({.inertia_kg_m2 = 0.1, .encoder_resolution_rad = 0.01, .position_rad = 0.034});
  SensorFrame sensors;
  plant.read(sensors);
  CHECK(sensors.joints[0].position_rad == doctest::Approx(0.03));
  plant.push(1);
  run(plant, 10);
  CHECK(plant.state().velocity_rad_s == doctest::Approx(0.01));
  plant.write(effort(std::numeric_limits<double>::quiet_NaN()));
  plant.step(tick_ns);
  CHECK(plant.state().torque_Nm == 0);
  const std::uint32_t before = sensors.joints[0].sequence;
  plant.read(sensors);
  CHECK(sensors.joints[0].sequence == before + 11);
}

TEST_CASE("A plant that cannot be is refused with key, value and range") {
  CHECK_THROWS_WITH_AS(OneJointPlant({.inertia_kg_m2 = 0}),
                       "one-joint plant: inertia_kg_m2 is 0.000000, must be in 0.000001..1000000.000000",
                       std::invalid_argument);
  CHECK_THROWS_AS(OneJointPlant({.spring_Nm_per_rad = 100}), std::invalid_argument);  // a rotor without inertia
  CHECK_THROWS_AS(OneJointPlant({.delay_ticks = 64}), std::invalid_argument);
  CHECK_THROWS_AS(OneJointPlant({.load_Nm = std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
}
