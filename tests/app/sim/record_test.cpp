// What is recorded: the choice of signals, and the flight recorder.
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/live/record_meshes.h"
#include "app/program.h"
#include "telemetry/mcap/mcap_reader.h"

namespace record_test {

using namespace kadans;
using namespace kadans::program;

namespace {

namespace fs = std::filesystem;

constexpr const char* squat = "sim config/scenarios/squat.json --duration 1.2 --record run.mcap";

// Messages by topic.
std::map<std::string, int> topics_of(const fs::path& file) {
  std::map<std::string, int> topics;
  McapReader reader(file.string());
  for (McapMessage message; reader.next(message);) ++topics[reader.channels().at(message.channel).topic];
  CHECK_MESSAGE(reader.complete(), reader.problem());
  return topics;
}

// Time of the first and last message of a topic.
std::pair<double, double> span_of(const fs::path& file, const std::string& topic) {
  std::pair<double, double> span{-1, -1};
  McapReader reader(file.string());
  for (McapMessage message; reader.next(message);) {
    if (reader.channels().at(message.channel).topic != topic) continue;
    span.second = 1e-9 * static_cast<double>(message.time_ns);
    if (span.first < 0) span.first = span.second;
  }
  return span;
}

}  // namespace

TEST_CASE("A record has joint states, the base's transform, wrenches, parameters and the robot for viewers") {
  const fs::path project = project_copy("record_viewers");
  REQUIRE(run(squat, project).exit_code == 0);
  auto topics = topics_of(project / "run.mcap");
  for (const char* topic : {"/joint_states", "/tf", "/wrench/l_ankle_roll_link", "/wrench/r_ankle_roll_link"})
    CHECK(topics[topic] == 60);
  CHECK(topics["/joint"] == 1200);
  CHECK(topics["/robot_description"] == 1);
  CHECK(topics["/description"] == 1);
  CHECK(topics["/parameters"] == 1);
  CHECK(flights_in(project).empty());
}

TEST_CASE("sim records the signals that are asked for, and replay compares those") {
  const fs::path project = project_copy("record_signals");
  REQUIRE(run(std::string(squat) + " --signals 'joint.*@100, base.pitch_rad'", project).exit_code == 0);
  auto topics = topics_of(project / "run.mcap");
  CHECK(topics["/joint"] == 120);
  CHECK(topics["/base"] == 1200);
  CHECK(topics.count("/control/posture") == 0);
  const Outcome replay = run("replay run.mcap", project);
  CHECK(replay.exit_code == 0);
  CHECK(has(replay.out, "the same, 1200 ticks, 43 signals"));
  const Outcome wrong = run(std::string(squat) + " --signals 'joint.*, bse.*'", project);
  CHECK(wrong.exit_code == 2);
  CHECK(has(wrong.err, "--signals: no signal is called 'bse.*', did you mean 'base.*'?"));
}

TEST_CASE("A robot's configuration chooses what is recorded, a mistake in it is told with its place") {
  const fs::path project = project_copy("record_configured");
  const fs::path robot = project / "config/tulip/robot.json";
  REQUIRE(
      edit(robot, "\"safety\": {", "\"record\": {\"signals\": {\"*\": 0, \"joint.l_knee.*\": 500}},\n  \"safety\": {"));
  REQUIRE(run(squat, project).exit_code == 0);
  auto topics = topics_of(project / "run.mcap");
  CHECK(topics["/joint"] == 600);
  CHECK(topics.count("/base") == 0);
  CHECK(topics["/joint_states"] == 60);
  REQUIRE(edit(robot, "joint.l_knee.*", "joint.l_kne.*"));
  const Outcome wrong = run(squat, project);
  CHECK(wrong.exit_code == 2);
  CHECK(has(wrong.err, "no signal is called 'joint.l_kne.*'"));
  CHECK(has(wrong.err, "robot.json:"));
}

TEST_CASE("A fault that latches in a simulation leaves a flight record, with or without a record") {
  const fs::path project = project_copy("record_flight");
  for (const std::string record : {"--no-record", "--record behaviors_stall.mcap"}) {
    CAPTURE(record);
    const Outcome outcome = run("sim config/scenarios/behaviors_stall.json --flight 2 " + record, project);
    CHECK(has(outcome.err, "flight record: behaviors_stall.flight.mcap"));
    const fs::path flight = project / "behaviors_stall.flight.mcap";
    REQUIRE(fs::exists(flight));
    auto topics = topics_of(flight);
    CHECK(topics["/faults"] > 0);
    CHECK(topics["/joint"] > 1500);
    CHECK(topics["/joint"] < 3200);
    CHECK(topics["/joint_states"] > 80);
    CHECK(topics["/robot_description"] == 1);
    CHECK(has(run("log info --json behaviors_stall.flight.mcap", project).out, "\"object posture\""));
    fs::remove(flight);
  }
}

TEST_CASE(
    "A fault that latches in a run leaves a flight record of what came before and a second after, its end does not") {
  const fs::path project = project_copy("record_flight_run");
  const std::string live = "run config/tulip/robot.json --threads-on-virtual-time --duration 4 --flight 3";
  CHECK(run(live, project).exit_code == 0);
  CHECK(flights_in(project).empty());
  REQUIRE(edit(project / "config/tulip/robot.json", "\"tilt_max_rad\": 0.6", "\"tilt_max_rad\": 0.01"));
  REQUIRE(edit(project / "config/tulip/robot.json", "\"heartbeat_lost\": {",
               "\"tilt\": { \"robot\": \"damp\", \"latch\": true }, \"heartbeat_lost\": {"));
  const Outcome outcome = run(live + " --play squat --record run.mcap --signals joint.*@10", project);
  CHECK_MESSAGE(has(outcome.err, "flight record: "), outcome.err);
  const auto flights = flights_in(project);
  REQUIRE(flights.size() == 1);
  auto topics = topics_of(flights[0]);
  CHECK(topics["/faults"] > 0);
  CHECK(topics["/base"] > 1000);
  const auto [fault_s, last_fault_s] = span_of(flights[0], "/faults");
  CHECK(span_of(flights[0], "/base").second >= fault_s + 1);
  CHECK(has(run("log info --json " + flights[0].string(), project).out, "\"fault_state\""));
  CHECK(topics_of(project / "run.mcap").count("/base") == 0);
}

TEST_CASE("A record does not take what is printed when the standard output is closed, and that fails") {
  const fs::path project = project_copy("record_closed_output");
  const std::string command =
      "cd '" + project.string() + "' && exec '" KADANS_BINARY_DIR "/kadans' " + squat + " --json <&- >&- 2>&-";
  CHECK(WEXITSTATUS(std::system(command.c_str())) == 2);
  CHECK(topics_of(project / "run.mcap")["/joint"] == 1200);
}

TEST_CASE("Records in a folder are numbered, go on in new files, and take no more room than they may") {
  const fs::path project = project_copy("record_folder");
  REQUIRE(edit(project / "config/tulip/robot.json", "\"urdf\"", "\"record\": {\"file_MB\": 0.5}, \"urdf\""));
  const std::string live =
      "run config/tulip/robot.json --threads-on-virtual-time --play squat --duration 5 --record kept/ "
      "--signals 'joint.*, base.*, actuation.*, plant.*'";
  const auto bytes_of = [](const fs::path& folder) {
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::directory_iterator(folder)) bytes += entry.file_size();
    return bytes;
  };
  const auto numbers_in = [](const fs::path& folder) {
    std::set<int> numbers;
    for (const auto& entry : fs::directory_iterator(folder))
      numbers.insert(std::stoi(entry.path().filename().string().substr(6, 4)));
    return numbers;
  };
  REQUIRE(run(live, project).exit_code == 0);
  const auto first = numbers_in(project / "kept");
  CHECK(first.size() >= 2);
  CHECK(*first.begin() == 1);
  for (const auto& entry : fs::directory_iterator(project / "kept")) {
    auto topics = topics_of(entry.path());
    CHECK(topics["/joint"] > 0);
    CHECK(topics["/robot_description"] == 1);
  }
  const std::uintmax_t without_bound = bytes_of(project / "kept");
  CHECK(without_bound > 1'200'000);
  REQUIRE(run(live + " --records-max 1", project).exit_code == 0);
  const auto second = numbers_in(project / "kept");
  CHECK(*second.begin() > *first.begin());
  CHECK(*second.rbegin() > *first.rbegin());
  CHECK(bytes_of(project / "kept") < 1'000'000 + 500'000);  // what comes in a second, with its inputs
  // A folder that is there is one without a slash, too; a name is a name.
  REQUIRE(
      run("run config/tulip/robot.json --threads-on-virtual-time --duration 0.5 --record kept", project).exit_code ==
      0);
  CHECK(*numbers_in(project / "kept").rbegin() > *second.rbegin());
}

TEST_CASE("The meshes of a record are found where its URDF still lies as it was, and nowhere else") {
  const fs::path project = project_copy("record_meshes"), urdf = project / "models/tulip/tulip.urdf";
  REQUIRE(edit(urdf, "<link name=\"torso\">",
               "<link name=\"torso\"><visual><geometry><mesh filename=\"plate.stl\"/></geometry></visual>"));
  write(project / "models/tulip/plate.stl", "solid plate");
  run("sim config/scenarios/squat.json --duration 0.05 --record run.mcap", project);
  const std::string record = (project / "run.mcap").string();
  const auto read = meshes_of_record(record);
  REQUIRE(read("plate.stl") != nullptr);
  CHECK(*read("plate.stl") == "solid plate");
  CHECK(read("../tulip/tulip.urdf") == nullptr);
  REQUIRE(edit(urdf, "plate.stl", "other.stl"));
  CHECK(meshes_of_record(record)("plate.stl") == nullptr);
}

}  // namespace record_test
