// Both sides of the low level, as programs: a quadruped stands up, is held, damps and is released on virtual time and
// over DDS, and a program of others (peer.cpp) reads and drives it. Domains are this machine's own. Nothing looks at
// the clock.
#include <filesystem>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace unitree_dds_test {

using namespace kadans::program;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string domain = std::to_string(own_dds_domain());
const std::string place = "lo:" + domain;

// The project of the robot in the folder dog.
fs::path dog_project(const std::string& name) {
  const fs::path folder = project_copy(name), from = KADANS_SOURCE_DIR "/tests/plant/unitree/dog";
  for (const char* part : {"models/dog", "config/dog", "behaviors/dog"}) fs::create_directories(folder / part);
  fs::copy(from / "dog.urdf", folder / "models/dog");
  fs::copy(from / "robot.json", folder / "config/dog");
  fs::copy(from / "get_up.lua", folder / "behaviors/dog");
  fs::copy(from / "stand.json", folder / "config/scenarios/dog_stand.json");
  REQUIRE(edit(folder / "config/dog/robot.json", "@plugin@", KADANS_BINARY_DIR "/plugins/unitree/unitree.so"));
  return folder;
}

std::string served(const std::string& more) {
  return "plant config/dog/robot.json --as unitree --soft --once --json --listen " + place + " " + more;
}

Json peer(const fs::path& project, const std::string& what) {
  const std::string command = "cd '" + project.string() + "' && '" KADANS_BINARY_DIR "/tests/unitree_peer' " + domain +
                              " " + what + " >peer.json";
  REQUIRE(std::system(command.c_str()) == 0);  // NOLINT: the shell is the point
  return Json::parse(read(project / "peer.json"));
}

// What a run on the wall clock tells at its end. On a busy machine it may have been late, and then it ends with 1.
Json driven_to_its_end(const Outcome& outcome) {
  const Json told = Json::parse(outcome.out, nullptr, false);
  REQUIRE_MESSAGE(told.is_object(), outcome.out << outcome.err);
  CHECK_MESSAGE(told.at("ended") == "duration over", outcome.out << outcome.err);
  return told;
}

// What the emulator says of its session.
Json session(Running& plant) {
  CHECK(plant.end() == 0);
  return Json::parse(plant.heard().substr(plant.heard().find("\n{") + 1));
}

}  // namespace

TEST_CASE("A quadruped stands up through its motors' own loops, and sinks softly when nobody speaks to it") {
  const fs::path project = dog_project("unitree_virtual");
  const auto hash = [&] {
    const Outcome outcome = run("sim config/scenarios/dog_stand.json --no-record --json", project);
    CHECK_MESSAGE(outcome.exit_code == 0, outcome.out << outcome.err);
    return Json::parse(outcome.out).at("state_hash").dump();
  };
  CHECK(hash() == hash());
  const Outcome refused =
      run("sim config/scenarios/dog_stand.json --no-record --set 'bus.faults=[\"bytes_lost@1=0.1\"]'", project);
  CHECK(refused.exit_code == 2);
}

TEST_CASE("A quadruped stands up over DDS, is held, and at the end damps and is released") {
  const fs::path project = dog_project("unitree_live");
  Running plant(project, served("--in-step"));
  REQUIRE(plant.says("serves 'dog'"));
  const Outcome outcome = run("run config/dog/robot.json --plant unitree --peer " + place +
                                  " --soft --no-ctl --json --play get_up --duration 3",
                              project);
  const Json driven = driven_to_its_end(outcome);
  CHECK(driven.at("link").at("corrupt") == 0);
  CHECK(driven.at("link").at("foreign") == 0);
  CHECK(driven.at("link").at("commands") > 100);
  const Json emulated = session(plant);
  CHECK(emulated.at("ended") == "the peer left");  // its last command gave no torque
  CHECK(emulated.at("link").at("commands") > 100);
  CHECK(emulated.at("link").at("refused") == 0);
  CHECK(emulated.at("link").at("corrupt") == 0);
}

TEST_CASE("A run that only reads commands nothing") {
  const fs::path project = dog_project("unitree_read_only");
  Running plant(project, served(""));
  REQUIRE(plant.says("serves 'dog'"));
  const Outcome outcome = run("run config/dog/robot.json --plant unitree --peer " + place +
                                  " --soft --no-ctl --json --read-only --duration 0.5",
                              project);
  const Json driven = driven_to_its_end(outcome);
  CHECK(driven.at("link").at("states") > 0);
  CHECK(driven.at("link").at("commands") == 0);
  CHECK(session(plant).at("link").at("commands") == 0);
}

TEST_CASE("A program of others reads a quadruped's states, stands it up, and lets it damp and go") {
  const fs::path project = dog_project("unitree_peer_go");
  Running plant(project, served("--in-step"));
  REQUIRE(plant.says("serves 'dog'"));
  const Json standing = peer(project, "go watch 20 stand 500");
  CHECK(standing.at("states") == 520);
  CHECK(standing.at("bad_checksums") == 0);
  CHECK(standing.at("not_newer") == 0);
  CHECK(standing.at("error_rad") < 0.2);
  CHECK(standing.at("up") > 8);
  CHECK(session(plant).at("link").at("commands") >= 500);
}

TEST_CASE("Commands of others that are garbage are refused, each for what is wrong with it") {
  const fs::path project = dog_project("unitree_garbage");
  Running plant(project, served(""));
  REQUIRE(plant.says("serves 'dog'"));
  (void)peer(project, "go watch 5 garbage 40 stop 10 damp 50 off 20");
  const Json link = session(plant).at("link");
  CHECK(link.at("corrupt") >= 10);
  CHECK(link.at("refused") >= 10);
  CHECK(link.at("commands") >= 40);
}

TEST_CASE("The other family's messages go the same ways, and mode_machine is told back") {
  const fs::path project = dog_project("unitree_peer_hg");
  std::string motors;
  for (const char* leg : {"FR", "FL", "RR", "RL"}) {
    for (const char* part : {"hip", "thigh", "calf"}) {
      motors += (motors.empty() ? "" : ", ") + ("\"" + std::string(leg) + "_" + part + "_joint\": { \"number\": ") +
                std::to_string(std::count(motors.begin(), motors.end(), '{')) + " }";
    }
  }
  REQUIRE(edit(project / "config/dog/robot.json", "\"go2\"", "\"g1\", \"motors\": { " + motors + " }"));
  {
    Running plant(project, served(""));
    REQUIRE(plant.says("serves 'dog'"));
    const Json seen = peer(project, "hg watch 10 damp 100 off 20");
    CHECK(seen.at("bad_checksums") == 0);
    CHECK(seen.at("states") == 130);
    const Json link = session(plant).at("link");
    CHECK(link.at("foreign") == 0);
    CHECK(link.at("commands") >= 100);
  }
  Running plant(project, served("--in-step"));
  REQUIRE(plant.says("serves 'dog'"));
  const Outcome outcome = run("run config/dog/robot.json --plant unitree --peer " + place +
                                  " --soft --no-ctl --json --play get_up --duration 1",
                              project);
  (void)driven_to_its_end(outcome);
  CHECK(session(plant).at("link").at("foreign") == 0);
}

TEST_CASE("A robot of another kind is told by its type, and an empty network by what may be wrong") {
  const fs::path project = dog_project("unitree_other_kind");
  Running plant(project, served(""));
  REQUIRE(plant.says("serves 'dog'"));
  const fs::path robot = project / "config/dog/robot.json";
  REQUIRE(edit(robot, "\"unitree\": {", "\"unitree\": { \"motors\": { \"FR_hip_joint\": { \"number\": 0 } },"));
  std::string motors;
  for (const char* leg : {"FR", "FL", "RR", "RL"}) {
    for (const char* part : {"hip", "thigh", "calf"})
      motors += ",\"" + std::string(leg) + "_" + part +
                "_joint\":{\"number\":" + std::to_string(std::count(motors.begin(), motors.end(), ',')) + "}";
  }
  REQUIRE(edit(robot, "\"FR_hip_joint\": { \"number\": 0 }", motors.substr(1)));
  REQUIRE(edit(robot, "\"go2\"", "\"g1\""));
  const std::string command = "run config/dog/robot.json --plant unitree --soft --no-ctl --duration 1 --peer ";
  Outcome outcome = run(command + place, project);
  CHECK(outcome.exit_code == 2);
  CHECK_MESSAGE(has(outcome.err, "rt/lowstate is written there as unitree_go::msg::dds_::LowState_"), outcome.err);
  CHECK(plant.end(SIGTERM) == 0);
  REQUIRE(edit(robot, "\"connect_timeout_s\": 60", "\"connect_timeout_s\": 0.1"));
  outcome = run(command + place, project);
  CHECK(outcome.exit_code == 2);
  CHECK_MESSAGE(has(outcome.err, "g1 on DDS domain " + domain + " on lo: no state within 0.1 s: nobody writes"),
                outcome.err);
  outcome = run(command + "no_card", project);
  CHECK(outcome.exit_code == 2);
  CHECK_MESSAGE(has(outcome.err, "is there such a network card"), outcome.err);
  outcome = run(command + "lo:x", project);
  CHECK(outcome.exit_code == 2);
  CHECK_MESSAGE(has(outcome.err, "'lo:x' is no place of a unitree robot"), outcome.err);
}

TEST_CASE("When the process that drives it is killed, the emulated robot damps by itself") {
  const fs::path project = dog_project("unitree_killed");
  Running plant(project, served(""));
  REQUIRE(plant.says("serves 'dog'"));
  Running driven(project,
                 "run config/dog/robot.json --plant unitree --peer " + place + " --soft --no-ctl --play get_up -v");
  REQUIRE(driven.says("get_up"));
  CHECK(driven.end(SIGKILL) == 128 + SIGKILL);
  const Json emulated = session(plant);
  CHECK(emulated.at("releases") >= 1);
  CHECK(emulated.at("ended") == "the peer fell silent");
}

TEST_CASE("A run in whose robot somebody else writes says so, and stops writing") {
  const fs::path project = dog_project("unitree_second");
  Running plant(project, served("--in-step"));
  REQUIRE(plant.says("serves 'dog'"));
  Running driven(project,
                 "run config/dog/robot.json --plant unitree --peer " + place + " --soft --no-ctl --play get_up -v");
  REQUIRE(driven.says("get_up"));
  const Json other = peer(project, "go watch 5 damp 30");
  CHECK(other.at("bad_checksums") == 0);
  CHECK(driven.says("others write rt/lowcmd"));
  (void)driven.end(SIGTERM);
  (void)plant.end(SIGTERM);
}

}  // namespace unitree_dds_test
