#include "kadans/config/scenario_config.h"

#include <algorithm>
#include <array>

#include "kadans/config/project_root.h"

namespace kadans {
namespace {

const std::array<std::string, 2> plant_names{"bullet", "ideal"};
const std::array<std::string, 4> check_names{"always", "never", "eventually", "at_end"};
constexpr double duration_max_s = 1e6;

void check_fields(Fields& f, ScenarioCheck& check) {
  constexpr NumberRange time{0, duration_max_s, "s"};
  f.string("name", check.name, "what is shown to hold", Need::required);
  f.choice("kind", check.kind, check_names, "when the signal must (never: must not) be in min..max", Need::required);
  f.string("signal", check.signal, "name of the signal", Need::required);
  f.number("min", check.min, {}, "least value, in the signal's unit");
  f.number("max", check.max, {}, "greatest value, in the signal's unit");
  f.number("from_s", check.from_s, time, "looked at from this time on");
  f.number("until_s", check.until_s, time, "looked at up to this time, else to the end");
  check.signal_place = f.place("signal");
}

// What the fields alone cannot say.
void verify(const Fields& f, const ScenarioCheck& check, const ScenarioConfig& scenario, Problems& problems) {
  if (!f.has("min") && !f.has("max")) problems.add(f.place(), f.path() + " needs min, max or both");
  if (!(check.min <= check.max)) {
    problems.add(f.place("max"),
                 f.path("max") + " is " + number_text(check.max) + ", must be at least min, " + number_text(check.min));
  }
  if (!(check.from_s <= check.until_s)) {
    problems.add(f.place("until_s"), f.path("until_s") + " is " + number_text(check.until_s) +
                                         ", must be at least from_s, " + number_text(check.from_s) + " s");
  }
  if (scenario.duration_s > 0 && !(check.from_s <= scenario.duration_s)) {
    problems.add(f.place("from_s"), f.path("from_s") + " is " + number_text(check.from_s) + ", the scenario ends at " +
                                        number_text(scenario.duration_s) + " s");
  }
  if (check.kind == CheckKind::at_end && (f.has("from_s") || f.has("until_s"))) {
    problems.add(f.place(f.has("from_s") ? "from_s" : "until_s"),
                 f.path() + " is judged at the end, from_s and until_s mean nothing here");
  }
  const auto same = [&](const ScenarioCheck& other) { return other.name == check.name; };
  if (std::any_of(scenario.checks.begin(), scenario.checks.end(), same)) {
    problems.add(f.place("name"), f.path("name") + ": another check is named " + in_quotes(check.name));
  }
}

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
    check_fields(e, check);
    if (!e.reading()) return;
    verify(e, check, scenario, problems);
    scenario.checks.push_back(std::move(check));
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
