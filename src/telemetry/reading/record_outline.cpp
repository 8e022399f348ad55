#include "record_outline.h"

#include <algorithm>
#include <set>

#include "config/json/name_pattern.h"
#include "config/json/problems.h"
#include "kadans/signal/state_hash.h"

namespace kadans {
namespace {

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
  if (facts == metadata.end()) return "";
  const auto fact = facts->second.find(key);
  return fact == facts->second.end() ? "" : fact->second;
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
    if (added) topic->second = {.topic = rows.topic(), .channel = rows.channel()};
    add_message(rows, outline, topic->second);
  }
  if (topics.empty()) {
    const std::string& problem = rows.reader().problem();
    throw InputError({.file = problem.empty() ? path : "", .message = problem.empty() ? "holds no message" : problem});
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
    if (!found)
      throw InputError({.file = record.file, .message = unknown_name("signal", pattern, record.signal_names())});
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
    if (chosen.size() == before)
      throw InputError({.file = record.file, .message = unknown_name("topic", wanted, names)});
  }
  return chosen;
}

}  // namespace kadans
