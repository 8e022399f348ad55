// The report of a suite of runs: as text for people, while it runs and at its end, and as JUnit XML for continuous
// integration.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "run_outcome.h"
#include "scenario/report/report.h"

namespace kadans {

// One line for a run: its result, its name, its times.
std::string suite_line(const RunOutcome& run, const ReportStyle& style);

// Why a run did not pass: its checks, small plots of the signals around the moment of failure, the last transitions,
// the values that were drawn for the run, and the command that repeats it.
std::string failure_report(const RunOutcome& run, const ReportStyle& style);

// The table at the end: failures first, then counts and times. `wall_s` is the time of the whole suite.
std::string suite_summary(const std::vector<RunOutcome>& runs, double wall_s, const ReportStyle& style);

// A <testsuites> document with one <testcase> for each run, as CI servers read it.
std::string junit_xml(const std::vector<RunOutcome>& runs, double wall_s);

// All runs of a suite as an HTML page: the result of each run, how long it took, and a link to its own report.
// A run gets a link when its report lies in `folder`. `wall_s` is the time of the whole suite.
std::string suite_page(const std::vector<RunOutcome>& runs, double wall_s, const std::filesystem::path& folder);

// A result for CI servers.
struct JunitCase {
  enum class Verdict : std::uint8_t { passed, failed, error, skipped };
  std::string file, name;
  double wall_s = 0;
  Verdict verdict = Verdict::passed;
  std::string type, message, text;  // of a case that did not pass: its kind in a word, one line, the whole text
};

// A <testsuites> document; characters that XML cannot hold are left out.
std::string junit_document(const std::vector<JunitCase>& cases, double wall_s);

}  // namespace kadans
