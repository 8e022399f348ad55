#include "app/terminal.h"
#include "log_verbs.h"
#include "signal/number_text.h"
#include "telemetry/reading/record_export.h"

namespace kadans {

int log_cut(const LogOptions& options) {
  const RecordCut cut{.span = span_of(options), .signals = options.signals};
  require_free(options);
  const RecordOutline record = outline_of(options.file);
  require_overlap(record, cut.span);
  UnfinishedFile file(options.out);
  const CutRecord made = cut_record(record, cut, file.path());
  file.finish();
  std::printf("%s: %s, %s, %.1f kB\n", options.out.c_str(), plural(made.messages, "message").c_str(),
              plural(made.signals, "signal").c_str(), 1e-3 * static_cast<double>(made.file_bytes));
  tell_problem(record);
  return exit_passed;
}

}  // namespace kadans
