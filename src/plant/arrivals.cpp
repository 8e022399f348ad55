#include "arrivals.h"

namespace kadans {

std::vector<PlantCount> counts_of(const DatagramCounts& s) {
  return {{"sent", s.sent},           {"unsent", s.unsent},         {"received", s.received}, {"lost", s.lost},
          {"reordered", s.reordered}, {"duplicates", s.duplicates}, {"late", s.late},         {"refused", s.refused}};
}

}  // namespace kadans
