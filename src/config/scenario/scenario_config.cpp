#include "scenario_config.h"

#include <algorithm>
#include <iterator>

#include "based_on.h"
#include "config/robot/project_root.h"
#include "config/robot/robot_config.h"
#include "kadans/plant/plant_type.h"

namespace kadans {
namespace {

// What plays the robot, and what it cannot play.
void plant_fields(Fields& f, ScenarioConfig& scenario, Problems& problems) {
  const std::vector<std::string> models = plant_type_names(&PlantType::is_model);
  constexpr std::string_view doc = "what plays the robot";
  auto chosen = static_cast<std::size_t>(std::ranges::find(models, scenario.plant) - models.begin());
  std::string named;
  if (f.has("plant")) scenario.plant_place = f.place("plant");
  const bool known = !f.reading() || !f.string("plant", named, doc) || std::ranges::count(models, named) > 0;
  if (!known && !scenario.robot.empty() && !read_plugin_files(scenario.robot).empty()) {
    scenario.plant = named;
    return;
  }
  f.choice("plant", chosen, models, doc);
  scenario.plant = models[chosen];
  if (plant_type(plant_types(), scenario.plant).has_objects()) return;
  std::string others;
  for (const std::string& name : plant_type_names(&PlantType::has_objects))
    others += (others.empty() ? "" : ", ") + name;
  for (const std::string key : {"world", "robots"}) {
    if (!f.has(key)) continue;
    problems.add(f.place(key),
                 key + ": only the " + others + " plant has one, this scenario's plant is " + scenario.plant);
  }
}

// How it is run among others.
void suite_fields(Fields& f, ScenarioConfig& scenario, Problems& problems) {
  std::vector<PlacedName> tags;
  f.strings("tags", tags, {0, 100}, "words by which kadans test finds it");
  for (const PlacedName& tag : tags) {
    if (tag.name.empty() || tag.name.find_first_of("/ ,*") != std::string::npos)
      problems.add(tag.place,
                   "tag " + in_quotes(tag.name) + " must be a word without blanks, commas, slashes and stars");
    scenario.tags.push_back(tag.name);
  }
  f.integer("repeat", scenario.repeat, {1, 10'000}, "runs of it in kadans test, each with the next seed");
  f.number("wall_limit_s", scenario.wall_limit_s, {0.1, 1e6, "s"}, "a run that takes longer is stopped and has failed");
}

// How this run's robot differs from the configured one.
void variant_fields(Fields& f, ScenarioConfig& scenario, Problems& problems) {
  f.string("start_pose", scenario.start_pose.name, "the pose in which the robot starts, else its own");
  scenario.start_pose.place = f.place("start_pose");
  f.object("set", "quantities that differ from the robot's files, by patterns over their names",
           [&](Fields& e) { e.number_entries(scenario.set, {}, "the quantity's value"); });
  variation_fields(f, "randomise", scenario.randomise, problems);
}

// What plays on one robot, and what pushes it.
void play_fields(Fields& f, ScenarioConfig& scenario, Problems& problems) {
  std::vector<PlacedName> lists;
  f.strings("behaviors", lists, {0, 100}, "what to play, one after the other: files, or \"squat{depth_m=0.08}, wave\"");
  const PlayFolders folders = folders_of(scenario);
  for (const PlacedName& list : lists) {
    const TextPlace start{list.place.line, list.place.column + 1};  // behind the quote
    std::ranges::move(read_play_items(list.name, start, folders, problems), std::back_inserter(scenario.behaviors));
  }
  f.list("events", {0, 10'000}, "what happens to what plays, each at its time", [&](Fields& e) {
    ScenarioEvent event;
    event_fields(e, event, folders, problems);
    if (e.reading()) scenario.events.push_back(std::move(event));
  });
  f.list("pushes", {0, 1000}, "pushes on the robot", [&](Fields& e) {
    ScenarioPush push;
    push_fields(e, push, problems);
    if (e.reading()) scenario.pushes.push_back(std::move(push));
  });
}

void further_robot_fields(Fields& f, ScenarioConfig& robot, const ScenarioConfig& scenario, Problems& problems) {
  f.string("name", robot.name, "the robot's name: its signals are NAME.plant.base.height_m and the like",
           Need::required);
  robot.plant_place = f.place("name");
  if (std::ranges::count(scenario.robots, robot.name, &ScenarioConfig::name) > 0)
    problems.add(robot.plant_place, "another robot has the name " + in_quotes(robot.name));
  if (robot.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
    problems.add(robot.plant_place,
                 "name " + in_quotes(robot.name) + " must consist of small letters, digits and underscores");
  robot.file = scenario.file;
  robot.plant = scenario.plant;
  robot.robot = scenario.robot;
  std::string file;
  if (f.string("robot", file, "its configuration, from the project root; else that of the first robot"))
    robot.robot = resolve_file(file, f.place("robot"), "robot", problems).string();
  variant_fields(f, robot, problems);
  play_fields(f, robot, problems);
}

void joystick_fields(Fields& f, ScenarioConfig& scenario, Problems& problems) {
  ScenarioJoystick& joystick = scenario.joystick;
  f.string("recording", joystick.recording, "input events, as evemu-record or cat wrote them", Need::required);
  joystick.place = f.place("recording");
  if (!joystick.recording.empty())
    joystick.recording = resolve_file(joystick.recording, joystick.place, "recording", problems).string();
  f.number("at_s", joystick.at_s, {0, scenario_duration_max_s, "s"}, "when its first event comes");
  f.number("lost_at_s", joystick.lost_at_s, {0, scenario_duration_max_s, "s"},
           "from when on it is unplugged; else never");
}

void scenario_fields(Fields& f, ScenarioConfig& scenario, Problems& problems) {
  std::string schema, base;
  f.string("$schema", schema, "the schema of this file, for editors");
  f.string("based_on", base, "another scenario; this file says only what is different");
  f.string("name", scenario.name, "the scenario's name", Need::required);
  f.string("doc", scenario.doc, "what it shows, one or two sentences");
  f.string("robot", scenario.robot, "the robot's configuration, from the project root", Need::required);
  if (!scenario.robot.empty()) {
    scenario.robot = resolve_file(scenario.robot, f.place("robot"), "robot", problems).string();
  }
  plant_fields(f, scenario, problems);
  f.number("duration_s", scenario.duration_s, {1e-3, scenario_duration_max_s, "s"}, "simulated time", Need::required);
  f.integer("seed", scenario.seed, {0, std::numeric_limits<std::uint64_t>::max()},
            "where all random numbers of the run come from");
  suite_fields(f, scenario, problems);
  variant_fields(f, scenario, problems);
  play_fields(f, scenario, problems);
  f.list("robots", {0, further_robots_max}, "further robots in the same world and time", [&](Fields& e) {
    ScenarioConfig robot;
    further_robot_fields(e, robot, scenario, problems);
    if (e.reading()) scenario.robots.push_back(std::move(robot));
  });
  f.list("faults", {0, 1000}, "what fails, each at its time", [&](Fields& e) {
    ScenarioFault fault;
    fault_fields(e, fault, problems);
    if (e.reading()) scenario.faults.push_back(std::move(fault));
  });
  world_fields(f, scenario.world, problems);
  f.object("joystick", "a joystick that is played from a recording",
           [&](Fields& e) { joystick_fields(e, scenario, problems); });
  f.list("checks", {0, 1000}, "what must hold", [&](Fields& e) {
    ScenarioCheck check;
    check_fields(e, check, scenario.duration_s, scenario.checks, problems);
    if (e.reading()) scenario.checks.push_back(std::move(check));
  });
}

}  // namespace

bool PluginGate::lets_in(const std::filesystem::path& file) const {
  return !closed || std::ranges::find(let_in, std::filesystem::absolute(file).lexically_normal()) != let_in.end();
}

PlayFolders folders_of(const ScenarioConfig& scenario) {
  return {scenario.file, std::filesystem::path(scenario.robot).parent_path().filename().string()};
}

ScenarioConfig read_scenario_config_text(const std::string& text, const std::string& file) {
  ScenarioConfig scenario;
  scenario.file = file;
  const BasedJson json = parse_based_json(text, file);
  if (!json.bases.empty()) (void)read_scenario_config(json.bases.front());
  Problems problems(file);
  read_fields(json.value, problems, [&](Fields& f) { scenario_fields(f, scenario, problems); });
  problems.throw_if_any();
  return scenario;
}

ScenarioConfig read_scenario_config(const std::filesystem::path& file) {
  return read_scenario_config_text(read_input_file(file), file.string());
}

FieldInfo describe_scenario_config() {
  ScenarioConfig scenario;
  Problems problems("");
  return describe_fields([&](Fields& f) { scenario_fields(f, scenario, problems); });
}

}  // namespace kadans
