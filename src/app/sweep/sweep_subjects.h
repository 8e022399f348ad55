// Reads and checks the scenarios of a plan before anything runs, with the quantities of their robots and a hash of
// everything that they depend on.
#pragma once

#include <string>
#include <vector>

#include "campaign/sweep/sweep_case.h"
#include "config/scenario/scenario_config.h"

namespace kadans {

// Throws InputError with all mistakes in the scenarios' files, in the plan's metrics, and in the ranges of varied
// quantities.
std::vector<SweepSubject> read_sweep_subjects(const ExperimentConfig& plan, const PluginGate& gate = {});

// The path of the program that runs scenarios: this program, or `kadans` beside kadans-tune.
std::string run_program_path();
// The program's version with a hash of its file, so that results of two builds are not mixed.
std::string build_version();

}  // namespace kadans
