// What helps or hinders the servos of a robot on this machine: the device of each port, its latency timer, and the
// period that its cycle can hold. Nothing is opened.
#pragma once

#include "settings.h"

namespace kadans::dynamixel {

std::vector<PlantType::Finding> examine_ports(const DynamixelSettings& settings, std::int64_t control_period_ns,
                                              const std::string& root = "/");

}  // namespace kadans::dynamixel
