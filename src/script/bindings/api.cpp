#include "api.h"

#include <algorithm>
#include <deque>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bindings.h"
#include "script/chart/chart_reader.h"
#include "script/check/known_names.h"
#include "script/motion/motion_options.h"
#include "signal/number_text.h"
#include "signal/status_fields.h"

namespace kadans {
namespace {

// Describes the arguments of the API's functions for editor stubs and the reference. The options of motions come from
// the table that the bindings read (motion_options.h).
struct OptionTable {
  MotionOption::Method method;
  const char* type;  // of the stubs
  const char* of;    // the function whose argument it is
};
constexpr OptionTable option_tables[] = {{MotionOption::move, "kadans.MoveOptions", "move"},
                                         {MotionOption::set, "kadans.SetOptions", "set"},
                                         {MotionOption::through, "kadans.ThroughOptions", "move_through"},
                                         {MotionOption::point, "kadans.Point", "a point of move_through"},
                                         {MotionOption::follow, "kadans.FollowLimits", "follow"}};

struct ArgumentType {
  std::string_view name;
  const char* type;
};
constexpr ArgumentType argument_types[] = {{"pose", ": kadans.pose|table<string, number>"},
                                           {"points", ": kadans.Point[]"},
                                           {"name", ": string"},
                                           {"setpoint", ": string"},
                                           {"preset", ": string"},
                                           {"set", ": string"},
                                           {"condition", ": string|table"},
                                           {"record", ": fun(c: kadans.Machine)"},
                                           {"event", ": string"},
                                           {"format", ": string"},
                                           {"value", ": number"},
                                           {"seconds", ": number"},
                                           {"table", ": table<string, table>"},
                                           {"data", "?: table"},
                                           {"receiver", "?: { to: string }"},
                                           {"...", ": any"}};

struct OptionWords {
  const char* type;   // of the stubs
  const char* value;  // of the reference, where there is no range
};
constexpr OptionWords option_words[] = {  // as MotionOption::Type
    {"number", ""},
    {"'minimum_jerk'|'trapezoid'", "text"},
    {"boolean", "boolean"},
    {"string[]", "list"}};
static_assert(std::size(option_words) == static_cast<std::size_t>(MotionOption::Type::list) + 1);
const OptionWords& words_of(const MotionOption& option) { return option_words[static_cast<std::size_t>(option.type)]; }

std::string range(const MotionOption& option) {
  return option.type == MotionOption::Type::number ? printed("%g..%g %s", option.min, option.max, option.unit) : "";
}

// The type of the argument `name` of a function, as ": kadans.MoveOptions"; "" when any value is allowed.
std::string argument_type(std::string_view function, std::string_view name) {
  if (name == "options" || name == "limits") {
    for (const OptionTable& table : option_tables) {
      const bool needed = table.method == MotionOption::move || table.method == MotionOption::follow;
      if (function == table.of) return std::string(needed ? ": " : "?: ") + table.type;
    }
  }
  if (function == "pose" && name == "name") return ": kadans.pose";
  const auto known = std::ranges::find(argument_types, name, &ArgumentType::name);
  return known == std::end(argument_types) ? "" : known->type;
}

std::string motion_option_stubs() {
  std::string text;
  for (const OptionTable& table : option_tables) {
    text += "---@class " + std::string(table.type) + "\n";
    if (table.method == MotionOption::point) text += "---@field [1] kadans.pose|table<string, number>\n";
    for (const MotionOption& option : motion_options()) {
      if ((option.methods & table.method) == 0) continue;
      const bool needed = table.method == MotionOption::point || table.method == MotionOption::follow;
      const std::string limits = range(option);
      text += "---@field " + std::string(option.name) + (needed ? " " : "? ") + words_of(option).type + " " +
              option.doc + (limits.empty() ? "" : "; " + limits) + "\n";
    }
    text += "\n";
  }
  return text;
}

std::string motion_option_reference() {
  std::string text =
      "\n## How a motion goes: the last argument of `move` and its kin\n\n| option | of | value | "
      "|\n|---|---|---|---|\n";
  for (const MotionOption& option : motion_options()) {
    std::string where;
    for (const OptionTable& table : option_tables) {
      if ((option.methods & table.method) != 0) where += (where.empty() ? "" : ", ") + std::string(table.of);
    }
    text += "| `" + std::string(option.name) + "` | " + where + " | " + range(option) + words_of(option).value + " | " +
            option.doc + " |\n";
  }
  return text;
}

constexpr ApiEntry written[] = {
    {"kadans", "behavior(name)", "fun(body: table): kadans.Behavior", "A behavior: k.behavior \"name\" { ... }"},
    {"kadans", "decisions(name)", "fun(body: table): kadans.Behavior",
     "What decides which behaviors play (docs/supervisor.md): k.decisions \"name\" { ... }"},
    {"kadans", "state(name)", "fun(body: kadans.Body): kadans.Node", "A state, with transitions and states inside"},
    {"kadans", "parallel(name)", "fun(body: kadans.Body): kadans.Node",
     "A state whose regions are all active together"},
    {"kadans", "region(name)", "fun(body: kadans.Body): kadans.Node", "One region of a k.parallel"},
    {"kadans", "final(name)", "fun(body: table): kadans.Node", "A final state, with its outcome"},
    {"kadans", "history(name)", "fun(body: table): kadans.Node",
     "Leads back to the state in which its parent was left; { deep = true }: to the innermost ones; { to = }: at "
     "first"},
    {"kadans", "call(name)", "fun(arguments: table): kadans.Node",
     "A state that plays another behavior, with values of its arguments and parameters: constants, parameters of the "
     "caller, or functions of (m, s)"},
    {"kadans", "args(table)", "table",
     "Declares what a behavior or a skill is called with: { name = { default, min =, max =, unit =, one_of =, doc = } "
     "}"},
    {"kadans", "skill(name)", "fun(spec: kadans.SkillSpec): kadans.Skill",
     "A state with arguments, offered by a module: { doc =, args =, make = function(a) }"},
    {"kadans", "params(table)", "table", "Declares parameters: { name = { default, min =, max =, unit =, doc = } }"},
    {"kadans", "events(table)", "nil",
     "Declares events that may come from outside or from another behavior: { name = { \"a sentence\", field = \"m\" } "
     "}; a field is a unit for a number, k.flag, k.text, or { one of them, min =, max =, optional =, doc = }"},
    {"kadans", "flag", "kadans.FieldType", "In k.events: the field is true or false"},
    {"kadans", "text", "kadans.FieldType", "In k.events: the field is a text"},
    {"kadans", "pose(name)", "table<string, number>", "A copy of a pose of the robot, joint = position in rad"},
    {"kadans", "budget()", "{ instructions: number, memory_bytes: number }", "What remains of this tick's budget"},
    {"kadans", "log", "kadans.Log", "Lines for people; at most 100 a second, the rest is dropped and counted"},

    {"transition", "to", "string|string[]?",
     "The target, or states in several regions of a k.parallel; none: action alone"},
    {"transition", "on", "string|string[]?",
     "The event, or one of several; \"fault.*\": all that begin so, \"*\": all"},
    {"transition", "when", "(fun(s: kadans.Snapshot, m: kadans.Machine): any)?", "The condition"},
    {"transition", "after", "number|table?", "Seconds in the state, a number or a parameter"},
    {"transition", "action", "(fun(m: kadans.Machine, s: kadans.Snapshot))?", "Runs between the exits and the entries"},
    {"transition", "internal", "boolean?", "true: leads to a state inside its own, which is not left"},
    {"transition", "why", "string?", "A word for the log"},

    {"log", "info(format, ...)", "nil",
     "A line in the record, and on the console with --verbose; arguments as those of string.format"},
    {"log", "warning(format, ...)", "nil", "As info, with the severity of a warning"},
    {"log", "error(format, ...)", "nil", "As info, with the severity of an error; the behavior goes on"},

    {"m", "name", "string", "The behavior's name"},
    {"m", "time_s", "number", "Time in s since the state whose function runs was entered"},
    {"m", "vars", "table", "The behavior's own plain data; a reload keeps it"},
    {"m", "args", "table", "Arguments of the caller"},
    {"m", "wait(seconds)", "nil", "Waits so many seconds; in `run` only"},
    {"m", "emit(event, data, receiver)", "boolean?, string?",
     "Sends an event, with a table of plain data if need be; what waits for it takes it in this tick; from `during` "
     "and `run` in the next; with { to = \"NAME\" } or { to = \"all\" } to other behaviors that play, which get it in "
     "their next tick; nil, "
     "\"queue_full\""},
    {"m", "on(condition, record, options)", "kadans.Armed?, string?",
     "Arms a transaction: the control engine sends what the function asks for in the tick in which the condition "
     "becomes true, within { within_s = }; nil, \"queue_full\""},
    {"m", "use(set)", "nil", "Inside the function of m:on: activates a control set"},
    {"m", "clear_faults()", "boolean?, string?",
     "Clears the faults of the safety layer, but no emergency stop; commands later in the same tick count already; "
     "nil, \"queue_full\""},
    {"m", "reset_odometry()", "boolean?, string?",
     "Lets s.odometry begin anew from where the robot is in the next tick; nil, \"queue_full\"; an error where the "
     "robot has no feet"},

    {"object", "move(pose, options)", "kadans.Motion?, string?, number?, string?",
     "Moves to a pose, by name or as joint = rad, or to tasks, in { time_s = }; nil, \"queue_full\", or nil, "
     "\"out_of_reach\", how far, set-point"},
    {"object", "move_through(points, options)", "kadans.Motion?, string?",
     "Moves on a smooth curve through { { pose, time_s = }, ... } to rest at the last; nil, \"queue_full\""},
    {"object", "follow(pose, limits)", "boolean?, string?",
     "Moves towards a pose that may change in every tick, within limits; nil, \"queue_full\""},
    {"object", "set(setpoint, value, options)", "kadans.Motion?, string?",
     "Sets one set-point, at once or in { time_s = }; nil, \"queue_full\""},
    {"object", "setpoint(name)", "number", "Present value of a set-point, also during a motion, in its unit"},
    {"object", "parameter(name)", "number", "The value of a parameter, in its unit"},
    {"object", "set_gains(preset)", "boolean?, string?", "Sets the parameters of a preset; nil, \"queue_full\""},
    {"object", "set_parameter(name, value)", "boolean?, string?", "Sets one parameter; nil, \"queue_full\""},

    {"object", "hold()", "boolean?, string?", "Lets all its motions come to rest where they are; nil, \"queue_full\""},

    {"armed", "outcome", "'waits'|'done'|'refused'|'expired'|'taken_back'|'over'",
     "What became of it; 'over': it ended, how is not known any more"},
    {"armed", "fired", "number", "How often it acted"},
    {"armed", "cancel()", "boolean?, string?", "Takes it back; nil, \"queue_full\""},

    {"motion", "done", "boolean",
     "Whether the motion is over: arrived, taken over by another one, cancelled or refused"},
    {"motion", "outcome", "'moving'|'done'|'cancelled'|'queue_full'|'refused'|'expired'", "How it ended"},
    {"motion", "reason", "string?", "Why the control engine refused it: which set-point or parameter, and its range"},
    {"motion", "wait()", "boolean?, string?, string?",
     "Waits until the motion is over; in `run` only; nil, outcome and reason when it was cancelled or refused"},
    {"motion", "cancel()", "boolean?, string?", "Comes to rest where it is; nil, \"queue_full\""},

    {"s", "joints", "kadans.Joints", "By name"},
    {"s", "base", "kadans.Base", "The trunk"},
    {"decider", "play(list, arguments)", "boolean?, string?",
     "Plays a list of behaviors after what plays now: `m:play(\"get_up, walk_to{x_m=1}\")`; a table has the arguments "
     "of "
     "the only one: `m:play(\"walk_to\", { x_m = far_m })`. Its end is the event play.done, play.failed or "
     "play.refused; "
     "nil, \"queue_full\" when too much was asked for in this tick"},
    {"decider", "replace(list, arguments)", "boolean?, string?", "The same in place of what plays now"},
    {"decider", "stop()", "boolean?, string?", "Ends what plays"},
    {"decider", "pause()", "boolean?, string?", "Lets what plays stand still, until it is resumed"},
    {"decider", "resume()", "boolean?, string?", "Lets what plays go on"},
    {"decider", "plays(name)", "string?",
     "The path of the innermost active state of the behavior of this name that plays now; without a name of the first "
     "one; nil: it does not play"},
    {"decider", "send(event, data)", "boolean?, string?",
     "Sends an event to the other robots: `m:send(\"robot.pass\", { x_m = 1 })`. Its name begins with `robot.`, and "
     "k.events "
     "declares it; a text field `from` has the sender's name where it comes in"},
    {"s", "event", "kadans.Event", "The event of the present step; empty outside of such a step"},
    {"s", "feet", "kadans.Feet",
     "By name, as the robot's configuration has them; two without names are left and right"},
    {"s", "support", "kadans.Support", "Where the ground supports the robot"},
    {"s", "odometry", "kadans.Odometry", "Where the robot is by its feet and its gyro; never valid without feet"},
    {"s", "safety", "kadans.Safety", "State of the safety layer"},
    {"s", "joystick", "kadans.Joystick", "A joystick; centred while there is none"},
    {"s", "seen", "kadans.Seen",
     "What perception saw last: the entries of the world model, by the names in robot.json (docs/supervisor.md)"},
    {"seen", "ball", "kadans.SeenBall",
     "The ball of a scenario's `sight`; keeps what it was until the ball is seen again"},
    {"event", "name", "string?", "Its name"},
    {"event", "data", "table?",
     "What its sender gave it; of an end: { result = }, of a k.parallel: { outcomes = { region = outcome }, results = "
     "{ "
     "region "
     "= result } }; of error: { message =, file =, line =, cause =, state = }; of refused: { reason =, what = }; of "
     "fault.NAME: { joint =, value =, limit = }"},
    {"base", "angular_velocity_rad_s", "kadans.Rate", "In the base frame"},
    {"s", "sensors", "kadans.Sensors",
     "What the robot's configuration names under `sensors`; NaN before the first reading"},
};

// Where a part of the snapshot is documented; as StatusField::Part.
constexpr const char* part_owners[] = {"s",        "joint",  "base",     "rate", "foot",  "support",
                                       "odometry", "safety", "joystick", "ball", "entry", "sensors"};
static_assert(std::size(part_owners) == static_cast<std::size_t>(StatusField::Part::sensors) + 1);

std::string type_of(const StatusField& field) {
  if (field.type == StatusField::Type::number) return "number";
  if (field.type == StatusField::Type::flag) return "boolean";
  std::string type;
  for (std::size_t i = 0; i < field.choices; ++i) type += (i == 0 ? "'" : "|'") + std::string(field.choice(i)) + "'";
  return type;
}

// What is written above, and the fields of the snapshot.
std::vector<ApiEntry> whole_api() {
  static std::deque<std::string> texts;
  const auto kept = [](std::string text) { return texts.emplace_back(std::move(text)).c_str(); };
  std::vector<ApiEntry> all(std::begin(written), std::end(written));
  for (const StatusField& field : status_fields()) {
    const std::string unit = field.unit;
    all.push_back({part_owners[static_cast<std::size_t>(field.part)], field.name, kept(type_of(field)),
                   kept(field.doc + (unit.empty() ? "" : ", in " + unit))});
  }
  return all;
}

struct Owner {
  const char* name;
  const char* type;  // of the stubs
  const char* title;
};
constexpr Owner owners[] = {{"kadans", "kadans", "The module: `local k = require \"kadans\"`"},
                            {"transition", "kadans.Transition", "A transition: `{ on = \"seen\", to = \"walk\" }`"},
                            {"log", "kadans.Log", "Lines for people: `k.log`"},
                            {"m", "kadans.Machine", "`m`: what a behavior acts through"},
                            {"object", "kadans.Object", "A control object: `m.posture`"},
                            {"motion", "kadans.Motion", "A motion: what `move` and `set` return"},
                            {"armed", "kadans.Armed", "An armed transaction: what `m:on` returns"},
                            {"s", "kadans.Snapshot", "`s`: the snapshot, read-only"},
                            {"event", "kadans.Event", "The event of the present step: `s.event`"},
                            {"joint", "kadans.Joint", "A joint: `s.joints.l_knee`"},
                            {"base", "kadans.Base", "The trunk: `s.base`"},
                            {"rate", "kadans.Rate", "A rate of rotation: `s.base.angular_velocity_rad_s`"},
                            {"foot", "kadans.Foot", "A foot: `s.feet.left`"},
                            {"support", "kadans.Support", "The ground: `s.support`"},
                            {"odometry", "kadans.Odometry", "Where it is by its feet: `s.odometry`"},
                            {"safety", "kadans.Safety", "The safety layer: `s.safety`"},
                            {"joystick", "kadans.Joystick", "A joystick: `s.joystick`"},
                            {"seen", "kadans.Seen", "What perception saw: `s.seen`"},
                            {"ball", "kadans.SeenBall", "The ball of a scenario's `sight`: `s.seen.ball`"},
                            {"entry", "kadans.Entry", "An entry of the world model: `s.seen.NAME`"},
                            {"decider", "kadans.Decider", "`m` of a k.decisions, beside wait, emit, vars and args"}};

std::string bare(std::string_view name) { return std::string(name.substr(0, name.find('('))); }

// "pose, options" with the types that an editor checks.
std::string typed(std::string_view function, std::string_view names) {
  std::string text;
  while (!names.empty()) {
    const std::size_t comma = names.find(", ");
    const std::string name(names.substr(0, comma));
    names.remove_prefix(comma == std::string_view::npos ? names.size() : comma + 2);
    text += (text.empty() ? "" : ", ") + name + argument_type(function, name);
  }
  return text;
}

// "---@field move fun(self, pose: ..., options: kadans.MoveOptions): kadans.Motion?, string?"
std::string stub_line(const ApiEntry& entry) {
  const std::string_view name = entry.name;
  const std::size_t bracket = name.find('(');
  std::string type = entry.type;
  if (bracket != std::string_view::npos) {
    const std::string given = typed(bare(name), name.substr(bracket + 1, name.size() - bracket - 2));
    const std::string_view owner = entry.owner;
    const bool method = owner != "kadans" && owner != "log";
    type = "fun(" + std::string(method ? "self" : "") + (method && !given.empty() ? ", " : "") + given + "): " + type;
  }
  return "---@field " + bare(name) + " " + type + " " + entry.doc + "\n";
}

std::string alternatives(const std::string& alias, const std::vector<std::string>& values) {
  std::string text = "---@alias " + alias + "\n";
  for (const std::string& value : values) text += "---| " + value + "\n";
  return text + "\n";
}

void add_object(std::string& text, const Catalog& catalog, const ObjectInfo& object) {
  const std::string type = "kadans." + object.name;
  std::vector<std::string> setpoints, parameters, presets;
  const auto note = [&](const auto& one) {  // a Setpoint or a Parameter
    return printed("'\"%s\"' # %g..%g %s", short_name(object, one.name), one.min, one.max, one.unit.c_str());
  };
  for (const SetpointId id : object.setpoints) setpoints.push_back(note(catalog.setpoints[id]));
  for (const ParameterId id : object.parameters) parameters.push_back(note(catalog.parameters.info(id)));
  for (const Preset& preset : object.presets) presets.push_back("'\"" + preset.name + "\"'");
  text += alternatives(type + ".setpoint", setpoints) + alternatives(type + ".parameter", parameters) +
          alternatives(type + ".preset", presets);
  text += "---@class " + type + ": kadans.Object\n";
  text += "---@field set fun(self, setpoint: " + type +
          ".setpoint, value: number, options: kadans.SetOptions?): " + "kadans.Motion?, string?\n";
  text += "---@field setpoint fun(self, name: " + type + ".setpoint): number\n";
  text += "---@field parameter fun(self, name: " + type + ".parameter): number\n";
  text += "---@field set_gains fun(self, preset: " + type + ".preset): boolean?, string?\n";
  text += "---@field set_parameter fun(self, name: " + type + ".parameter, value: number): boolean?, string?\n\n";
}

}  // namespace

std::span<const ApiEntry> script_api() {
  static const std::vector<ApiEntry> all = whole_api();
  return all;
}

std::string lua_stubs(const Catalog& catalog) {
  std::string text =
      "---@meta kadans\n-- Generated by `kadans lua-stubs`; do not edit.\n\n---@class kadans.Node\n---@class "
      "kadans.Behavior\n---@class kadans.Body\n---@field [integer] kadans.Node|kadans.Transition\n---@field always "
      "kadans.Transition[]?\n---@field initial string|string[]?\n"
      "---@class kadans.FieldType\n\n---@class kadans.SkillSpec\n---@field doc string\n---@field args? table\n"
      "---@field make fun(a: table): kadans.Node\n\n---@alias kadans.Skill fun(name: string): fun(body: table): "
      "kadans.Node\n\n";
  std::vector<std::string> poses;
  for (const PoseInfo& pose : catalog.poses) poses.push_back("'\"" + pose.name + "\"'");
  text += alternatives("kadans.pose", poses);
  for (const ObjectInfo& object : catalog.objects) add_object(text, catalog, object);
  text += motion_option_stubs();
  text += "---@class kadans.Joints\n";
  for (const Joint& joint : catalog.model->joints) text += "---@field " + joint.name + " kadans.Joint\n";
  text += "\n---@class kadans.Sensors\n";
  const auto add_number = [&text](const auto& one) {  // a SensorChannel or a SeenField
    text += "---@field " + one.name + " number " + one.doc + (one.unit.empty() ? "" : " In " + one.unit) + "\n";
  };
  std::ranges::for_each(catalog.sensors, add_number);
  for (const SeenInfo& entry : catalog.seen) {
    text += "\n---@class kadans.Entry." + entry.name + ": kadans.Entry\n";
    std::ranges::for_each(entry.fields, add_number);
  }
  text += "\n---@class kadans.Feet\n";
  for (const FootInfo& foot : catalog.feet) text += "---@field " + foot.name + " kadans.Foot\n";
  text += "\n";
  for (const Owner& owner : owners) {
    text += "---@class " + std::string(owner.type) + "\n";
    for (const ApiEntry& entry : script_api()) {
      if (std::string_view(entry.owner) == owner.name) text += stub_line(entry);
    }
    if (std::string_view(owner.name) == "seen") {
      for (const SeenInfo& entry : catalog.seen)
        text += "---@field " + entry.name + " kadans.Entry." + entry.name + " " + entry.doc + "\n";
    }
    if (std::string_view(owner.name) == "m") {
      for (const ObjectInfo& object : catalog.objects) {
        text += "---@field " + object.name + " kadans." + object.name + " " + object.type + "\n";
      }
    }
    text += "\n";
  }
  return text + "---@type kadans\nlocal kadans\nreturn kadans\n";
}

std::string api_reference(const std::filesystem::path& root) {
  std::string text =
      "# Reference of behaviors\n\nGenerated by `kadans lua-stubs --markdown`; do not edit. The guide is "
      "[behaviors.md](behaviors.md).\n";
  for (const Owner& owner : owners) {
    text += "\n## " + std::string(owner.title) + "\n\n| name | type or result | |\n|---|---|---|\n";
    for (const ApiEntry& entry : script_api()) {
      if (std::string_view(entry.owner) != owner.name) continue;
      std::string type = entry.type;
      for (std::size_t at = 0; (at = type.find('|', at)) != std::string::npos; at += 2) type.insert(at, "\\");
      text += "| `" + std::string(entry.name) + "` | " + type + " | " + entry.doc + " |\n";
    }
  }
  return text + motion_option_reference() + skill_reference(root);
}

std::vector<std::string> bound_names(const std::filesystem::path& root, const std::filesystem::path& behavior,
                                     const Catalog& catalog) {
  BehaviorLog silence;
  Behavior::Parts parts({.root = root, .file = behavior}, catalog, silence);
  load_behavior(parts, parts.settings.limits.load_instructions);
  KnownNames known = read_known_names(parts);
  std::vector<std::string> all;
  const auto add = [&](const std::string& owner, const std::vector<std::string>& names) {
    for (const std::string& name : names) all.push_back(std::string(owner).append(".").append(name));
  };
  for (const ObjectInfo& object : catalog.objects) known.machine.fields.erase(object.name);
  auto& s = known.snapshot.fields;
  add("transition", transition_key_names());
  add("log", known.module.fields["log"].names());
  add("kadans", known.module.names());
  add("m", known.machine.names());
  add("object", known.object_methods);
  add("motion", {"cancel", "done", "outcome", "reason", "wait"});
  add("armed", {"cancel", "fired", "outcome"});
  add("s", known.snapshot.names());
  for (const char* part : {"event", "base", "support", "odometry", "safety", "joystick", "seen"})
    add(part, s[part].names());
  add("joint", s["joints"].fields.begin()->second.names());
  add("rate", s["base"].fields["angular_velocity_rad_s"].names());
  add("foot", s["feet"].fields.begin()->second.names());
  add("ball", s["seen"].fields["ball"].names());
  for (const char* field : {"age_s", "carried", "confidence", "source"}) all.push_back(std::string("entry.") + field);
  for (std::string& word : decider_words()) all.push_back(std::move(word));
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace kadans
