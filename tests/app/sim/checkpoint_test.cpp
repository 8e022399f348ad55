// kadans sim --checkpoint and --from: a run that goes on is the one that was never interrupted.
#include <map>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"
#include "telemetry/mcap/mcap_reader.h"

namespace checkpoint_test {

using namespace kadans::program;

namespace {

namespace fs = std::filesystem;

// A squat with noise and varied masses, standing on its feet, pushed after the checkpoint; a motion is under way at it.
constexpr double pushed_s = 2.4, checkpoint_s = 2.2;
constexpr const char* squat = "sim config/scenarios/pushed.json";

fs::path project(const std::string& name) {
  const fs::path folder = project_copy(name);
  std::string scenario = read(folder / "config/scenarios/squat_varied.json");
  const std::size_t at = scenario.find("\"randomise\"");
  REQUIRE(at != std::string::npos);
  scenario.insert(at, "\"pushes\": [{ \"link\": \"torso\", \"at_s\": " + std::to_string(pushed_s) +
                          ", \"impulse_Ns\": [0, 1.5, 0] }],\n  ");
  write(folder / "config/scenarios/pushed.json", scenario);
  return folder;
}

nlohmann::json parsed(const Outcome& outcome) {
  REQUIRE_MESSAGE(!outcome.out.empty(), outcome.err);
  return nlohmann::json::parse(outcome.out);
}

// The bytes of each message from a tick on, by topic and tick.
using Rows = std::map<std::pair<std::string, std::uint32_t>, std::string>;
Rows rows(const fs::path& record, std::uint32_t from) {
  Rows all;
  kadans::McapReader reader(record.string());
  for (kadans::McapMessage message; reader.next(message);) {
    const auto& channel = reader.channels().at(message.channel);
    if (message.sequence < from || channel.metadata.count("signals") == 0) continue;
    all[{channel.topic, message.sequence}] = {reinterpret_cast<const char*>(message.payload.data()),
                                              message.payload.size()};
  }
  CHECK(reader.complete());
  return all;
}

}  // namespace

TEST_CASE(
    "A run that goes on from a checkpoint ends with the hash and the record of the run that was not interrupted") {
  const fs::path folder = project("checkpoint_same");
  const auto whole = parsed(run(std::string(squat) + " --duration 3 --seed 3 --json --record whole.mcap", folder));
  const auto left = parsed(run(std::string(squat) + " --duration 3 --seed 3 --json --no-record --checkpoint " +
                                   std::to_string(checkpoint_s) + "=here.mcap",
                               folder));
  CHECK(left["state_hash"] == whole["state_hash"]);
  fs::remove_all(folder / "behaviors");  // a checkpoint has all that it needs
  fs::remove_all(folder / "models");
  const auto on = parsed(run("sim --from here.mcap --json --record on.mcap", folder));
  CHECK(on["state_hash"] == whole["state_hash"]);
  CHECK(on["control_ticks"] == 3000);
  CHECK(on["checks"] == whole["checks"]);
  CHECK(on["quantities"] == whole["quantities"]);
  const Rows expected = rows(folder / "whole.mcap", 2200), found = rows(folder / "on.mcap", 0);
  CHECK(expected.size() >= 800);
  // A topic that stands still is written seldom, counted from a record's first row: not in the same ticks by both.
  std::size_t of_both = 0;
  std::string differ;
  for (const auto& [row, bytes] : found) {
    const auto other = expected.find(row);
    if (other == expected.end()) continue;
    ++of_both;
    if (other->second != bytes) differ = row.first + " in tick " + std::to_string(row.second);
  }
  CHECK(differ == "");
  CHECK(of_both > 3000);
}

TEST_CASE(
    "Branches of a checkpoint part from one state: what changes nothing goes on the same, the others each their way") {
  const fs::path folder = project("checkpoint_branches");
  const auto whole =
      parsed(run(std::string(squat) + " --duration 3 --json --no-record --checkpoint 2.2=here.mcap", folder));
  const Outcome outcome =
      run("sim --from here.mcap --json --branch same: --branch 'hard: push torso=0,2,0' "
          "--branch 'soft: set control.posture.*.kp_Nm_per_rad_scale=0.8; play wave'",
          folder);
  CHECK(outcome.err.empty());
  std::istringstream lines(outcome.out);
  std::map<std::string, nlohmann::json> branches;
  std::string order;
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::json::parse(line);
    order += json["branch"].get<std::string>() + " ";
    branches[json["branch"]] = json;
  }
  CHECK(order == "same hard soft ");
  CHECK(branches["same"]["state_hash"] == whole["state_hash"]);
  CHECK(branches["hard"]["state_hash"] != whole["state_hash"]);
  CHECK(branches["soft"]["state_hash"] != whole["state_hash"]);
  // One alone, not split off, is the same again; and its record replays, branch and all.
  const auto alone = parsed(run("sim --from here.mcap --json --push torso=0,2,0 --record alone.mcap", folder));
  CHECK(alone["state_hash"] == branches["hard"]["state_hash"]);
  for (const char* record : {"alone.mcap", "pushed.soft.mcap", "squat_varied.soft.mcap"}) {
    if (!fs::exists(folder / record)) continue;
    CAPTURE(record);
    const Outcome replayed = run(std::string("replay --from-record ") + record, folder);
    CHECK(replayed.exit_code == 0);
    CHECK(has(replayed.out, "the same, 800 ticks"));
  }
  CHECK(fs::exists(folder / "squat_varied.soft.mcap"));
}

TEST_CASE("A checkpoint that does not come out as it was left is refused, with the time by which it parted") {
  const fs::path folder = project("checkpoint_parted");
  REQUIRE(run(std::string(squat) + " --duration 1 --no-record --checkpoint 0.6=here.mcap", folder).exit_code == 0);
  std::string bytes = read(folder / "here.mcap");
  const std::size_t mark = bytes.find("\n300000000 ");  // the hash after 0.3 s, and the one at the end
  const std::size_t end = bytes.find("state_hash");
  REQUIRE(mark != std::string::npos);
  REQUIRE(end != std::string::npos);
  const auto change = [&](std::size_t at) { bytes[at] = bytes[at] == '1' ? '2' : '1'; };
  change(mark + 12);
  change(end + 10 + 4);
  write(folder / "here.mcap", bytes);
  const Outcome outcome = run("sim --from here.mcap --no-record", folder);
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out.empty());
  CHECK(has(outcome.err, "they part between 0.2 s and 0.3 s"));
}

TEST_CASE("A control object that comes to the checkpoint in another state is named, though all signals are the same") {
  const fs::path folder = project("checkpoint_object");
  REQUIRE(run(std::string(squat) + " --duration 0.4 --no-record --checkpoint 0.2=here.mcap", folder).exit_code == 0);
  std::string bytes = read(folder / "here.mcap");
  const std::size_t objects = bytes.find("control_objects");
  const std::size_t posture = bytes.find("posture", objects);
  REQUIRE(objects != std::string::npos);
  REQUIRE(posture != std::string::npos);
  char& digit = bytes[posture + 7 + 4];  // behind the name and the length of the hash
  digit = digit == '1' ? '2' : '1';
  write(folder / "here.mcap", bytes);
  const Outcome outcome = run("sim --from here.mcap --no-record", folder);
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out.empty());
  CHECK(has(outcome.err, "the state of these control objects differs: posture\n"));
}

TEST_CASE("Wrong wishes for checkpoints and branches are refused before anything runs") {
  const fs::path folder = project("checkpoint_wrong");
  REQUIRE(run(std::string(squat) + " --duration 0.3 --no-record --checkpoint 0.2=here.mcap", folder).exit_code == 0);
  struct Wrong {
    const char *arguments, *says;
  };
  for (const Wrong& wrong :
       {Wrong{"config/scenarios/pushed.json --checkpoint 0.2", "must be SECONDS=FILE"},
        Wrong{"config/scenarios/pushed.json --push torso=0,1,0", "goes with --from"},
        Wrong{"config/scenarios/pushed.json --from here.mcap", "has its own scenario"}, Wrong{"", "name a scenario"},
        Wrong{"--from config/tulip/robot.json", "not an MCAP file"}, Wrong{"--from here.mcap --seed 2", "the seed"},
        Wrong{"--from here.mcap --duration 0.1", "more than the 0.2 s"},
        Wrong{"--from here.mcap --set ground.friction=0.2", "stays as it is"},
        Wrong{"--from here.mcap --set control.postur.l_knee.kp_Nm_per_rad=2", "did you mean"},
        Wrong{"--from here.mcap --set control.posture.l_knee.kp_Nm_per_rad=-2", "must be 0.."},
        Wrong{"--from here.mcap --push torsoo=0,1,0", "did you mean 'torso'?"},
        Wrong{"--from here.mcap --push torso=0,1", "LINK=X,Y,Z"},
        Wrong{"--from here.mcap --play wawe", "did you mean 'wave'?"},
        Wrong{"--from here.mcap --branch 'a: jump high'", "must be set"},
        Wrong{"--from here.mcap --branch 'a:' --set control.x=1", "says itself"}}) {
    CAPTURE(std::string(wrong.arguments));
    const Outcome outcome = run(std::string("sim --no-record ") + wrong.arguments, folder);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK(has(outcome.err, wrong.says));
  }
}

}  // namespace checkpoint_test
