// What a suite of runs has to say: for people while it runs and at its end, for continuous integration as JUnit XML.
#pragma once

#include <string>
#include <vector>

#include "kadans/campaign/run_outcome.h"

namespace kadans {

struct SuiteStyle {
  bool color = false;
  bool unicode = true;
};

// One run in a line: what came of it, its name, its times.
std::string suite_line(const RunOutcome& run, const SuiteStyle& style);

// Why a run did not pass: its checks, the signals around the moment as small plots, the last transitions, what was
// drawn for it, and the command that repeats it.
std::string failure_report(const RunOutcome& run, const SuiteStyle& style);

// The table at the end: failures first, then counts and times. `wall_s`: of the whole suite.
std::string suite_summary(const std::vector<RunOutcome>& runs, double wall_s, const SuiteStyle& style);

// A <testsuites> document, one <testcase> a run, as CI servers read it.
std::string junit_xml(const std::vector<RunOutcome>& runs, double wall_s);

}  // namespace kadans
