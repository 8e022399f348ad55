// All runs of a suite as a page: what came of each, how long it took, the way to its own report.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kadans/campaign/run_outcome.h"

namespace kadans {

// Links those reports that lie in the folder. `wall_s`: of the whole suite.
std::string suite_page(const std::vector<RunOutcome>& runs, double wall_s, const std::filesystem::path& folder);

}  // namespace kadans
