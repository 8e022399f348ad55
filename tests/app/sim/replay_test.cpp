// kadans replay: the same, or where and why not.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"
#include "telemetry/record/run_inputs.h"

using namespace kadans::program;

namespace {

namespace fs = std::filesystem;

constexpr const char* recorded = "sim config/scenarios/squat_varied.json --seed 4 --duration 1.7 --record run.mcap";

fs::path recorded_project(const std::string& name, const std::string& options = "") {
  const fs::path project = project_copy(name);
  const Outcome outcome = run(recorded + (" " + options), project);
  REQUIRE_MESSAGE(fs::exists(project / "run.mcap"), outcome.err);
  return project;
}

void cut(const fs::path& file, std::size_t bytes) { write(file, read(file).substr(0, bytes)); }

bool same(const Outcome& outcome) { return outcome.exit_code == 0 && has(outcome.out, "run.mcap: the same, "); }

}  // namespace

TEST_CASE("A record replays bit for bit with what was set and drawn for it, from its project and from anywhere") {
  const fs::path project = recorded_project(
      "replay_same",
      "--set ground.friction=0.6 --play 'squat{repeats=1, depth_m=0.05} | wave' --set link.torso.mass_scale=1.1");
  const Outcome here = run("replay run.mcap", project);
  CHECK(same(here));
  CHECK(has(here.out, "1700 ticks"));
  CHECK_FALSE(has(here.out, "since it was recorded"));
  const fs::path elsewhere = fresh_folder("replay_elsewhere");
  fs::copy(project / "run.mcap", elsewhere / "run.mcap");
  const Outcome lost = run("replay run.mcap", elsewhere);
  CHECK(lost.exit_code == 2);
  CHECK(has(lost.err, "--from-record"));
  CHECK(same(run("replay run.mcap --from-record", elsewhere)));
  CHECK(same(run("replay '" + (project / "run.mcap").string() + "'", elsewhere)));
}

TEST_CASE("A record replays from itself when its robot gives parameters to behaviors that it did not play") {
  const fs::path project = project_copy("replay_behavior_values");
  REQUIRE(run("sim config/scenarios/soft_squat.json --duration 1.2 --record run.mcap", project).err.empty());
  const fs::path elsewhere = fresh_folder("replay_behavior_values_elsewhere");
  fs::copy(project / "run.mcap", elsewhere / "run.mcap");
  const Outcome outcome = run("replay run.mcap --from-record", elsewhere);
  CHECK_MESSAGE(same(outcome), outcome.err);
}

TEST_CASE("After a change of script, configuration or model the replay says where it parts and which file changed") {
  const fs::path project = recorded_project("replay_changed");
  struct Change {
    const char *file, *from, *to;
  };
  for (const Change& change : {Change{"behaviors/tulip/squat.lua", "0.10", "0.11"},
                               Change{"config/tulip/robot.json", "\"*_knee\": 0.3", "\"*_knee\": 0.301"},
                               Change{"models/tulip/tulip.urdf", "mass value=\"", "mass value=\"1"},
                               Change{"config/scenarios/squat_varied.json", "[0.5, 1.0]", "[0.5, 1.1]"}}) {
    const auto [file, from, to] = change;
    CAPTURE(change.file);
    const std::string before = read(project / file);
    REQUIRE(edit(project / file, from, to));
    const Outcome parted = run("replay run.mcap", project);
    CHECK(parted.exit_code == 1);
    CHECK(has(parted.out, "parts in tick "));
    CHECK(has(parted.out, "since it was recorded: " + std::string(file) + " changed"));
    CHECK(same(run("replay run.mcap --from-record", project)));
    write(project / file, before);
  }
  CHECK(same(run("replay run.mcap", project)));
}

TEST_CASE("The replay names the first tick and signal that differ, and by how much, as JSON too") {
  const fs::path project = recorded_project("replay_json");
  REQUIRE(edit(project / "behaviors/tulip/squat.lua", "0.10", "0.11"));
  const Outcome outcome = run("replay run.mcap --json", project);
  CHECK(outcome.exit_code == 1);
  const auto json = nlohmann::json::parse(outcome.out);
  CHECK(json["same"] == false);
  CHECK(json["parted"]["tick"] == 1501);  // the first after the squat begins
  CHECK(json["ticks"] == 1501);
  CHECK(json["files"][0]["what"] == "behaviors/tulip/squat.lua");
  CHECK(json["program"].empty());
  bool found = false;
  for (const auto& signal : json["parted"]["signals"]) {
    if (signal["name"] != "control.posture.l_knee.reference_rad") continue;
    found = true;
    CHECK(signal["unit"] == "rad");
    CHECK(signal["recorded"] != signal["replayed"]);
    CHECK(signal["by"] == signal["replayed"].get<double>() - signal["recorded"].get<double>());
  }
  CHECK(found);
}

TEST_CASE("A comment in a script changes its file and nothing else") {
  const fs::path project = recorded_project("replay_comment");
  write(project / "behaviors/tulip/squat.lua", read(project / "behaviors/tulip/squat.lua") + "-- no more\n");
  const Outcome outcome = run("replay run.mcap", project);
  CHECK(same(outcome));
  CHECK(has(outcome.out, "behaviors/tulip/squat.lua changed"));
}

TEST_CASE("A record that is cut short is replayed as far as it goes") {
  const fs::path project = recorded_project("replay_cut");
  cut(project / "run.mcap", read(project / "run.mcap").size() * 2 / 3);
  const Outcome outcome = run("replay run.mcap", project);
  CHECK(same(outcome));
  CHECK(has(outcome.out, "the record is not whole"));
  CHECK_FALSE(has(outcome.out, "1700 ticks"));
}

TEST_CASE("What cannot be run again is refused with the reason, and what is missing is named") {
  const fs::path project = recorded_project("replay_refused");
  const auto refused = [&](const char* file) {
    const Outcome outcome = run(std::string("replay ") + file, project);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    return outcome.err;
  };
  CHECK(has(refused("config/tulip/robot.json"), "not an MCAP file"));
  CHECK(has(refused("nowhere.mcap"), "there is no such file"));
  const std::string whole = read(project / "run.mcap");
  write(project / "head.mcap", whole.substr(0, 30));
  CHECK(has(refused("head.mcap"), "ends before it begins"));
  kadans::McapWriter other;  // as another program or a real robot leaves it
  REQUIRE(other.open((project / "other.mcap").string()));
  REQUIRE(other.close());
  CHECK(has(refused("other.mcap"), "was not recorded by kadans"));
  kadans::McapWriter real;
  REQUIRE(real.open((project / "real.mcap").string()));
  REQUIRE(kadans::write_inputs(real, {.run = {{"clock", "wall"}}}));
  REQUIRE(real.close());
  CHECK(has(refused("real.mcap"), "its clock is 'wall'"));
  fs::remove(project / "behaviors/lib/legs.lua");
  const std::string missing = refused("run.mcap");
  CHECK(has(missing, "behaviors/lib/legs.lua is gone"));
  CHECK(has(missing, "no module 'legs'"));
}
