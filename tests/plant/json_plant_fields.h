// Reads a plant type's fields from JSON, without a robot: for tests that make what a type makes of its configuration.
#pragma once

#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "kadans/plant/plant_type.h"

namespace kadans::test {

class JsonPlantFields final : public PlantFields {
 public:
  explicit JsonPlantFields(const nlohmann::ordered_json& json) : json_(json) {}
  void number(std::string_view name, double& value, Range, std::string_view) override { take(name, value); }
  void integer(std::string_view name, std::uint32_t& value, Range, std::string_view) override { take(name, value); }
  void boolean(std::string_view name, bool& value, std::string_view) override { take(name, value); }
  void string(std::string_view name, std::string& value, std::string_view) override { take(name, value); }
  void map(std::string_view name, const ReadEntry& read, std::string_view) override {
    if (!json_.contains(name)) return;
    for (const auto& [key, entry] : json_.at(std::string(name)).items()) {
      JsonPlantFields fields(entry);
      read(fields, key);
    }
  }
  bool reading() const noexcept override { return true; }
  std::span<const std::string> drives() const noexcept override { return {}; }
  void refuse(std::string_view name, const std::string& why) override {
    throw std::invalid_argument(std::string(name) + ": " + why);
  }

 private:
  template <typename T>
  void take(std::string_view name, T& value) {
    if (json_.contains(name)) value = json_.at(std::string(name)).get<T>();
  }
  const nlohmann::ordered_json& json_;
};

}  // namespace kadans::test
