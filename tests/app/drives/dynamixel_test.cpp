// JIWIY on Dynamixel servos: its whole control system, the driver, the packets and the servos, on virtual time.
#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"

using namespace kadans;
using namespace kadans::program;

namespace {

constexpr const char* robot_file = KADANS_SOURCE_DIR "/config/jiwiy/servos.json";

struct Sine {
  bool passed = false;
  std::string why;
  std::uint64_t hash = 0;
  std::vector<PlantCount> counts;
};

Sine sine(const char* bus, std::uint64_t seed) {
  ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/jiwiy_sine.json");
  scenario.robot = robot_file;
  scenario.bus.type.name = bus;
  RunLog log;
  Assembly robot(scenario, seed, log);
  Checks checks(robot.catalog().signals, scenario.checks);
  const RunResult result = run_scenario(robot.parts(), scenario.duration_s, checks, {});
  Sine is{.passed = result.passed};
  for (const CheckResult& check : result.checks) {
    if (!check.passed) is.why += check.name + "; ";
  }
  for (const RunFault& one : result.faults) is.why += std::string(name(one.code)) + "; ";
  is.hash = result.state_hash;
  is.why += result.error;
  is.counts = robot.plant().link_counts();
  return is;
}

}  // namespace

TEST_CASE("JIWIY follows its sine through servos, with the behavior that drives the model, on every seed") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    const Sine model = sine("", seed), servos = sine("dynamixel", seed);
    CAPTURE(servos.why);
    CHECK(model.passed);
    CHECK(servos.passed);
    CHECK(servos.hash != model.hash);
    CHECK(servos.counts.at(0).value > 3700);  // a cycle in each control tick of 2 ms
    CHECK(servos.counts.at(2).value == 0);    // none lost
  }
  CHECK(sine("dynamixel", 1).hash == sine("dynamixel", 1).hash);
}

TEST_CASE("A device that is no port of servos is refused, with what to do") {
  const auto folder = project_copy("servos");
  const std::string command = "run config/jiwiy/servos.json --plant dynamixel --soft --no-ctl --peer ";
  Outcome outcome = run(command + "/dev/null", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "--peer: the serial port /dev/null: is no serial port"));
  outcome = run(command + "/dev/ttyNONE", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "is not there: is the adapter plugged in?"));
  outcome = run("run config/jiwiy/servos.json --plant dynamixel --soft --no-ctl", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "config/jiwiy/servos.json:"));  // where its device stands
  CHECK(has(outcome.err, "the serial port /dev/ttyUSB0: is not there"));
  outcome = run("run config/tulip/robot.json --plant dynamixel --soft --no-ctl", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "says no plant.dynamixel.servos"));
}

TEST_CASE("doctor tells whether a port of servos can hold its cycle, and what is wrong with its device") {
  const auto folder = project_copy("servos_doctor");
  REQUIRE(edit(folder / "config/jiwiy/servos.json", "/dev/ttyUSB0", "/dev/ttyNONE"));
  const Outcome outcome = run("doctor config/jiwiy/servos.json", folder);
  CHECK(has(outcome.out,
            "2 servos: 104 bytes at 3000000 baud are 0.35 ms, with the adapter 1.35 ms; the bus runs at "
            "2.00 ms, the control at 2.00 ms"));
  CHECK(has(outcome.out, "/dev/ttyNONE: No such file or directory"));
}
