// A stretch of a record, and some of its signals, as a record of its own: chunks, CRCs, index, schemas, facts and
// attachments, so that whatever reads records reads it. What holds when the stretch begins is kept: of signals their
// last row before, with its own time, since a signal that stands still has none for a while; of descriptions (messages
// of topics that hold neither rows nor events: URDF, parameters) the last one, at the beginning.
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
