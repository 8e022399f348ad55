// Cuts a time span and chosen signals out of a record and writes them as a complete record of their own, with chunks,
// CRCs, index, schemas, facts and attachments. The new record begins with the state at the beginning of the span. For
// signals it holds the last row before the span with that row's own time, because a signal that stands still may have
// no row for a while. For descriptions (topics with neither rows nor events: URDF, parameters) it holds the last
// message, at the time at which the span begins.
#pragma once

#include <string>
#include <vector>

#include "record_rows.h"

namespace kadans {

struct RecordCut {
  TimeSpan span;
  std::vector<std::string> signals;  // patterns for choose_signals; empty: all signals
};
struct CutRecord {
  std::uint64_t messages = 0, file_bytes = 0;
  std::size_t signals = 0;
};
// Replaces the file `to`. Throws InputError when the span holds no message, or when the file cannot be written.
CutRecord cut_record(const RecordOutline& record, const RecordCut& cut, const std::string& to);

}  // namespace kadans
