// What is left of a torque: each limit of a joint on its own.
#include <doctest/doctest.h>

#include "bench.h"

namespace joint_limiter_test {

using namespace kadans;
using namespace kadans::safety_bench;

namespace {

bool damps(const JointActuation& actuation, double velocity_rad_s) {
  return actuation.mode == ActuationMode::effort && actuation.effort_Nm == doctest::Approx(-2.0 * velocity_rad_s);
}

}  // namespace

TEST_CASE("Too much torque is limited and flagged once, and forgotten when it is over for a while") {
  Bench bench;
  bench.ask(-40);
  bench.check();
  bench.check();
  CHECK(bench.written.joints[0].effort_Nm == -25);
  CHECK(bench.status.level == SafetyLevel::limited);
  CHECK(bench.count(FaultCode::effort_limit) == 1);
  bench.ask(5);
  bench.check_for(0.04);
  CHECK(bench.written.joints[0].effort_Nm == 5);
  CHECK(bench.status.level == SafetyLevel::limited);
  bench.check_for(0.02);
  CHECK(bench.status.level == SafetyLevel::normal);
}

TEST_CASE("An actuation that is not finite makes the joint damp until faults are cleared") {
  for (const double bad : {not_a_number, std::numeric_limits<double>::infinity()}) {
    Bench bench;
    bench.check();
    bench.place(1, 3);
    bench.ask(bad);
    CHECK(damps(bench.check(), 3));
    bench.ask(5);
    CHECK(damps(bench.check(), 3));
    CHECK(bench.status.level == SafetyLevel::damp);
    CHECK(bench.codes() == "actuation_not_finite");
    bench.safety->clear();
    bench.place(1);
    bench.check();
    CHECK(bench.status.level == SafetyLevel::limited);  // its torque comes back
    bench.check_for(0.6);
    CHECK(bench.status.level == SafetyLevel::normal);
    CHECK(bench.status.fault_count == 0);
  }
  Bench bench;
  bench.asked.joints[0].velocity_rad_s = not_a_number;  // a field that the mode does not use
  CHECK(damps(bench.check(), 0));
}

TEST_CASE("Not even a configuration that shrugs lets a value be written that is not finite") {
  SafetySettings careless = settings();
  for (Reaction& reaction : careless.reactions) reaction = {};
  Bench bench(careless);
  bench.ask(not_a_number);
  bench.place(1, not_a_number);
  const JointActuation& written = bench.check();
  CHECK(std::isfinite(written.effort_Nm));
  CHECK(written.mode == ActuationMode::off);
}

TEST_CASE("A position beyond limit and margin, or NaN, makes the joint damp") {
  for (const double position_rad : {2.06, -0.06, not_a_number}) {
    Bench bench;
    bench.place(position_rad, 1);
    CHECK(damps(bench.check(), 1));
    CHECK(bench.status.first_fault.code == FaultCode::position_limit);
    CHECK(bench.status.first_fault.joint == 0);
  }
}

TEST_CASE("Towards a soft stop torque fades to none at the limit, away from it torque is free") {
  struct Row {
    double position_rad, asked_Nm, written_Nm;
  };
  const Row rows[] = {{1.96, 20, 20},   {1.985, 20, 12.5},   {2.0, 20, 0},  {1.999, -20, -20},
                      {0.04, -20, -20}, {0.015, -20, -12.5}, {0.0, -20, 0}, {0.001, 20, 20}};
  for (const Row& row : rows) {
    CAPTURE(row.position_rad);
    Bench bench;
    bench.place(row.position_rad);
    bench.ask(row.asked_Nm);
    CHECK(bench.check().effort_Nm == doctest::Approx(row.written_Nm));
    const bool cut = row.asked_Nm != row.written_Nm;
    CHECK(bench.count(FaultCode::soft_stop) == (cut ? 1 : 0));
    CHECK(bench.status.level == (cut ? SafetyLevel::limited : SafetyLevel::normal));
  }
}

TEST_CASE("A joint that rests at its limit, and is pushed into it by rounding alone, is no fault") {
  for (const double asked_Nm : {-2e-21, -0.02, -1.0}) {  // of 25
    CAPTURE(asked_Nm);
    Bench bench;
    bench.place(-1e-9);
    bench.ask(asked_Nm);
    CHECK(bench.check().effort_Nm >= 0);
    CHECK(bench.count(FaultCode::soft_stop) == (asked_Nm < -0.1 ? 1 : 0));
  }
}

TEST_CASE("Beyond a limit a spring pulls back") {
  Bench bench;
  bench.place(2.03);
  bench.ask(20);
  CHECK(bench.check().effort_Nm == doctest::Approx(-3));
  bench.ask(-10);
  CHECK(bench.check().effort_Nm == -10);  // it wants back by itself, and more
  Bench lower;
  lower.place(-0.03);
  lower.ask(-20);
  CHECK(lower.check().effort_Nm == doctest::Approx(3));
}

TEST_CASE("A velocity beyond limit and margin makes the joint damp, with no more than its torque") {
  Bench bench;
  bench.place(1, 12.5);
  CHECK(bench.check().effort_Nm == doctest::Approx(-200 / 12.5));  // the power limit
  CHECK(bench.status.first_fault.code == FaultCode::velocity_limit);
  CHECK(bench.status.first_fault.limit == doctest::Approx(12));
}

TEST_CASE("Beyond the speed limit torque that drives on fades out, torque that brakes does not") {
  SafetySettings strong = settings();
  strong.joints[0].power_max_W = 1e6;
  Bench bench(strong);
  bench.place(1, 10);  // half way from the limit to the fault
  bench.ask(20);
  CHECK(bench.check().effort_Nm == doctest::Approx(12.5));
  CHECK(bench.codes() == "soft_speed");
  bench.ask(-10);
  CHECK(bench.check().effort_Nm == -10);
}

TEST_CASE("Torque times speed stays within the power limit, driving and braking") {
  SafetySettings weak = settings();
  weak.joints[0].power_max_W = 40;
  for (const double sign : {1.0, -1.0}) {
    Bench bench(weak);
    bench.place(1, 4);
    bench.ask(20 * sign);
    CHECK(bench.check().effort_Nm == doctest::Approx(10 * sign));
    CHECK(bench.codes() == "power_limit");
    CHECK(bench.faults[0].limit == 40);
    CHECK(bench.faults[0].value == doctest::Approx(80 * sign));
  }
}

TEST_CASE("Torque changes no faster than its rate") {
  SafetySettings slow = settings();
  slow.joints[0].effort_rate_max_Nm_s = 2000;
  Bench bench(slow);
  bench.ask(7);
  CHECK(bench.check().effort_Nm == doctest::Approx(2));
  CHECK(bench.check().effort_Nm == doctest::Approx(4));
  CHECK(bench.codes() == "effort_rate_limit");
  bench.check_for(0.01);
  CHECK(bench.written.joints[0].effort_Nm == 7);
}

TEST_CASE("What was computed in a late tick may have changed in all the time that had passed") {
  SafetySettings slow = settings();
  slow.joints[0].effort_rate_max_Nm_s = 2000;
  Bench bench(slow);
  bench.ask(0);
  bench.check();
  bench.since_last_s = 0.005;  // this tick is late, what it writes was computed before that
  bench.check();
  bench.since_last_s = 0.0005;  // the next one is not: it writes what the late one computed
  bench.ask(9);
  CHECK(bench.check().effort_Nm == 9);
  CHECK(bench.codes().empty());
  bench.ask(18);  // from here on the rate is the usual one again
  CHECK(bench.check().effort_Nm == doctest::Approx(10));
  CHECK(bench.codes() == "effort_rate_limit");
}

TEST_CASE("A winding heats up as the torque squared, is derated when warm and takes the joint out when hot") {
  SafetySettings hot = settings();
  hot.joints[0].thermal_time_constant_s = 10;
  hot.joints[0].continuous_Nm = 10;
  Bench steady(hot);
  steady.ask(10);
  steady.check_for(40);
  CHECK(steady.safety->temperature_C(0) == doctest::Approx(25 + 95 * (1 - std::exp(-4))).epsilon(0.001));
  CHECK(steady.count(FaultCode::motor_hot) == 0);
  Bench bench(hot);
  bench.ask(20);
  bench.sensors.joints[0].motor_effort_Nm = 20;  // measured: goes on heating whatever is asked
  const int warm = bench.ticks_until(FaultCode::motor_warm, 10000);
  CHECK(warm == doctest::Approx(1e4 * std::log(380.0 / (380 - 70))).epsilon(0.01));
  CHECK(bench.status.level == SafetyLevel::limited);
  const int hotter = bench.ticks_until(FaultCode::motor_hot, 10000);
  CHECK(warm + hotter == doctest::Approx(1e4 * std::log(380.0 / (380 - 95))).epsilon(0.01));
  CHECK(bench.status.level == SafetyLevel::damp);
  Bench derated(hot);
  derated.ask(25);
  derated.check_for(5);
  CHECK(derated.safety->temperature_C(0) > 95);
  CHECK(derated.written.joints[0].effort_Nm < 25);
  CHECK(derated.written.joints[0].effort_Nm > 10);
}

TEST_CASE("What the ground loads onto a joint's spring, or a broken sensor says of it, does not heat the motor") {
  Bench bench;
  bench.ask(0);
  for (const double spring_Nm : {1000.0, not_a_number}) {
    bench.joints.joints[0].effort_Nm = spring_Nm;
    bench.sensors.joints[0].motor_effort_Nm = spring_Nm > 0 ? 0 : spring_Nm;
    bench.check_for(10);
    CHECK(bench.safety->temperature_C(0) == 25);
  }
}

TEST_CASE("In position and velocity mode the set-point stays within the limits") {
  Bench bench;
  bench.asked.joints[0] = {.effort_Nm = 30, .position_rad = 2.5, .velocity_rad_s = -9, .mode = ActuationMode::position};
  bench.check();
  const JointActuation& position = bench.check();
  CHECK(position.mode == ActuationMode::position);
  CHECK(position.position_rad == 2.0);
  CHECK(position.velocity_rad_s == -8);
  CHECK(position.effort_Nm == 25);
  CHECK(bench.status.level == SafetyLevel::limited);
  bench.asked.joints[0] = {.velocity_rad_s = 20, .mode = ActuationMode::velocity};
  CHECK(bench.check().velocity_rad_s == 8);
}

TEST_CASE("In impedance mode the set-point stays within the limits, and no spring or damper pushes") {
  Bench bench;
  bench.asked.joints[0] = {.effort_Nm = 30,
                           .position_rad = 2.5,
                           .velocity_rad_s = -9,
                           .stiffness_Nm_per_rad = -40,
                           .damping_Nms_per_rad = -2,
                           .mode = ActuationMode::impedance};
  bench.check();
  const JointActuation& asked = bench.check();
  CHECK(asked.mode == ActuationMode::impedance);
  CHECK(asked.position_rad == 2.0);
  CHECK(asked.velocity_rad_s == -8);
  CHECK(asked.effort_Nm == 25);
  CHECK(asked.stiffness_Nm_per_rad == 0);
  CHECK(asked.damping_Nms_per_rad == 0);
  bench.asked.joints[0] = {.stiffness_Nm_per_rad = not_a_number, .mode = ActuationMode::impedance};
  CHECK(bench.check().mode == ActuationMode::effort);  // it damps
  CHECK(bench.codes().ends_with("actuation_not_finite"));
}

TEST_CASE("A fault of a set-point tells what was asked, and what it may be") {
  Bench bench;
  bench.asked.joints[0] = {.position_rad = 2.5, .velocity_rad_s = -9, .mode = ActuationMode::position};
  bench.check();
  REQUIRE(bench.codes() == "soft_stop soft_speed");
  CHECK(bench.faults[0].value == 2.5);
  CHECK(bench.faults[0].limit == 2.0);
  CHECK(bench.faults[1].value == -9);
  CHECK(bench.faults[1].limit == 8);
}

TEST_CASE("In velocity mode the speed asked fades to none into a soft stop, away from it it is free") {
  struct Row {
    double position_rad, asked_rad_s, written_rad_s;
  };
  const Row rows[] = {{1.96, 6, 6},   {1.985, 6, 4},   {2.0, 6, 0},  {2.03, 6, 0}, {1.999, -6, -6},
                      {0.04, -6, -6}, {0.015, -6, -4}, {0.0, -6, 0}, {0.001, 6, 6}};
  for (const Row& row : rows) {
    CAPTURE(row.position_rad);
    CAPTURE(row.asked_rad_s);
    Bench bench;
    bench.place(row.position_rad);
    bench.asked.joints[0] = {.velocity_rad_s = row.asked_rad_s, .mode = ActuationMode::velocity};
    CHECK(bench.check().velocity_rad_s == doctest::Approx(row.written_rad_s));
    CHECK(bench.codes() == (row.asked_rad_s == row.written_rad_s ? "" : "soft_stop"));
  }
}

}  // namespace joint_limiter_test
