// A request as JSON that keeps the rules of the table of orders, and the order that it becomes. Whoever serves clients
// reads what they say here, and finishes here what the threads have answered.
//
// Threads that serve clients.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "ctl_json.h"
#include "kadans/remote/configuration_text.h"
#include "kadans/remote/order_table.h"

namespace kadans {

struct OrderRequest {
  const OrderInfo* info = nullptr;
  Json json = Json::object();  // the arguments by their names

  bool is(std::string_view verb) const noexcept { return verb == info->verb; }
  std::string text(const char* argument) const { return json.value(argument, std::string()); }
  double number(const char* argument, double without) const { return json.value(argument, without); }

  // Of an order that becomes one.
  Order order(const std::string& who, std::uint64_t client = 0) const;
};

// {"verb": "set", "name": "l_knee.kp", "value": 50}. Throws InputError: no JSON, unknown verb or argument, one missing,
// of another kind or out of its range, not for this role.
OrderRequest read_request(std::string_view line, Role role);

// {"verb": "set", "text": "l_knee.kp", "value": 50}: `text` is the order's text, `value` its number, whatever they are
// called; other fields are the caller's. `paced`: time can be held. Throws as above.
OrderRequest read_brief_request(const Json& json, bool paced);

// What a `save` does once the behavior thread has told what was changed: the file is written here, and that thread is
// told. Throws what ConfigurationText::save throws.
std::vector<PresetOverride> save_changes(Instance& instance, InstancePort& port, const Answer& answer,
                                         const std::string& who, const std::string& preset = {});

}  // namespace kadans
