
#include "record_export.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "input_reader.h"
#include "kadans/signal/nearest_name.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "signal/utf8.h"
#include "telemetry/mcap/mcap_writer.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

void append_json_number(std::string& text, double value) {
  if (std::isfinite(value))
    append_number(text, value);
  else
    text += "null";
}

// The fields of a message in JSON behind those of the line.
void append_fields(std::string& line, std::string_view text) {
  std::optional<Json> json = read_foreign_json(text);
  if (!json || !json->is_object()) {
    line += ",\"message\":" + json_text(std::string(text));
    return;
  }
  json->erase("timestamp");
  const std::string fields = json_text(*json);
  if (fields.size() > 2) line += "," + fields.substr(1, fields.size() - 2);
}

// std_msgs/String in CDR: head, length, bytes, zero.
std::optional<std::string> string_in(const RecordRows& rows) {
  if (rows.topic().schema != "std_msgs/msg/String") return std::nullopt;
  ByteReader body(rows.payload());
  body.take<std::uint32_t>();
  std::string text = body.take_string();
  if (!body.ok()) return std::nullopt;
  if (!text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

std::string slashed(const std::string& topic) {
  return topic.starts_with('/') || topic.starts_with('*') ? topic : "/" + topic;
}

}  // namespace

void append_number(std::string& text, double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  text.append(digits, end);
}

void append_seconds(std::string& text, std::int64_t time_ns) {
  constexpr std::uint64_t second_ns = 1'000'000'000;
  const bool negative = time_ns < 0;
  const std::uint64_t ns = negative ? 0 - static_cast<std::uint64_t>(time_ns) : static_cast<std::uint64_t>(time_ns);
  if (negative) text += '-';
  text += std::to_string(ns / second_ns);
  std::string rest = std::to_string(second_ns + ns % second_ns);
  rest[0] = '.';
  text += rest.substr(0, rest.find_last_not_of("0.") + 1);
}

JsonLines::JsonLines(const std::string& path, std::vector<std::string> topics, TimeSpan span)
    : rows_(path), topics_(std::move(topics)), met_(topics_.size()), span_(span) {}

bool JsonLines::wanted() {
  if (topics_.empty()) return true;
  bool wanted = false;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    if (!matches(slashed(topics_[i]), rows_.topic().name)) continue;
    met_[i] = wanted = true;
  }
  return wanted;
}

bool JsonLines::next(std::string& line) {
  while (rows_.next()) {
    if (!wanted() || !span_.holds(rows_.time_ns())) continue;
    ++lines_;
    line.clear();
    write(line);
    return true;
  }
  return false;
}

const std::vector<std::string>& JsonLines::keys() {
  const auto [known, added] = keys_.try_emplace(rows_.channel());
  if (!added) return known->second;
  for (const Signal& signal : rows_.topic().signals) known->second.push_back("," + json_text(signal.name) + ":");
  return known->second;
}

void JsonLines::write(std::string& line) {
  const RecordTopic& topic = rows_.topic();
  line += "{\"time_s\":";
  append_seconds(line, rows_.time_ns());
  line += ",\"topic\":" + json_text(topic.name);
  if (!rows_.values().empty()) {
    line += ",\"tick\":" + std::to_string(rows_.tick());
    const std::vector<std::string>& names = keys();
    for (std::size_t i = 0; i < names.size(); ++i) {
      line += names[i];
      append_json_number(line, rows_.values()[i]);
    }
  } else if (topic.is_json()) {
    append_fields(line, rows_.text());
  } else if (const std::optional<std::string> text = string_in(rows_)) {
    line += ",\"data\":" + json_text(*text);
  } else {
    line += ",\"bytes\":" + std::to_string(rows_.payload().size());
  }
  line += '}';
}

std::vector<std::string> JsonLines::unknown_topics() const {
  std::vector<std::string> unknown;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    bool known = met_[i];  // perhaps a channel without a message
    for (const auto& [id, channel] : reader().channels()) known = known || matches(slashed(topics_[i]), channel.topic);
    if (!known) unknown.push_back(topics_[i]);
  }
  return unknown;
}

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
    line += "," + csv_field(signal.info.name + (signal.info.unit.empty() ? "" : " [" + signal.info.unit + "]"));
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

namespace {

// How the messages of one channel go on.
struct Passage {
  std::uint16_t channel = 0;        // in the new file
  std::vector<std::size_t> places;  // of the values that are kept; empty: the message as it is
  bool rows = false, event = false;
  // The last message before the stretch.
  std::uint32_t before_tick = 0;
  std::int64_t before_ns = 0;
  std::vector<std::byte> before;
};

bool is_event(const RecordTopic& topic) {
  return topic.schema == "foxglove.Log" || topic.schema == "kadans.Transition" || topic.schema == "kadans.Fault";
}

// The inputs of a record's ticks up to a time, stored anew for a file with other signals.
class CutInputs {
 public:
  // `exact`: the signals of which the new file has each tick with all bits.
  CutInputs(const RecordOutline& record, std::int64_t to_ns, const std::set<std::string>& exact, McapWriter& file)
      : to_ns_(std::min(to_ns, record.last_ns)), file_(file), ticks_(record.file), behaviors_(record.file) {
    more_ = ticks_.next(tick_);
    if (!more_)
      refuse(record.file,
             "has no inputs to be kept: " + (ticks_.problem().empty() ? "it holds no tick" : ticks_.problem()));
    if (tick_.tick != 0)
      refuse(record.file, "begins in tick " + std::to_string(tick_.tick) +
                              " of its run: only inputs from the first tick on can be repeated");
    if (ticks_.layout().state_bytes > 0) refuse(record.file, "is a flight record: its inputs are not cut");
    std::vector<bool> known;
    TextMap facts = ticks_.layout().facts();
    for (const std::string& name : ticks_.signals()) {
      known.push_back(exact.contains(name));
      facts["names"] += name + '\n';
    }
    encoder_ = std::make_unique<InputEncoder>(ticks_.layout(), std::move(known));
    const std::uint16_t schema = file_.add_schema("kadans.Inputs", "", "");
    written_ = file_.add_metadata(inputs_metadata, facts);
    inputs_channel_ = file_.add_channel(inputs_topic, "", schema);
    behaviors_channel_ = file_.add_channel(behavior_inputs_topic, "", schema);
  }

  // Those of all ticks before this time, whose rows have been written. False: the file failed.
  bool until(std::int64_t time_ns) {
    for (; more_ && tick_.time_ns < time_ns && tick_.time_ns <= to_ns_; more_ = ticks_.next(tick_)) {
      if (encoder_->full()) put();
      if (!encoder_->add(tick_.tick, tick_.time_ns, tick_.words, ticks_.row())) break;
      last_tick_ = tick_.tick;
    }
    return written_;
  }
  bool finish() {
    (void)until(std::numeric_limits<std::int64_t>::max());
    if (encoder_->ticks() > 0) put();
    return written_;
  }

 private:
  void put() {
    message_.clear();
    encoder_->encode(message_);
    written_ = file_.write(inputs_channel_, 0, encoder_->time_ns(), message_.bytes()) && written_;
    put_behaviors();
  }

  // What came before the first tick of the behaviors that saw a later control tick.
  void put_behaviors() {
    message_.clear();
    while (waits_ || behaviors_.next(event_)) {
      waits_ = event_.kind == BehaviorInput::Kind::tick_begins && event_.snapshot > last_tick_ + 1;
      if (waits_) break;
      message_.put(behaviors_.bytes());
    }
    if (message_.size() > 0)
      written_ = file_.write(behaviors_channel_, 0, encoder_->time_ns(), message_.bytes()) && written_;
  }

  std::int64_t to_ns_;
  McapWriter& file_;
  TickReader ticks_;
  BehaviorInputReader behaviors_;
  std::unique_ptr<InputEncoder> encoder_;
  std::uint16_t inputs_channel_ = 0, behaviors_channel_ = 0;
  ByteWriter message_;
  TickTaken tick_;
  BehaviorInput event_;
  std::uint64_t last_tick_ = 0;
  bool more_ = false, waits_ = false, written_ = true;
};

bool is_input(const RecordTopic& topic) {
  return topic.name == inputs_topic || topic.name == behavior_inputs_topic || topic.name == states_topic;
}

class Cutting {
 public:
  Cutting(const RecordOutline& record, const RecordCut& cut) : record_(record), cut_(cut), rows_(record.file) {
    for (const ChosenSignal& signal : choose_signals(record, cut.signals)) {
      chosen_[signal.channel].push_back(signal.place);
      ++result_.signals;
    }
    for (auto& [channel, places] : chosen_) std::ranges::sort(places);
  }

  CutRecord write(const std::string& to) {
    check(file_.open(to));
    put_facts();
    if (cut_.inputs) inputs_ = std::make_unique<CutInputs>(record_, cut_.span.to_ns, exact_signals(), file_);
    while (rows_.next()) pass();
    if (result_.messages == 0) refuse(record_.file, "holds nothing between these times");
    if (inputs_) check(inputs_->finish());
    check(file_.close());
    result_.file_bytes = file_.file_bytes();
    return result_;
  }

 private:
  void check(bool done) const {
    if (!done) refuse(file_.error());
  }

  void put_facts() {
    // Not: of inputs, which are stored anew; of a next file, of the whole record's end.
    const std::set<std::string> left_out{inputs_metadata, "goes_on", "recorder"};
    for (const auto& [name, facts] : record_.metadata) {
      if (!left_out.contains(name)) check(file_.add_metadata(name, facts));
    }
    std::string from, to;
    append_seconds(from, std::max(cut_.span.from_ns, record_.first_ns));
    append_seconds(to, std::min(cut_.span.to_ns, record_.last_ns));
    check(file_.add_metadata(
        "cut", {{"from_s", from}, {"to_s", to}, {"signals", std::to_string(result_.signals)}, {"of", record_.file}}));
    for (const McapAttachment& attachment : record_.attachments)
      check(file_.attach(attachment.name, attachment.media_type, attachment.time_ns, attachment.data));
  }

  // Signals that the new file has in each tick, with all bits.
  std::set<std::string> exact_signals() const {
    std::set<std::string> names;
    for (const TopicOutline& topic : record_.topics) {
      if (!topic.exact) continue;
      const auto chosen = chosen_.find(topic.channel);
      if (chosen == chosen_.end()) continue;
      for (const std::size_t place : chosen->second) names.insert(topic.topic.signals[place].name);
    }
    return names;
  }

  Passage* passage() {
    const auto [known, added] = passages_.try_emplace(rows_.channel());
    if (added) known->second = make_passage(rows_.channel());
    return known->second ? &*known->second : nullptr;
  }

  std::optional<Passage> make_passage(std::uint16_t id) {
    const McapChannel& channel = rows_.reader().channels().at(id);
    const RecordTopic& topic = rows_.topic();
    if (is_input(topic)) return std::nullopt;
    Passage passage;
    passage.rows = !topic.signals.empty();
    passage.event = is_event(topic);
    if (passage.rows && chosen_[id].empty()) return std::nullopt;
    std::vector<SignalTopic> topics;
    if (passage.rows && chosen_[id].size() != topic.signals.size()) {
      const double zero = 0;
      SignalTable table;
      for (const std::size_t place : chosen_[id]) table.add(topic.signals[place], &zero);
      topics = signal_topics(table, rows_.precision());
    }
    if (topics.size() != 1) {  // whole; also of an older record, where these shared a topic
      passage.channel = file_.add_channel(channel.topic, channel.encoding, schema(channel.schema), channel.metadata);
      return passage;
    }
    for (const SignalId signal : topics.front().signals) passage.places.push_back(chosen_[id][signal]);
    TextMap metadata = channel.metadata;
    metadata["signals"] = topics.front().description;
    const std::uint16_t schema = file_.add_schema(topics.front().type, "ros2msg", topics.front().definition);
    passage.channel = file_.add_channel(channel.topic, channel.encoding, schema, metadata);
    return passage;
  }

  std::uint16_t schema(std::uint16_t id) {
    if (id == 0) return 0;
    const auto known = schemas_.find(id);
    if (known != schemas_.end()) return known->second;
    const McapSchema& schema = rows_.reader().schemas().at(id);
    return schemas_[id] = file_.add_schema(schema.name, schema.encoding, schema.text);
  }

  void pass() {
    if (rows_.time_ns() > cut_.span.to_ns) return;
    Passage* const way = passage();
    if (way == nullptr || (!way->places.empty() && rows_.values().empty())) return;  // the latter: damaged
    if (rows_.time_ns() < cut_.span.from_ns) {
      if (way->event) return;
      way->before_tick = rows_.tick();
      way->before_ns = rows_.time_ns();
      const std::span<const std::byte> kept = kept_of(*way);
      way->before.assign(kept.begin(), kept.end());
      return;
    }
    if (result_.messages == 0) begin(rows_.time_ns());
    if (inputs_ && way->rows) check(inputs_->until(rows_.time_ns()));
    put(*way, rows_.tick(), rows_.time_ns(), kept_of(*way));
  }

  // What holds when the stretch begins. Rows keep their own time; what describes the run has none that matters.
  void begin(std::int64_t time_ns) {
    for (auto& [id, way] : passages_) {
      if (way && !way->before.empty()) put(*way, way->before_tick, way->rows ? way->before_ns : time_ns, way->before);
    }
  }

  void put(const Passage& way, std::uint32_t tick, std::int64_t time_ns, std::span<const std::byte> payload) {
    ++result_.messages;
    check(file_.write(way.channel, tick, time_ns, payload));
  }

  // The message that was read, or the values of it that are chosen.
  std::span<const std::byte> kept_of(const Passage& way) {
    if (way.places.empty()) return rows_.payload();
    values_.clear();
    for (const std::size_t place : way.places) values_.push_back(rows_.values()[place]);
    payload_.resize(cdr_bytes(values_.size(), rows_.precision()));
    write_cdr(payload_, values_, rows_.precision());
    return payload_;
  }

  const RecordOutline& record_;
  const RecordCut& cut_;
  RecordRows rows_;
  McapWriter file_;
  std::unique_ptr<CutInputs> inputs_;
  std::map<std::uint16_t, std::vector<std::size_t>> chosen_;
  std::map<std::uint16_t, std::optional<Passage>> passages_;
  std::map<std::uint16_t, std::uint16_t> schemas_;
  std::vector<double> values_;
  std::vector<std::byte> payload_;
  CutRecord result_;
};

}  // namespace

CutRecord cut_record(const RecordOutline& record, const RecordCut& cut, const std::string& to) {
  return Cutting(record, cut).write(to);
}

}  // namespace kadans
