#include "record_rows.h"

#include <sstream>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
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
  const auto description = info.metadata.find("signals");
  if (description == info.metadata.end() || info.encoding != "cdr") return topic;
  std::istringstream lines(description->second);
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
  for (const Precision precision : {Precision::full, Precision::single}) {
    precision_ = precision;
    if (read_cdr(message_.payload, values_, precision)) return true;
  }
  values_.clear();
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

}  // namespace kadans
