// Writes parts of a record for others: as text for other tools, or as a complete record of their own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "record_rows.h"

namespace kadans {

// Writes a record as text for other tools: every message as JSON lines, or chosen signals as a table (CSV). It works
// line by line, so the record may have any length. Numbers have enough digits to read back exactly the same number.
void append_number(std::string& text, double value);           // shortest; "nan", "inf", "-inf"
void append_seconds(std::string& text, std::int64_t time_ns);  // exact: "1.234"

// {"time_s": 1.5, "topic": "/joint", "tick": 1500, "joint.l_knee.position_rad": 0.3, ...} for a row;
// {"time_s": 1.5, "topic": "/transitions", "behavior": "squat", ...} for a message in JSON, without its own timestamp;
// "data" for a message that is text, "bytes" with their number for any other. NaN and infinities become null.
class JsonLines {
 public:
  // `topics` are patterns as for choose_topics; empty: all. Topics that do not exist are known only at the end:
  // unknown_topics().
  JsonLines(const std::string& path, std::vector<std::string> topics, TimeSpan span);

  [[nodiscard]] bool next(std::string& line);  // without a newline at its end
  const McapReader& reader() const noexcept { return rows_.reader(); }
  std::uint64_t lines() const noexcept { return lines_; }
  std::vector<std::string> unknown_topics() const;

 private:
  bool wanted();
  void write(std::string& line);
  const std::vector<std::string>& keys();

  RecordRows rows_;
  std::map<std::uint16_t, std::vector<std::string>> keys_;  // of a channel: its signals' names, quoted
  std::vector<std::string> topics_;
  std::vector<bool> met_;  // of the topics
  TimeSpan span_;
  std::uint64_t lines_ = 0;
};

// A header line with names and units, then one line for each time at which any of the signals has a row; with
// `every_ns` the lines are evenly spaced in time. A signal keeps its value from one row to the next, because topics
// that are slower or stand still have fewer rows.
class CsvLines {
 public:
  CsvLines(const std::string& path, std::vector<ChosenSignal> signals, TimeSpan span,
           std::optional<std::int64_t> every_ns = std::nullopt);

  [[nodiscard]] bool next(std::string& line);
  const McapReader& reader() const noexcept { return rows_.reader(); }
  std::uint64_t lines() const noexcept { return lines_; }  // without the header

 private:
  bool next_row();
  void take_row();
  void write_head(std::string& line) const;
  void write(std::int64_t time_ns, std::string& line);

  RecordRows rows_;
  std::vector<ChosenSignal> signals_;
  std::map<std::uint16_t, std::vector<std::size_t>> columns_;  // of a channel
  TimeSpan span_;
  std::optional<std::int64_t> every_ns_;
  std::vector<std::optional<double>> cells_;
  bool head_written_ = false, started_ = false, ended_ = false;
  bool held_ = false;         // a row that belongs to a later line has been read
  std::int64_t time_ns_ = 0;  // of the next line
  std::int64_t last_ns_ = 0;  // of the last row
  std::uint64_t lines_ = 0;
};

// Cuts a time span and chosen signals out of a record and writes them as a complete record of their own, with chunks,
// CRCs, index, schemas, facts and attachments. The new record begins with the state at the beginning of the span. For
// signals it holds the last row before the span with that row's own time, because a signal that stands still may have
// no row for a while. For descriptions (topics with neither rows nor events: URDF, parameters) it holds the last
// message, at the time at which the span begins.
//
// The inputs of a run on threads (telemetry/record/input_stream.h) are left out, or with `inputs` they are kept, so
// that the new record can be repeated: then the span starts with the record. They are stored anew, because they refer
// to the signals that are there.
struct RecordCut {
  TimeSpan span;
  std::vector<std::string> signals;  // patterns for choose_signals; empty: all signals
  bool inputs = false;
};
struct CutRecord {
  std::uint64_t messages = 0, file_bytes = 0;
  std::size_t signals = 0;
};
// Replaces the file `to`. Throws InputError when the span holds no message, when the inputs are not there, or when the
// file cannot be written.
CutRecord cut_record(const RecordOutline& record, const RecordCut& cut, const std::string& to);

}  // namespace kadans
