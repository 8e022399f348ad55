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
  if (plant_type(plant_types(), scenario.plant).has_objects() || !f.has("world")) return;
  std::string others;
  for (const std::string& name : plant_type_names(&PlantType::has_objects))
    others += (others.empty() ? "" : ", ") + name;
  problems.add(f.place("world"),
               "world: only the " + others + " plant has one, this scenario's plant is " + scenario.plant);
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
  f.integer("repeat", scenario.repeat, {1, 10'000}, "number of runs in kadans test, each with the next seed");
  f.number("wall_limit_s", scenario.wall_limit_s, {0.1, 1e6, "s"},
           "wall-clock time after which a run is stopped and has failed");
}

// How this run's robot differs from the configured one.
void variant_fields(Fields& f, ScenarioConfig& scenario, Problems& problems) {
  f.string("start_pose", scenario.start_pose.name,
           "the pose in which the robot starts (default: the one in its configuration)");
  scenario.start_pose.place = f.place("start_pose");
  f.object("set", "quantities that differ from the robot's files, by a pattern of their names",
           [&](Fields& e) { e.number_entries(scenario.set, {}, "value of the quantity"); });
  variation_fields(f, "randomise", scenario.randomise, problems);
}

void joystick_fields(Fields& f, ScenarioConfig& scenario, Problems& problems) {
  ScenarioJoystick& joystick = scenario.joystick;
  f.string("recording", joystick.recording, "input events, as evemu-record or cat wrote them", Need::required);
  joystick.place = f.place("recording");
  if (!joystick.recording.empty())
    joystick.recording = resolve_file(joystick.recording, joystick.place, "recording", problems).string();
  f.number("at_s", joystick.at_s, {0, scenario_duration_max_s, "s"}, "time of its first event");
  f.number("lost_at_s", joystick.lost_at_s, {0, scenario_duration_max_s, "s"},
           "time at which it is unplugged (default: never)");
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
  f.number("duration_s", scenario.duration_s, {1e-3, scenario_duration_max_s, "s"}, "duration of the simulation",
           Need::required);
  f.integer("seed", scenario.seed, {0, std::numeric_limits<std::uint64_t>::max()},
            "seed of all random numbers of the run");
  suite_fields(f, scenario, problems);
  variant_fields(f, scenario, problems);
  std::vector<PlacedName> lists;
  f.strings("behaviors", lists, {0, 100}, "what to play, one after the other: files, or \"squat{depth_m=0.08}, wave\"");
  const PlayFolders folders = folders_of(scenario);
  for (const PlacedName& list : lists) {
    const TextPlace start{list.place.line, list.place.column + 1};  // behind the quote
    std::ranges::move(read_play_items(list.name, start, folders, problems), std::back_inserter(scenario.behaviors));
  }
  f.list("events", {0, 10'000}, "changes to the list of behaviors, each at its time", [&](Fields& e) {
    ScenarioEvent event;
    event_fields(e, event, folders, problems);
    if (e.reading()) scenario.events.push_back(std::move(event));
  });
  f.list("pushes", {0, 1000}, "pushes on the robot", [&](Fields& e) {
    ScenarioPush push;
    push_fields(e, push, problems);
    if (e.reading()) scenario.pushes.push_back(std::move(push));
  });
  f.list("faults", {0, 1000}, "faults, each at its time", [&](Fields& e) {
    ScenarioFault fault;
    fault_fields(e, fault, problems);
    if (e.reading()) scenario.faults.push_back(std::move(fault));
  });
  world_fields(f, scenario.world, problems);
  f.object("joystick", "a joystick that is played from a recording",
           [&](Fields& e) { joystick_fields(e, scenario, problems); });
  f.list("checks", {0, 1000}, "checks that must hold", [&](Fields& e) {
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
