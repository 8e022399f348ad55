// A program of one's own that steps a scenario: include/kadans/app/simulation.h.
#include "kadans/app/simulation.h"

#include <string>

#include <doctest/doctest.h>

#include "app/program.h"
#include "kadans/signal/input_error.h"
#include "signal/number_text.h"

namespace simulation_test {

using namespace kadans;
using namespace kadans::program;

const std::string scenario_file = KADANS_SOURCE_DIR "/config/scenarios/side_by_side.json";

TEST_CASE("A program that steps a scenario goes through the same states as kadans sim") {
  Simulation simulation(read(scenario_file), scenario_file, 7);
  while (simulation.time_ns() < 500'000'000) simulation.step();
  const Outcome outcome =
      run("sim " + scenario_file + " --seed 7 --duration 0.5 --no-record --json", fresh_folder("simulation"));
  CHECK_MESSAGE(has(outcome.out, hash_text(simulation.state_hash())), outcome.out);
  CHECK(simulation.robots() >= 2);
}

TEST_CASE("A program sees the truth of each robot, moves it by hand and reads its signals") {
  Simulation simulation(read(scenario_file), scenario_file, 1);
  simulation.step();
  const auto height = simulation.catalog(1).signals.find("plant.base.height_m");
  REQUIRE(height);
  CHECK(simulation.signal(1, *height) > 0.5);
  simulation.robot(1).carry(3, 4, 1);
  simulation.step();
  CHECK(simulation.robot(1).truth().base.position_m[0] == doctest::Approx(3).epsilon(0.01));
  CHECK(simulation.status(1).base.posture == Posture::upright);
  CHECK_THROWS_AS(simulation.robot(9), std::out_of_range);
  CHECK_THROWS_AS(simulation.observe(1, {}), std::invalid_argument);
  CHECK_THROWS_AS((void)simulation.entry(1, "ball"), std::invalid_argument);
  CHECK_THROWS_AS((void)simulation.object("no such"), std::invalid_argument);
}

TEST_CASE("What is observed reaches the world model of a robot with a supervisor, and what is said can be read") {
  const std::string file = KADANS_SOURCE_DIR "/config/scenarios/fetch.json";
  Simulation simulation(read(file), file, 3);
  const auto seen = simulation.catalog(0).signals.find("seen.ball.x_m");
  REQUIRE(seen);
  const std::uint32_t ball = simulation.entry(0, "ball");
  for (int i = 0; i < 200; ++i) simulation.step();
  Observation observation{.entry = ball, .time_ns = simulation.time_ns() - simulation.period_ns()};
  observation.fields = {1.25, 0.5};
  simulation.observe(0, observation);
  for (int i = 0; i < 60; ++i) simulation.step();
  CHECK(simulation.signal(0, *seen) == doctest::Approx(1.25).epsilon(0.01));
  std::size_t heard = 0;
  for (const Observation& one : simulation.take_observed(0)) heard += one.entry == ball ? 1 : 0;
  CHECK(heard > 0);  // of the simulated perception
  CHECK(simulation.take_observed(0).empty());
  bool said = false;
  for (const SaidLine& line : simulation.take_lines()) said = said || has(line.text, "replace stand");
  CHECK(said);
  CHECK(simulation.take_lines().empty());
}

TEST_CASE(
    "A record or a page of a program that steps a scenario changes no bit of it, and only that program repeats it") {
  const std::filesystem::path folder = fresh_folder("simulation_record");
  const std::string record = (folder / "stepped.mcap").string();
  std::vector<std::uint64_t> hashes;
  for (const char* what : {"neither", "record", "both"}) {
    const bool recorded = std::string(what) != "neither";
    Simulation simulation(read(scenario_file), scenario_file, 7);
    if (recorded) simulation.record({.file = record, .signals = "*plant.base.*@50", .repeat = "my-program --seed 7"});
    if (std::string(what) == "both") simulation.show({.port = 0});
    while (simulation.time_ns() < 300'000'000) simulation.step();
    if (recorded) simulation.end_record({{"ended", "well"}});
    hashes.push_back(simulation.state_hash());
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
  const Outcome info = run("log info " + record, folder), again = run("replay " + record, folder);
  CHECK_MESSAGE(has(info.out, "my-program --seed 7"), info.out);
  CHECK(again.exit_code == 2);
  CHECK_MESSAGE(has(again.err, "stepped by another program, which alone repeats it: my-program --seed 7"), again.err);
  const Outcome place = run("log csv " + record + " left.plant.base.height_m", folder);
  CHECK_MESSAGE(place.exit_code == 0, place.err);
  Simulation nowhere(read(scenario_file), scenario_file, 7);
  CHECK_THROWS_AS(nowhere.record({.file = "/dev/null/record.mcap"}), InputError);
}

TEST_CASE("A scenario with a mistake is refused as kadans sim refuses it, with its place") {
  CHECK_THROWS_WITH_AS(Simulation("{ \"name\": \"x\",\n \"robots\": 3 }", scenario_file, 1),
                       doctest::Contains("side_by_side.json:"), InputError);
}

TEST_CASE("A robot that is bolted down is not carried: that is known before it begins") {
  CHECK_THROWS_WITH_AS(Simulation(R"({ "name": "x", "robot": "config/jiwiy/robot.json", "duration_s": 1,
    "carried": [{ "at_s": 0.5, "to_m": [1, 0] }] })",
                                  scenario_file, 1),
                       doctest::Contains("side_by_side.json:2:40: carried: the robot is bolted down"), InputError);
}

}  // namespace simulation_test
