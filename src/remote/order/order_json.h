// The requests and answers of clients as JSON. A request is checked against the table of orders and becomes an order;
// tables and answers become the JSON that clients of ctl read. All servers read requests and finish the order `save`
// here.
//
// For threads that serve clients.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "order.h"
#include "remote/instance/instance.h"
#include "remote/instance/parameter_history.h"

namespace kadans {

using Json = nlohmann::ordered_json;

std::string refusal(const std::string& why);

Json behaviors_json(const Answer& report);
Json reasons_json(const Answer& answer);
Json status_json(const Instance& instance, const InstanceStatus& status);
// {"ok", "supply_V", "emergency", "drives": [{joint, state, code, temperature_C, homed}]}; unknown values are null.
Json drives_json(const PowerStatus& power, const RobotModel& model);
// {"ok", "world": [{entry, source, age_s, confidence, carried, fields: {x_m: 1.2}}]}; of an entry of which nothing is
// known its name alone.
Json world_json(const SeenEntries& seen, const std::vector<SeenInfo>& declared);

const std::vector<std::string>& list_kinds();  // what can be listed: "behaviors", "sets" ...
// Lists all items of a kind. `report` is used for behaviors, parameters and events, `status` for sets. Throws
// InputError on another kind.
Json list_json(const std::string& what, const Instance& instance, const InstanceStatus& status, const Answer& report);

// A request of a client, checked against the table of orders.
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
// whatever their names in the table are. "id" is the caller's. `paced`: the run's time can be held. Throws InputError
// for an order that is not brief (OrderInfo::is_brief) or needs a run that is paced, for any other field, for a text or
// a number that the order does not take, and as read_request for arguments; roles are the caller's business.
OrderRequest read_brief_request(const Json& json, bool paced);

// Finishes a `save` after the behavior thread has answered with the changes: writes the file and informs that thread.
// Throws what ConfigurationText::save throws.
std::vector<PresetOverride> save_changes(Instance& instance, InstancePort& port, const Answer& answer,
                                         const std::string& who, const std::string& preset);
// The same, and what came of it is the answer: a line for people.
Answer saved(Instance& instance, InstancePort& port, const Answer& answer, const std::string& who,
             const std::string& preset);

}  // namespace kadans
