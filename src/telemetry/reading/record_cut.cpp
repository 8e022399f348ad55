#include "record_cut.h"

#include <algorithm>
#include <optional>

#include "kadans/signal/input_error.h"
#include "record_text.h"
#include "signal/number_text.h"
#include "telemetry/mcap/mcap_writer.h"

namespace kadans {
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
    while (rows_.next()) pass();
    if (result_.messages == 0) refuse_empty();
    check(file_.close());
    result_.file_bytes = file_.file_bytes();
    return result_;
  }

 private:
  void check(bool done) const {
    if (!done) throw InputError({.message = file_.error()});
  }

  [[noreturn]] void refuse_empty() const {
    throw InputError({.file = record_.file, .message = "holds nothing between these times"});
  }

  void put_facts() {
    for (const auto& [name, facts] : record_.metadata) check(file_.add_metadata(name, facts));
    std::string from, to;
    append_seconds(from, std::max(cut_.span.from_ns, record_.first_ns));
    append_seconds(to, std::min(cut_.span.to_ns, record_.last_ns));
    check(file_.add_metadata(
        "cut", {{"from_s", from}, {"to_s", to}, {"signals", std::to_string(result_.signals)}, {"of", record_.file}}));
    for (const McapAttachment& attachment : record_.attachments)
      check(file_.attach(attachment.name, attachment.media_type, attachment.time_ns, attachment.data));
  }

  Passage* passage() {
    const auto known = passages_.find(rows_.channel());
    if (known != passages_.end()) return known->second ? &*known->second : nullptr;
    std::optional<Passage>& made = passages_[rows_.channel()];
    made = make_passage(rows_.channel());
    return made ? &*made : nullptr;
  }

  std::optional<Passage> make_passage(std::uint16_t id) {
    const McapChannel& channel = rows_.reader().channels().at(id);
    const RecordTopic& topic = rows_.topic();
    Passage passage;
    passage.rows = !topic.signals.empty();
    passage.event = is_event(topic);
    if (topic.signals.empty() || chosen_[id].size() == topic.signals.size()) {
      passage.channel = file_.add_channel(channel.topic, channel.encoding, schema(channel.schema), channel.metadata);
      return passage;
    }
    if (chosen_[id].empty()) return std::nullopt;
    const double zero = 0;
    SignalTable table;
    for (const std::size_t place : chosen_[id]) table.add(topic.signals[place], &zero);
    const std::vector<SignalTopic> topics = signal_topics(table, rows_.precision());
    if (topics.size() != 1)
      throw InputError(
          {.file = record_.file, .message = "signals of topic " + topic.name + " cannot be chosen singly"});
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
