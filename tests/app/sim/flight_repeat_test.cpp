// kadans replay of a flight record: the control engine goes on from a saved state.
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace flight_repeat_test {

using namespace kadans::program;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

fs::path flight_in(const fs::path& project) {
  const std::vector<fs::path> flights = flights_in(project);
  REQUIRE_FALSE(flights.empty());
  return flights.front().filename();
}

// A robot that is stopped after some seconds of virtual time, with the last ones in its flight record.
fs::path flight_of(const fs::path& project, const std::string& arguments, const char* first = "wander: ") {
  Running robot(project,
                "run config/" + arguments + " --threads-on-virtual-time --flight 5 --duration 1000 --ctl ctl -v 2>&1");
  REQUIRE(robot.says(first));
  for (int i = 0; i < 3; ++i) (void)run("ctl --socket ctl status", project);
  (void)run("ctl --socket ctl estop", project);
  robot.end(SIGTERM);
  return flight_in(project);
}

// A TULip that squats with one leg alone on virtual time and latches when it falls, after 3 s.
fs::path latched_flight(const fs::path& project, const std::string& more = " --flight 20") {
  if (edit(project / "behaviors/tulip/squat.lua", "{ \"l_\", \"r_\" }", "{ \"l_\" }"))  // the first time
    REQUIRE(edit(project / "config/tulip/robot.json", "\"heartbeat_lost\": {",
                 "\"tilt\": { \"robot\": \"damp\", \"latch\": true }, \"heartbeat_lost\": {"));
  (void)run("run config/tulip/robot.json --threads-on-virtual-time --duration 5 --play squat" + more, project);
  return flight_in(project);
}

}  // namespace

TEST_CASE("The flight record of every robot is repeated bit for bit from a state of its control engine") {
  struct Row {
    const char *arguments, *says;
  };
  for (const Row& row : {Row{"head/robot.json --plant bullet --play wander", "wander: "},
                         Row{"jiwiy/robot.json --plant bullet --play look", "look: "},
                         Row{"tulip/robot.json --plant bullet --play squat", "squat: "},
                         Row{"tulip/robot.json --plant ideal --play wave --behaviors process", "wave: "}}) {
    CAPTURE(row.arguments);
    const fs::path project = project_copy("flight_robots");
    const fs::path flight = flight_of(project, row.arguments, row.says);
    const Outcome outcome = run("replay " + flight.string() + " --json", project);
    CHECK_MESSAGE(outcome.exit_code == 0, (outcome.out + outcome.err));
    REQUIRE_FALSE(outcome.out.empty());
    const Json json = Json::parse(outcome.out);
    CHECK(json["same"] == true);
    CHECK(json["ticks"].get<int>() > 50);
    CHECK_MESSAGE(has(json["notes"].dump(), "behaviors and the high levels of control objects are not repeated"),
                  outcome.out);
  }
}

TEST_CASE("A flight record is repeated with its fault, its commands and its later states, beside a record and alone") {
  struct Row {
    const char *options, *from, *commands, *states;
  };
  for (const Row& row :
       {Row{" --flight 20", " at 0.002 s: ", "47 commands", "; 1 later state "},
        Row{" --flight 20 --record run.mcap --signals joint.*@10", " at 0.002 s: ", "47 commands", "; 1 later state "},
        Row{" --flight 2", " at 2.002 s: ", "0 commands", "; 0 later states "}}) {
    CAPTURE(row.options);
    const fs::path project = project_copy("flight_record");
    const Outcome outcome = run("replay " + latched_flight(project, row.options).string(), project);
    CHECK_MESSAGE(outcome.exit_code == 0, (outcome.out + outcome.err));
    CHECK_MESSAGE(has(outcome.out, ": the same, "), outcome.out);
    for (const char* part : {row.from, row.commands, row.states}) CHECK_MESSAGE(has(outcome.out, part), outcome.out);
    if (!fs::exists(project / "run.mcap")) continue;
    const Outcome whole = run("replay run.mcap", project);
    CHECK_MESSAGE(whole.exit_code == 0, (whole.out + whole.err));
  }
}

TEST_CASE("A flight record in little memory has the signals of its last part, and --record writes those of all ticks") {
  const fs::path project = project_copy("flight_little");
  REQUIRE(edit(project / "config/tulip/robot.json", "\"urdf\":", "\"record\": {\"flight_MB\": 1.5}, \"urdf\":"));
  const std::string flight = latched_flight(project).string();
  const auto first_row = [&](const std::string& record) {
    const std::string table = run("log csv " + record + " joint.l_knee.position_rad", project).out;
    return std::stod(table.substr(table.find('\n') + 1));
  };
  CHECK(run("replay " + flight + " --record " + flight, project).exit_code == 2);
  const Outcome outcome = run("replay " + flight + " --record whole.mcap", project);
  CHECK_MESSAGE(outcome.exit_code == 0, (outcome.out + outcome.err));
  CHECK_MESSAGE(has(outcome.out, " at 0.002 s: "), outcome.out);
  CHECK(first_row(flight) > 1);
  CHECK(first_row("whole.mcap") == doctest::Approx(0.002));
  CHECK(run("log diff " + flight + " whole.mcap --json", project).exit_code < 2);
}

TEST_CASE("What needs the behaviors of a run says that a flight record has none") {
  const fs::path project = project_copy("flight_no_behaviors");
  const std::string flight = latched_flight(project).string();
  for (const std::string& command : {"replay " + flight + " --with config/tulip/robot.json",
                                     "replay " + flight + " --then-simulate config/scenarios/squat.json --at 2",
                                     "log cut " + flight + " --inputs -o cut.mcap"}) {
    const Outcome outcome = run(command, project);
    CHECK(outcome.exit_code == 2);
    CHECK_MESSAGE(has(outcome.err, "is a flight record"), outcome.err);
  }
}

TEST_CASE("A flight record that is damaged, of another version or without inputs says so") {
  const fs::path project = project_copy("flight_damaged");
  const fs::path flight = latched_flight(project);
  check_damaged(project / flight);
  const std::string whole = read(project / flight);
  const std::string name("state_bytes", 11);
  const std::size_t at = whole.find(name);
  REQUIRE(at != std::string::npos);
  std::string other = whole;
  char& digit = other[at + name.size() + 4];
  digit = digit == '1' ? '2' : '1';
  write(project / "other.mcap", other);
  const Outcome refused = run("replay other.mcap", project);
  CHECK(refused.exit_code == 2);
  CHECK_MESSAGE(has(refused.err, "other.mcap: its control engine was another one"), refused.err);
  fs::remove(project / flight);
  REQUIRE(edit(project / "config/tulip/robot.json", "{", "{ \"record\": { \"inputs\": false },"));
  const fs::path plain = latched_flight(project);
  const Outcome none = run("replay " + plain.string(), project);
  CHECK(none.exit_code == 2);
  CHECK_MESSAGE(has(none.err, "holds no inputs of its ticks"), none.err);
}

}  // namespace flight_repeat_test
