// The schemas in config/schema are what the readers' field lists say, and the shipped files keep to them.
#include "schema.h"

#include "config/json/json_value.h"
#include "config/right_texts.h"
#include "schema_checks.h"

namespace kadans::schema_test {
namespace {

namespace fs = std::filesystem;
using Json = schema_checks::Json;
using schema_checks::check_file, schema_checks::check_shipped, schema_checks::check_value, schema_checks::source;

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
