// What a script declares of itself: tunable parameters, arguments, and events that it takes.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/scenario/play_item.h"

namespace kadans {

// A tunable parameter of a behavior, declared in k.params. It has a range and can be changed while the behavior runs.
struct ScriptParameter {
  std::string chunk;  // the file that declares it
  std::string name;
  std::string unit;
  std::string doc;
  double initial = 0, min = 0, max = 0;
  double value = 0;
  double loaded = 0;  // its value when the behavior was loaded, with its arguments and those of robot.json
};

// An argument of a behavior or a skill, as k.args declares it (chart_arguments.h).
struct ScriptArgument {
  std::string name, unit{}, doc{};
  std::optional<PlayValue>
      initial{};  // the default, which tells the type; nullopt: a table, which only k.call can give
  double min = -HUGE_VAL, max = HUGE_VAL;  // of a number
  std::vector<std::string> one_of{};       // of a text; empty: any
};

// An event that a behavior declares in k.events: it may come from outside the chart, with data of these fields.
struct ScriptEvent {
  struct Field {
    enum class Type : std::uint8_t { number, flag, text };
    std::string name;
    Type type = Type::number;
    std::string unit{}, doc{};
    double min = 0, max = 0;  // of a number
    bool optional = false;

    bool operator==(const Field&) const = default;
  };
  std::string chunk;  // the file that declares it, and where
  int line = 0;
  std::string name;
  std::string doc{};
  std::vector<Field> fields{};  // by name

  bool same_as(const ScriptEvent& other) const { return name == other.name && fields == other.fields; }
};

// The receiver of what decisions send by m:send(name, data).
inline constexpr const char* other_robots = "robots";

// An event that a behavior sends to others: by m:emit(name, data, { to = }).
struct SentEvent {
  PlayedEvent event;
  std::string to;          // name of a behavior, or "all"; of decisions also other_robots
  std::uint32_t lane = 0;  // of the sender
};

const char* type_text(ScriptEvent::Field::Type type) noexcept;  // "a number", "true or false", "a text"
// "distance_m: a number in m, 0..5; left: true or false, optional"; "": it has no data.
std::string fields_text(const ScriptEvent& event);

// Why data of an event from outside does not fit the declaration, and which field is wrong. "": it fits.
struct WrongData {
  std::string why;
  TextPlace place{};
};
WrongData wrong_data(const ScriptEvent& declared, const PlayedEvent& event);

// The declaration of this name; nullptr: there is none.
const ScriptEvent* find_event(const std::vector<ScriptEvent>& events, std::string_view name) noexcept;

}  // namespace kadans
