// What helps or hinders a device on a serial port of this machine, for `kadans doctor ROBOT`. Nothing is opened.
#pragma once

#include <string>
#include <vector>

#include "kadans/plant/plant_type.h"

namespace kadans {

// Adds what is to say of the port: the device and this user's right to it ("port NAME"), and the USB adapter's latency
// timer ("latency NAME"), from /sys below `root`.
void examine_serial_port(const std::string& name, const std::string& device, const std::string& root,
                         std::vector<PlantType::Finding>& findings);

}  // namespace kadans
