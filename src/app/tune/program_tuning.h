// A tuning whose candidates a program scores: any program that takes NAME=VALUE and prints metrics as a JSON object in
// its last line. So what no scenario can express can be fitted too, such as a model to recordings of the real thing.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "app/sweep/sweep_subjects.h"
#include "campaign/tuning/cma_es.h"

namespace kadans {

// main.cpp: what all tunings have in common.
CmaEs make_search(const TunePlan& plan, const std::vector<TunedAxis>& axes);
nlohmann::ordered_json by_name(const std::vector<TunedAxis>& axes, const std::vector<double>& values);
void require_free(const TuneOptions& options);  // throws InputError when --write names a file that is there
void print_generation(const TunePlan& plan, const CmaEs& search, const std::vector<double>& scores);
void print_found(const TunePlan& plan, const std::vector<TunedAxis>& axes, const std::vector<double>& values);

// Searches, then judges the values found against those at the start, and reports. Returns the exit code. Throws
// InputError for options that mean nothing here, and when the program fails at the values of the start.
int tune_by_program(const TuneOptions& options, const TunePlan& plan);

}  // namespace kadans
