
#include "record_rows.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "config/json/problems.h"
#include "kadans/signal/nearest_name.h"
#include "kadans/signal/state_hash.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

// A line of a topic's description: name, unit and sentence between tabs.
Signal signal_in(const std::string& line) {
  const std::size_t first = line.find('\t');
  if (first == std::string::npos) return {line, "", ""};
  const std::size_t second = line.find('\t', first + 1);
  if (second == std::string::npos) return {line.substr(0, first), line.substr(first + 1), ""};
  return {line.substr(0, first), line.substr(first + 1, second - first - 1), line.substr(second + 1)};
}

// Nothing in a file is trusted: what is no object, or lacks a field, reads as empty.
Json object_in(std::string_view text) {
  const std::optional<Json> json = read_foreign_json(text);
  return json && json->is_object() ? *json : Json::object();
}

std::string text_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

double number_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : 0;
}

BehaviorLog::Severity severity_of(double level) noexcept {
  if (level >= 4) return BehaviorLog::Severity::error;
  return level >= 3 ? BehaviorLog::Severity::warning : BehaviorLog::Severity::info;
}

}  // namespace

RecordTopic topic_of(const McapReader& reader, std::uint16_t channel) {
  const McapChannel& info = reader.channels().at(channel);
  RecordTopic topic{.name = info.topic, .schema = "", .encoding = info.encoding, .signals = {}};
  if (info.schema != 0) topic.schema = reader.schemas().at(info.schema).name;
  if (info.encoding != "cdr") return topic;
  std::istringstream lines(fact_in(info.metadata, "signals"));
  for (std::string line; std::getline(lines, line);) topic.signals.push_back(signal_in(line));
  return topic;
}

bool RecordRows::next() {
  values_.clear();
  if (!reader_.next(message_)) return false;
  const auto known = topics_.find(message_.channel);
  topic_ = known != topics_.end()
               ? &known->second
               : &topics_.emplace(message_.channel, topic_of(reader_, message_.channel)).first->second;
  if (topic_->signals.empty()) return true;
  values_.resize(topic_->signals.size());
  const std::optional<Precision> precision = read_cdr(message_.payload, values_);
  precision_ = precision.value_or(Precision::single);
  if (!precision) values_.clear();
  return true;
}

std::optional<Event> event_in(const RecordTopic& topic, std::string_view json, std::int64_t time_ns) {
  const bool transition = topic.schema == "kadans.Transition";
  if (!topic.is_json() || (!transition && topic.schema != "foxglove.Log")) return std::nullopt;
  const Json read = object_in(json);
  Event event;
  event.transition.time_ns = time_ns;
  if (transition) {
    event.kind = Event::Kind::transition;
    event.transition = {time_ns, text_in(read, "behavior"), text_in(read, "from"), text_in(read, "to"),
                        text_in(read, "why")};
  } else {
    event.severity = severity_of(number_in(read, "level"));
    event.transition.behavior = text_in(read, "name");
    event.text = text_in(read, "message");
  }
  return event;
}

std::optional<ToldFault> fault_in(const RecordTopic& topic, std::string_view json, std::int64_t time_ns) {
  if (!topic.is_json() || topic.schema != "kadans.Fault") return std::nullopt;
  const Json read = object_in(json);
  return ToldFault{text_in(read, "name"),    text_in(read, "joint"), number_in(read, "value"),
                   number_in(read, "limit"), text_in(read, "words"), time_ns};
}

std::string transition_text(const Transition& transition) {
  return transition.behavior + ": " + transition.from + (transition.from.empty() ? "-> " : " -> ") + transition.to +
         (transition.why.empty() ? "" : " (" + transition.why + ")");
}

namespace {

std::optional<Event> active_in(const RecordTopic& topic, std::string_view json, std::int64_t time_ns) {
  if (!topic.is_json() || topic.schema != "kadans.Active") return std::nullopt;
  const Json read = object_in(json);
  Event event{.kind = Event::Kind::active, .transition = {time_ns, text_in(read, "behavior"), "", "", ""}};
  const auto states = read.find("states");
  if (states == read.end() || !states->is_array()) return event;
  for (const Json& state : *states) {
    if (state.is_string()) event.states.push_back(state.get<std::string>());
  }
  return event;
}

void add_message(const RecordRows& rows, RecordOutline& outline, TopicOutline& topic) {
  const std::int64_t time_ns = rows.time_ns();
  if (topic.messages == 0) topic.first_ns = time_ns;
  ++topic.messages;
  topic.bytes += rows.payload().size();
  topic.last_ns = std::max(topic.last_ns, time_ns);
  outline.first_ns = std::min(outline.first_ns, time_ns);
  outline.last_ns = std::max(outline.last_ns, time_ns);
  if (std::optional<Event> event = event_in(rows.topic(), rows.text(), time_ns)) {
    if (event->kind == Event::Kind::transition)
      outline.transitions.push_back(std::move(event->transition));
    else
      outline.log.push_back(std::move(*event));
  } else if (std::optional<ToldFault> fault = fault_in(rows.topic(), rows.text(), time_ns)) {
    outline.faults.push_back(std::move(*fault));
  } else if (rows.topic().signals.empty()) {
    if (std::optional<Event> told = active_in(rows.topic(), rows.text(), time_ns))
      outline.active.push_back(std::move(*told));
    StateHash hash;
    hash.add(topic.hash);
    for (const std::byte byte : rows.payload()) hash.add(static_cast<std::uint64_t>(byte));
    topic.hash = hash.value();
  }
}

// Channels without a message are told as well.
void finish(const McapReader& reader, std::map<std::uint16_t, TopicOutline>& topics, RecordOutline& outline) {
  for (const auto& [channel, info] : reader.channels()) {
    const auto [topic, added] = topics.try_emplace(channel);
    if (added) topic->second = {.topic = topic_of(reader, channel), .channel = channel};
  }
  for (auto& [channel, topic] : topics) {
    if (!topic.topic.signals.empty()) outline.rows = std::max(outline.rows, topic.messages);
    outline.topics.push_back(std::move(topic));
  }
  outline.complete = reader.complete();
  outline.problem = reader.problem();
  outline.file_bytes = reader.file_bytes();
  outline.packing = reader.packing();
  outline.metadata = reader.metadata();
  outline.attachments = reader.attachments();
}

bool begins(const std::string& name, const std::string& front) {
  return name.size() > front.size() && name.starts_with(front) && name[front.size()] == '.';
}

}  // namespace

double TopicOutline::rate_hz() const noexcept {
  if (messages < 2 || last_ns <= first_ns) return 0;
  return static_cast<double>(messages - 1) / seconds(last_ns - first_ns);
}

std::string RecordOutline::fact(const std::string& metadata_name, const std::string& key) const {
  const auto facts = metadata.find(metadata_name);
  return facts == metadata.end() ? "" : fact_in(facts->second, key);
}

std::string RecordOutline::robot() const {
  constexpr std::string_view ending = ".urdf";
  for (const McapAttachment& attachment : attachments) {
    const std::string& name = attachment.name;
    if (name.ends_with(ending)) return name.substr(0, name.size() - ending.size());
  }
  return "";
}

std::vector<std::string> RecordOutline::signal_names() const {
  std::vector<std::string> names;
  for (const TopicOutline& topic : topics) {
    for (const Signal& signal : topic.topic.signals) names.push_back(signal.name);
  }
  return names;
}

RecordOutline outline_of(const std::string& path) {
  RecordRows rows(path);
  RecordOutline outline;
  outline.file = path;
  outline.first_ns = std::numeric_limits<std::int64_t>::max();
  std::map<std::uint16_t, TopicOutline> topics;
  while (rows.next()) {
    const auto [topic, added] = topics.try_emplace(rows.channel());
    if (added) {
      topic->second = {.topic = rows.topic(), .channel = rows.channel()};
      const TextMap& facts = rows.reader().channels().at(rows.channel()).metadata;
      topic->second.exact = fact_in(facts, "every_ticks") == "1" && rows.precision() == Precision::full;
    }
    add_message(rows, outline, topic->second);
  }
  if (topics.empty()) {
    const std::string& problem = rows.reader().problem();
    if (problem.empty()) refuse(path, "holds no message");
    refuse(problem);
  }
  finish(rows.reader(), topics, outline);
  return outline;
}

std::vector<ChosenSignal> choose_signals(const RecordOutline& record, const std::vector<std::string>& patterns) {
  std::vector<ChosenSignal> all, chosen;
  for (const TopicOutline& topic : record.topics) {
    for (std::size_t i = 0; i < topic.topic.signals.size(); ++i)
      all.push_back({topic.channel, i, topic.topic.signals[i]});
  }
  if (patterns.empty()) return all;
  std::set<std::string> taken;
  for (const std::string& pattern : patterns) {
    bool found = false;
    for (const ChosenSignal& signal : all) {
      const std::string& name = signal.info.name;
      if (!matches(pattern, name) && !begins(name, pattern)) continue;
      found = true;
      if (taken.insert(name).second) chosen.push_back(signal);
    }
    if (!found) refuse(record.file, unknown_name("signal", pattern, record.signal_names()));
  }
  return chosen;
}

std::vector<std::uint16_t> choose_topics(const RecordOutline& record, const std::vector<std::string>& patterns) {
  std::vector<std::uint16_t> chosen;
  for (const std::string& pattern : patterns) {
    const std::string wanted = pattern.starts_with('/') || pattern.starts_with('*') ? pattern : "/" + pattern;
    const std::size_t before = chosen.size();
    std::vector<std::string> names;
    for (const TopicOutline& topic : record.topics) {
      names.push_back(topic.topic.name);
      if (matches(wanted, topic.topic.name)) chosen.push_back(topic.channel);
    }
    if (chosen.size() == before) refuse(record.file, unknown_name("topic", wanted, names));
  }
  return chosen;
}

}  // namespace kadans
