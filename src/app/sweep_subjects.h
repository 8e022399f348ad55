// The scenarios of a plan as campaigns need them: with the quantities of their robots, a hash of all they depend on,
// and looked through before anything runs.
#pragma once

#include <string>
#include <vector>

#include "kadans/campaign/sweep_case.h"
#include "kadans/config/scenario_config.h"

namespace kadans {

// Throws InputError with everything that is wrong in the scenarios' files, in the plan's metrics, and in the ranges of
// what it varies.
std::vector<SweepSubject> read_sweep_subjects(const ExperimentConfig& plan, const PluginGate& gate = {});

// The program that runs scenarios: this one, or that beside it.
std::string run_program_path();
// Its version with a hash of the program itself: results of two builds are not mixed.
std::string build_version();

}  // namespace kadans
