#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

using namespace kadans::program;

namespace {

constexpr const char* squat = "sim config/scenarios/squat.json";

nlohmann::json parsed(const Outcome& outcome) {
  REQUIRE_MESSAGE(!outcome.out.empty(), outcome.err);
  return nlohmann::json::parse(outcome.out);
}

}  // namespace

TEST_CASE("sim runs the squat of a copied tree, prints a report, leaves a record and exits 0") {
  const auto project = project_copy("sim_report");
  const Outcome outcome = run(std::string(squat) + " --duration 3", project);
  CHECK(outcome.exit_code == 0);
  CHECK(has(outcome.out, "PASSED"));
  CHECK(has(outcome.out, "kadans sim config/scenarios/squat.json --seed 1 --duration 3"));
  CHECK(outcome.err.empty());  // no progress bar where there is no terminal
  CHECK(read(project / "squat.mcap").substr(1, 4) == "MCAP");
}

TEST_CASE("sim --json prints one object and nothing else") {
  const auto project = project_copy("sim_json");
  const Outcome outcome = run(std::string(squat) + " --duration 2 --json --record run.mcap", project);
  const auto json = parsed(outcome);
  CHECK(outcome.exit_code == 0);
  CHECK(json["scenario"] == "squat");
  CHECK(json["seed"] == 1);
  CHECK(json["passed"] == true);
  CHECK(json["duration_s"] == 2);
  CHECK(json["control_ticks"] == 2000);
  CHECK(json["behavior_ticks"] == 200);
  CHECK(json["queue"]["refused"] == 0);
  CHECK(json["queue"]["sent"] > 0);
  CHECK(json["faults"].empty());
  CHECK(json["tick_ns"]["median"] > 0);
  CHECK(json["record"] == "run.mcap");
  CHECK(read(project / "run.mcap").size() > 1000);
}

TEST_CASE("sim works from any folder, with paths meant from the file's project") {
  const auto project = project_copy("sim_elsewhere");
  const auto elsewhere = fresh_folder("sim_elsewhere_cwd");
  const Outcome outcome = run(
      "sim '" + (project / "config/scenarios/squat.json").string() + "' --duration 1 --no-record --json", elsewhere);
  CHECK(outcome.exit_code == 0);
  CHECK(parsed(outcome)["record"] == "");
}

TEST_CASE("A deeper squat in the Lua file is a deeper squat of the robot") {
  const auto project = project_copy("sim_deeper");
  const std::string until_crouched = std::string(squat) + " --duration 3.2 --json --no-record";
  const auto depth = [&] { return parsed(run(until_crouched, project))["checks"][0]["value"].get<double>(); };
  const double before_m = depth();
  REQUIRE(edit(project / "behaviors/tulip/squat.lua", "0.10", "0.13"));
  CHECK(depth() == doctest::Approx(before_m - 0.03).epsilon(0.006));
}

TEST_CASE("A script that does not parse is refused with its line before anything runs") {
  const auto project = project_copy("sim_syntax");
  write(project / "behaviors/tulip/squat.lua",
        "local k = require \"kadans\"\n\nreturn k.behavior \"squat\" {\n  initial = = 1\n}\n");
  const Outcome outcome = run(squat, project);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "behaviors/tulip/squat.lua:4:"));
  CHECK(outcome.out.empty());
  CHECK_FALSE(std::filesystem::exists(project / "squat.mcap"));
}

TEST_CASE("A script that fails while it runs is told with its line, the robot stays up and the run fails") {
  const auto project = project_copy("sim_script_error");
  write(project / "behaviors/tulip/squat.lua",
        "local k = require \"kadans\"\n"
        "return k.behavior \"squat\" {\n"
        "  controls = \"posture\",\n"
        "  initial = \"stand\",\n"
        "  k.state \"stand\" { { after = 0.5, to = \"broken\" } },\n"
        "  k.state \"broken\" {\n"
        "    enter = function(m)\n"
        "      local nothing = nil\n"
        "      nothing.field = 1\n"
        "    end,\n"
        "    { after = 1, to = \"up\" },\n"
        "  },\n"
        "  k.final \"up\" { outcome = \"done\" },\n"
        "}\n");
  const Outcome outcome = run(std::string(squat) + " --duration 4 --json --no-record", project);
  CHECK(outcome.exit_code == 1);
  const auto json = parsed(outcome);
  CHECK(json["passed"] == false);
  CHECK(has(json["errors"][0].get<std::string>(), "behaviors/tulip/squat.lua:9:"));
  CHECK(json["checks"][0]["name"] == "stays up, lowest height in m");
  CHECK(json["checks"][0]["passed"] == true);
}

TEST_CASE("A record that was asked for and cannot be written is an error, the usual one is not") {
  const auto project = project_copy("sim_no_disk");
  const Outcome asked = run(std::string(squat) + " --duration 1 --record nowhere/run.mcap", project);
  CHECK(asked.exit_code == 2);
  CHECK(has(asked.err, "nowhere/run.mcap"));
  std::filesystem::create_directory(project / "squat.mcap");  // a folder in the way
  const Outcome usual = run(std::string(squat) + " --duration 1", project);
  CHECK(usual.exit_code == 0);
  CHECK(has(usual.err, "squat.mcap"));
}

TEST_CASE("Wrong usage exits 2 and says what was meant") {
  const auto folder = fresh_folder("usage");
  CHECK(has(run("smi x.json", folder).err, "unknown command 'smi', did you mean 'sim'?"));
  for (const char* wrong :
       {"", "smi", "sim", "sim x.json --seed one", "sim x.json --duration -1", "sim x.json --duration nan",
        "sim x.json --sed 1", "sim nowhere.json", "check", "check nowhere.json"}) {
    CAPTURE(wrong);
    const Outcome outcome = run(wrong, folder);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK_FALSE(outcome.err.empty());
  }
  CHECK(has(run("sim nowhere.json", folder).err, "nowhere.json"));
}

TEST_CASE("--help and --version go to stdout and exit 0") {
  const auto folder = fresh_folder("help");
  const Outcome help = run("--help", folder);
  CHECK(help.exit_code == 0);
  CHECK(has(help.out, "kadans sim config/scenarios/squat.json"));
  CHECK(has(help.out, "Exit codes"));
  CHECK(run("--version", folder).out.rfind("kadans ", 0) == 0);
  CHECK(has(run("sim --help", folder).out, "--seed"));
}
