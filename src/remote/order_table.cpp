#include "kadans/remote/order_table.h"

#include <algorithm>

namespace kadans {
namespace {

using enum OrderArgument::Kind;
using enum OrderInfo::Faces;
using Is = Order::Kind;

constexpr OrderArgument record_file{
    .name = "file", .kind = text, .shown = "FILE", .doc = "its name, else robot and time"};

constexpr OrderArgument joints{.name = "joints",
                               .kind = text,
                               .shown = "JOINTS",
                               .doc = "by name or pattern, such as \"l_*\" (default: all)",
                               .lists = "joints"};

constexpr OrderInfo table[] = {
    {"status", "status", ctl, Role::read, "What it is, what it does, how it is", Is::report},
    {"list",
     "list",
     ctl,
     Role::read,
     "What there is of a kind, with units, ranges and values",
     Is::report,
     {{{.name = "what",
        .kind = text,
        .shown = "KIND",
        .doc = "behaviors, sets, objects, parameters, signals or joints",
        .required = true}}}},
    {"get",
     "get",
     ctl,
     Role::read,
     "The value of a parameter or signal",
     Is::report,
     {{{.name = "name", .kind = text, .shown = "NAME", .lists = "parameters signals", .required = true}}}},
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
        .doc = "samples a second at most (default: 10)",
        .min = 0.01,
        .max = 1000}}}},
    {"unwatch", "", sockets, Role::read, "No more of them", {}},
    {"drives", "drives", ctl, Role::read, "What the drives and their supply say of themselves", {}},
    {"enable_drives",
     "drive enable",
     all,
     Role::operate,
     "Let drives give torque; a joint that safety has let go stays so until faults are cleared",
     Is::enable_drives,
     {{joints}}},
    {"disable_drives",
     "drive disable",
     all,
     Role::operate,
     "No torque; brakes hold where there are any",
     Is::disable_drives,
     {{joints}}},
    {"reset_drives", "drive reset", all, Role::operate, "Clear the drives' own faults", Is::reset_drives, {{joints}}},
    {"home_drives", "drive home", all, Role::operate, "Find where positions count from", Is::home_drives, {{joints}}},
    {"brake_drives", "drive brake", all, Role::operate, "Let brakes hold the joints", Is::brake_drives, {{joints}}},
    {"release_drives",
     "drive release",
     all,
     Role::operate,
     "Open brakes by hand: what they held may fall",
     Is::release_drives,
     {{{.name = "joints",
        .kind = text,
        .shown = "JOINTS",
        .doc = "by name or pattern, such as \"l_*\"",
        .lists = "joints",
        .required = true}}}},
    {"faults", "fault list", ctl, Role::read, "What went wrong so far", {}},
    {"clear_faults", "fault clear", all, Role::operate, "Let the safety layer forget its faults", Is::clear_faults},
    {"estop", "estop", all, Role::operate, "Emergency stop: damp at once, then off, until faults are cleared", {}},
    {"play",
     "play",
     all,
     Role::operate,
     "Behaviors behind what plays: \"squat{depth_m=0.08}, wave\"",
     Is::play,
     {{{.name = "list", .kind = text, .shown = "LIST", .lists = "behaviors", .required = true},
       {.name = "replace", .kind = flag, .shown = "--replace", .doc = "in place of what plays"}}}},
    {"replace",
     "",
     all,
     Role::operate,
     "The same in place of what plays",
     Is::replace,
     {{{.name = "list", .kind = text, .required = true}}}},
    {"pause", "pause", all, Role::operate, "Behaviors and motions stand still", Is::pause},
    {"resume", "resume", all, Role::operate, "They go on", Is::resume},
    {"stop", "stop", all, Role::operate, "End what plays", Is::stop},
    {"switch",
     "switch",
     all,
     Role::operate,
     "Another control set",
     Is::switch_set,
     {{{.name = "set", .kind = text, .shown = "SET", .lists = "sets", .required = true}}}},
    {"set_point",
     "lead",
     all,
     Role::operate,
     "Set-points, all or none: \"gaze.x_m=1.2,gaze.y_m=0.3\"",
     Is::set_point,
     {{{.name = "list", .kind = text, .shown = "LIST", .required = true},
       {.name = "time_s",
        .kind = number,
        .shown = "--time S",
        .doc = "to be reached in so many seconds (default: 0)",
        .min = 0}}}},
    {"record_start", "record start", all, Role::operate, "Begin a record", Is::record_start, {{record_file}}},
    {"record_stop", "record stop", all, Role::operate, "End it", Is::record_stop},
    {"record_dump",
     "record dump",
     all,
     Role::operate,
     "Write what the flight recorder has of the last seconds",
     Is::record_dump,
     {{record_file}}},
    {"set",
     "set",
     all,
     Role::develop,
     "Give a parameter another value",
     Is::set_parameter,
     {{{.name = "name", .kind = text, .shown = "NAME", .lists = "parameters", .required = true},
       {.name = "value", .kind = number, .shown = "X", .required = true}}}},
    {"undo", "undo", all, Role::develop, "Take the last set back; again for the one before", Is::undo},
    {"save",
     "save",
     all,
     Role::develop,
     "Write what was set into the robot's configuration",
     Is::changes,
     {{{.name = "preset", .kind = text, .shown = "--preset NAME", .doc = "also into this preset, what it sets"}}}},
    {"reload",
     "reload",
     all,
     Role::develop,
     "Read a behavior's file again, or those of all that play",
     Is::reload,
     {{{.name = "name", .kind = text, .shown = "NAME", .lists = "behaviors"}}}},
    {"line",
     "",
     sockets,
     Role::develop,
     "A line for the console of this client",
     Is::line,
     {{{.name = "text", .kind = text, .required = true}}}},
    {"complete",
     "",
     sockets,
     Role::develop,
     "What its beginning may become",
     Is::complete,
     {{{.name = "text", .kind = text, .required = true}}}},
    {"hold", "", paced, Role::operate, "Time stands still", {}},
    {"go", "", paced, Role::operate, "It goes on", {}},
    {"step", "", paced, Role::operate, "By one tick", {}},
    {"speed",
     "",
     paced,
     Role::operate,
     "So many times as fast as the wall clock",
     {},
     {{{.name = "times", .kind = number, .required = true, .min = 0.01, .max = 100}}}},
    {"push",
     "",
     paced,
     Role::operate,
     "An impulse on a link, Ns: \"torso=0,2,0\"",
     {},
     {{{.name = "push", .kind = text, .required = true}}}},
};

}  // namespace

const OrderArgument* OrderInfo::argument(OrderArgument::Kind wanted) const noexcept {
  const auto found = std::ranges::find(arguments, wanted, &OrderArgument::kind);
  return found == arguments.end() ? nullptr : found;
}

std::span<const OrderInfo> order_table() noexcept { return table; }

const OrderInfo* find_order(std::string_view verb) noexcept {
  const auto found = std::ranges::find(table, verb, &OrderInfo::verb);
  return found == std::end(table) ? nullptr : found;
}

std::string brief_verbs(bool with_pace) {
  std::string verbs;
  for (const OrderInfo& order : table) {
    if (order.is_brief() && (with_pace || order.faces != paced))
      verbs += (verbs.empty() ? "" : " ") + std::string(order.verb);
  }
  return verbs;
}

}  // namespace kadans
