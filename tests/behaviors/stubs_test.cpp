#include <algorithm>

#include <doctest/doctest.h>

#include "app/assembly/robot.h"
#include "app/program.h"
#include "script/bindings/api.h"

using namespace kadans;

TEST_CASE("the table of the API names what the sandbox binds, all of it and nothing else") {
  const Robot robot = read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json");
  const auto system = make_control_system(robot);
  std::vector<std::string> told;
  for (const ApiEntry& entry : script_api()) {
    const std::string name = entry.name;
    told.push_back(std::string(entry.owner) + "." + name.substr(0, name.find('(')));
  }
  std::sort(told.begin(), told.end());
  CHECK(told == bound_names(KADANS_SOURCE_DIR, KADANS_SOURCE_DIR "/behaviors/tulip/squat.lua", system->catalog));
}

TEST_CASE("lua-stubs writes the robot's own names, and an editor's settings") {
  const auto project = program::project_copy("stubs");
  const auto outcome = program::run("lua-stubs --output editor --robot config/tulip/robot.json", project);
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const std::string stubs = program::read(project / "editor/kadans.lua");
  CHECK(stubs.starts_with("---@meta"));
  CHECK(program::has(stubs, "---@field posture kadans.posture"));
  CHECK(program::has(stubs, "---@field l_knee kadans.Joint"));
  CHECK(program::has(stubs, "'\"l_knee.position_rad\"'"));
  CHECK(program::has(stubs, "'\"stiff\"'"));
  CHECK(program::has(stubs,
                     "---@field move fun(self, pose: kadans.pose|table<string, number>, options: "
                     "kadans.MoveOptions): kadans.Motion?, string?"));
  CHECK(program::has(stubs, "---@class kadans.MoveOptions\n---@field time_s? number"));
  CHECK(program::has(stubs, "---@class kadans.FollowLimits\n---@field velocity_max_rad_s number"));
  CHECK(program::has(stubs, "---@class kadans.Log\n---@field info fun(format: string, ...: any): nil"));
  CHECK(program::has(program::read(project / "editor/.luarc.json"), "\"runtime.version\": \"LuaJIT\""));
}

TEST_CASE("the committed reference is what the table says") {
  CHECK(program::read(KADANS_SOURCE_DIR "/docs/behaviors_reference.md") == api_reference(KADANS_SOURCE_DIR));
}

TEST_CASE("params lists the parameters of a behavior and of a robot, with ranges and units") {
  const auto project = program::project_copy("params");
  const auto behavior = program::run("params behaviors/tulip/squat.lua --json", project);
  CHECK(behavior.exit_code == 0);
  CHECK(program::has(behavior.out, R"("name":"depth_m","value":0.1,"unit":"m","min":0.0,"max":0.2)"));
  const auto robot = program::run("params config/tulip/robot.json", project);
  CHECK(robot.exit_code == 0);
  CHECK(program::has(robot.out, "posture.l_knee.kp_Nm_per_rad"));
}
