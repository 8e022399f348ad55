// Whether this machine has a network card in the network of a board. Nothing is sent.
#pragma once

#include <vector>

#include "settings.h"

namespace kadans::hostmot2 {

PlantType::Finding examine_card(const BoardSettings& board);  // of one on Ethernet
std::vector<PlantType::Finding> examine_boards(const HostMot2Settings& settings, std::int64_t control_period_ns);

}  // namespace kadans::hostmot2
