// Converts tables and answers to the JSON that clients of ctl read.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "remote/instance/instance.h"

namespace kadans {

using Json = nlohmann::ordered_json;

std::string refusal(const std::string& why);

Json behaviors_json(const Answer& report);
Json status_json(const Instance& instance, const InstanceStatus& status);
// {"ok", "supply_V", "emergency", "drives": [{joint, state, code, temperature_C, homed}]}; unknown values are null.
Json drives_json(const PowerStatus& power, const RobotModel& model);

// Lists all items of a kind: "behaviors", "sets", "objects", "parameters", "signals". `report` is used for behaviors
// and parameters, `status` for sets. Throws InputError on another kind.
Json list_json(const std::string& what, const Instance& instance, const InstanceStatus& status, const Answer& report);

}  // namespace kadans
