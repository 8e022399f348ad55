// The safety layer as a whole: what passes, what the runtime's own failures do, faults and their clearing.
#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <doctest/doctest.h>

#include "bench.h"
#include "kadans/testing/allocation_count.h"

namespace safety_test {

using namespace kadans;
using namespace kadans::safety_bench;

namespace {

bool damps(const JointActuation& actuation, double velocity_rad_s) {
  return actuation.mode == ActuationMode::effort && actuation.effort_Nm == doctest::Approx(-2.0 * velocity_rad_s);
}

}  // namespace

TEST_CASE("What is within the limits passes untouched") {
  Bench bench;
  bench.check_for(1);
  CHECK(bench.written.joints[0].effort_Nm == 5);
  CHECK(bench.status.level == SafetyLevel::normal);
  CHECK(bench.codes().empty());
}

TEST_CASE("A passive joint is never actuated") {
  Bench bench;
  bench.asked.joints[1] = {.effort_Nm = 3, .mode = ActuationMode::effort};
  bench.check();
  CHECK(bench.written.joints[1].mode == ActuationMode::off);
  CHECK(bench.written.joints[1].effort_Nm == 0);
}

TEST_CASE("A lost heartbeat holds, then damps, then takes all torque, only holding is undone by its return") {
  Bench bench;
  bench.heartbeat_age_s = 0.2;
  bench.check();
  CHECK(bench.status.level == SafetyLevel::hold);
  CHECK(bench.codes() == "heartbeat_lost");
  CHECK(bench.written.joints[0].effort_Nm == 5);  // the last set-points go on
  bench.heartbeat_age_s = 0;
  bench.check_for(0.03);
  CHECK(bench.status.level == SafetyLevel::normal);
  bench.heartbeat_age_s = 0.2;
  bench.check_for(1.1);
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.heartbeat_age_s = 0;
  bench.check_for(0.1);
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.heartbeat_age_s = 0.2;
  bench.check_for(2.1);
  CHECK(bench.status.level == SafetyLevel::off);
  CHECK(bench.written.joints[0].mode == ActuationMode::off);
  CHECK(bench.count(FaultCode::heartbeat_lost) == 3);  // each time it was lost, no more
}

TEST_CASE("A heartbeat of no age that makes sense counts as lost") {
  Bench bench;
  bench.heartbeat_age_s = not_a_number;
  bench.check();
  CHECK(bench.status.level == SafetyLevel::hold);
}

TEST_CASE("Overruns are counted, too many in a row make the robot damp until cleared") {
  Bench bench;
  bench.missed_ticks = 1;
  for (int i = 0; i < 4; ++i) bench.check();
  bench.missed_ticks = 0;
  bench.check();
  CHECK(bench.status.level == SafetyLevel::normal);
  CHECK(bench.codes() == "tick_overrun");
  bench.missed_ticks = 2;
  CHECK(bench.ticks_until(FaultCode::overruns) == 5);
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.missed_ticks = 0;
  bench.check_for(1);
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.safety->clear();
  bench.check();
  CHECK(bench.safety->robot_level() == SafetyLevel::normal);
}

TEST_CASE("The first fault is kept, with joint, tick, value and limit, later ones are counted") {
  Bench bench;
  bench.check();
  bench.ask(40);
  bench.check();
  bench.place(3);
  bench.check();
  const Fault& first = bench.status.first_fault;
  CHECK(first.code == FaultCode::effort_limit);
  CHECK(first.joint == 0);
  CHECK(first.tick == 1);
  CHECK(first.value == 40);
  CHECK(first.limit == 25);
  CHECK(bench.status.fault_count == bench.faults.size());
  CHECK(bench.faults.size() >= 2);
}

TEST_CASE("Clearing forgets the faults, and the next check judges anew") {
  Bench bench;
  bench.place(2.1, 1);
  bench.check();
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.safety->clear();
  bench.check();
  CHECK(bench.status.level == SafetyLevel::damp);  // it is still there
  for (const double back_rad : {2.08, 2.06, 2.04, 2.02, 2.0, 1.98, 1.96, 1.94}) {
    bench.place(back_rad);
    bench.check();
  }
  bench.safety->clear();
  bench.check_for(0.6);
  CHECK(bench.status.level == SafetyLevel::normal);
  CHECK(bench.status.fault_count == 0);
  CHECK(bench.status.first_fault.code == FaultCode::none);
}

TEST_CASE("A joint that comes back gets its torque back over recover_s") {
  Bench bench;
  bench.ask(20);
  bench.check();
  bench.ask(not_a_number);
  bench.check();
  bench.ask(20);
  bench.safety->clear();
  bench.check();
  CHECK(bench.written.joints[0].effort_Nm < 0.1);
  CHECK(bench.safety->joint_level(0) == SafetyLevel::limited);
  bench.check_for(0.25);
  CHECK(bench.written.joints[0].effort_Nm == doctest::Approx(0.5 * 25).epsilon(0.02));
  bench.check_for(0.25);
  CHECK(bench.written.joints[0].effort_Nm == 20);
  CHECK(bench.safety->joint_level(0) == SafetyLevel::normal);
  CHECK(bench.status.fault_count == 0);
}

TEST_CASE("Who computes set-points is told once when a joint comes back, cleared or by itself") {
  Bench cleared;
  cleared.ask(not_a_number);
  cleared.check();
  CHECK(!cleared.safety->came_back());
  cleared.ask(5);
  cleared.check();
  CHECK(!cleared.safety->came_back());  // latched
  cleared.safety->clear();
  CHECK(cleared.safety->came_back());
  cleared.check();
  CHECK(!cleared.safety->came_back());
  cleared.safety->clear();
  CHECK(!cleared.safety->came_back());  // nothing had given way
}

TEST_CASE("A joint that comes back by itself damps once more, since what is asked is from before") {
  SafetySettings mild = settings();
  mild.reactions[static_cast<std::size_t>(FaultCode::position_limit)] = {.joint = SafetyLevel::damp, .exit_s = 0.01};
  Bench bench(mild);
  bench.place(2.06, 3);
  CHECK(damps(bench.check(), 3));
  bench.place(2.045, 3);
  bench.ask(-5);
  int ticks = 0;
  while (!bench.safety->came_back() && ++ticks < 100) CHECK(damps(bench.check(), 3));
  CHECK(ticks == doctest::Approx(11).epsilon(0.1));
  CHECK(bench.check().effort_Nm == doctest::Approx(-0.1));  // of 25 Nm, as much as two ticks of recover_s give
  CHECK(!bench.safety->came_back());
}

TEST_CASE("A drive that comes back in position mode is told positions again at once") {
  Bench bench;
  bench.asked.joints[0] = {.position_rad = 1.2, .mode = ActuationMode::position};
  bench.health.joints[0].finite = false;
  CHECK(bench.check().mode == ActuationMode::off);
  bench.health.joints[0].finite = true;
  bench.safety->clear();
  CHECK(bench.safety->came_back());
  CHECK(bench.check().mode == ActuationMode::position);
}

TEST_CASE("When too many joints are lost the robot damps") {
  SafetySettings one = settings();
  one.joints_lost_max = 1;
  Bench bench(one);
  bench.health.joints[0].finite = false;
  bench.check();
  CHECK(bench.safety->robot_level() == SafetyLevel::normal);
  bench.health.joints[1].finite = false;
  bench.check();
  CHECK(bench.codes() == "sensor_not_finite sensor_not_finite joints_lost");
  CHECK(bench.safety->robot_level() == SafetyLevel::damp);
  bench.check_for(0.5);
  CHECK(bench.count(FaultCode::joints_lost) == 1);
}

TEST_CASE("A reaction of the configuration replaces the default one") {
  SafetySettings mild = settings();
  mild.reactions[static_cast<std::size_t>(FaultCode::position_limit)] = {
      .joint = SafetyLevel::limited, .robot = SafetyLevel::hold, .exit_s = 0.2};
  Bench bench(mild);
  bench.place(2.06);
  bench.check();
  CHECK(bench.safety->robot_level() == SafetyLevel::hold);
  CHECK(bench.written.joints[0].mode == ActuationMode::effort);
  bench.place(1);
  bench.check_for(0.18);
  CHECK(bench.safety->robot_level() == SafetyLevel::hold);
  bench.check_for(0.04);
  CHECK(bench.safety->robot_level() == SafetyLevel::normal);
}

TEST_CASE("What others raise is counted, and its reaction follows in the next check") {
  SafetySettings strict = settings();
  strict.reactions[static_cast<std::size_t>(FaultCode::command_refused)] = {.robot = SafetyLevel::hold};
  Bench bench(strict);
  bench.check();
  bench.safety->raise({.code = FaultCode::command_refused, .tick = 1, .value = 7});
  CHECK(bench.safety->robot_level() == SafetyLevel::normal);
  bench.check();
  CHECK(bench.safety->robot_level() == SafetyLevel::hold);
  CHECK(bench.status.fault_count == 1);
  bench.check_for(0.1);
  CHECK(bench.safety->robot_level() == SafetyLevel::normal);
}

TEST_CASE("Limits that make no sense are refused before the loop") {
  const auto refused = [](auto&& spoil) {
    SafetySettings wrong = settings();
    spoil(wrong);
    CHECK_THROWS_AS(Safety(wrong, robot()), std::invalid_argument);
  };
  refused([](SafetySettings& s) { s.joints[0].effort_max_Nm = not_a_number; });
  refused([](SafetySettings& s) { s.joints[0].thermal_time_constant_s = 0; });
  refused([](SafetySettings& s) { s.joints.pop_back(); });
  refused([](SafetySettings& s) { s.velocity_margin = 0.5; });
  refused([](SafetySettings& s) { s.recover_s = 0; });
  refused([](SafetySettings& s) { s.thermal.warm_C = s.thermal.ambient_C; });
  refused([](SafetySettings& s) { s.fall.soft_share = 1.5; });
}

TEST_CASE("Levels and temperatures are signals") {
  Bench bench;
  SignalTable table;
  bench.safety->declare_signals(table, robot());
  std::vector<double> row(table.size());
  bench.ask(not_a_number);
  bench.check();
  table.gather(row);
  CHECK(row[table.find("safety.level").value()] == 3);
  CHECK(row[table.find("safety.robot_level").value()] == 0);
  CHECK(row[table.find("safety.knee.level").value()] == 3);
  CHECK(row[table.find("safety.toe.level").value()] == 0);
  CHECK(row[table.find("safety.faults").value()] == 1);
  CHECK(row[table.find("safety.knee.temperature_C").value()] == doctest::Approx(25));
  CHECK(!table.find("safety.toe.temperature_C"));
}

TEST_CASE("Checking allocates nothing, whatever is wrong") {
  Bench bench;
  bench.asked.joints[0].effort_Nm = not_a_number;
  bench.place(5, 50);
  bench.health.joints[1].finite = false;
  bench.health.imu.silent_ticks = 100;
  bench.base.pitch_rad = 2;
  bench.base.tilt_rad = 2;
  bench.missed_ticks = 1;
  bench.heartbeat_age_s = 9;
  const kadans::testing::AllocationCount heap;
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    bench.written = bench.asked;
    bench.safety->check({tick, dt_s, 1, 9, bench.sensors, bench.joints, bench.base, bench.health}, bench.written,
                        bench.status);
  }
  const auto allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(bench.status.fault_count > 5);
}

TEST_CASE("The table at the head of detection.h promises something of each fault, a row a promise") {
  std::ifstream file(KADANS_SOURCE_DIR "/src/safety/detection.h");
  std::set<std::string> promised;
  for (std::string line; std::getline(file, line) && line != "#pragma once";) {
    constexpr std::size_t column = 56;  // where the ticks stand
    if (!line.starts_with("//   ") || line.find("---") != std::string::npos || line.ends_with(" ticks")) continue;
    REQUIRE_MESSAGE(line.size() > column, line);
    CHECK_MESSAGE((line[column - 1] == ' ' && line[column] != ' '), line);
    std::string names = line.substr(0, column);
    std::ranges::replace(names, ',', ' ');
    std::istringstream words(names.substr(2));
    for (std::string word; words >> word;) promised.insert(word);
  }
  CHECK(promised.size() == fault_codes - 1);  // all but none
  for (std::size_t code = 1; code < fault_codes; ++code) {
    const std::string fault = name(static_cast<FaultCode>(code));
    CHECK_MESSAGE(promised.contains(fault), fault);
  }
}

}  // namespace safety_test
