// What a shipped schema and the shipped files that name it are held to.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "signal/input_file.h"

namespace kadans::schema_checks {

namespace fs = std::filesystem;
using Json = nlohmann::json;

inline const fs::path source = KADANS_SOURCE_DIR;

// On a difference the schema as it should be is left in the build tree, to be copied.
inline void check_shipped(const std::string& schema, const char* name) {
  const fs::path shipped = source / "config" / "schema" / name;
  const fs::path renewed = fs::path(KADANS_BINARY_DIR) / name;
  const bool same = fs::exists(shipped) && read_input_file(shipped) == schema;
  if (!same) std::ofstream(renewed) << schema;
  CHECK_MESSAGE(same, "renew it: cp " << renewed.string() << " " << shipped.string());
}

// The part of JSON Schema that our schemas use. What is not whole, because it is based on another file, may leave out
// what is required.
inline void check_value(const Json& schema, const Json& value, const std::string& path, bool whole = true) {
  CAPTURE(path);
  const bool plain = schema.at("type").is_array();  // a number, a boolean or a string
  if (plain) CHECK(value.is_primitive());
  if (plain) return;
  const std::string type = schema.at("type");
  if (type == "object") {
    REQUIRE(value.is_object());
    for (const auto& name : schema.value("required", Json::array())) {
      CHECK((!whole || value.contains(name.get<std::string>())));
    }
    const Json properties = schema.value("properties", Json::object());
    for (const auto& [key, member] : value.items()) {
      const Json rest = schema.at("additionalProperties");
      const bool named = properties.contains(key);
      REQUIRE_MESSAGE((named || rest.is_object()), "unknown key in " << path);
      check_value(named ? properties[key] : rest, member, path + "/" + key, whole);
    }
  } else if (type == "array") {
    REQUIRE(value.is_array());
    CHECK(value.size() >= schema.value("minItems", std::size_t{0}));
    CHECK(value.size() <= schema.value("maxItems", value.size()));
    for (const Json& item : value) check_value(schema.at("items"), item, path + "/-", whole);
  } else if (type == "string") {
    CHECK(value.is_string());
  } else if (type == "boolean") {
    CHECK(value.is_boolean());
  } else {
    REQUIRE(value.is_number());
    if (type == "integer") CHECK(value.is_number_integer());
    CHECK(value.get<double>() >= schema.value("minimum", value.get<double>()));
    CHECK(value.get<double>() <= schema.value("maximum", value.get<double>()));
  }
}

inline void check_file(const std::string& schema, const fs::path& file) {
  const Json value = Json::parse(read_input_file(file));
  check_value(Json::parse(schema), value, file.filename().string(), !value.contains("based_on"));
}

}  // namespace kadans::schema_checks
