#include "status_fields.h"

#include <array>
#include <iterator>
#include <string>
#include <utility>

namespace kadans {
namespace {

using enum StatusField::Part;
using enum StatusField::Type;
using Place = StatusReference;

const char* level_name(std::size_t value) { return name(static_cast<SafetyLevel>(value)); }
const char* source_name(std::size_t value) { return name(static_cast<SeenSource>(value)); }
const char* posture_name(std::size_t value) { return name(static_cast<Posture>(value)); }

template <std::size_t axis>
Place rate_at(Snapshot& s, std::size_t) {
  return s.status.base.angular_velocity_rad_s[axis];
}
template <std::size_t axis>
Place axis_at(Snapshot& s, std::size_t) {
  return s.joystick.axes[axis];
}
template <std::size_t button>
Place button_at(Snapshot& s, std::size_t) {
  return s.joystick.buttons[button];
}

template <std::size_t channel>
Place channel_at(Snapshot& s, std::size_t) {
  return s.status.channels[channel];
}
template <std::size_t... channel>
constexpr auto channel_places(std::index_sequence<channel...>) {
  return std::array{&channel_at<channel>...};
}

template <std::size_t field>
Place seen_field_at(Snapshot& s, std::size_t i) {
  return s.seen.entries[i].fields[field];
}
template <std::size_t... field>
constexpr auto seen_places(std::index_sequence<field...>) {
  return std::array{&seen_field_at<field>...};
}

constexpr StatusField fields[] = {
    {joint, number, "position_rad", "rad", "Position, as measured",
     [](Snapshot& s, std::size_t i) -> Place { return s.joints.joints[i].position_rad; }},
    {joint, number, "velocity_rad_s", "rad/s", "Velocity, filtered",
     [](Snapshot& s, std::size_t i) -> Place { return s.joints.joints[i].velocity_rad_s; }},
    {joint, number, "effort_Nm", "Nm", "Torque at the joint, from its spring or its motor",
     [](Snapshot& s, std::size_t i) -> Place { return s.joints.joints[i].effort_Nm; }},

    {base, number, "roll_rad", "rad", "Roll", [](Snapshot& s, std::size_t) -> Place { return s.status.base.roll_rad; }},
    {base, number, "pitch_rad", "rad", "Pitch; positive leans forward",
     [](Snapshot& s, std::size_t) -> Place { return s.status.base.pitch_rad; }},
    {base, number, "yaw_rad", "rad", "Yaw since the start; it drifts",
     [](Snapshot& s, std::size_t) -> Place { return s.status.base.yaw_rad; }},
    {base, number, "tilt_rad", "rad", "Angle from upright, >= 0",
     [](Snapshot& s, std::size_t) -> Place { return s.status.base.tilt_rad; }},
    {base, number, "height_m", "m", "Height over the lowest sole that bears load; keeps its value while none does",
     [](Snapshot& s, std::size_t) -> Place { return s.status.base.height_m; }},
    {rate, number, "x", "rad/s", "Rate of rotation about the base's x axis", rate_at<0>, "rate_x_rad_s"},
    {rate, number, "y", "rad/s", "Rate of rotation about the base's y axis", rate_at<1>, "rate_y_rad_s"},
    {rate, number, "z", "rad/s", "Rate of rotation about the base's z axis", rate_at<2>, "rate_z_rad_s"},
    {base, choice, "posture", "", "Whether the trunk is upright, falls, or lies on its front, its back or a side",
     [](Snapshot& s, std::size_t) -> Place { return s.status.base.posture; }, nullptr, posture_name, posture_count},

    {foot, number, "force_N", "N", "Sum of the foot's pressure sensors",
     [](Snapshot& s, std::size_t i) -> Place { return s.status.feet[i].force_N; }},
    {foot, flag, "contact", "", "Whether the foot bears load",
     [](Snapshot& s, std::size_t i) -> Place { return s.status.feet[i].contact; }},
    {foot, number, "cop_x_m", "m", "Centre of pressure, forward in the foot's frame; keeps its value without contact",
     [](Snapshot& s, std::size_t i) -> Place { return s.status.feet[i].cop_x_m; }},
    {foot, number, "cop_y_m", "m",
     "Centre of pressure, to the left in the foot's frame; keeps its value without contact",
     [](Snapshot& s, std::size_t i) -> Place { return s.status.feet[i].cop_y_m; }},

    {support, number, "force_N", "N", "Sum of the forces under the feet that bear load",
     [](Snapshot& s, std::size_t) -> Place { return s.status.support.force_N; }},
    {support, number, "cop_x_m", "m",
     "Centre of pressure of all feet, ahead of the trunk; keeps its value without contact",
     [](Snapshot& s, std::size_t) -> Place { return s.status.support.cop_x_m; }},
    {support, number, "cop_y_m", "m",
     "Centre of pressure of all feet, left of the trunk; keeps its value without contact",
     [](Snapshot& s, std::size_t) -> Place { return s.status.support.cop_y_m; }},

    {odometry, number, "x_m", "m", "Where the base is, forward of where it was at the last reset",
     [](Snapshot& s, std::size_t) -> Place { return s.status.odometry.x_m; }},
    {odometry, number, "y_m", "m", "To the left of there",
     [](Snapshot& s, std::size_t) -> Place { return s.status.odometry.y_m; }},
    {odometry, number, "heading_rad", "rad", "Where it points, from where it pointed then, -pi..pi",
     [](Snapshot& s, std::size_t) -> Place { return s.status.odometry.heading_rad; }},
    {odometry, flag, "valid", "", "Whether the robot has stood on its feet since the last reset, and did not fall",
     [](Snapshot& s, std::size_t) -> Place { return s.status.odometry.valid; }},

    {safety, choice, "level", "", "Rung of the degradation ladder",
     [](Snapshot& s, std::size_t) -> Place { return s.status.safety.level; }, nullptr, level_name, safety_levels},
    {safety, number, "faults", "", "Faults since the last clearing",
     [](Snapshot& s, std::size_t) -> Place { return s.status.safety.fault_count; }},
    {safety, number, "first_fault", "", "Code of the first fault; 0: none",
     [](Snapshot& s, std::size_t) -> Place { return s.status.safety.first_fault.code; }},

    {joystick, number, "x", "", "Deflection to the right, -1..1; 0 within the dead zone", axis_at<0>},
    {joystick, number, "y", "", "Deflection forward, -1..1", axis_at<1>},
    {joystick, number, "twist", "", "Rotation, clockwise as seen from above, -1..1", axis_at<2>},
    {joystick, number, "throttle", "", "Position of the throttle, forward, -1..1", axis_at<3>},
    {joystick, flag, "button_1", "", "Whether the button is pressed", button_at<0>},
    {joystick, flag, "button_2", "", "Whether the button is pressed", button_at<1>},
    {joystick, flag, "button_3", "", "Whether the button is pressed", button_at<2>},
    {joystick, flag, "button_4", "", "Whether the button is pressed", button_at<3>},
    {joystick, flag, "button_5", "", "Whether the button is pressed", button_at<4>},
    {joystick, flag, "button_6", "", "Whether the button is pressed", button_at<5>},
    {joystick, flag, "button_7", "", "Whether the button is pressed", button_at<6>},
    {joystick, flag, "button_8", "", "Whether the button is pressed", button_at<7>},
    {joystick, flag, "connected", "", "Whether a joystick is connected",
     [](Snapshot& s, std::size_t) -> Place { return s.joystick.connected; }},

    {ball, number, "x_m", "m", "Where it was seen, ahead of the trunk; NaN until it is seen",
     [](Snapshot& s, std::size_t) -> Place { return s.ball.x_m; }},
    {ball, number, "y_m", "m", "Left of the trunk", [](Snapshot& s, std::size_t) -> Place { return s.ball.y_m; }},
    {ball, number, "age_s", "s", "Time since the picture in which it was seen; NaN until it is seen",
     [](Snapshot& s, std::size_t) -> Place { return s.ball.age_s; }},
    {ball, number, "confidence", "", "How certain it was, 0..1; 0 until it is seen",
     [](Snapshot& s, std::size_t) -> Place { return s.ball.confidence; }},

    {seen, number, "age_s", "s", "Time since the observation; NaN while nothing is known",
     [](Snapshot& s, std::size_t i) -> Place { return s.seen.entries[i].age_s; }},
    {seen, number, "confidence", "", "How certain it is, 0..1; 0 while nothing is known",
     [](Snapshot& s, std::size_t i) -> Place { return s.seen.entries[i].confidence; }},
    {seen, flag, "carried", "", "Whether the odometry tells the whole way since the observation",
     [](Snapshot& s, std::size_t i) -> Place { return s.seen.entries[i].carried; }},
    {seen, choice, "source", "", "Who told it",
     [](Snapshot& s, std::size_t i) -> Place { return s.seen.entries[i].source; }, nullptr, source_name, seen_sources},

    {root, number, "time_s", "s", "Time on the engine's clock", nullptr},
    {root, number, "tick", "", "Number of the control engine's tick",
     [](Snapshot& s, std::size_t) -> Place { return s.tick; }},
};

}  // namespace

double StatusReference::value() const noexcept {
  return std::visit([](const auto* at) { return static_cast<double>(*at); }, at_);
}

void StatusReference::set(double value) const noexcept {
  std::visit([value]<typename T>(T* at) { *at = static_cast<T>(value); }, at_);
}

void StatusReference::declare(SignalTable& table, Signal signal) const {
  std::visit(
      [&](const auto* at) {
        if constexpr (requires { table.add(std::move(signal), at); }) table.add(std::move(signal), at);
      },
      at_);
}

std::span<const StatusField> status_fields() noexcept { return fields; }

std::vector<StatusField> status_fields(const std::vector<SensorChannel>& channels,
                                       const std::vector<SeenInfo>& entries) {
  static constexpr auto places = channel_places(std::make_index_sequence<max_channels>{});
  static constexpr auto seen_at = seen_places(std::make_index_sequence<max_seen_fields>{});
  std::vector<StatusField> all(std::begin(fields), std::end(fields));
  for (std::size_t i = 0; i < channels.size() && i < max_channels; ++i) {
    const SensorChannel& one = channels[i];
    all.push_back({sensors, number, one.name.c_str(), one.unit.c_str(), one.doc.c_str(), places[i]});
  }
  for (std::size_t i = 0; i < entries.size() && i < max_seen; ++i) {
    for (std::size_t f = 0; f < entries[i].fields.size() && f < max_seen_fields; ++f) {
      const SeenField& one = entries[i].fields[f];
      all.push_back({seen, number, one.name.c_str(), one.unit.c_str(), one.doc.c_str(), seen_at[f]});
      all.back().only = i;
    }
  }
  return all;
}

void declare_part(SignalTable& table, StatusField::Part part, const std::string& topic, const Snapshot& snapshot,
                  std::size_t index) {
  for (const StatusField& field : fields) {
    if (field.part != part) continue;
    const std::string name = topic + "." + (field.signal != nullptr ? field.signal : field.name);
    std::string doc = field.doc;
    if (field.type == choice) {
      for (std::size_t i = 0; i < field.choices; ++i)
        doc += (i == 0 ? ": " : ", ") + std::to_string(i) + " " + field.choice(i);
    }
    // The table reads it and writes nothing.
    field.at(const_cast<Snapshot&>(snapshot), index).declare(table, {name, field.unit, doc + "."});
  }
}

}  // namespace kadans
