// Applies `kadans behavior check` to the behaviors that a scenario plays, before anything moves.
#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "config/scenario/scenario_config.h"
#include "kadans/control/catalog.h"
#include "kadans/signal/input_error.h"

namespace kadans {

class Assembly;

// The problems in these files. `root` is the project's root. A problem in a file that several of them require or call
// stands there once.
std::vector<InputProblem> problems_in(const std::set<std::filesystem::path>& files, const std::filesystem::path& root,
                                      const Catalog& catalog);

// The problems in the behaviors of the scenario's list and of its events' lists. Versions that an event reloads are
// left out: a wrong version is refused at its time, and the running one goes on.
std::vector<InputProblem> problems_of_played(const ScenarioConfig& scenario, const Catalog& catalog);
// The same, with the versions that events reload.
std::vector<InputProblem> problems_of_named(const ScenarioConfig& scenario, const Catalog& catalog);

// Throws InputError when problems_of_played() finds any.
void refuse_faulty_behaviors(const ScenarioConfig& scenario, const Catalog& catalog);
void refuse_faulty_behaviors(const Assembly& assembly);  // of all its robots

}  // namespace kadans
