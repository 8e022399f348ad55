// Events from outside as people and programs write them: "ball_seen", "ball_seen distance_m=1.2,left=true",
// "ball_seen{distance_m=1.2}", or with a JSON object: "ball_seen {\"distance_m\": 1.2}". All that comes from outside is
// bounded here, before anybody looks at its meaning.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "config/json/json_value.h"
#include "play_item.h"

namespace kadans {

struct EventBounds {
  static constexpr std::size_t fields = 64, name_bytes = 64, text_bytes = 256;
  static constexpr std::size_t data_bytes = 4096;  // of the names and texts of all its fields
};

// Words of letters, digits and '_', separated by dots; at most name_bytes.
bool is_event_name(std::string_view name) noexcept;
// An event's name as configurations write it; "" means none.
void check_event_name(const PlacedName& name, Problems& problems);
// A number, true or false, or a text, each within its bounds and finite. Other values are mistakes.
std::vector<PlayArgument> read_event_data(const JsonValue& object, Problems& problems);
// Throws InputError.
PlayedEvent read_event(std::string_view text, const std::string& source);
// Why it is out of bounds; "": it is not.
std::string out_of_bounds(const std::vector<PlayArgument>& data);

// The data as a JSON object on one line; numbers keep all their bits.
std::string data_json(const std::vector<PlayArgument>& data);
// "ball_seen {...}", as read_event() reads it; the name alone when it has no data.
std::string event_text(const PlayedEvent& event);

}  // namespace kadans
