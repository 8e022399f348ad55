// A request of a client as JSON, checked against the table of orders, and the order that it becomes. All servers read
// requests and finish the order `save` here.
//
// For threads that serve clients.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "order_table.h"
#include "remote/ctl/ctl_json.h"
#include "remote/instance/configuration_text.h"

namespace kadans {

struct OrderRequest {
  const OrderInfo* info = nullptr;
  Json json = Json::object();  // the arguments by their names

  bool is(std::string_view verb) const noexcept { return verb == info->verb; }
  std::string text(const char* argument) const { return json.value(argument, std::string()); }
  double number(const char* argument, double without) const { return json.value(argument, without); }

  // Makes the order; only for requests whose info->kind is set.
  Order order(const std::string& who, std::uint64_t client = 0) const;
};

// {"verb": "set", "name": "l_knee.kp", "value": 50}. Throws InputError when the line is no JSON, when the verb or an
// argument is unknown, when an argument is missing, of the wrong type or out of range, or when the role may not give
// the order.
OrderRequest read_request(std::string_view line, Role role);

// {"verb": "set", "text": "l_knee.kp", "value": 50}: `text` is the order's text argument and `value` its number,
// whatever their names in the table are. Other fields are left to the caller. `paced`: the run's time can be held.
// Throws as read_request.
OrderRequest read_brief_request(const Json& json, bool paced);

// Finishes a `save` after the behavior thread has answered with the changes: writes the file and informs that thread.
// Throws what ConfigurationText::save throws.
std::vector<PresetOverride> save_changes(Instance& instance, InstancePort& port, const Answer& answer,
                                         const std::string& who, const std::string& preset = {});

}  // namespace kadans
