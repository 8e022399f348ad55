#include "scenario/simulated_perception.h"

#include <cmath>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"

namespace simulated_perception_test {

using namespace kadans;

namespace {

constexpr std::int64_t tick_ns = 1'000'000;

PlantTruth robot_and_ball(double x_m, double y_m, double yaw_rad) {
  PlantTruth truth;
  truth.base = {{1, 2, 0.8}, from_roll_pitch_yaw(0.05, 0.1, yaw_rad)};
  truth.object_count = 1;
  truth.objects[0].pose.position_m = {1 + x_m, 2 + y_m, 0.1};
  return truth;
}

const SightSettings exact{.rate_Hz = 20,
                          .latency_s = 0.1,
                          .distance_noise = 0,
                          .bearing_noise_rad = 0,
                          .missed = 0,
                          .view_rad = 2,
                          .far_m = 6};

}  // namespace

TEST_CASE("SimulatedSight says where the ball was when the picture was taken, as late as it is") {
  SimulatedSight sight(exact, 0, 1);
  const PlantTruth truth = robot_and_ball(0, 2, M_PI / 2);  // straight ahead of a robot that looks along y
  for (std::int64_t tick = 0; tick < 100; ++tick) CHECK(sight.at(tick * tick_ns, truth).confidence == 0);
  const SeenBall seen = sight.at(100 * tick_ns, truth);
  CHECK(seen.time_ns == 0);
  CHECK(seen.x_m == doctest::Approx(2));
  CHECK(seen.y_m == doctest::Approx(0).scale(1));
  CHECK(seen.confidence > 0.5);
  for (std::int64_t tick = 101; tick < 150; ++tick) CHECK(sight.at(tick * tick_ns, truth).time_ns == 0);
  CHECK(sight.at(150 * tick_ns, truth).time_ns == 50 * tick_ns);
}

TEST_CASE("SimulatedSight sees nothing behind the robot or too far, and then keeps what it saw") {
  for (const double x_m : {-1.0, 7.0}) {
    SimulatedSight sight(exact, 0, 1);
    const PlantTruth near = robot_and_ball(1, 0, 0), away = robot_and_ball(x_m, 0, 0);
    (void)sight.at(0, near);
    SeenBall seen;
    for (std::int64_t tick = 1; tick < 1000; ++tick) seen = sight.at(tick * tick_ns, away);
    CHECK(seen.time_ns == 0);
    CHECK(seen.x_m == doctest::Approx(1));
  }
}

TEST_CASE("SimulatedSight is off by its noise and misses its share, the same with the same seed") {
  SightSettings settings = exact;
  settings.distance_noise = 0.05;
  settings.bearing_noise_rad = 0.02;
  settings.missed = 0.25;
  settings.latency_s = 0;
  SimulatedSight sight(settings, 0, 7), again(settings, 0, 7);
  const PlantTruth truth = robot_and_ball(2, 0, 0);
  double distance2 = 0, bearing2 = 0;
  int pictures = 0;
  std::int64_t last_ns = -1;
  for (std::int64_t tick = 0; tick < 200'000; ++tick) {
    const SeenBall seen = sight.at(tick * tick_ns, truth);
    const SeenBall same = again.at(tick * tick_ns, truth);
    if (seen.confidence == 0 || seen.time_ns == last_ns) continue;
    REQUIRE(same.x_m == seen.x_m);
    last_ns = seen.time_ns;
    ++pictures;
    distance2 += std::pow(std::hypot(seen.x_m, seen.y_m) / 2 - 1, 2);
    bearing2 += std::pow(std::atan2(seen.y_m, seen.x_m), 2);
  }
  CHECK(pictures == doctest::Approx(0.75 * 4000).epsilon(0.03));
  CHECK(std::sqrt(distance2 / pictures) == doctest::Approx(0.05).epsilon(0.05));
  CHECK(std::sqrt(bearing2 / pictures) == doctest::Approx(0.02).epsilon(0.05));
}

}  // namespace simulated_perception_test
