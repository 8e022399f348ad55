#include "record_comparison.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <sstream>

#include "signal/number_text.h"

namespace kadans {

bool is_upkeep(const std::string& name) {
  if (!name.starts_with("behavior.")) return false;
  return name.ends_with(".heap_bytes") || name.ends_with(".instructions") || name.ends_with(".gc_pause_ns");
}

namespace {

std::uint32_t number_in(const TextMap& metadata, const char* name) {
  const auto found = metadata.find(name);
  return found == metadata.end() ? 1 : number_of<std::uint32_t>(found->second).value_or(1);
}

}  // namespace

RecordComparison::RecordComparison(McapReader& record, const SignalTable& signals) : record_(record), table_(signals) {
  advance();
}

// To the next message that holds signals.
void RecordComparison::advance() {
  while (record_.next(message_)) {
    if (!topic_of(message_.channel).signals.empty()) return;
  }
  ended_ = true;
}

RecordComparison::Topic& RecordComparison::topic_of(std::uint16_t channel) {
  const auto [known, added] = topics_.try_emplace(channel);
  Topic& topic = known->second;
  if (!added) return topic;
  const McapChannel& info = record_.channels().at(channel);
  const auto description = info.metadata.find("signals");
  if (description == info.metadata.end()) return topic;
  std::istringstream lines(description->second);
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(0, line.find('\t'));
    const auto signal = table_.find(name);
    if (!signal && !is_upkeep(name)) gone_.push_back(name);
    const bool compared = signal && !is_upkeep(name);
    topic.signals.push_back(compared ? *signal : not_compared);
    if (compared) ++compared_;
  }
  topic.values.resize(topic.signals.size());
  topic.every_ticks = std::max(1U, number_in(info.metadata, "every_ticks"));
  topic.standstill_ticks = number_in(info.metadata, "standstill_ticks");
  return topic;
}

void RecordComparison::compare(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) {
  if (over()) return;
  const auto number = static_cast<std::uint32_t>(tick);  // as messages count
  found_.clear();
  bool any = false;
  while (!ended_ && message_.sequence <= number) {
    if (message_.sequence == number) any = compare_message(row, time_ns) || any;
    advance();
  }
  if (!ended_) any = compare_standing(tick, row) || any;
  if (found_.empty()) {
    if (any) ++ticks_;
    return;
  }
  parted_ = true;
  tick_ = tick;
  time_ns_ = time_ns;
  std::ranges::sort(found_, {}, [](const auto& difference) { return difference.first; });
  for (auto& [id, difference] : found_) differences_.push_back(std::move(difference));
}

bool RecordComparison::compare_message(std::span<const double> row, std::int64_t time_ns) {
  Topic& topic = topic_of(message_.channel);
  topic.single = !read_cdr(message_.payload, topic.values, Precision::full);
  if (topic.single && !read_cdr(message_.payload, topic.values, Precision::single)) return false;
  topic.read = true;
  topic.sequence = message_.sequence;
  if (message_.time_ns != time_ns) {
    found_.push_back(
        {0, {"time", "s", static_cast<double>(message_.time_ns) / 1e9, static_cast<double>(time_ns) / 1e9}});
  }
  compare_values(topic, row);
  return true;
}

// The topics that have no message in this tick because they did not change.
bool RecordComparison::compare_standing(std::uint64_t tick, std::span<const double> row) {
  bool any = false;
  const auto number = static_cast<std::uint32_t>(tick);
  for (const auto& [channel, topic] : topics_) {
    const bool stands = topic.read && topic.sequence < number && number - topic.sequence < topic.standstill_ticks;
    if (!stands || tick % topic.every_ticks != 0) continue;
    compare_values(topic, row);
    any = true;
  }
  return any;
}

void RecordComparison::compare_values(const Topic& topic, std::span<const double> row) {
  for (std::size_t i = 0; i < topic.signals.size(); ++i) {
    const SignalId id = topic.signals[i];
    if (id == not_compared) continue;
    const double replayed = topic.single ? static_cast<double>(static_cast<float>(row[id])) : row[id];
    if (same_value(topic.values[i], replayed)) continue;
    const Signal& info = table_.info(id);
    found_.push_back({id, {info.name, info.unit, topic.values[i], replayed}});
  }
}

}  // namespace kadans
