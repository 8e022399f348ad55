
#include "scenario_config.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>

#include "based_on.h"
#include "config/robot/project_root.h"
#include "config/robot/robot_config.h"
#include "event_text.h"
#include "kadans/plant/plant_type.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr double time_max_s = 1e6;

// Which of the other fields an event has to have.
struct Wants {
  bool list = false, reload = false, event = false;
};

void verify(const Fields& f, const ScenarioEvent& event, Wants wants) {
  const std::string& kind = play_order_names[static_cast<std::size_t>(event.order.kind)];
  const auto field = [&](const char* name, bool wanted) {
    if (wanted && !f.has(name)) f.refuse(f.place(), f.path(name) + " is missing: to " + kind + " needs it");
    if (!wanted && f.has(name)) f.refuse(name, " means nothing here: to " + kind + " has none");
  };
  field("list", wants.list);
  field("behavior", wants.reload);
  field("file", wants.reload);
  field("event", wants.event);
  if (!wants.event) field("data", false);
}

using FaultKind = ScenarioFault::Kind;

struct KindInfo {
  const char* name;
  const char* size;  // what `size` means; "" when it means nothing
};
constexpr std::array<KindInfo, 23> fault_kinds{{
    {"sensor_silent", ""},
    {"sensor_stuck", ""},
    {"sensor_offset", "added: rad, of the IMU rad/s, of a foot N"},
    {"sensor_noise", "added at random, at most: rad, rad/s, N"},
    {"sensor_jump", "added once: rad, rad/s, N"},
    {"sensor_not_finite", ""},
    {"drive_dead", ""},
    {"drive_weak", "share of the effort that is left"},
    {"drive_stuck", ""},
    {"drive_offset", "added effort, Nm"},
    {"drive_late", "delay in control ticks, at most 255"},
    {"drive_tripped", "the maker's code that it tells"},
    {"drive_disabled", ""},
    {"drive_hot", "temperature that it tells, C"},
    {"drive_old", "age of its readings, s"},
    {"supply", "voltage of the drives' supply, V"},
    {"emergency_button", ""},
    {"behaviors_silent", ""},
    {"commands_lost", ""},
    {"commands_late", "delay in behavior ticks"},
    {"commands_not_finite", ""},
    {"clock_missed", "control ticks missed in a row, each time"},
    {"supervisor_silent", ""},
}};

std::array<std::string, fault_kinds.size()> names_of_kinds() {
  std::array<std::string, fault_kinds.size()> names;
  for (std::size_t i = 0; i < fault_kinds.size(); ++i) names[i] = fault_kinds[i].name;
  return names;
}

void verify(const Fields& f, const ScenarioFault& fault) {
  const KindInfo& info = fault_kinds.at(static_cast<std::size_t>(fault.kind));
  const std::string kind = std::string(" of kind '") + info.name + "'";
  if (info.size[0] != '\0' && !f.has("size")) f.refuse(" is" + kind + " and needs size: " + info.size);
  if (info.size[0] == '\0' && f.has("size")) f.refuse("size", " means nothing to a fault" + kind);
  const bool wants_of = of_sensor(fault.kind) || of_drive(fault.kind);
  if (wants_of && fault.of.name.empty())
    f.refuse(" is" + kind + " and needs of: the " +
             (of_sensor(fault.kind) ? "joint, the foot's link, a sensor, or imu" : "drive"));
  if (!wants_of && f.has("of")) f.refuse("of", " means nothing to a fault" + kind);
  if (!(fault.from_s < fault.until_s))
    f.refuse("until_s", fault.until_s, "after from_s, " + number_text(fault.from_s) + " s");
  if ((fault.kind == FaultKind::drive_late || fault.kind == FaultKind::commands_late ||
       fault.kind == FaultKind::clock_missed) &&
      !(fault.size >= 1 && fault.size <= 255))
    f.refuse("size", fault.size, "1..255 ticks");
}

const std::array<std::string, 2> shape_names{"constant", "half_sine"};

}  // namespace

void event_fields(Fields& f, ScenarioEvent& event, const PlayFolders& folders) {
  std::string list, file;
  PlayOrder& order = event.order;
  f.number("at_s", event.at_s, {0, time_max_s, "s"}, "time of the event", Need::required);
  const bool known = f.choice("do", order.kind, play_order_names,
                              "change to the list of behaviors, or emit: an event for them", Need::required);
  f.string("list", list, "for play and replace: the behaviors, such as \"squat{depth_m=0.08}, wave\"");
  f.string("behavior", order.behavior.name, "for reload: name of a behavior that plays");
  f.string("file", file, "for reload: the file with which it continues, from the project root");
  f.string("event", order.event.name, "for emit: name of an event that a behavior declares");
  f.object("data", "for emit: the event's data", [&](Fields& data) {
    if (const JsonValue* given = data.plain_entries("value of the field"))
      order.event.data = read_event_data(*given, f.problems());
  });
  if (!f.reading() || !known) return;
  using Kind = PlayOrder::Kind;
  verify(
      f, event,
      {order.kind == Kind::play || order.kind == Kind::replace, order.kind == Kind::reload, order.kind == Kind::emit});
  order.event.place = f.place("event");
  order.event.who = "scenario";
  check_event_name({order.event.name, order.event.place}, f.problems());
  order.behavior.place = f.place("behavior");
  if (!file.empty()) order.file = resolve_file(file, f.place("file"), "reload", f.problems());
  if (list.empty()) return;
  TextPlace start = f.place("list");
  ++start.column;  // behind the quote
  order.list = read_play_items(list, start, folders, f.problems());
}

void fault_fields(Fields& f, ScenarioFault& fault) {
  constexpr NumberRange time{0, 1e6, "s"};
  f.choice("kind", fault.kind, names_of_kinds(), "kind of fault", Need::required);
  f.string("of", fault.of.name,
           "where it happens; for sensors a joint, a foot's link, a sensor's name or imu, for drives a "
           "drive as in plant.drives: of the joint's name, or a coupled drive's own");
  f.number("from_s", fault.from_s, time, "time at which the fault begins");
  f.number("until_s", fault.until_s, time, "time at which the fault ends (default: the end of the run)");
  f.number("size", fault.size, {-1e6, 1e6, ""}, "size of the fault; the kind says what it means");
  if (!f.reading()) return;
  fault.of.place = f.place("of");
  verify(f, fault);
}

void push_fields(Fields& f, ScenarioPush& push) {
  constexpr NumberRange time{0, 1e6, "s"};
  f.string("link", push.link.name, "the link that is pushed", Need::required);
  f.number("at_s", push.at_s, time, "time at which the push begins", Need::required);
  f.number("duration_s", push.duration_s, {1e-3, 1e6, "s"}, "duration of the push");
  f.choice("shape", push.shape, shape_names, "shape of the force over time");
  f.numbers("impulse_Ns", push.impulse_Ns, {-push_max_Ns, push_max_Ns, "Ns"},
            "impulse of the push in world axes: x forward, y left, z up");
  Vec3 force_N{};
  f.numbers("force_N", force_N, {-1e5, 1e5, "N"}, "instead of impulse_Ns: the force; for half_sine its peak");
  f.numbers("point_m", push.point_m, {-10, 10, "m"}, "point of the link, in its frame");
  if (!f.reading()) return;
  push.link.place = f.place("link");
  if (f.has("impulse_Ns") == f.has("force_N")) {
    f.refuse(" must have one of impulse_Ns and force_N");
    return;
  }
  if (f.has("impulse_Ns")) return;
  const double mean = push.shape == ScenarioPush::Shape::half_sine ? 2 / std::numbers::pi : 1;
  for (std::size_t i = 0; i < 3; ++i) push.impulse_Ns[i] = force_N[i] * mean * push.duration_s;
}

namespace {

// What plays the robot, and what it cannot play.
void plant_fields(Fields& f, ScenarioConfig& scenario) {
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
  const std::string others = listed(plant_type_names(&PlantType::has_objects));
  for (const auto& [key, what] : {std::pair{"world", "has one"},
                                  {"robots", "has one"},
                                  {"pushes", "can be pushed"},
                                  {"carried", "can be carried"}}) {
    if (f.has(key))
      f.refuse(key, ": only the " + others + " plant " + what + ", this scenario's plant is " + scenario.plant);
  }
}

void bus_fields(Fields& f, ScenarioConfig& scenario) {
  ScenarioBus& bus = scenario.bus;
  f.string("type", bus.type.name,
           "the bus, as `kadans run --plant` names it; where its drives are stands in the robot's configuration",
           Need::required);
  bus.type.place = f.place("type");
  f.strings("faults", bus.faults, {0, 1000},
            "what befalls the bus or its drives, as KIND[:OF]@S[+D][=SIZE]: cable_out@2+0.5, drive_hot:tilt@3=85");
  if (f.reading() && !scenario.robots.empty())
    f.refuse(": a robot on a bus is alone in its world, this scenario has robots");
}

// How it is run among others.
void suite_fields(Fields& f, ScenarioConfig& scenario) {
  std::vector<PlacedName> tags;
  f.strings("tags", tags, {0, 100}, "words by which kadans test finds it");
  for (const PlacedName& tag : tags) {
    if (tag.name.empty() || tag.name.find_first_of("/ ,*") != std::string::npos)
      f.refuse(tag.place, "tag " + in_quotes(tag.name) + " must be a word without blanks, commas, slashes and stars");
    scenario.tags.push_back(tag.name);
  }
  f.integer("repeat", scenario.repeat, {1, 10'000}, "number of runs in kadans test, each with the next seed");
  f.number("wall_limit_s", scenario.wall_limit_s, {0.1, 1e6, "s"},
           "wall-clock time after which a run is stopped and has failed");
}

// How this run's robot differs from the configured one.
void variant_fields(Fields& f, ScenarioConfig& scenario) {
  f.string("start_pose", scenario.start_pose.name,
           "the pose in which the robot starts (default: the one in its configuration)");
  scenario.start_pose.place = f.place("start_pose");
  f.object("set", "quantities that differ from the robot's files, by a pattern of their names",
           [&](Fields& e) { e.number_entries(scenario.set, {}, "value of the quantity"); });
  variation_fields(f, "randomise", scenario.randomise);
}

// What plays on one robot, what pushes it, and what fails.
void play_fields(Fields& f, ScenarioConfig& scenario) {
  std::vector<PlacedName> lists;
  f.strings("behaviors", lists, {0, 100}, "what to play, one after the other: files, or \"squat{depth_m=0.08}, wave\"");
  const PlayFolders folders = folders_of(scenario);
  for (const PlacedName& list : lists) {
    const TextPlace start{list.place.line, list.place.column + 1};  // behind the quote
    std::ranges::move(read_play_items(list.name, start, folders, f.problems()), std::back_inserter(scenario.behaviors));
  }
  f.list("events", {0, 10'000}, "changes to the list of behaviors, each at its time", scenario.events,
         [&](Fields& e, ScenarioEvent& event) { event_fields(e, event, folders); });
  f.list("pushes", {0, 1000}, "pushes on the robot", scenario.pushes, push_fields);
  f.list("carried", {0, 1000}, "a person lifts the robot as it stands, and puts it down at rest elsewhere",
         scenario.carried, [](Fields& e, ScenarioCarry& carry) {
           e.number("at_s", carry.at_s, {0, scenario_duration_max_s, "s"}, "time", Need::required);
           e.numbers("to_m", carry.to_m, {-1000, 1000, "m"}, "x and y of the base, in the world", Need::required);
           e.number("heading_rad", carry.heading_rad, {-7, 7, "rad"}, "its heading then; 0: along x");
           carry.place = e.place("to_m");
         });
  f.list("faults", {0, 1000}, "faults, each at its time", scenario.faults, fault_fields);
}

void perception_fields(Fields& f, ScenarioPerception& perception) {
  f.string("entry", perception.entry.name, "the entry of the world model that it tells of", Need::required);
  perception.entry.place = f.place("entry");
  f.string("object", perception.object.name, "the object of the world that is looked for; else record");
  perception.object.place = f.place("object");
  f.string("record", perception.record.name,
           "a record whose observations of this entry come again, or a sequence of `kadans log observations`");
  perception.record.place = f.place("record");
  f.number("from_s", perception.from_s, {0, scenario_duration_max_s, "s"},
           "time of the record at which the scenario begins");
  for (const SightRange& range : sight_ranges)
    f.number(range.name, perception.settings.*range.value, {range.min, range.max, range.unit}, range.doc);
  f.number("imagined", perception.imagined, {0, 1}, "share of the pictures that show it where it is not");
  f.boolean("hidden", perception.hidden, "other objects of the world may stand before it");
  if (!f.reading()) return;
  const bool recorded = f.has("record");
  if (recorded == f.has("object"))
    f.refuse(f.place("entry"), "perception needs either an object of the world, or a record: " +
                                   std::string(recorded ? "it has both" : "it has none of them"));
  if (!recorded && f.has("from_s"))
    f.refuse(f.place("from_s"), "from_s: only perception from a record has a time there");
  if (!recorded) return;
  for (const SightRange& range : sight_ranges) {
    if (f.has(range.name)) f.refuse(f.place(range.name), std::string(range.name) + ": comes with the record");
  }
  for (const char* const key : {"imagined", "hidden"}) {
    if (f.has(key)) f.refuse(f.place(key), std::string(key) + ": comes with the record");
  }
  perception.record.name =
      resolve_file(perception.record.name, perception.record.place, "record", f.problems()).string();
}

// What it knows, and what decides.
void supervisor_part(Fields& f, ScenarioConfig& scenario) {
  f.object("supervisor", "what decides what is played, in place of that of the robot's configuration",
           [&](Fields& e) { supervisor_fields(e, scenario.supervisor, folders_of(scenario)); });
  f.list("perception", {0, max_seen}, "perception of entries of the world model, simulated or from a record",
         scenario.perception, perception_fields);
}

// With this name a robot's signals begin, or viewers show it.
void check_robot_name(const std::string& name, const TextPlace& place, const ScenarioConfig& scenario,
                      Problems& problems) {
  if (std::ranges::count(scenario.robots, name, &ScenarioConfig::name) > 0 ||
      (!name.empty() && name == scenario.robot_name))
    problems.add(place, "another robot has the name " + in_quotes(name));
  if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
    problems.add(place, "name " + in_quotes(name) + " must consist of small letters, digits and underscores");
}

void further_robot_fields(Fields& f, ScenarioConfig& robot, const ScenarioConfig& scenario) {
  f.string("name", robot.name, "the robot's name: its signals are NAME.plant.base.height_m and the like",
           Need::required);
  robot.plant_place = f.place("name");
  check_robot_name(robot.name, robot.plant_place, scenario, f.problems());
  if (robot.name == "last")
    f.refuse(robot.plant_place, "name 'last': checks read last.SIGNAL as the signal's value one tick before");
  constexpr std::array quantities{"actuation", "control", "ground", "imu",       "joint",
                                  "link",      "start",   "sight",  "perception"};
  if (std::ranges::find(quantities, robot.name) != quantities.end())
    f.refuse(robot.plant_place, "name " + in_quotes(robot.name) + ": `set` and --set read " + robot.name +
                                    ".KEY as a quantity of the first robot");
  robot.file = scenario.file;
  robot.plant = scenario.plant;
  robot.robot = scenario.robot;
  std::string file;
  if (f.string("robot", file, "its configuration, from the project root; else that of the first robot"))
    robot.robot = resolve_file(file, f.place("robot"), "robot", f.problems()).string();
  variant_fields(f, robot);
  play_fields(f, robot);
  supervisor_part(f, robot);
  if (std::ranges::count(robot.faults, ScenarioFault::Kind::clock_missed, &ScenarioFault::kind) > 0)
    f.refuse("faults", ": clock_missed is a fault of all robots: it belongs to the scenario's own faults");
}

void joystick_fields(Fields& f, ScenarioConfig& scenario) {
  ScenarioJoystick& joystick = scenario.joystick;
  f.string("recording", joystick.recording, "input events, as evemu-record or cat wrote them", Need::required);
  joystick.place = f.place("recording");
  if (!joystick.recording.empty())
    joystick.recording = resolve_file(joystick.recording, joystick.place, "recording", f.problems()).string();
  f.number("at_s", joystick.at_s, {0, scenario_duration_max_s, "s"}, "time of its first event");
  f.number("lost_at_s", joystick.lost_at_s, {0, scenario_duration_max_s, "s"},
           "time at which it is unplugged (default: never)");
  f.map("buttons", std::string(buttons_doc) + ", in place of those of the robot's configuration",
        [&](Fields& e) { button_fields(e, joystick.buttons); });
}

void sight_fields(Fields& f, ScenarioSight& sight, const WorldConfig& world) {
  f.string("ball", sight.ball.name, "the object of the world that behaviors see as s.seen.ball", Need::required);
  sight.ball.place = f.place("ball");
  for (const SightRange& range : sight_ranges)
    f.number(range.name, sight.settings.*range.value, {range.min, range.max, range.unit}, range.doc);
  if (!f.reading() || !f.has("ball")) return;
  std::vector<std::string> names;
  for (const WorldObject& object : world.settings.objects) names.push_back(object.name);
  (void)f.problems().known(sight.ball, "object", names);
}

// A record that is repeated says itself what its run was.
void record_test_fields(Fields& f, ScenarioConfig& scenario) {
  std::vector<PlacedName> with;
  f.string("record", scenario.record,
           "a record of `kadans run` that is repeated in place of a simulation, from this file's folder");
  f.strings("with", with, {0, 100},
            "with a record: files of this project that take the place of the record's, from the project root");
  if (!f.reading()) return;
  if (!f.has("record")) {
    if (f.has("with")) f.refuse("with", ": only a scenario that repeats a record has one");
    return;
  }
  for (const char* const key : {"robot",      "plant",  "seed",    "repeat",  "start_pose", "set",        "randomise",
                                "behaviors",  "events", "pushes",  "carried", "faults",     "supervisor", "perception",
                                "robot_name", "robots", "network", "world",   "bus",        "joystick",   "sight"}) {
    if (f.has(key)) f.refuse(key, ": comes with the record, which is repeated");
  }
  const std::filesystem::path file = std::filesystem::absolute(scenario.file).parent_path() / scenario.record;
  if (!std::filesystem::is_regular_file(file))
    f.refuse("record", ": there is no file " + in_quotes(file.lexically_normal().string()));
  scenario.record = file.lexically_normal().string();
  for (const PlacedName& name : with)
    scenario.with.push_back(resolve_file(name.name, name.place, "file", f.problems()).string());
  if (!f.has("duration_s")) scenario.duration_s = scenario_duration_max_s;
}

void scenario_fields(Fields& f, ScenarioConfig& scenario) {
  std::string schema, base;
  f.string("$schema", schema, "the schema of this file, for editors");
  f.string("based_on", base, "another scenario; this file says only what is different");
  f.string("name", scenario.name, "the scenario's name", Need::required);
  f.string("doc", scenario.doc, "what it shows, one or two sentences");
  record_test_fields(f, scenario);
  const Need need = f.reading() && !f.has("record") ? Need::required : Need::optional;  // either these two or a record
  f.string("robot", scenario.robot, "the robot's configuration, from the project root; not with a record", need);
  if (!scenario.robot.empty()) {
    scenario.robot = resolve_file(scenario.robot, f.place("robot"), "robot", f.problems()).string();
  }
  plant_fields(f, scenario);
  f.number("duration_s", scenario.duration_s, {1e-3, scenario_duration_max_s, "s"},
           "duration of the simulation; of a record, how much of it is repeated (default: all)", need);
  f.integer("seed", scenario.seed, {0, std::numeric_limits<std::uint64_t>::max()},
            "seed of all random numbers of the run");
  suite_fields(f, scenario);
  variant_fields(f, scenario);
  play_fields(f, scenario);
  supervisor_part(f, scenario);
  std::string robot_name;
  if (f.string("robot_name", robot_name, "what viewers call the first robot (default: as its configuration does)")) {
    check_robot_name(robot_name, f.place("robot_name"), scenario, f.problems());
    scenario.robot_name = robot_name;
  }
  f.list("robots", {0, further_robots_max}, "further robots in the same world and time", scenario.robots,
         [&](Fields& e, ScenarioConfig& robot) { further_robot_fields(e, robot, scenario); });
  f.object("network", "the network between the robots", [&](Fields& e) {
    e.number("delay_s", scenario.network.delay_s, {0, 10, "s"}, "the least time that a message takes");
    e.number("jitter_s", scenario.network.jitter_s, {0, 10, "s"}, "the most that it takes longer");
    e.number("lost", scenario.network.lost, {0, 1}, "share of the messages that are lost");
  });
  world_fields(f, scenario.world);
  f.object("bus", "a bus with drives between the control and the model, byte by byte on virtual time",
           [&](Fields& e) { bus_fields(e, scenario); });
  f.object("joystick", "a joystick that is played from a recording", [&](Fields& e) { joystick_fields(e, scenario); });
  f.object("sight", "simulated perception of a ball",
           [&](Fields& e) { sight_fields(e, scenario.sight, scenario.world); });
  f.list("checks", {0, 1000}, "checks that must hold", scenario.checks,
         [&](Fields& e, ScenarioCheck& check) { check_fields(e, check, scenario.duration_s, scenario.checks); });
}

}  // namespace

bool PluginGate::lets_in(const std::filesystem::path& file) const {
  return !closed || std::ranges::find(let_in, std::filesystem::absolute(file).lexically_normal()) != let_in.end();
}

PlayFolders folders_of(const ScenarioConfig& scenario) {
  return {scenario.file, std::filesystem::path(scenario.robot).parent_path().filename().string()};
}

void set_last(ScenarioConfig& scenario, NumberEntry entry) {
  const auto is_theirs = [&](const ScenarioConfig& robot) { return entry.key.starts_with(robot.name + "."); };
  const auto robot = std::ranges::find_if(scenario.robots, is_theirs);
  if (robot == scenario.robots.end()) return scenario.set_last.push_back(std::move(entry));
  entry.key.erase(0, robot->name.size() + 1);
  robot->set_last.push_back(std::move(entry));
}

ScenarioConfig read_scenario_config_text(const std::string& text, const std::string& file) {
  ScenarioConfig scenario;
  scenario.file = file;
  read_based_fields(text, file, read_tested_scenario, [&](Fields& f) { scenario_fields(f, scenario); });
  return scenario;
}

ScenarioConfig read_tested_scenario(const std::filesystem::path& file) {
  return read_scenario_config_text(read_input_file(file), file.string());
}

ScenarioConfig read_scenario_config(const std::filesystem::path& file) {
  ScenarioConfig scenario = read_tested_scenario(file);
  if (!scenario.record.empty())
    refuse(file, "repeats a record, so it cannot be simulated: kadans test and kadans sim repeat it");
  return scenario;
}

FieldInfo describe_scenario_config() {
  ScenarioConfig scenario;
  return describe_fields([&](Fields& f) { scenario_fields(f, scenario); });
}

}  // namespace kadans
