// The orders that clients may give to a running instance.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/frames.h"
#include "kadans/signal/parameter.h"
#include "remote/ctl/ctl_folder.h"

namespace kadans {

struct ParameterChange {
  std::string name;
  double before = 0, now = 0;
  std::string chunk{};  // for a behavior's parameter: the file that declares it
};

struct Order {
  enum class Kind : std::uint8_t {
    // Behavior thread.
    report,    // Answer::behaviors = what plays
    why,       // Answer::reasons = why transitions were not taken; `text` = name of a behavior, "": all that play
    describe,  // Answer::text = behaviors_description
    play,      // `text` = list; it is appended to what plays
    replace,   // `text` = list; it replaces what plays
    pause,
    resume,
    stop,
    reload,         // `text` = name; "": all playing behaviors
    emit,           // `text` = an event, as read_event() reads it
    switch_set,     // `text` = name
    set_point,      // `text` = "gaze.x_m=1.2,gaze.y_m=0.3", in one transaction; `value` = duration in s
    set_parameter,  // `text` = name in the table, or BEHAVIOR.NAME; `value`
    undo,           // reverts the newest set_parameter
    changes,        // Answer::changes = changes by set_parameter since the start or the last `saved`
    saved,          // `changes` have been written into the configuration
    clear_faults,
    reset_odometry,
    mark,  // `text` for the record
    // `text` = joints by a pattern, "" = all; as the orders to drives (frames.h).
    enable_drives,
    disable_drives,
    reset_drives,
    home_drives,
    brake_drives,
    release_drives,
    line,           // `text` for the console of this client
    complete,       // `text` = the beginning of a line
    leave_console,  // the client is gone
    // Record thread.
    record_start,  // `text` = file
    record_stop,
    record_dump,  // `text` = file; writes what the flight recorder holds
  };
  Kind kind = Kind::report;
  std::string text{};
  double value = 0;
  std::string who{};         // for the log: "uid 1000 (develop)"
  std::uint64_t client = 0;  // the client whose console it is
  std::vector<ParameterChange> changes{};
};

// The record thread carries these out, the behavior thread all others.
constexpr bool is_about_records(Order::Kind kind) noexcept {
  using enum Order::Kind;
  return kind == record_start || kind == record_stop || kind == record_dump;
}

// What an order asks of drives; none: it is about something else.
constexpr DriveOrder drive_order_of(Order::Kind kind) noexcept {
  using enum Order::Kind;
  if (kind < enable_drives || kind > release_drives) return DriveOrder::none;
  return static_cast<DriveOrder>(1 + static_cast<std::uint8_t>(kind) - static_cast<std::uint8_t>(enable_drives));
}
static_assert(drive_order_of(Order::Kind::enable_drives) == DriveOrder::enable &&
              drive_order_of(Order::Kind::home_drives) == DriveOrder::home &&
              drive_order_of(Order::Kind::release_drives) == last_drive_order);

struct OrderArgument {
  enum class Kind : std::uint8_t { none, text, number, flag, texts };
  const char* name = "";
  Kind kind = Kind::none;
  const char* shown = "";  // on the command line: "NAME", or an option, "--rate HZ"
  const char* doc = "";    // a sentence, when the order's own does not explain it
  const char* lists = "";  // one or two words of `list`, by which a shell completes it
  bool required = false;
  double min = std::numeric_limits<double>::lowest(), max = std::numeric_limits<double>::max();  // range of a number
  bool is_option() const noexcept { return shown[0] == '-'; }
};

struct OrderInfo {
  // Where an order may be given. ctl: on the command line and its sockets. all: there, on the page and by ROS 2. paced:
  // only on the page and by ROS 2, when the run's time can be held. sockets: only on the sockets, for consoles.
  enum class Faces : std::uint8_t { ctl, all, paced, sockets };

  const char* verb;
  const char* words;  // the words on the command line: "record start"
  Faces faces;
  Role role;
  const char* doc;
  std::optional<Order::Kind> kind;           // the order that it becomes; nullopt: the server answers by itself
  std::array<OrderArgument, 2> arguments{};  // a second text stands behind the first, after a blank
  const char* examples = "";                 // command lines for its --help, where the words alone do not do

  bool is_brief() const noexcept { return faces == Faces::all || faces == Faces::paced; }
  // The first argument of this kind; nullptr: there is none.
  const OrderArgument* argument(OrderArgument::Kind kind) const noexcept;
};

// All orders. `kadans ctl` with its help and completion, the lines on its sockets, the web page and ROS 2 all use this
// table. A new order is an entry here, with its Order::Kind, and the code that carries it out.
namespace order_table {

using enum OrderArgument::Kind;
using enum OrderInfo::Faces;
using Is = Order::Kind;

inline constexpr OrderArgument record_file{
    .name = "file", .kind = text, .shown = "FILE", .doc = "name of the file (default: from robot and time)"};

inline constexpr OrderArgument some_text{.name = "text", .kind = text, .required = true};
inline constexpr OrderArgument some_joints{.name = "joints",
                                           .kind = text,
                                           .shown = "JOINTS",
                                           .doc = "names or patterns of joints, such as \"l_*\" (default: all)",
                                           .lists = "joints"};

inline constexpr OrderInfo orders[] = {
    {"status",
     "status",
     ctl,
     Role::read,
     "The instance's name, mode, safety level and behaviors",
     Is::report,
     {},
     "  kadans ctl status --json\n"},
    {"why",
     "why",
     all,
     Role::operate,
     "Why the transitions of the active states were not taken: events, times, guards",
     Is::why,
     {{{.name = "behavior",
        .kind = text,
        .shown = "NAME",
        .doc = "name of a behavior (default: all that play)",
        .lists = "behaviors"}}},
     "  kadans ctl why\n  kadans ctl why squat --json\n"},
    {"list",
     "list",
     ctl,
     Role::read,
     "All items of a kind, with units, ranges and values",
     Is::report,
     {{{.name = "what",
        .kind = text,
        .shown = "KIND",
        .doc = "behaviors, sets, objects, parameters, signals, joints or events",
        .required = true}}},
     "  kadans ctl list behaviors\n  kadans ctl list parameters --names\n"},
    {"get",
     "get",
     ctl,
     Role::read,
     "The value of a parameter or signal",
     Is::report,
     {{{.name = "name", .kind = text, .shown = "NAME", .lists = "parameters signals", .required = true}}},
     "  kadans ctl get posture.l_knee.kp_Nm_per_rad\n"},
    {"watch",
     "watch",
     ctl,
     Role::read,
     "Values of signals as they change, until Ctrl-C",
     {},
     {{{.name = "signals", .kind = texts, .shown = "SIGNAL", .lists = "signals", .required = true},
       {.name = "rate_hz",
        .kind = number,
        .shown = "--rate HZ",
        .doc = "largest number of samples in a second (default: 10)",
        .min = 0.01,
        .max = 1000}}},
     "  kadans ctl watch joint.l_knee.position_rad safety.level\n"
     "  kadans ctl watch base.tilt_rad --rate 100 --count 500 --json\n"},
    {"unwatch", "", sockets, Role::read, "End the samples", {}},
    {"drives",
     "drives",
     ctl,
     Role::read,
     "What the drives and their supply report: state, code, temperature, voltage",
     {},
     {},
     "  kadans ctl drives --json\n"},
    {"world", "world", ctl, Role::read, "What the robot knows of the world: entries with age, confidence, source", {}},
    {"enable_drives",
     "drive enable",
     all,
     Role::operate,
     "Let drives give torque; a joint that safety has let go stays so until faults are cleared",
     Is::enable_drives,
     {{some_joints}},
     "  kadans ctl drive enable\n"
     "  kadans ctl drive enable 'l_*'\n"},
    {"disable_drives",
     "drive disable",
     all,
     Role::operate,
     "Let drives give no torque; brakes hold where there are any",
     Is::disable_drives,
     {{some_joints}},
     "  kadans ctl drive disable l_knee\n"},
    {"reset_drives",
     "drive reset",
     all,
     Role::operate,
     "Clear the drives' own faults",
     Is::reset_drives,
     {{some_joints}},
     "  kadans ctl drive reset\n"
     "  kadans ctl drive reset l_knee\n"},
    {"home_drives",
     "drive home",
     all,
     Role::operate,
     "Let drives find their zero position",
     Is::home_drives,
     {{some_joints}},
     "  kadans ctl drive home 'l_*'\n"},
    {"brake_drives", "drive brake", all, Role::operate, "Engage the brakes", Is::brake_drives, {{some_joints}}},
    {"release_drives",
     "drive release",
     all,
     Role::operate,
     "Release the brakes; what they held may fall",
     Is::release_drives,
     {{{.name = "joints",
        .kind = text,
        .shown = "JOINTS",
        .doc = "names or patterns of joints, such as \"l_*\"",
        .lists = "joints",
        .required = true}}},
     "  kadans ctl drive release l_knee\n"},
    {"faults",
     "fault list",
     ctl,
     Role::read,
     "Faults since the start or the last clearing",
     {},
     {},
     "  kadans ctl fault list --json\n"},
    {"clear_faults", "fault clear", all, Role::operate, "Clear the faults of the safety layer, and the emergency stop",
     Is::clear_faults},
    {"mark",
     "mark",
     ctl,
     Role::operate,
     "Put a line into the record's log, so that this moment is found again",
     Is::mark,
     {OrderArgument{.name = "text", .kind = text, .shown = "TEXT", .required = true}},
     "  kadans ctl mark 'here it stumbles'\n"},
    {"reset_odometry", "odometry reset", all, Role::operate, "Let the robot's odometry begin anew, where it is now",
     Is::reset_odometry},
    {"estop", "estop", all, Role::operate, "Emergency stop: damp at once, then off, until faults are cleared", {}},
    {"play",
     "play",
     all,
     Role::operate,
     "Play behaviors after those that play now: \"squat{depth_m=0.08}, wave\"",
     Is::play,
     {{{.name = "list", .kind = text, .shown = "LIST", .lists = "behaviors", .required = true},
       {.name = "replace", .kind = flag, .shown = "--replace", .doc = "instead of those that play now"}}},
     "  kadans ctl play 'squat{depth_m=0.08}, wave'\n"
     "  kadans ctl play stand --replace\n"},
    {"replace",
     "",
     all,
     Role::operate,
     "Play behaviors instead of those that play now",
     Is::replace,
     {{{.name = "list", .kind = text, .required = true}}}},
    {"pause", "pause", all, Role::operate, "Pause behaviors and motions", Is::pause},
    {"resume", "resume", all, Role::operate, "Resume behaviors and motions", Is::resume},
    {"stop", "stop", all, Role::operate, "Stop the behaviors that play", Is::stop},
    {"emit",
     "emit",
     all,
     Role::operate,
     "Send an event to the behaviors that play and declare it",
     Is::emit,
     {{{.name = "event", .kind = text, .shown = "NAME", .lists = "events", .required = true},
       {.name = "data",
        .kind = text,
        .shown = "DATA",
        .doc = "its data: name=value,name=value, or a JSON object (default: none)"}}},
     "  kadans ctl emit whistle\n"
     "  kadans ctl emit ball_seen distance_m=1.2,left=true\n"},
    {"switch",
     "switch",
     all,
     Role::operate,
     "Activate another control set",
     Is::switch_set,
     {{{.name = "set", .kind = text, .shown = "SET", .lists = "sets", .required = true}}},
     "  kadans ctl switch posture\n"},
    {"set_point",
     "lead",
     all,
     Role::operate,
     "Set set-points, all or none: \"gaze.x_m=1.2,gaze.y_m=0.3\"",
     Is::set_point,
     {{{.name = "list", .kind = text, .shown = "LIST", .required = true},
       {.name = "time_s",
        .kind = number,
        .shown = "--time S",
        .doc = "duration of the motion to them (default: 0)",
        .min = 0}}},
     "  kadans ctl lead gaze.x_m=1.2,gaze.y_m=0.3 --time 0.5\n"},
    {"record_start",
     "record start",
     all,
     Role::operate,
     "Begin a record",
     Is::record_start,
     {{record_file}},
     "  kadans ctl record start\n"
     "  kadans ctl record start walk.mcap\n"},
    {"record_stop", "record stop", all, Role::operate, "End the record", Is::record_stop},
    {"record_dump",
     "record dump",
     all,
     Role::operate,
     "Write what the flight recorder holds",
     Is::record_dump,
     {{record_file}}},
    {"set",
     "set",
     all,
     Role::develop,
     "Set a parameter",
     Is::set_parameter,
     {{{.name = "name", .kind = text, .shown = "NAME", .lists = "parameters", .required = true},
       {.name = "value", .kind = number, .shown = "X", .required = true}}},
     "  kadans ctl set posture.l_knee.kp_Nm_per_rad 250\n"
     "  kadans ctl set squat.depth_m 0.08\n"},
    {"undo", "undo", all, Role::develop, "Undo the last set; repeat it for earlier ones", Is::undo},
    {"save",
     "save",
     all,
     Role::develop,
     "Write the parameters that were set into the robot's configuration",
     Is::changes,
     {{{.name = "preset",
        .kind = text,
        .shown = "--preset NAME",
        .doc = "write those that this preset contains into the preset, too"}}},
     "  kadans ctl save\n"
     "  kadans ctl save --preset stiff    also into the gains that behaviors choose as \"stiff\"\n"},
    {"reload",
     "reload",
     all,
     Role::develop,
     "Reload the file of a behavior, or the files of all that play",
     Is::reload,
     {{{.name = "name", .kind = text, .shown = "NAME", .lists = "behaviors"}}},
     "  kadans ctl reload\n"
     "  kadans ctl reload squat\n"},
    {"line", "", sockets, Role::develop, "A line for the console of this client", Is::line, {{some_text}}},
    {"complete", "", sockets, Role::develop, "Completions of the line's beginning", Is::complete, {{some_text}}},
    {"hold", "", paced, Role::operate, "Stop time", {}},
    {"go", "", paced, Role::operate, "Let time continue", {}},
    {"step", "", paced, Role::operate, "Let time continue for one tick", {}},
    {"speed",
     "",
     paced,
     Role::operate,
     "Speed as a multiple of the wall clock's",
     {},
     {{{.name = "times", .kind = number, .required = true, .min = 0.01, .max = 100}}}},
    {"push",
     "",
     paced,
     Role::operate,
     "Push a link with an impulse in Ns: \"torso=0,2,0\"",
     {},
     {{{.name = "push", .kind = text, .required = true}}}},
};

}  // namespace order_table

const OrderInfo* find_order(std::string_view verb) noexcept;  // nullptr: there is none
// The verbs of the page and of ROS 2, separated by blanks.
std::string brief_verbs(bool paced);

}  // namespace kadans
