// kadans shrink as a person runs it, on JIWIY, of which 10 s are simulated in 30 ms: what is needed is known, because
// the check looks at the pan alone, which one of the pushes moves far enough.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace shrink_command_test {

using namespace kadans::program;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

const std::string pushed = R"({
  "$schema": "../schema/scenario.schema.json", "name": "pushed", "robot": "config/jiwiy/robot.json",
  "duration_s": 1, "seed": 3, "tags": ["pushed"], "repeat": 2,
  "pushes": [
    { "link": "camera", "at_s": 0.1, "impulse_Ns": [0, 0.02, 0], "point_m": [0.05, 0, 0] },
    { "link": "camera", "at_s": 0.3, "duration_s": 0.05, "impulse_Ns": [0, 0.3, 0], "point_m": [0.05, 0, 0] },
    { "link": "camera", "at_s": 0.5, "impulse_Ns": [0, 0, 0.02], "point_m": [0.05, 0, 0] }
  ],
  "faults": [{ "kind": "drive_late", "of": "pan", "from_s": 0.2, "size": 1 }],
  "events": [{ "at_s": 0.15, "do": "pause" }],
)";
const std::string varied = R"(
  "randomise": { "link.*.mass_scale": { "uniform": [0.98, 1.02] }, "joint.*.damping_scale": { "uniform": [0.9, 1.1] } },
)";
const std::string checks = R"(
  "checks": [{ "name": "pan", "kind": "always", "that": "abs(joint.pan.position_rad) < 0.02" },
             { "name": "tilt", "kind": "always", "that": "abs(joint.tilt.position_rad) < 3" }]
})";

fs::path project(const std::string& name, const std::string& text) {
  const fs::path folder = project_copy("shrink_" + name);
  write(folder / "config/scenarios/pushed.json", text);
  return folder;
}

Json shrunk(const std::string& arguments, const fs::path& folder) {
  const Outcome outcome = run("shrink " + arguments + " --json", folder);
  REQUIRE_MESSAGE(outcome.exit_code == 0, outcome.err);
  return Json::parse(outcome.out);
}

}  // namespace

TEST_CASE(
    "A failing scenario is reduced to the push that is needed, and the file that says so fails by the same check") {
  const fs::path folder = project("one", pushed + varied + checks);
  const Json report = shrunk("config/scenarios/pushed.json", folder);
  CHECK(report.at("check") == "pan");
  CHECK(report.at("disturbances") == Json{{"before", 5}, {"after", 1}});
  CHECK(report.at("quantities") == Json{{"before", 5}, {"after", 0}});
  CHECK(report.at("impulse_Ns").at("after").get<double>() < 0.25);
  CHECK(report.at("complete") == true);
  CHECK(report.at("runs").get<int>() < 80);
  CHECK(has(report.at("sentence"), "It fails because of a push of 0."));
  CHECK(has(report.at("sentence"), "Ns on camera at 0.3 s. The run as it was could not be saved from tick 3"));
  const Json file = Json::parse(read(folder / "pushed_shrunk.json"));
  REQUIRE(file.at("pushes").size() == 1);
  CHECK(file.at("pushes")[0].at("at_s") == 0.3);
  for (const char* gone : {"faults", "events", "randomise", "set", "seed", "tags", "repeat"})
    CHECK_FALSE(file.contains(gone));
  CHECK(file.at("duration_s").get<double>() < 0.45);
  CHECK(file.at("checks").size() == 1);
  CHECK(run("check pushed_shrunk.json", folder).exit_code == 0);
  const Json again = Json::parse(run("sim pushed_shrunk.json --no-record --json", folder).out);
  CHECK(again.at("checks")[0].at("passed") == false);
  // With a fiftieth less it passes: it is the least.
  Json less = file;
  const double impulse_Ns = file.at("pushes")[0].at("impulse_Ns")[1];
  less["pushes"][0]["impulse_Ns"][1] = 0.98 * impulse_Ns;
  less["duration_s"] = 1;
  write(folder / "less.json", less.dump());
  CHECK(run("sim less.json --no-record", folder).exit_code == 0);
}

TEST_CASE("The result and the count of the runs are the same, however many run at once") {
  const fs::path folder = project("jobs", pushed + varied + checks);
  Json one = shrunk("config/scenarios/pushed.json -j 1 --out one.json", folder);
  Json many = shrunk("config/scenarios/pushed.json -j 5 --out many.json", folder);
  for (Json* report : {&one, &many}) report->erase("out");
  CHECK(one == many);
  CHECK(edit(folder / "many.json", "\"many\"", "\"one\""));
  CHECK(read(folder / "many.json") == read(folder / "one.json"));
}

TEST_CASE("What is short enough is based on the original, when nothing but the failure fails in it") {
  std::string text = pushed + checks;
  const fs::path folder = project("based", text);
  (void)shrunk("config/scenarios/pushed.json --out config/scenarios/less.json", folder);
  const std::string less = read(folder / "config/scenarios/less.json");
  CHECK(has(less, R"("based_on": "config/scenarios/pushed.json")"));
  CHECK(has(less, R"("$schema": "../schema/scenario.schema.json")"));
  CHECK(has(less, R"("faults": [])"));
  CHECK_FALSE(has(less, "robot"));
  CHECK(run("sim config/scenarios/less.json --no-record", folder).exit_code == 1);
  const Outcome refused = run("shrink config/scenarios/pushed.json --out config/scenarios/less.json", folder);
  CHECK(refused.exit_code == 2);
  CHECK(has(refused.err, "is there already"));
  (void)shrunk("config/scenarios/less.json --out config/scenarios/less2.json", folder);  // and that is reduced in turn
}

TEST_CASE("A fault that is needed is made short, and the quantity without which it would not matter stays") {
  const fs::path folder = project("fault", R"({ "name": "weak", "robot": "config/jiwiy/robot.json", "duration_s": 1,
    "set": { "joint.pan.damping_scale": 1.1, "link.*.mass_scale": 1.5 },
    "faults": [{ "kind": "drive_dead", "of": "tilt", "from_s": 0.2 }, { "kind": "drive_dead", "of": "pan", "from_s": 0.4 }],
    "checks": [{ "name": "held", "kind": "never", "that": "abs(joint.tilt.position_rad) > 0.02" }] })");
  const Json report = shrunk("config/scenarios/pushed.json", folder);
  CHECK(report.at("disturbances").at("after") == 1);
  const Json file = Json::parse(read(folder / "pushed_shrunk.json"));
  CHECK(file.at("faults")[0].at("of") == "tilt");
  CHECK(file.at("faults")[0].at("until_s").get<double>() < 0.5);
  CHECK(has(report.at("sentence"), "the fault drive_dead of tilt from 0.2 s to 0."));
}

TEST_CASE("A check of the end is judged in the shortest run that passes without the disturbances") {
  const fs::path folder = project("end", R"({ "name": "end", "robot": "config/jiwiy/robot.json", "duration_s": 2,
    "faults": [{ "kind": "drive_dead", "of": "tilt", "from_s": 0.2 }],
    "checks": [{ "name": "up", "kind": "at_end", "that": "abs(joint.tilt.position_rad) < 0.05" }] })");
  const Json report = shrunk("config/scenarios/pushed.json", folder);
  CHECK(report.at("duration_s").at("after").get<double>() < 1);
  CHECK(report.at("duration_s").at("after").get<double>() > 0.2);
}

TEST_CASE("A behavior's error is a failure, too: what is left raises the same one") {
  const fs::path folder = project("error", R"({ "name": "error", "robot": "config/jiwiy/robot.json", "duration_s": 1,
    "behaviors": ["breaks"],
    "pushes": [{ "link": "camera", "at_s": 0.1, "impulse_Ns": [0, 0.02, 0] }],
    "events": [{ "at_s": 0.3, "do": "emit", "event": "kicked" }, { "at_s": 0.4, "do": "emit", "event": "seen" }],
    "checks": [] })");
  write(folder / "behaviors/jiwiy/breaks.lua", R"(local k = require "kadans"

k.events { kicked = {}, seen = {} }

return k.behavior "breaks" {
  controls = "position",
  initial  = "rest",
  k.state "rest" { { on = "kicked", to = "kick" }, { on = "seen", to = "rest" } },
  k.state "kick" { enter = function() error("no leg to kick with") end, { on = "seen", to = "rest" } },
}
)");
  const Json report = shrunk("config/scenarios/pushed.json", folder);
  CHECK(report.at("check") == "");
  CHECK(has(report.at("failure"), "no leg to kick with"));
  CHECK(report.at("because_of") == Json{"the event 'emit kicked' at 0.3 s"});
}

TEST_CASE("A case of a sweep is shrunk by its folder, its number, its file or the line that repeats it") {
  const fs::path folder = project("sweep", pushed + checks);
  write(folder / "config/sweeps/p.json", R"({ "name": "p", "scenarios": ["config/scenarios/pushed.json"],
    "sampling": "latin_hypercube", "cases": 3,
    "vary": { "joint.*.damping_scale": { "uniform": [0.9, 1.1], "together": true },
              "link.*.mass_scale": { "uniform": [0.95, 1.05] } } })");
  REQUIRE(run("sweep config/sweeps/p.json --out results", folder).exit_code == 1);
  fs::path file;
  for (const auto& entry : fs::directory_iterator(folder / "results/cases")) {
    if (entry.path().filename().string().starts_with("000001-")) file = entry.path();
  }
  Json by_file = shrunk("results/cases/" + file.filename().string() + " --out a.json", folder);
  Json by_number = shrunk("results --case 1 --out b.json", folder);
  const std::string line = Json::parse(read(file)).at("repeat");
  REQUIRE(line.starts_with("kadans sim "));
  Json by_line = shrunk(line.substr(11) + " --out c.json", folder);
  for (Json* report : {&by_file, &by_number, &by_line}) report->erase("out");
  CHECK(by_file == by_number);
  CHECK(by_file == by_line);
  CHECK(by_file.at("quantities") == Json{{"before", 5}, {"after", 0}});
  CHECK(shrunk("results --out d.json", folder).at("seed") != by_file.at("seed"));  // the first that failed
  const Outcome none = run("shrink results --case 7", folder);
  CHECK(none.exit_code == 2);
  CHECK(has(none.err, "has no result of case 7"));
}

TEST_CASE("What cannot be shrunk is told in a sentence, and nothing is written") {
  const fs::path folder = project("refused", pushed + varied + checks);
  const auto refused = [&](const std::string& arguments, const std::string& what) {
    const Outcome outcome = run("shrink " + arguments, folder);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK_MESSAGE(has(outcome.err, what), outcome.err);
  };
  refused("config/scenarios/jiwiy_sine.json", "passes with seed 1: there is no failure to shrink");
  refused("config/scenarios/pushed.json --check tilt", "'tilt' passes; what fails first is 'pan (");
  refused("config/scenarios/pushed.json --check pam", "unknown check 'pam', did you mean 'pan'?");
  refused("config/scenarios/pushed.json --set joint.pn.damping_scale=1", "did you mean 'joint.pan.damping_scale'");
  refused("config/scenarios/pushed.json --max-runs 2", "--max-runs: is too little");
  refused("config/scenarios/pushed.json --case 3", "goes with the results of a sweep");
  refused("config/sweeps/jiwiy.json", "is the plan of a sweep, not a scenario");
  refused("nowhere.json", "nowhere.json: there is no such file");
  write(folder / "fall.json", "\x89MCAP0\r\n and what follows");
  refused("fall.json", "is a record: its run cannot be changed");
  refused("fall.mcap", "fall.mcap: there is no such file");
  refused("config", "holds no results of a sweep");
  write(folder / "config/scenarios/slow.json", R"({ "name": "slow", "robot": "config/tulip/robot.json",
    "duration_s": 100000, "wall_limit_s": 0.2, "checks": [] })");
  refused("config/scenarios/slow.json", "takes longer than its wall_limit_s of 0.2 s");
  write(folder / "config/scenarios/broken.json", R"({ "name": "broken", "robot": "config/jiwiy/robot.json",
    "duration_s": 1, "pushes": [{ "link": "camra", "at_s": 0 , "impulse_Ns": [0, 0, 1] }] })");
  refused("config/scenarios/broken.json", "broken.json:2:43: unknown link 'camra', did you mean 'camera'?");
  CHECK_FALSE(fs::exists(folder / "pushed_shrunk.json"));
}

TEST_CASE("After the runs that are allowed, what has been found until then is written, and said not to be all") {
  const fs::path folder = project("spent", pushed + varied + checks);
  const Json report = shrunk("config/scenarios/pushed.json --max-runs 6", folder);
  CHECK(report.at("complete") == false);
  CHECK(report.at("lost_tick").is_null());
  CHECK(run("sim pushed_shrunk.json --no-record", folder).exit_code == 1);
  const Outcome text = run("shrink config/scenarios/pushed.json --max-runs 6 --overwrite", folder);
  CHECK(has(text.out, "no more were allowed (--max-runs)"));
}

}  // namespace shrink_command_test
