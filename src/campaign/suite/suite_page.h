// All runs of a suite as an HTML page: the result of each run, how long it took, and a link to its own report.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "run_outcome.h"

namespace kadans {

// A run gets a link when its report lies in `folder`. `wall_s` is the time of the whole suite.
std::string suite_page(const std::vector<RunOutcome>& runs, double wall_s, const std::filesystem::path& folder);

}  // namespace kadans
