// Reports the counts of the link between a plant and its control engine.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "kadans/plant/plant.h"

namespace kadans {

std::string link_text(const std::vector<PlantCount>& counts);  // "12 sent, 0 unsent, ..."
nlohmann::ordered_json link_json(const std::vector<PlantCount>& counts);

}  // namespace kadans
