// What `kadans behavior check` finds in the behaviors that a scenario plays: told before anything moves.
#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "kadans/config/scenario_config.h"
#include "kadans/control/catalog.h"
#include "kadans/signal/input_error.h"

namespace kadans {

// In these files, from the project's root; what several of them require or call is told once.
std::vector<InputProblem> problems_in(const std::set<std::filesystem::path>& files, const std::filesystem::path& root,
                                      const Catalog& catalog);

// Of its lists, and of those of its events. A version that an event reloads is not among them: it is refused when it
// comes, and the running one goes on.
std::vector<InputProblem> problems_of_played(const ScenarioConfig& scenario, const Catalog& catalog);
// The same, with those versions.
std::vector<InputProblem> problems_of_named(const ScenarioConfig& scenario, const Catalog& catalog);

// Throws InputError when there are any in what is played.
void refuse_faulty_behaviors(const ScenarioConfig& scenario, const Catalog& catalog);

}  // namespace kadans
