#include "ordered_events.h"

#include <string_view>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "config/scenario/event_text.h"
#include "telemetry/mcap/mcap_reader.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t events_max = 100'000;

// One event in a line: {"time_ns", "event", "data", "who"}.
void add(const Json& json, std::int64_t time_ns, const std::string& file, ScenarioConfig& scenario) {
  const auto text = [&](const char* name) { return json.value(name, std::string()); };
  const bool whole = json.is_object() && json.contains("event") && json["event"].is_string() && json.contains("data") &&
                     json.contains("who") && json["who"].is_string();
  if (!whole || scenario.events.size() >= events_max || time_ns < 0) refuse(file, "its events are damaged");
  ScenarioEvent event{.at_s = 1e-9 * static_cast<double>(time_ns), .order = {.kind = PlayOrder::Kind::emit}};
  event.order.event = {.name = text("event"), .who = text("who"), .ordered = true};
  if (!is_event_name(event.order.event.name)) refuse(file, "its events are damaged");
  Problems problems(file);
  event.order.event.data = read_event_data(parse_json(json_text(json["data"]), file), problems);
  if (!problems.empty()) refuse(file, "its events are damaged");
  scenario.events.push_back(std::move(event));
}

void add_from_fact(std::string_view fact, const std::string& file, ScenarioConfig& scenario) {
  while (!fact.empty()) {
    const Json json = read_foreign_json(fact.substr(0, fact.find('\n'))).value_or(Json());
    const bool timed = json.is_object() && json.contains("time_ns") && json["time_ns"].is_number_integer();
    add(json, timed ? json["time_ns"].get<std::int64_t>() : -1, file, scenario);
    fact.remove_prefix(std::min(fact.find('\n'), fact.size() - 1) + 1);
  }
}

void add_from_messages(const std::string& record, ScenarioConfig& scenario) {
  McapReader reader(record);
  for (McapMessage message; reader.next(message);) {
    const auto channel = reader.channels().find(message.channel);
    if (channel == reader.channels().end() || channel->second.topic != "/events") continue;
    const std::string_view text(reinterpret_cast<const char*>(message.payload.data()), message.payload.size());
    const Json json = read_foreign_json(text).value_or(Json());
    const bool ordered = json.is_object() && json.contains("ordered") && json["ordered"] == true;
    if (ordered) add(json, message.time_ns, record, scenario);
  }
}

}  // namespace

void OrderedEvents::tell_emitted(const EmittedEvent& event) {
  if (!event.ordered) return;
  fact_ += json_text(Json{{"time_ns", event.time_ns},
                          {"event", event.event},
                          {"data", read_foreign_json(event.data).value_or(Json::object())},
                          {"who", event.who}}) +
           "\n";
}

void add_ordered_events(const RunInputs& inputs, const std::string& record, ScenarioConfig& scenario) {
  add_from_fact(inputs.fact("events"), record.empty() ? "the checkpoint" : record, scenario);
  if (!record.empty() && !inputs.fact("ctl").empty()) add_from_messages(record, scenario);
}

}  // namespace kadans
