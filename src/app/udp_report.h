// What became of the datagrams of one side of a plant over the network.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "kadans/plant/udp/arrivals.h"

namespace kadans {

std::string udp_text(const UdpStatistics& statistics);
nlohmann::ordered_json udp_json(const UdpStatistics& statistics);

}  // namespace kadans
