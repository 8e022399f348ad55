// Topics by which nodes of ROS 2 send events to the behaviors that play: /kadans/event/NAME for each event that one of
// them declares (k.events), with the dots of its name as slashes, and of a type of std_msgs by its fields:
//
//   none        Empty
//   one         Float64, Bool or String, by the field's type
//   several     String: the data as an order has them, {"distance_m": 1.2, "left": true}
//
// The event cmd_vel with the numbers forward_m_s, left_m_s and turn_rad_s has the topic /cmd_vel with the type Twist,
// as everything that drives robots has it.
//
// An event becomes the text order `emit` (text_orders.h), so its data are checked and answered as those of any other
// sender. One thread, that of the domain.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dds_domain.h"
#include "script/host/behavior_tables.h"

namespace kadans {

class EventTopics {
 public:
  static constexpr std::size_t topics_max = 64;  // further events come by orders alone

  explicit EventTopics(DdsDomain& domain) : domain_(domain) {}

  // Listens for the events that these behaviors take, too. A topic stays, with its type, until the domain is left: who
  // sends an event that nobody takes any more, or that has other fields now, is told so. Throws InputError.
  void listen(const std::vector<BehaviorReport>& behaviors);
  // Takes the next event that waits, as an order. False: none does.
  [[nodiscard]] bool take(std::string& order);

 private:
  enum class Type : std::uint8_t { empty, number, flag, text, fields, velocity };
  struct Topic {
    std::string event, field;
    Type type = Type::empty;
    dds_entity_t reader = 0;
  };
  void add(const ScriptEvent& event);
  bool take(const Topic& topic, std::string& data);

  DdsDomain& domain_;
  std::vector<Topic> topics_;
};

}  // namespace kadans
