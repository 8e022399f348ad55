#include "link_report.h"

namespace kadans {

std::string link_text(const std::vector<PlantCount>& counts) {
  std::string text;
  for (const PlantCount& count : counts)
    text += (text.empty() ? "" : ", ") + std::to_string(count.value) + " " + std::string(count.name);
  return text;
}

nlohmann::ordered_json link_json(const std::vector<PlantCount>& counts) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const PlantCount& count : counts) json[count.name] = count.value;
  return json;
}

}  // namespace kadans
