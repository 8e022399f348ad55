// The commands and the configuration of docs/control.md, in a copy of the project. Its tests are built into this
// program.
#include <filesystem>
#include <sstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace fs = std::filesystem;
using namespace kadans::program;
using Json = nlohmann::json;

namespace {

const fs::path guide = GUIDE_FOLDER;

// The project with the guide's plug-in in it, and its block of configuration added to TULip's.
fs::path project_of_the_guide(const std::string& name) {
  fs::path project = project_copy(name);
  fs::create_directories(project / "plugins");
  fs::copy(guide / "knee_pd.so", project / "plugins");
  const Json block = Json::parse(read(guide / "blocks/configuration.json"));
  Json robot = Json::parse(read(project / "config/tulip/robot.json"));
  robot["plugins"] = block.at("plugins");
  Json& control = robot["control"];
  for (const Json& object : block.at("control").at("objects")) control["objects"].push_back(object);
  for (const auto& [set, objects] : block.at("control").at("sets").items()) control["sets"][set] = objects;
  write(project / "config/tulip/robot.json", robot.dump(2));
  return project;
}

}  // namespace

TEST_CASE("The guide's commands run in a project with the guide's plug-in") {
  const fs::path project = project_of_the_guide("guide");
  std::istringstream commands(read(guide / "blocks/commands.sh"));
  int executed = 0;
  for (std::string line; std::getline(commands, line);) {
    if (line.empty()) continue;
    REQUIRE_MESSAGE(line.starts_with("kadans "), line);
    const Outcome outcome = run(line.substr(7), project);
    CHECK_MESSAGE(outcome.exit_code == 0, line << ": " << outcome.err);
    ++executed;
  }
  CHECK(executed >= 2);
  CHECK(fs::exists(project / "knee_pd/knee_pd_test.cpp"));
}

TEST_CASE("A robot of the guide's configuration runs a scenario with the plug-in's object in it") {
  const fs::path project = project_of_the_guide("guide_sim");
  const Outcome outcome = run("sim config/scenarios/squat.json --duration 0.05 --no-record --json", project);
  CHECK_MESSAGE(outcome.exit_code <= 1, outcome.err);
  CHECK(has(outcome.out, "state_hash"));
}

TEST_CASE("A plug-in that is not there or is none is refused at its place in the configuration") {
  const fs::path project = project_of_the_guide("guide_refused");
  write(project / "plugins/knee_pd.so", "no library");
  const Outcome wrong = run("check --plugins config/tulip/robot.json", project);
  CHECK(wrong.exit_code == 2);
  CHECK(has(wrong.err, "config/tulip/robot.json:"));
  CHECK(has(wrong.err, "knee_pd.so: cannot be loaded"));
  fs::remove(project / "plugins/knee_pd.so");
  write(project / "plugins/knee_pb.so", "");
  const Outcome missing = run("check config/tulip/robot.json", project);
  CHECK(missing.exit_code == 2);
  CHECK(has(missing.err, "there is no file 'plugins/knee_pd.so'"));
  CHECK(has(missing.err, "did you mean 'knee_pb.so'?"));
}
