// `kadans new sweep`: a scenario many times, with quantities of its robot that are different in each run.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/assembly/assembled_plant.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "config/robot/project_root.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/shell_word.h"
#include "new_files.h"
#include "new_subject.h"
#include "scenario/disturb/quantities.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int cases_planned = 24, cases_run = 4;

// The scenarios of this robot in the project.
std::vector<fs::path> scenarios_of(const NewSubject& subject) {
  std::vector<fs::path> found;
  const fs::path folder = subject.project / "config/scenarios";
  if (!fs::is_directory(folder)) return found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    try {
      const ScenarioConfig scenario = read_scenario_config(entry.path());
      std::error_code ignored;
      if (fs::equivalent(scenario.robot, subject.file(), ignored)) found.push_back(entry.path());
    } catch (const InputError&) {  // one that is wrong is nobody's
    }
  }
  std::ranges::sort(found);
  return found;
}

fs::path scenario_for(const NewPartOptions& options) {
  const fs::path here = folder_of(options);
  if (!options.scenario.empty()) return file_named(options.scenario, here);
  std::error_code ignored;
  const fs::path own = project_root(here / "x") / "config/scenarios" / (options.name + ".json");
  if (fs::exists(own, ignored)) return own;
  const NewSubject subject = read_subject(options);
  const std::vector<fs::path> all = scenarios_of(subject);
  if (all.size() == 1) return all.front();
  std::string names;
  for (std::size_t i = 0; i < std::min<std::size_t>(all.size(), 8); ++i)
    names += (i == 0 ? ": " : ", ") + fs::proximate(all[i]).string();
  if (all.size() > 8) names += " and " + std::to_string(all.size() - 8) + " more";
  refuse(subject.file(), all.empty() ? "has no scenario yet: `kadans new scenario NAME` writes one"
                                     : "has several scenarios, name one: --scenario FILE" + names);
}

bool one_matches(const std::vector<std::string>& names, const std::string& begin, const std::string& end) {
  return std::ranges::any_of(names,
                             [&](const std::string& name) { return name.starts_with(begin) && name.ends_with(end); });
}

// Of those that move.
std::string heaviest_link(const NewSubject& subject) {
  const auto first = subject.model().links.begin() + (subject.stands() ? 0 : 1);
  return std::ranges::max_element(first, subject.model().links.end(), {},
                                  [](const Link& link) { return link.inertia.mass_kg; })
      ->name;
}

Json varied(const NewSubject& subject, const std::vector<std::string>& names) {
  const auto uniform = [](double from, double to) { return Json{{"uniform", {from, to}}}; };
  Json vary = Json::object();
  if (subject.stands()) vary["ground.friction"] = uniform(0.6, 1.0);
  vary["link." + heaviest_link(subject) + ".mass_scale"] = uniform(0.95, 1.05);
  const auto add = [&](const std::string& begin, const std::string& end, Json range) {
    if (!one_matches(names, begin, end)) return;
    range["together"] = true;
    vary[begin + "*" + end] = range;
  };
  add("joint.", ".torque_scale", uniform(0.95, 1));
  add("joint.", ".encoder_noise_rad", uniform(0, 0.0001));
  add("control.", ".kp_Nm_per_rad_scale", uniform(0.95, 1.05));
  vary["actuation.delay_s"] = {{"values", {0, 0.001}}};
  return vary;
}

int run_new_sweep(const NewPartOptions& options) {
  refuse_bad_name(options.name, "a sweep", "nudged");
  const fs::path scenario_file = scenario_for(options);
  ScenarioConfig scenario = read_scenario_config(scenario_file);
  NewPartOptions of = options;
  if (of.robot.empty()) of.robot = scenario.robot;
  const NewSubject subject = read_subject(of);
  std::error_code ignored;
  if (!fs::equivalent(scenario.robot, subject.file(), ignored))
    refuse(scenario_file, "is a scenario of another robot, " + scenario.robot);
  const fs::path file = subject.project / "config/sweeps" / (options.name + ".json");
  const std::string from_root =
      fs::proximate(fs::weakly_canonical(scenario_file), fs::weakly_canonical(subject.project)).string();

  PlantVariant variant = plant_variant(scenario, subject.robot.config);
  const Quantities quantities(variant, subject.system->catalog);
  Json metrics = Json::object();
  metrics["speed_max"] = {{"kind", "max"}, {"signal", "plant.limits.speed_share"}};
  if (subject.stands()) metrics["tilt_max_rad"] = {{"kind", "max"}, {"signal", "plant.base.tilt_rad"}};
  if (scenario.behaviors.empty()) {
    metrics["time_s"] = {{"kind", "since"}, {"that", "plant.limits.speed_share < 0.02"}};
  } else {
    metrics["time_s"] = {{"kind", "first_time"}, {"that", "play.done == " + std::to_string(scenario.behaviors.size())}};
  }
  const Json plan{{"name", options.name},
                  {"doc", scenario.name + ", with other masses, torques, noise, gains and delay in each run."},
                  {"scenarios", {from_root}},
                  {"sampling", "latin_hypercube"},
                  {"cases", cases_planned},
                  {"vary", varied(subject, quantities.names())},
                  {"metrics", metrics},
                  {"time", "time_s"},
                  {"worst", subject.stands() ? "tilt_max_rad" : "speed_max"},
                  {"passed_min", 0.9}};
  const fs::path out = subject.project / "sweeps" / (options.name + "_first");
  write_new_files({file, out}, {{fs::proximate(file), json_text(plan, 2) + "\n"}});
  const std::string shown = shell_word("config/sweeps/" + options.name + ".json");
  tell_command("Run all of it", subject.project, "sweep " + shown);
  if (options.no_run) return exit_passed;
  return run_kadans({"sweep", fs::absolute(file).string(), "--cases", std::to_string(cases_run), "--out",
                     fs::proximate(out).string()});
}

}  // namespace

void add_new_sweep(CLI::App& made, CommandLine& line) {
  const auto [sweep, options] =
      line.add<NewPartOptions>(made, "sweep", "Write a sweep over a scenario, and run its first cases", run_new_sweep);
  add_part_options(*sweep, options, "Its name, for example nudged", "Do not run its first cases");
  sweep
      ->add_option("--scenario", options.scenario,
                   "The scenario (default: the one of the same name, or else the robot's only one)")
      ->type_name("FILE");
}

}  // namespace kadans
