#include <cstdio>
#include <filesystem>
#include <set>

#include "commands.h"
#include "kadans/app/assembly.h"
#include "kadans/config/based_on.h"
#include "kadans/config/project_root.h"
#include "kadans/model/urdf.h"
#include "kadans/script/check_behavior.h"
#include "sweep_command.h"
#include "terminal.h"
#include "tune_command.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

std::string check_urdf(const std::string& file) {
  const RobotModel model = read_urdf(file, {.mesh_hulls = true});
  std::size_t motors = 0;
  for (const Joint& joint : model.joints) motors += joint.passive() ? 0 : 1;
  char text[128];
  std::snprintf(text, sizeof text, "robot description: %zu links, %zu joints, %zu motors, %.3f kg", model.links.size(),
                model.joints.size(), motors, model.mass_kg());
  return text;
}

// Whether the behaviors that the robot gives parameters take them.
void check_behavior_values(const RobotConfig& config, const Catalog& catalog) {
  std::set<std::string> files;
  for (const BehaviorValue& given : config.behavior_values) files.insert(given.chunk);
  const fs::path root = project_root(config.file);
  std::vector<InputProblem> problems;
  for (const std::string& file : files) {
    for (InputProblem& problem : check_behavior(root, file, catalog)) problems.push_back(std::move(problem));
  }
  tell_once(problems);
  if (!problems.empty()) throw InputError(problems);
}

std::string check_robot(const std::string& file) {
  const Robot robot = read_robot(file);
  const auto system = make_control_system(robot);
  const ControlSets sets(system->catalog, std::move(system->objects));
  check_behavior_values(robot.config, system->catalog);
  return "robot: " + std::to_string(sets.size()) + " control objects, " + std::to_string(system->catalog.sets.size()) +
         " control sets, " + std::to_string(system->catalog.parameters.size()) + " parameters";
}

std::string check_scenario(const std::string& file) {
  const ScenarioConfig scenario = read_scenario_config(file);
  RunLog log;
  const Assembly assembly(scenario, scenario.seed, log);
  const Checks checks(assembly.catalog().signals, scenario.checks, scenario.file);
  return "scenario: " + std::to_string(scenario.behaviors.size()) + " behaviors, " + std::to_string(checks.size()) +
         " checks, " + std::to_string(assembly.catalog().signals.size()) + " signals";
}

// A behavior belongs to the robot whose configuration has the name of the behavior's folder.
std::string check_lua(const std::string& file, const std::string& robot) {
  fs::path config = robot;
  if (config.empty()) {
    config = project_root(file) / "config" / fs::absolute(file).parent_path().filename() / "robot.json";
    if (!fs::exists(config)) {
      throw InputError(
          {.file = file,
           .message = "no robot to check it against: there is no " + config.string() + "; name one with --robot FILE"});
    }
  }
  const Robot made_for = read_robot(config);
  const auto system = make_control_system(made_for);
  const std::vector<InputProblem> problems = check_behavior(project_root(file), file, system->catalog);
  if (!problems.empty()) throw InputError(problems);
  return "behavior: fits " + made_for.config.name;
}

std::string check_json(const std::string& file) {
  const JsonValue json = parse_based_json(read_input_file(file), file).value;
  if (json.find("tune") != nullptr) return check_tune_plan(file);
  if (json.find("scenarios") != nullptr) return check_sweep_plan(file);
  return json.find("urdf") != nullptr || json.find("control") != nullptr ? check_robot(file) : check_scenario(file);
}

std::string check_file(const std::string& file, const CheckOptions& options) {
  const std::string extension = fs::path(file).extension().string();
  if (extension == ".urdf") return check_urdf(file);
  if (extension == ".json") return check_json(file);
  if (extension == ".lua") return check_lua(file, options.robot);
  throw InputError({.file = file, .message = "not a file that can be checked: .urdf, .json or .lua"});
}

}  // namespace

int run_check(const CheckOptions& options) {
  int code = exit_passed;
  for (const std::string& file : options.files) {
    try {
      std::printf("ok  %s  %s\n", file.c_str(), check_file(file, options).c_str());
    } catch (const InputError& error) {
      print_problems(error);
      code = exit_usage;
    }
  }
  return code;
}

}  // namespace kadans
