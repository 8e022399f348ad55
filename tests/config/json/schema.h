// Makes JSON Schemas (draft-07) from the same field lists that read the files, so that editors can complete and check
// the files. config/schema/*.schema.json hold these texts; a test compares them.
#pragma once

#include <string>

#include "config/json/fields.h"

namespace kadans {

std::string json_schema(const FieldInfo& fields, const std::string& title);

std::string robot_schema();
std::string scenario_schema();
std::string sweep_schema();
std::string tune_schema();

}  // namespace kadans
