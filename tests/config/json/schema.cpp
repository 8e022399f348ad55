#include "schema.h"

#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "config/plan/experiment_plans.h"
#include "config/robot/robot_config.h"
#include "config/scenario/scenario_config.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

Json schema_of(const FieldInfo& info);

// Whole numbers without a decimal point, as far as doubles hold them exactly.
Json limit(double value) {
  constexpr double exact_max = 9007199254740992.0;  // 2^53
  if (value == std::floor(value) && std::abs(value) <= exact_max) return static_cast<std::int64_t>(value);
  return value;
}

void add_range(Json& schema, const FieldInfo& info) {
  constexpr double exact_max = 9007199254740992.0;
  if (std::isfinite(info.min)) schema["minimum"] = limit(info.min);
  if (std::isfinite(info.max) && info.max <= exact_max) schema["maximum"] = limit(info.max);
}

Json doc_schema() { return {{"description", "A note for people."}, {"type", "string"}}; }

void add_object(Json& schema, const FieldInfo& info) {
  Json& properties = schema["properties"] = Json::object();
  Json required = Json::array();
  for (const FieldInfo& field : info.fields) {
    properties[field.name] = schema_of(field);
    if (field.required) required.push_back(field.name);
  }
  if (!properties.contains("doc")) properties["doc"] = doc_schema();
  if (!required.empty()) schema["required"] = std::move(required);
  schema["additionalProperties"] = false;
}

void add_list(Json& schema, const FieldInfo& info) {
  if (info.count.min > 0) schema["minItems"] = info.count.min;
  if (info.count.max < std::numeric_limits<std::size_t>::max()) schema["maxItems"] = info.count.max;
  schema["items"] = schema_of(info.fields.at(0));
}

void add_type(Json& schema, const FieldInfo& info) {
  using Kind = FieldInfo::Kind;
  switch (info.kind) {
    case Kind::boolean:
      schema["type"] = "boolean";
      return;
    case Kind::integer:
      schema["type"] = "integer";
      return add_range(schema, info);
    case Kind::number:
      schema["type"] = "number";
      return add_range(schema, info);
    case Kind::string:
      schema["type"] = "string";
      if (info.required) schema["minLength"] = 1;
      if (!info.choices.empty()) schema["enum"] = info.choices;
      return;
    case Kind::plain:
      schema["type"] = {"boolean", "number", "string"};
      return;
    case Kind::object:
      schema["type"] = "object";
      return add_object(schema, info);
    case Kind::list:
      schema["type"] = "array";
      return add_list(schema, info);
    case Kind::map:
      schema["type"] = "object";
      schema["properties"]["doc"] = doc_schema();
      schema["additionalProperties"] = schema_of(info.fields.at(0));
      return;
  }
}

Json schema_of(const FieldInfo& info) {
  Json schema = Json::object();
  std::string text = info.doc;
  if (!info.unit.empty()) text += (text.empty() ? "in " : ", in ") + info.unit;
  if (!text.empty()) schema["description"] = text;
  add_type(schema, info);
  if (!info.default_json.empty()) schema["default"] = parse_foreign_json(info.default_json);
  return schema;
}

}  // namespace

std::string json_schema(const FieldInfo& fields, const std::string& title) {
  Json schema = Json::object();
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = title;
  schema.update(schema_of(fields));
  return json_text(schema, 2) + "\n";
}

std::string robot_schema() { return json_schema(describe_robot_config(), "Configuration of a robot"); }
std::string scenario_schema() { return json_schema(describe_scenario_config(), "Scenario"); }
std::string sweep_schema() { return json_schema(describe_sweep_plan(), "Sweep"); }
std::string tune_schema() { return json_schema(describe_tune_plan(), "Tuning"); }

}  // namespace kadans
