// An event that a behavior declares in k.events: it may come from outside the chart, with data of these fields.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scenario/play_item.h"

namespace kadans {

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
