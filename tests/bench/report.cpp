#include "report.h"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace kadans::bench {

void Report::print_table() const {
  std::size_t widest = 0;
  for (const Figure& figure : figures_) widest = std::max(widest, figure.text.size());
  for (const Figure& figure : figures_) {
    std::printf("%-*s %12.4g %s\n", static_cast<int>(widest), figure.text.c_str(), figure.value, figure.unit.c_str());
  }
}

void Report::print_json() const {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Figure& figure : figures_) {
    nlohmann::ordered_json* place = &json;
    std::size_t begin = 0;
    for (std::size_t dot = figure.key.find('.'); dot != std::string::npos; dot = figure.key.find('.', begin)) {
      place = &(*place)[figure.key.substr(begin, dot - begin)];
      begin = dot + 1;
    }
    (*place)[figure.key.substr(begin)] = figure.value;
  }
  std::puts(json.dump().c_str());
}

}  // namespace kadans::bench
