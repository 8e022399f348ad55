// What a viewer must know of a run before the first number makes sense: the robot's name and feet, control sets with
// their objects, parameters with unit and range, and the charts of the behaviors, their states numbered as
// behavior.<name>.state counts them. One JSON text: the first message on /description in a record, the asset
// "description.json" of a live run.
//
// Made from the tables; nothing here knows a concrete control object or behavior.
#pragma once

#include <cstdint>
#include <string>

#include "kadans/config/robot_config.h"
#include "kadans/control/catalog.h"
#include "kadans/script/script_host.h"

namespace kadans {

// Before the loop, or between two behavior ticks: it reads parameters' values and charts. Without a host, of behaviors
// that play in a process of their own, their charts are not told.
std::string run_description(const RobotConfig& robot, const Catalog& catalog, const ScriptHost* host);
// Its "behaviors" alone, an array: what changes when other behaviors play, or new versions. Between two behavior ticks.
std::string behaviors_description(const ScriptHost* host);
// A number that is another one when the chart is. Behavior thread.
std::uint64_t chart_sign(const Chart& chart) noexcept;

}  // namespace kadans
