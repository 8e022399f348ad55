#include <algorithm>

#include "record_text.h"

namespace kadans {
namespace {

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace

CsvLines::CsvLines(const std::string& path, std::vector<ChosenSignal> signals, TimeSpan span,
                   std::optional<std::int64_t> every_ns)
    : rows_(path), signals_(std::move(signals)), span_(span), every_ns_(every_ns), cells_(signals_.size()) {
  for (std::size_t i = 0; i < signals_.size(); ++i) columns_[signals_[i].channel].push_back(i);
}

// To the next row with any of the signals, unless one is held.
bool CsvLines::next_row() {
  if (held_) return true;
  while (rows_.next()) {
    if (rows_.values().empty() || !columns_.contains(rows_.channel())) continue;
    if (rows_.time_ns() > span_.to_ns) continue;
    if (rows_.time_ns() >= span_.from_ns) return held_ = true;
    take_row();  // what holds when the table begins
  }
  return false;
}

void CsvLines::take_row() {
  for (const std::size_t column : columns_.at(rows_.channel())) {
    const std::size_t place = signals_[column].place;
    if (place < rows_.values().size()) cells_[column] = rows_.values()[place];
  }
  last_ns_ = std::max(last_ns_, rows_.time_ns());
  held_ = false;
}

bool CsvLines::next(std::string& line) {
  line.clear();
  if (!head_written_) {
    head_written_ = true;
    write_head(line);
    return true;
  }
  while (next_row()) {
    if (!started_) {  // evenly spaced lines begin where they were asked to, when there are values already
      const bool known = std::ranges::any_of(cells_, [](const auto& value) { return value.has_value(); });
      time_ns_ = known && every_ns_ ? span_.from_ns : rows_.time_ns();
      started_ = true;
    }
    if (rows_.time_ns() > time_ns_) {  // the line is whole
      write(time_ns_, line);
      time_ns_ = every_ns_ ? time_ns_ + *every_ns_ : rows_.time_ns();
      return true;
    }
    take_row();
  }
  if (!started_ || ended_ || time_ns_ > last_ns_) return false;
  write(time_ns_, line);
  ended_ = !every_ns_;
  if (every_ns_) time_ns_ += *every_ns_;
  return true;
}

void CsvLines::write_head(std::string& line) const {
  line = "time_s";
  for (const ChosenSignal& signal : signals_)
    line += "," + cell(signal.info.name + (signal.info.unit.empty() ? "" : " [" + signal.info.unit + "]"));
}

// A row that comes late, with an earlier time, repeats what holds.
void CsvLines::write(std::int64_t time_ns, std::string& line) {
  append_seconds(line, time_ns);
  for (const std::optional<double>& value : cells_) {
    line += ',';
    if (value) append_number(line, *value);
  }
  ++lines_;
}

}  // namespace kadans
