#include "event_topics.h"

#include <algorithm>
#include <array>

#include "config/json/foreign_json.h"
#include "messages.h"  // made by idlc from messages.idl
#include "remote/order/order_json.h"

namespace kadans {
namespace {

constexpr std::int32_t events_depth = 16;  // that may wait, of a topic

template <typename Value>
std::string data_of(const std::string& field, const Value& value) {
  return json_text(Json{{field, value}});
}

// Forward, to the left, turning: in the order of a Twist that moves on the ground.
constexpr std::array velocity_fields{"forward_m_s", "left_m_s", "turn_rad_s"};

bool is_velocity(const ScriptEvent& event) {
  if (event.name != "cmd_vel" || event.fields.size() != velocity_fields.size()) return false;
  return std::ranges::all_of(velocity_fields, [&](const char* name) {
    return std::ranges::any_of(event.fields, [&](const auto& field) {
      return field.name == name && field.type == ScriptEvent::Field::Type::number;
    });
  });
}

}  // namespace

void EventTopics::listen(const std::vector<BehaviorReport>& behaviors) {
  for (const BehaviorReport& behavior : behaviors) {
    for (const ScriptEvent& event : behavior.events) {
      const bool there = std::ranges::find(topics_, event.name, &Topic::event) != topics_.end();
      if (!there && topics_.size() < topics_max) add(event);
    }
  }
}

void EventTopics::add(const ScriptEvent& event) {
  constexpr Type types[] = {Type::number, Type::flag, Type::text};
  Topic topic{.event = event.name};
  if (is_velocity(event)) {
    topic.type = Type::velocity;
  } else if (event.fields.size() == 1) {
    topic.field = event.fields.front().name;
    topic.type = types[static_cast<std::size_t>(event.fields.front().type)];
  } else if (!event.fields.empty()) {
    topic.type = Type::fields;
  }
  const dds_topic_descriptor_t* const messages[] = {
      // by Type
      &std_msgs_msg_dds__Empty__desc,  &std_msgs_msg_dds__Float64__desc, &std_msgs_msg_dds__Bool__desc,
      &std_msgs_msg_dds__String__desc, &std_msgs_msg_dds__String__desc,  &geometry_msgs_msg_dds__Twist__desc};
  std::string name = topic.type == Type::velocity ? "rt/cmd_vel" : "rt/kadans/event/" + event.name;
  std::ranges::replace(name, '.', '/');
  topic.reader = domain_.reader(*messages[static_cast<std::size_t>(topic.type)], name, {.depth = events_depth});
  topics_.push_back(std::move(topic));
}

bool EventTopics::take(std::string& order) {
  for (const Topic& topic : topics_) {
    std::string data;
    if (!take(topic, data)) continue;
    order = json_text({{"verb", "emit"}, {"text", topic.event + (data.empty() ? "" : " " + data)}});
    return true;
  }
  return false;
}

bool EventTopics::take(const Topic& topic, std::string& data) {
  switch (topic.type) {
    case Type::empty:
      return domain_.take<std_msgs_msg_dds__Empty_>(topic.reader, [](const auto&) {});
    case Type::number:
      return domain_.take<std_msgs_msg_dds__Float64_>(topic.reader,
                                                      [&](const auto& m) { data = data_of(topic.field, m.data); });
    case Type::flag:
      return domain_.take<std_msgs_msg_dds__Bool_>(topic.reader,
                                                   [&](const auto& m) { data = data_of(topic.field, m.data); });
    case Type::velocity:
      return domain_.take<geometry_msgs_msg_dds__Twist_>(topic.reader, [&](const auto& m) {
        const auto& [forward, left, turn] = velocity_fields;
        data = json_text(Json{{forward, m.linear.x}, {left, m.linear.y}, {turn, m.angular.z}});
      });
    case Type::text:
    case Type::fields:
      break;
  }
  return domain_.take<std_msgs_msg_dds__String_>(topic.reader, [&](const auto& m) {
    const std::string text = m.data != nullptr ? m.data : "";
    data = topic.type == Type::text ? data_of(topic.field, text) : text;
  });
}

}  // namespace kadans
