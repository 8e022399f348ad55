#include "scenario_event.h"

#include <array>
#include <numbers>

#include "config/robot/project_root.h"

namespace kadans {
namespace {

constexpr double time_max_s = 1e6;

// Which of the other fields an event has to have.
struct Wants {
  bool list = false, reload = false;
};

void verify(const Fields& f, const ScenarioEvent& event, Wants wants, Problems& problems) {
  const std::string& kind = play_order_names[static_cast<std::size_t>(event.order.kind)];
  const auto field = [&](const char* name, bool wanted) {
    if (wanted && !f.has(name)) problems.add(f.place(), f.path(name) + " is missing: to " + kind + " needs it");
    if (!wanted && f.has(name))
      problems.add(f.place(name), f.path(name) + " means nothing here: to " + kind + " has none");
  };
  field("list", wants.list);
  field("behavior", wants.reload);
  field("file", wants.reload);
}

using FaultKind = ScenarioFault::Kind;

struct KindInfo {
  const char* name;
  const char* size;  // what `size` means; "" when it means nothing
};
constexpr std::array<KindInfo, 22> fault_kinds{{
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
}};

std::array<std::string, fault_kinds.size()> names_of_kinds() {
  std::array<std::string, fault_kinds.size()> names;
  for (std::size_t i = 0; i < fault_kinds.size(); ++i) names[i] = fault_kinds[i].name;
  return names;
}

void verify(const Fields& f, const ScenarioFault& fault, Problems& problems) {
  const KindInfo& info = fault_kinds.at(static_cast<std::size_t>(fault.kind));
  const std::string kind = std::string(" of kind '") + info.name + "'";
  if (info.size[0] != '\0' && !f.has("size"))
    problems.add(f.place(), f.path() + " is" + kind + " and needs size: " + info.size);
  if (info.size[0] == '\0' && f.has("size"))
    problems.add(f.place("size"), f.path("size") + " means nothing to a fault" + kind);
  const bool wants_of = fault.of_sensor() || fault.of_drive();
  if (wants_of && fault.of.name.empty())
    problems.add(f.place(), f.path() + " is" + kind + " and needs of: the joint" +
                                (fault.of_sensor() ? ", the foot's link, a sensor, or imu" : ""));
  if (!wants_of && f.has("of")) problems.add(f.place("of"), f.path("of") + " means nothing to a fault" + kind);
  if (!(fault.from_s < fault.until_s))
    problems.add(f.place("until_s"), f.path("until_s") + " is " + number_text(fault.until_s) +
                                         ", must be after from_s, " + number_text(fault.from_s) + " s");
  if ((fault.kind == FaultKind::drive_late || fault.kind == FaultKind::commands_late ||
       fault.kind == FaultKind::clock_missed) &&
      !(fault.size >= 1 && fault.size <= 255))
    problems.add(f.place("size"), f.path("size") + " is " + number_text(fault.size) + ", must be 1..255 ticks");
}

const std::array<std::string, 2> shape_names{"constant", "half_sine"};

}  // namespace

void event_fields(Fields& f, ScenarioEvent& event, const PlayFolders& folders, Problems& problems) {
  std::string list, file;
  PlayOrder& order = event.order;
  f.number("at_s", event.at_s, {0, time_max_s, "s"}, "time of the event", Need::required);
  const bool known = f.choice("do", order.kind, play_order_names, "change to the list of behaviors", Need::required);
  f.string("list", list, "for play and replace: the behaviors, such as \"squat{depth_m=0.08}, wave\"");
  f.string("behavior", order.behavior.name, "for reload: name of a behavior that plays");
  f.string("file", file, "for reload: the file with which it continues, from the project root");
  if (!f.reading() || !known) return;
  using Kind = PlayOrder::Kind;
  verify(f, event, {order.kind == Kind::play || order.kind == Kind::replace, order.kind == Kind::reload}, problems);
  order.behavior.place = f.place("behavior");
  if (!file.empty()) order.file = resolve_file(file, f.place("file"), "reload", problems);
  if (list.empty()) return;
  TextPlace start = f.place("list");
  ++start.column;  // behind the quote
  order.list = read_play_items(list, start, folders, problems);
}

void fault_fields(Fields& f, ScenarioFault& fault, Problems& problems) {
  constexpr NumberRange time{0, 1e6, "s"};
  f.choice("kind", fault.kind, names_of_kinds(), "kind of fault", Need::required);
  f.string("of", fault.of.name,
           "where it happens; for sensors a joint, a foot's link, a sensor's name or imu, for drives a joint");
  f.number("from_s", fault.from_s, time, "time at which the fault begins");
  f.number("until_s", fault.until_s, time, "time at which the fault ends (default: the end of the run)");
  f.number("size", fault.size, {-1e6, 1e6, ""}, "size of the fault; the kind says what it means");
  if (!f.reading()) return;
  fault.of.place = f.place("of");
  verify(f, fault, problems);
}

void push_fields(Fields& f, ScenarioPush& push, Problems& problems) {
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
    problems.add(f.place(), f.path() + " must have one of impulse_Ns and force_N");
    return;
  }
  if (f.has("impulse_Ns")) return;
  const double mean = push.shape == ScenarioPush::Shape::half_sine ? 2 / std::numbers::pi : 1;
  for (std::size_t i = 0; i < 3; ++i) push.impulse_Ns[i] = force_N[i] * mean * push.duration_s;
}

}  // namespace kadans
