// Whether this machine has a network card in the network of a board. Nothing is sent.
#pragma once

#include <string>

#include "settings.h"

namespace kadans::hostmot2 {

struct CardFinding {
  bool good = false;
  std::string is;   // "eth0 (192.168.1.2) reaches it"
  std::string how;  // what to do where it is not good
};
CardFinding network_card_for(const std::string& address);

std::vector<PlantType::Finding> examine_boards(const HostMot2Settings& settings, std::int64_t control_period_ns);

}  // namespace kadans::hostmot2
