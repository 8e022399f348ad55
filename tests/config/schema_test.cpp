// The schemas in config/schema are what the readers' field lists say, and the shipped files keep to them.
#include "schema.h"

#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "config/json/json_value.h"
#include "right_texts.h"

namespace kadans::schema_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path source = KADANS_SOURCE_DIR;

// On a difference the schema as it should be is left in the build tree, to be copied.
void check_shipped(const std::string& schema, const char* name) {
  const fs::path shipped = source / "config" / "schema" / name;
  const fs::path renewed = fs::path(KADANS_BINARY_DIR) / name;
  const bool same = fs::exists(shipped) && read_input_file(shipped) == schema;
  if (!same) std::ofstream(renewed) << schema;
  CHECK_MESSAGE(same, "renew it: cp " << renewed.string() << " " << shipped.string());
}

// The part of JSON Schema that our schemas use. What is not whole, because it is based on another file, may leave out
// what is required.
void check_value(const Json& schema, const Json& value, const std::string& path, bool whole = true) {
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

void check_file(const std::string& schema, const fs::path& file) {
  const Json value = Json::parse(read_input_file(file));
  check_value(Json::parse(schema), value, file.filename().string(), !value.contains("based_on"));
}

}  // namespace

TEST_CASE("The shipped schemas are what the readers' field lists say") {
  check_shipped(robot_schema(), "robot.schema.json");
  check_shipped(scenario_schema(), "scenario.schema.json");
  check_shipped(sweep_schema(), "sweep.schema.json");
  check_shipped(tune_schema(), "tune.schema.json");
}

TEST_CASE("What the readers accept fits the schemas, what the schemas refuse is no shipped file") {
  check_value(Json::parse(robot_schema()), Json::parse(right_robot), "robot");
  check_value(Json::parse(scenario_schema()), Json::parse(right_scenario), "scenario");
  for (const std::string robot : {"head", "jiwiy", "tulip"}) {
    check_file(robot_schema(), source / "config" / robot / "robot.json");
  }
  check_file(robot_schema(), source / "config" / "tulip" / "soft.json");
  for (const auto& entry : fs::directory_iterator(source / "config" / "scenarios")) {
    if (entry.path().extension() == ".json") check_file(scenario_schema(), entry.path());
  }
  for (const auto& entry : fs::directory_iterator(source / "config" / "sweeps")) {
    if (entry.path().extension() == ".json") check_file(sweep_schema(), entry.path());
  }
  for (const auto& entry : fs::directory_iterator(source / "config" / "tuning")) {
    if (entry.path().extension() == ".json") check_file(tune_schema(), entry.path());
  }
}

TEST_CASE("A field's range, unit, default and meaning stand in the schema") {
  const Json schema = Json::parse(robot_schema());
  const Json& period = schema["properties"]["engine"]["properties"]["control_period_s"];
  CHECK(period["minimum"] == 1e-5);
  CHECK(period["maximum"] == 1);
  CHECK(period["default"] == 0.001);
  CHECK(period["description"] == "period of the control engine, in s");
  CHECK(schema["required"] == Json({"name", "urdf", "control"}));
  const Json& drive = schema["properties"]["plant"]["properties"]["drives"]["additionalProperties"];
  CHECK(drive.at("properties").contains("spring_Nm_per_rad"));
  CHECK(drive.value("additionalProperties", true) == false);
}

}  // namespace kadans::schema_test
