// The emergency stop, and the same way down at the end of a run.
#include "safety/emergency_stop.h"

#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include "bench.h"

namespace emergency_stop_test {

using namespace kadans;
using namespace kadans::safety_bench;

namespace {

bool damps(const Bench& bench) {
  return bench.written.joints[0].effort_Nm == doctest::Approx(-2.0 * bench.joints.joints[0].velocity_rad_s);
}

}  // namespace

TEST_CASE(
    "The emergency stop damps in the tick in which it arrives and is off damp_s later, as one fault that says who") {
  Bench bench;
  bench.place(1, 0.5);
  bench.check_for(0.01);
  CHECK(bench.status.level == SafetyLevel::normal);
  bench.safety->emergency_stop().ask("uid 1000 (operate)");
  bench.check();
  CHECK(damps(bench));
  CHECK(bench.status.level == SafetyLevel::damp);
  CHECK(bench.status.stopped);
  REQUIRE(bench.codes() == "emergency_stop");
  const Fault& fault = bench.faults.front();
  CHECK(fault.tick == 10);
  CHECK(std::string(fault.words.data()) == "uid 1000 (operate)");
  CHECK(fault_detail(told(fault)) == "uid 1000 (operate)");
  CHECK(bench.status.fault_count == 1);
  CHECK(bench.status.first_fault.code == FaultCode::emergency_stop);
  const double damp_s = bench.safety->settings().damp_s;
  bench.check_for(damp_s - 0.005);
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.check_for(0.01);
  CHECK(bench.status.level == SafetyLevel::off);
  CHECK(bench.written.joints[0].mode == ActuationMode::off);
  CHECK(bench.codes() == "emergency_stop");
}

TEST_CASE("Who asks for the emergency stop again adds nothing until faults are cleared, then it is another one") {
  Bench bench;
  bench.safety->emergency_stop().ask("one");
  bench.check();
  bench.safety->emergency_stop().ask("two");
  bench.check_for(0.1);
  CHECK(bench.codes() == "emergency_stop");
  bench.safety->clear();  // as a behavior's command would
  bench.check_for(2);
  CHECK(bench.status.stopped);
  CHECK(bench.status.level == SafetyLevel::off);
  CHECK(bench.status.lifts == 0);
  bench.safety->emergency_stop().lift();
  bench.check_for(2);
  CHECK(bench.status.lifts == 1);
  CHECK(bench.status.level <= SafetyLevel::limited);  // the torque has come back
  CHECK_FALSE(bench.status.stopped);
  bench.safety->emergency_stop().ask("three");
  bench.check();
  CHECK(bench.codes() == "emergency_stop emergency_stop");
  CHECK(std::string(bench.faults.back().words.data()) == "three");
  CHECK(bench.status.level == SafetyLevel::damp);
}

TEST_CASE("No reaction of a configuration takes anything from the emergency stop") {
  SafetySettings lenient = settings();
  for (Reaction& reaction : lenient.reactions) reaction = {};
  Bench bench(lenient);
  bench.safety->emergency_stop().ask("somebody");
  bench.check();
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.check_for(lenient.damp_s + 0.01);
  CHECK(bench.status.level == SafetyLevel::off);
}

TEST_CASE("At the end of a run the robot goes the same way down, without a fault, and nothing takes it back") {
  Bench bench;
  bench.place(1, 0.5);
  bench.safety->emergency_stop().leave();
  bench.check();
  CHECK(damps(bench));
  bench.safety->clear();
  bench.check();
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.check_for(bench.safety->settings().damp_s + 0.01);
  CHECK(bench.status.level == SafetyLevel::off);
  CHECK(bench.codes().empty());
  CHECK_FALSE(bench.status.stopped);
}

TEST_CASE("Words that are longer than a fault has room for are cut, and threads that ask at once are no race") {
  EmergencyStop stop;
  stop.ask(std::string(200, 'x'));
  FaultWords who{};
  CHECK(stop.take(who));
  CHECK(std::string(who.data()) == std::string(who.size() - 1, 'x'));
  CHECK_FALSE(stop.take(who));
  std::vector<std::thread> threads;
  for (char c = 'a'; c < 'e'; ++c) {
    threads.emplace_back([&stop, c] {
      for (int i = 0; i < 20'000; ++i) stop.ask(std::string(30, c));
    });
  }
  int taken = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (!stop.take(who)) continue;
    ++taken;
    const std::string words = who.data();
    CHECK((words.empty() || words == std::string(30, words[0])));  // never of two
  }
  for (std::thread& thread : threads) thread.join();
  CHECK((taken > 0 || stop.take(who)));
}

TEST_CASE("Who asks for the emergency stop in the tick of a lift is heard, the lift is not") {
  Bench bench;
  bench.safety->emergency_stop().lift();
  bench.safety->emergency_stop().ask("somebody");
  bench.check_for(0.01);
  CHECK(bench.status.stopped);
  CHECK(bench.status.lifts == 0);
}

}  // namespace emergency_stop_test
