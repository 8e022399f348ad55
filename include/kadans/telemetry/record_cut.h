// A stretch of a record, and some of its signals, as a record of its own: chunks, CRCs, index, schemas, facts and
// attachments, so that whatever reads records reads it. Descriptions (messages of topics that hold neither rows nor
// events: URDF, parameters) hold until the next one: the last before the stretch is kept, at its beginning. So do rows
// of signals that stood still then; such a row keeps its own time, a little before.
#pragma once

#include <string>
#include <vector>

#include "kadans/telemetry/record_outline.h"

namespace kadans {

struct RecordCut {
  TimeSpan span;
  std::vector<std::string> signals;  // as choose_signals takes them; none: all
};
struct CutRecord {
  std::uint64_t messages = 0, file_bytes = 0;
  std::size_t signals = 0;
};
// Replaces `to`. Throws InputError when nothing is left, or the file cannot be written.
CutRecord cut_record(const RecordOutline& record, const RecordCut& cut, const std::string& to);

}  // namespace kadans
