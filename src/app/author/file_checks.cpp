#include "file_checks.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <glob.h>

#include "app/sim/played_behaviors.h"
#include "app/sim/repeated_run.h"
#include "app/sweep/sweep_subjects.h"
#include "app/terminal.h"
#include "behavior_stage.h"
#include "config/robot/project_root.h"
#include "config/scenario/based_on.h"
#include "estimate/estimator.h"
#include "kadans/plant/bullet/bullet_world.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/shell_word.h"
#include "robot_description.h"
#include "scenario/judge/checks.h"
#include "script/check/check_behavior.h"
#include "signal/number_text.h"

namespace kadans {

namespace {

namespace fs = std::filesystem;

bool hidden(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with('.') || name == "node_modules";
}

bool counts(const fs::path& file, bool scripts_only) {
  const std::string extension = file.extension().string();
  if (extension == ".lua") return true;
  if (scripts_only) return false;
  const std::string name = file.filename().string();
  if (name.ends_with(".schema.json") || name.ends_with(".golden.json")) return false;
  return is_robot_description(file) || extension == ".json";
}

void add_below(const fs::path& folder, bool scripts_only, std::vector<fs::path>& files) {
  for (fs::recursive_directory_iterator at(folder), end; at != end; ++at) {
    if (hidden(at->path())) {
      at.disable_recursion_pending();
    } else if (at->is_regular_file() && counts(at->path(), scripts_only)) {
      files.push_back(at->path());
    }
  }
}

// In a project only its three folders are searched, because it holds much else.
std::vector<fs::path> files_in(const fs::path& folder, bool scripts_only) {
  std::vector<fs::path> parts;
  for (const char* part : {"behaviors", "config", "models"}) {
    if (fs::is_directory(folder / part)) parts.push_back(folder / part);
  }
  if (parts.size() < 2) parts = {folder};
  std::vector<fs::path> files;
  for (const fs::path& part : parts) add_below(part, scripts_only, files);
  std::ranges::sort(files);
  if (files.empty())
    refuse(folder, scripts_only ? "there is no .lua in it" : "there is no .urdf, MJCF, .json or .lua in it");
  return files;
}

std::vector<fs::path> chosen_by(const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  }
  globfree(&found);
  if (paths.empty()) refuse(pattern, "nothing has a name like that");
  return paths;
}

// The named files, all files below a named folder, and all files that a pattern chooses ("config/*/robot.json"), each
// once. In a folder .urdf (.URDF), .json and .lua files count, but not names that begin with a dot. In a whole project
// only config, models and behaviors are searched. `scripts_only`: only .lua files. Throws InputError for a file that
// does not exist and for a folder without files to check.
std::vector<CheckedFile> files_to_check(const std::vector<std::string>& named, bool scripts_only) {
  std::vector<CheckedFile> all;
  std::set<fs::path> known;
  const auto add = [&](const fs::path& file, bool found) {
    if (known.insert(fs::absolute(file).lexically_normal()).second) all.push_back({file, found});
  };
  for (const std::string& name : named) {
    const bool pattern = !fs::exists(name) && name.find_first_of("*?[") != std::string::npos;
    for (const fs::path& path : pattern ? chosen_by(name) : std::vector<fs::path>{name}) {
      if (!fs::is_directory(path)) {
        add(path, false);
        continue;
      }
      for (const fs::path& file : files_in(path, scripts_only)) add(file, true);
    }
  }
  return all;
}

std::string with_warnings(std::string what, const std::vector<InputProblem>& warnings) {
  for (const InputProblem& warning : warnings) what += "\nwarning: " + warning.text();
  return what;
}

// Checks that behaviors accept the parameters that the robot's configuration gives them.
void check_behavior_values(const RobotConfig& config, const Catalog& catalog) {
  std::set<fs::path> files;
  for (const BehaviorValue& given : config.behavior_values) files.insert(given.chunk);
  const std::vector<InputProblem> problems = problems_in(files, project_root(config.file), catalog);
  if (!problems.empty()) throw InputError(problems);
}

struct Known {
  const char* name;     // "a robot's configuration"
  const char* command;  // the command that takes it, before the file's name ...
  const char* does;     // ... and what that command does
};

const Known& known(JsonKind kind) {
  static constexpr Known all[] = {{"something else", "check", "says what is wrong in it"},
                                  {"a scenario", "sim", "runs it"},
                                  {"a robot's configuration", "run", "drives it"},
                                  {"the plan of a sweep", "sweep", "runs it"},
                                  {"the plan of a tuning", "tune", "runs it"}};
  return all[static_cast<std::size_t>(kind)];
}

JsonKind kind_of(const JsonValue& json) {
  const auto has = [&](const char* key) { return json.find(key) != nullptr; };
  if (has("tune")) return JsonKind::tuning;
  if (has("scenarios")) return JsonKind::sweep;
  if (has("urdf") || has("control")) return JsonKind::robot;
  return has("robot") || has("record") || has("duration_s") || has("checks") ? JsonKind::scenario : JsonKind::other;
}

// "; 2 pairs of links touch with all joints at 0, and pass through each other: a and b, c and d"
std::string told_touching(const RobotConfig& robot) {
  constexpr std::size_t shown_max = 12;
  if (!robot.plant.self_collision) return "";
  std::vector<std::pair<std::string, std::string>> pairs;
  try {
    pairs = touching_links(robot.model, robot.plant, TouchingAt::zero);
  } catch (const std::invalid_argument&) {  // it may be driven by another plant, and Bullet's says so itself
  }
  if (pairs.empty()) return "";
  std::string text = "; " + std::to_string(pairs.size()) +
                     (pairs.size() == 1 ? " pair of links touches" : " pairs of links touch") +
                     " with all joints at 0, and " + (pairs.size() == 1 ? "passes" : "pass") + " through each other: ";
  for (std::size_t i = 0; i < std::min(pairs.size(), shown_max); ++i)
    text += (i == 0 ? "" : ", ") + pairs[i].first + " and " + pairs[i].second;
  return text + (pairs.size() > shown_max ? " ..." : "");
}

}  // namespace

FileChecks::FileChecks(std::string robot, bool plugins, UrdfOptions urdf)
    : robot_(std::move(robot)),
      gate_{.closed = !plugins, .let_in = {}, .remedy = "to load it is to run its code, which --plugins does"},
      urdf_(std::move(urdf)) {}

std::string FileChecks::check_description_of(const fs::path& file) {
  std::vector<InputProblem> warnings;
  const RobotModel model = read_robot_description(file, urdf_, &warnings).model;
  std::size_t motors = 0, mimics = 0;
  for (const Joint& joint : model.joints) {
    motors += joint.passive() ? 0 : 1;
    mimics += joint.mimic ? 1 : 0;
  }
  std::string what = printed("robot description: %zu links, %zu joints, %zu motors, %.3f kg", model.links.size(),
                             model.joints.size(), motors, model.mass_kg());
  if (mimics > 0) what += "; " + std::to_string(mimics) + " joints mimic others";
  return with_warnings(what, warnings);
}

std::string FileChecks::check_robot(const fs::path& file) {
  if (gate_.closed && !read_plugin_files(file).empty()) {
    const RobotConfig config = read_robot_config(file, {});
    return told_robot(config, std::to_string(config.objects.size()) +
                                  " control objects; its plug-ins were not loaded, so types and parameters are not "
                                  "checked: --plugins does");
  }
  const Robot robot = read_robot(file);
  const auto system = make_control_system(robot);
  const ControlSets sets(system->catalog, std::move(system->objects));
  check_behavior_values(robot.config, system->catalog);
  return told_robot(robot.config, std::to_string(sets.size()) + " control objects, " +
                                      std::to_string(system->catalog.sets.size()) + " control sets, " +
                                      std::to_string(system->catalog.parameters.size()) + " parameters" +
                                      told_touching(robot.config));
}

std::string FileChecks::told_robot(const RobotConfig& robot, const std::string& what) const {
  if (urdf_.strict && !robot.urdf_warnings.empty()) throw InputError(robot.urdf_warnings);
  return with_warnings("robot: " + what, robot.urdf_warnings);
}

std::string FileChecks::check_scenario(const fs::path& file) {
  ScenarioConfig scenario = read_tested_scenario(file);
  if (!scenario.record.empty())
    return "scenario: repeats a record, " + std::to_string(count_record_checks(scenario)) + " checks";
  scenario.plugins = gate_;
  RunLog log;
  const Assembly assembly(scenario, scenario.seed, log);
  const Checks checks(assembly.catalog().signals, scenario.checks, scenario.file, assembly.signal_states());
  std::vector<InputProblem> problems = problems_of_named(scenario, assembly.catalog());
  for (const auto& robot : assembly.others()) {
    std::ranges::move(problems_of_named(robot->scenario(), robot->catalog()), std::back_inserter(problems));
  }
  if (!problems.empty()) throw InputError(problems);
  return "scenario: " + std::to_string(scenario.behaviors.size()) + " behaviors, " + std::to_string(checks.size()) +
         " checks, " + std::to_string(assembly.catalog().signals.size()) + " signals";
}

std::string FileChecks::check_json(const fs::path& file) {
  switch (kind_of(parse_based_json(read_input_file(file), file).value)) {
    case JsonKind::tuning:
      return check_tune_plan(file, gate_);
    case JsonKind::sweep:
      return check_sweep_plan(file, gate_);
    case JsonKind::robot:
      return check_robot(file);
    case JsonKind::scenario:
      return check_scenario(file);
    case JsonKind::other:
      break;
  }
  return "";
}

const FileChecks::Known& FileChecks::robot_at(const fs::path& config) {
  std::unique_ptr<Known>& known = robots_[fs::absolute(config).lexically_normal()];
  if (known) return *known;
  auto read = std::make_unique<Known>();
  read->robot = read_robot(config, gate_);
  read->system = make_control_system(read->robot);
  declare_signals(read->system->catalog.signals, read->robot.config.model, read->robot.config.estimate,
                  *read->measured);
  known = std::move(read);
  return *known;
}

// A behavior belongs to the robot whose configuration folder has the name of the behavior's folder.
const FileChecks::Known* FileChecks::robot_of(const fs::path& script, std::string& missing) {
  if (!robot_.empty()) return &robot_at(robot_);
  fs::path config;
  try {
    config = robot_of_behavior(script);
  } catch (const InputError& error) {
    missing = error.problems().front().message;
    return nullptr;
  }
  return &robot_at(config);
}

std::string FileChecks::check_script_file(const CheckedFile& checked_file) {
  const fs::path& file = checked_file.file;
  (void)read_input_file(file);  // throws when it does not exist
  std::string missing;
  const Known* const known = robot_of(file, missing);
  CheckedScript checked =
      check_script(project_root(file), fs::absolute(file), known == nullptr ? nullptr : &known->system->catalog);
  if (!checked.problems.empty() && known == nullptr)
    checked.problems.push_back({.file = file.string(), .message = "was looked at without a robot: " + missing});
  if (!checked.problems.empty()) throw InputError(checked.problems);
  if (checked.kind == ScriptKind::module) return "a module";
  if (checked.kind == ScriptKind::test) return "tests";
  if (known == nullptr && checked_file.found) return "loads; it is of no robot here, --robot FILE checks more";
  if (known == nullptr) refuse(file, missing);
  return "fits " + known->robot.config.name;
}

std::string FileChecks::check(const CheckedFile& checked) {
  const fs::path& file = checked.file;
  const std::string extension = file.extension().string();
  if (extension == ".xacro" || extension == ".xml" || is_robot_description(file)) return check_description_of(file);
  if (extension == ".lua") {
    const std::string what = check_script_file(checked);
    return what == "a module" || what == "tests" ? what : "behavior: " + what;
  }
  if (extension != ".json")
    refuse(file, "not a file that can be checked: .urdf, .xacro, .xml and .mjcf (MJCF), .json or .lua");
  const std::string what = check_json(file);
  if (what.empty() && !checked.found) refuse(file, "is no robot, scenario, sweep or tuning of ours");
  return what;
}

int FileChecks::print_all(const std::vector<std::string>& named, bool scripts_only) {
  int code = exit_passed;
  bool any = false;
  for (const CheckedFile& checked : files_to_check(named, scripts_only)) {
    try {
      const std::string what = scripts_only ? check_script_file(checked) : check(checked);
      if (what.empty()) continue;
      std::printf("ok  %s  %s\n", checked.file.c_str(), what.c_str());
      any = true;
    } catch (const InputError& error) {
      print_problems(error);
      code = exit_usage;
    }
  }
  if (!any && code == exit_passed) refuse(named.front(), "holds nothing of ours");
  return code;
}

std::optional<JsonKind> kind_in(const std::filesystem::path& file) {
  try {
    return kind_of(parse_based_json(read_input_file(file), file.string()).value);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void require_kind(const std::filesystem::path& file, JsonKind wanted) {
  const std::optional<JsonKind> kind = kind_in(file);
  if (!kind || *kind == wanted || *kind == JsonKind::other) return;
  const Known& is = known(*kind);
  refuse(file, std::string("is ") + is.name + ", not " + known(wanted).name + ": 'kadans " + is.command + " " +
                   shell_word(file.string()) + "' " + is.does);
}

}  // namespace kadans
