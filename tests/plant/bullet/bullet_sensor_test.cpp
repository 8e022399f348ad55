#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "plant/small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

struct Spread {
  double mean = 0, deviation = 0;
};

template <typename Reading>
Spread spread(BulletWorld& plant, int steps, Reading reading) {
  SensorFrame sensors;
  std::vector<double> values;
  for (int i = 0; i < steps; ++i) {
    plant.step(ms);
    plant.read(sensors);
    values.push_back(reading(sensors));
  }
  Spread result;
  for (const double value : values) result.mean += value / steps;
  for (const double value : values) result.deviation += (value - result.mean) * (value - result.mean) / steps;
  result.deviation = std::sqrt(result.deviation);
  return result;
}

}  // namespace

TEST_CASE("An encoder reads in whole counts and its noise has the deviation set") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.position_rad = {0.12345};
  robot.settings.encoders = {{.resolution_rad = 0.01, .noise_rad = 0}};
  BulletWorld coarse(robot.model, robot.settings, 1);
  SensorFrame sensors;
  coarse.read(sensors);
  CHECK(sensors.joints[0].position_rad == doctest::Approx(0.12).epsilon(1e-12));
  robot.settings.encoders = {{.resolution_rad = 0, .noise_rad = 0.02}};
  BulletWorld noisy(robot.model, robot.settings, 1);
  const Spread position = spread(noisy, 4000, [](const SensorFrame& s) { return s.joints[0].position_rad; });
  CHECK(position.mean == doctest::Approx(0.12345).epsilon(0.02));
  CHECK(position.deviation == doctest::Approx(0.02).epsilon(0.05));
}

TEST_CASE("Every step is a new reading, and reading twice is not") {
  Robot robot = pendulum(1, 0.1, 0.02);
  BulletWorld plant(robot.model, robot.settings, 1);
  SensorFrame first, second, third;
  plant.read(first);
  plant.read(second);
  plant.step(ms);
  plant.read(third);
  CHECK(first.joints[0].sequence == second.joints[0].sequence);
  CHECK(third.joints[0].sequence == second.joints[0].sequence + 1);
  CHECK(third.imu.sequence == second.imu.sequence + 1);
  CHECK(third.time_ns == second.time_ns + ms);
}

TEST_CASE("At rest the IMU feels gravity upwards, in its own axes, in free fall nothing") {
  Robot robot = box(2, {0.2, 0.2, 0.2});
  robot.settings.imu.pose.orientation = {std::sqrt(0.5), 0, std::sqrt(0.5), 0};  // its z along the body's x
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 300);
  SensorFrame sensors;
  plant.read(sensors);
  CHECK(sensors.imu.acceleration_m_s2[0] == doctest::Approx(-g).epsilon(1e-3));
  CHECK(std::abs(sensors.imu.acceleration_m_s2[2]) < 0.05);

  robot.settings.stand_on_ground = false;
  robot.settings.base.position_m = {0, 0, 10};
  BulletWorld falling(robot.model, robot.settings, 1);
  run(falling, 100);
  falling.read(sensors);
  for (const double component : sensors.imu.acceleration_m_s2) CHECK(std::abs(component) < 1e-6);
}

TEST_CASE("Off the axis a turning IMU feels the centripetal acceleration") {
  Robot robot = box(2, {0.2, 0.2, 0.2});
  robot.settings.gravity_m_s2 = {0, 0, 0};
  robot.settings.stand_on_ground = false;
  robot.settings.base.position_m = {0, 0, 5};
  robot.settings.imu.pose.position_m = {0.3, 0, 0};
  BulletWorld plant(robot.model, robot.settings, 1);
  const double inertia_kg_m2 = 2 * 0.08 / 12;
  plant.push(0, {0, 10, 0}, {1, 0, 0});
  plant.push(0, {0, -10, 0}, {0, 0, 0});
  run(plant, 200);
  const double rate = 10 * 1e-3 / inertia_kg_m2;
  SensorFrame sensors;
  plant.read(sensors);
  CHECK(sensors.imu.angular_velocity_rad_s[2] == doctest::Approx(rate).epsilon(1e-3));
  CHECK(sensors.imu.acceleration_m_s2[0] == doctest::Approx(-rate * rate * 0.3).epsilon(0.01));
}

TEST_CASE("An impact is in the IMU's acceleration") {
  Robot robot = box(2, {0.2, 0.2, 0.2});
  robot.settings.stand_on_ground = false;
  robot.settings.base.position_m = {0, 0, 0.6};
  BulletWorld plant(robot.model, robot.settings, 1);
  SensorFrame sensors;
  double largest = 0, sum = 0;
  for (int i = 0; i < 500; ++i) {
    plant.step(ms);
    plant.read(sensors);
    largest = std::max(largest, sensors.imu.acceleration_m_s2[2]);
    sum += 1e-3 * sensors.imu.acceleration_m_s2[2];
  }
  CHECK(largest > 1000);                                 // 3.1 m/s taken away in two or three steps
  CHECK(sum == doctest::Approx(g * 0.5).epsilon(0.01));  // at rest before and after: all of it is gravity's impulse
}

TEST_CASE("IMU noise has the deviation set, and its bias is drawn once a run") {
  Robot robot = box(2, {0.2, 0.2, 0.2});
  robot.settings.imu.gyro_noise_rad_s = 0.01;
  robot.settings.imu.gyro_bias_rad_s = 0.1;
  BulletWorld plant(robot.model, robot.settings, 7);
  const auto rate = [](const SensorFrame& s) { return s.imu.angular_velocity_rad_s[0]; };
  const Spread early = spread(plant, 3000, rate), late = spread(plant, 3000, rate);
  CHECK(early.deviation == doctest::Approx(0.01).epsilon(0.05));
  CHECK(std::abs(early.mean) > 0.005);
  CHECK(late.mean == doctest::Approx(early.mean).epsilon(0.05));
  BulletWorld other(robot.model, robot.settings, 8);
  CHECK(std::abs(spread(other, 3000, rate).mean - early.mean) > 0.005);
}

TEST_CASE("The four pressure sensors show where the load is") {
  Robot robot = box(2, {0.2, 0.2, 0.05});
  BulletWorld plant(robot.model, robot.settings, 1);
  for (int i = 0; i < 500; ++i) {
    plant.push(0, {0, 0, -20}, {0.08, 0, 0});
    plant.step(ms);
  }
  SensorFrame sensors;
  plant.read(sensors);
  const auto& [heel_inner, heel_outer, toe_inner, toe_outer] = sensors.feet[0].force_N;
  const double total_N = heel_inner + heel_outer + toe_inner + toe_outer;
  CHECK(total_N == doctest::Approx(2 * g + 20).epsilon(1e-3));
  const double cop_m = 0.1 * (toe_inner + toe_outer - heel_inner - heel_outer) / total_N;
  CHECK(cop_m == doctest::Approx(0.08 * 20 / total_N).epsilon(0.01));
}

TEST_CASE("Foot noise never shows a negative force") {
  Robot robot = box(2, {0.2, 0.2, 0.05});
  robot.settings.feet[0].noise_N = 20;
  BulletWorld plant(robot.model, robot.settings, 1);
  SensorFrame sensors;
  double least_N = 1, most_N = 0;
  for (int i = 0; i < 500; ++i) {
    plant.step(ms);
    plant.read(sensors);
    for (const double force_N : sensors.feet[0].force_N) {
      least_N = std::min(least_N, force_N);
      most_N = std::max(most_N, force_N);
    }
  }
  CHECK(least_N == 0);
  CHECK(most_N > 30);
}
