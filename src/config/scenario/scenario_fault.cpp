#include "scenario_fault.h"

#include <array>

namespace kadans {
namespace {

using FaultKind = ScenarioFault::Kind;

struct KindInfo {
  const char* name;
  const char* size;  // what `size` means; "" when it means nothing
};
constexpr std::array<KindInfo, 22> kinds{{
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

std::array<std::string, kinds.size()> names_of_kinds() {
  std::array<std::string, kinds.size()> names;
  for (std::size_t i = 0; i < kinds.size(); ++i) names[i] = kinds[i].name;
  return names;
}

void verify(const Fields& f, const ScenarioFault& fault, Problems& problems) {
  const KindInfo& info = kinds.at(static_cast<std::size_t>(fault.kind));
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

}  // namespace

void fault_fields(Fields& f, ScenarioFault& fault, Problems& problems) {
  constexpr NumberRange time{0, 1e6, "s"};
  f.choice("kind", fault.kind, names_of_kinds(), "what fails and how", Need::required);
  f.string("of", fault.of.name, "of sensors: a joint, a foot's link, a sensor, or imu; of drives: a joint");
  f.number("from_s", fault.from_s, time, "from this time on");
  f.number("until_s", fault.until_s, time, "up to this time, else to the end");
  f.number("size", fault.size, {-1e6, 1e6, ""}, "how much; what it means depends on the kind");
  if (!f.reading()) return;
  fault.of.place = f.place("of");
  verify(f, fault, problems);
}

}  // namespace kadans
