// `kadans log cat` and `kadans log csv`: print a record line by line.
#include <cmath>

#include "app/terminal.h"
#include "log_verbs.h"
#include "telemetry/reading/record_export.h"

namespace kadans {
namespace {

// Prints all lines. False: interrupted, or the reader has stopped reading.
template <typename Lines>
bool pour(Lines& lines, LineOutput& output) {
  for (std::string line; lines.next(line);) {
    if (interrupted() || !output.put(line)) return false;
  }
  return true;
}

}  // namespace

int log_cat(const LogOptions& options) {
  const TimeSpan span = span_of(options);
  JsonLines lines(options.file, options.topics, span);
  LineOutput output("");
  const bool all = pour(lines, output);
  output.finish();
  if (interrupted()) return exit_interrupted;
  if (!all) return exit_passed;
  if (!lines.unknown_topics().empty()) (void)choose_topics(outline_of(options.file), lines.unknown_topics());  // throws
  if (lines.lines() == 0) require_overlap(outline_of(options.file), span);
  tell_problem(lines.reader());
  return exit_passed;
}

int log_csv(const LogOptions& options) {
  const TimeSpan span = span_of(options);
  if (!options.out.empty()) require_free(options);
  const RecordOutline record = outline_of(options.file);
  require_overlap(record, span);
  std::optional<std::int64_t> every_ns;
  if (options.every_s) every_ns = std::llround(*options.every_s * 1e9);
  CsvLines lines(options.file, choose_signals(record, options.signals), span, every_ns);
  LineOutput output(options.out);
  const bool all = pour(lines, output);
  if (interrupted()) return exit_interrupted;
  output.finish();
  if (all) tell_problem(record);
  return exit_passed;
}

}  // namespace kadans
