// Leaning, falling, lying, getting up.
#include <doctest/doctest.h>

#include "bench.h"
#include "safety/detection.h"

namespace fall_test {

using namespace kadans;
using namespace kadans::safety_bench;
using Phase = FallWatch::Phase;

namespace {

void lean(Bench& bench, double pitch_rad) {
  bench.base.pitch_rad = pitch_rad;
  bench.base.tilt_rad = std::abs(pitch_rad);
}

void turn(Bench& bench, double rate_rad_s) { bench.base.angular_velocity_rad_s = {0, rate_rad_s, 0}; }

Bench fallen() {
  Bench bench;
  lean(bench, 1.5);
  bench.check_for(0.7);
  return bench;
}

}  // namespace

TEST_CASE("A robot that leans too far is reported, and keeps its torque") {
  Bench bench;
  lean(bench, 0.61);
  bench.check();
  CHECK(bench.codes() == "tilt");
  CHECK(bench.status.level == SafetyLevel::limited);
  CHECK(bench.written.joints[0].effort_Nm == 5);
}

TEST_CASE("A robot beyond 60 degrees of roll, 45 of pitch or 7 rad/s for 40 ms falls") {
  const auto ticks = [](auto&& spoil) {
    Bench bench;
    bench.check();
    spoil(bench);
    return bench.ticks_until(FaultCode::fall, 100);
  };
  const int promised = static_cast<int>(detection_ticks(FaultCode::fall, settings(), dt_s));
  for (const int seen : {ticks([](Bench& b) { b.base.roll_rad = -1.05; }), ticks([](Bench& b) { lean(b, 0.79); }),
                         ticks([](Bench& b) { turn(b, 7.1); })}) {
    CHECK(seen >= 40);
    CHECK(seen <= promised);
  }
  CHECK(ticks([](Bench& b) { lean(b, 0.78); }) == 0);
  CHECK(ticks([](Bench& b) { turn(b, 6.9); }) == 0);
}

TEST_CASE("A stumble shorter than 40 ms is no fall") {
  Bench bench;
  turn(bench, 8);
  bench.check_for(0.03);
  turn(bench, 0);
  bench.check_for(0.1);
  CHECK(bench.count(FaultCode::fall) == 0);
}

TEST_CASE("On the way down joints are soft, and when the robot lies still their torque comes back over recover_s") {
  Bench bench;
  bench.check();
  lean(bench, 1.0);
  turn(bench, 2);
  bench.check_for(0.1);
  CHECK(bench.safety->fall_phase() == Phase::falling);
  CHECK(bench.written.joints[0].effort_Nm == doctest::Approx(0.25 * 5));
  CHECK(bench.status.level == SafetyLevel::limited);
  turn(bench, 0.1);
  bench.check_for(0.45);
  CHECK(bench.safety->fall_phase() == Phase::falling);
  bench.check_for(0.1);
  CHECK(bench.safety->fall_phase() == Phase::fallen);
  CHECK(bench.written.joints[0].effort_Nm < 0.4 * 5);
  bench.check_for(0.1);
  CHECK(bench.written.joints[0].effort_Nm > 0.4 * 5);
  CHECK(bench.written.joints[0].effort_Nm < 0.6 * 5);
  bench.check_for(0.3);
  CHECK(bench.written.joints[0].effort_Nm == 5);
  CHECK(bench.status.level == SafetyLevel::normal);  // it lies; that is known
}

TEST_CASE("A drive in position mode damps on the way down") {
  Bench bench;
  bench.asked.joints[0] = {.position_rad = 1.2, .mode = ActuationMode::position};
  bench.place(1, 2);
  lean(bench, 1.0);
  turn(bench, 2);
  bench.check_for(0.1);
  CHECK(bench.written.joints[0].mode == ActuationMode::effort);
  CHECK(bench.written.joints[0].effort_Nm == doctest::Approx(-4));
  CHECK(!bench.safety->came_back());
  turn(bench, 0);
  int ticks = 0;
  while (!bench.safety->came_back() && ++ticks < 2000) bench.check();
  CHECK(ticks == doctest::Approx(500 + 375).epsilon(0.01));      // it lies, then torque comes back from a quarter
  CHECK(bench.written.joints[0].mode == ActuationMode::effort);  // what is asked is still from before the fall
  CHECK(bench.check().mode == ActuationMode::position);
}

TEST_CASE("A fall that is configured to damp damps") {
  SafetySettings limp = settings();
  limp.reactions[static_cast<std::size_t>(FaultCode::fall)] = {.robot = SafetyLevel::damp};
  Bench bench(limp);
  bench.place(1, 2);
  lean(bench, 1.0);
  bench.check_for(0.1);
  CHECK(bench.written.joints[0].effort_Nm == doctest::Approx(-4));
}

TEST_CASE("The largest impact of a fall is recorded, and a hard one is a fault") {
  Bench bench;
  lean(bench, 1.0);
  turn(bench, 2);
  bench.check_for(0.1);
  CHECK(bench.count(FaultCode::impact) == 0);
  bench.sensors.imu.acceleration_m_s2 = {0, 150, 0};
  bench.check();
  bench.sensors.imu.acceleration_m_s2 = {0, 20, 0};
  bench.check_for(0.01);
  CHECK(bench.count(FaultCode::impact) == 1);
  CHECK(bench.faults.back().value == doctest::Approx(150));
}

TEST_CASE("A fallen robot may get up through any attitude, and stands when it is well within the limits") {
  Bench bench = fallen();
  CHECK(bench.safety->fall_phase() == Phase::fallen);
  lean(bench, 0.9);
  turn(bench, 3);
  bench.check_for(0.3);
  CHECK(bench.safety->fall_phase() == Phase::fallen);
  lean(bench, 0.2);
  turn(bench, 0);
  bench.check_for(0.52);
  CHECK(bench.safety->fall_phase() == Phase::upright);
}

TEST_CASE("A fallen robot that is thrown falls again, and clearing faults does not make it stand") {
  Bench bench = fallen();
  bench.safety->clear();
  bench.check_for(0.1);
  CHECK(bench.safety->fall_phase() == Phase::fallen);
  CHECK(bench.status.level == SafetyLevel::normal);
  turn(bench, 7.5);
  bench.check();
  CHECK(bench.safety->fall_phase() == Phase::falling);
}

}  // namespace fall_test
