// Finds the meshes that a record's URDFs name.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "remote/page/live_content.h"

namespace kadans {

// Reads a mesh by its name in a URDF of the record, as LiveAssets do; nullptr: there is none. Meshes are not in the
// record: they are found where its URDFs still lie as they were, in the project of its scenario, in that around the
// working directory, or in that around the record. Throws InputError for a file that is no record.
std::function<LiveAssets::Content(std::string_view name)> meshes_of_record(const std::string& record);

}  // namespace kadans
