#include "input_event.h"

#include <algorithm>
#include <utility>

#include "config/json/fields.h"
#include "config/scenario/event_text.h"
#include "kadans/signal/joystick.h"

namespace kadans {

void input_event_fields(Fields& f, InputEvent event, const char* rise, const char* fall, std::vector<InputEvent>& all) {
  f.string(rise, event.rise, std::string("event sent at each ") + rise);
  f.string(fall, event.fall, std::string("event sent at each ") + fall);
  if (!f.reading()) return;
  check_event_name({event.rise, f.place(rise)}, f.problems());
  check_event_name({event.fall, f.place(fall)}, f.problems());
  if (!event.rise.empty() || !event.fall.empty()) all.push_back(std::move(event));
}

void button_fields(Fields& entry, std::vector<InputEvent>& all) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= joystick_buttons; ++i) names.push_back("button_" + std::to_string(i));
  const auto found = entry.problems().known({entry.key(), entry.key_place()}, "button", names);
  input_event_fields(entry,
                     {.of = InputEvent::Of::button,
                      .index = static_cast<std::uint32_t>(found.value_or(names.size())),
                      .input = "joystick." + entry.key()},
                     "press", "release", all);
}

std::vector<InputEvent> overridden(std::vector<InputEvent> all, const std::vector<InputEvent>& own) {
  for (const InputEvent& event : own) {
    std::erase_if(all, [&](const InputEvent& other) { return other.input == event.input; });
    all.push_back(event);
  }
  return all;
}

}  // namespace kadans
