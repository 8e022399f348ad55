#include "kadans/config/scenario_config.h"

#include <algorithm>
#include <array>

#include "kadans/config/project_root.h"

namespace kadans {
namespace {

const std::array<std::string, 2> plant_names{"bullet", "ideal"};
constexpr double duration_max_s = 1e6;

void reload_fields(Fields& f, ScenarioReload& reload, Problems& problems) {
  f.number("at_s", reload.at_s, {0, duration_max_s, "s"}, "when", Need::required);
  f.string("behavior", reload.behavior.name, "name of a behavior that plays", Need::required);
  f.string("file", reload.file.name, "what it goes on with, from the project root", Need::required);
  if (!f.reading()) return;
  reload.behavior.place = f.place("behavior");
  reload.file.place = f.place("file");
  if (!reload.file.name.empty()) {
    reload.file.name = resolve_file(reload.file.name, reload.file.place, "reload", problems).string();
  }
}

void scenario_fields(Fields& f, ScenarioConfig& scenario, Problems& problems) {
  std::string schema;
  f.string("$schema", schema, "the schema of this file, for editors");
  f.string("name", scenario.name, "the scenario's name", Need::required);
  f.string("doc", scenario.doc, "what it shows, one or two sentences");
  f.string("robot", scenario.robot, "the robot's configuration, from the project root", Need::required);
  f.choice("plant", scenario.plant, plant_names, "what plays the robot");
  f.number("duration_s", scenario.duration_s, {1e-3, duration_max_s, "s"}, "simulated time", Need::required);
  f.integer("seed", scenario.seed, {0, std::numeric_limits<std::uint64_t>::max()},
            "where all random numbers of the run come from");
  f.strings("behaviors", scenario.behaviors, {0, 100}, "behavior files, played one after the other");
  f.list("reload", {0, 10'000}, "behaviors that go on with another file", [&](Fields& e) {
    ScenarioReload reload;
    reload_fields(e, reload, problems);
    if (e.reading()) scenario.reloads.push_back(std::move(reload));
  });
  f.list("checks", {0, 1000}, "what must hold", [&](Fields& e) {
    ScenarioCheck check;
    check_fields(e, check, scenario.duration_s, scenario.checks, problems);
    if (e.reading()) scenario.checks.push_back(std::move(check));
  });
  if (!f.reading()) return;
  if (!scenario.robot.empty()) {
    scenario.robot = resolve_file(scenario.robot, f.place("robot"), "robot", problems).string();
  }
  for (PlacedName& behavior : scenario.behaviors) {
    behavior.name = resolve_file(behavior.name, behavior.place, "behavior", problems).string();
  }
}

}  // namespace

ScenarioConfig read_scenario_config_text(const std::string& text, const std::string& file) {
  ScenarioConfig scenario;
  scenario.file = file;
  Problems problems(file);
  read_fields(parse_json(text, file), problems, [&](Fields& f) { scenario_fields(f, scenario, problems); });
  problems.throw_if_any();
  return scenario;
}

ScenarioConfig read_scenario_config(const std::filesystem::path& file) {
  return read_scenario_config_text(read_text_file(file), file.string());
}

FieldInfo describe_scenario_config() {
  ScenarioConfig scenario;
  Problems problems("");
  return describe_fields([&](Fields& f) { scenario_fields(f, scenario, problems); });
}

}  // namespace kadans
