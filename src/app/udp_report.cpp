#include "udp_report.h"

#include <array>
#include <cstdio>

namespace kadans {

std::string udp_text(const UdpStatistics& s) {
  std::array<char, 240> text{};
  std::snprintf(text.data(), text.size(),
                "%u sent (%u not taken), %u received, %u lost, %u reordered, %u duplicates, %u late, %u refused",
                s.sent, s.unsent, s.received, s.lost, s.reordered, s.duplicates, s.late, s.refused);
  return text.data();
}

nlohmann::ordered_json udp_json(const UdpStatistics& s) {
  return {{"sent", s.sent},           {"unsent", s.unsent},         {"received", s.received}, {"lost", s.lost},
          {"reordered", s.reordered}, {"duplicates", s.duplicates}, {"late", s.late},         {"refused", s.refused}};
}

}  // namespace kadans
