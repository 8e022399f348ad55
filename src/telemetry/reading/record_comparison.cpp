
#include "record_comparison.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <unordered_map>

#include "kadans/signal/nearest_name.h"
#include "signal/number_text.h"

namespace kadans {

bool is_upkeep(const std::string& name) {
  if (name == "play.events_refused") return true;  // counts orders, too, that were refused and left no other trace
  if (!name.starts_with("behavior.")) return false;
  return name.ends_with(".heap_bytes") || name.ends_with(".instructions") || name.ends_with(".gc_pause_ns");
}

namespace {

std::uint32_t number_in(const TextMap& metadata, const char* name) {
  return number_of<std::uint32_t>(fact_in(metadata, name)).value_or(1);
}

}  // namespace

RecordComparison::RecordComparison(McapReader& record, const SignalTable& signals)
    : record_(record), table_(signals), left_out_(signals.size()) {
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
  for (const std::string& name : names_of(kadans::topic_of(record_, channel).signals)) {
    const auto signal = table_.find(name);
    if (!signal && !is_upkeep(name)) gone_.push_back(name);
    const bool compared = signal && !is_upkeep(name);
    topic.signals.push_back(compared ? *signal : not_compared);
    if (compared) ++compared_;
  }
  topic.values.resize(topic.signals.size());
  const TextMap& facts = record_.channels().at(channel).metadata;
  topic.every_ticks = std::max(1U, number_in(facts, "every_ticks"));
  topic.standstill_ticks = number_in(facts, "standstill_ticks");
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
  const std::optional<Precision> precision = read_cdr(message_.payload, topic.values);
  topic.single = precision != Precision::full;
  if (!precision) return false;
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
    if (id == not_compared || left_out_[id]) continue;
    const double replayed = topic.single ? static_cast<double>(static_cast<float>(row[id])) : row[id];
    if (same_value(topic.values[i], replayed)) continue;
    const Signal& info = table_.info(id);
    found_.push_back({id, {info.name, info.unit, topic.values[i], replayed}});
  }
}

namespace {

constexpr std::size_t none = SIZE_MAX;

// Of one record, what its signals hold at one time after the other.
class Rows {
 public:
  Rows(const std::string& path, const std::unordered_map<std::string, std::size_t>& signals)
      : rows_(path), signals_(signals), held_(signals.size()) {
    (void)read();
    more_ = next();
  }

  bool more() const noexcept { return more_; }
  bool begun() const noexcept { return begun_; }  // has been stepped over once
  std::int64_t time_ns() const noexcept { return time_ns_; }
  std::uint32_t tick() const noexcept { return tick_; }

  // Past the rows of this time, to the next.
  void step() {
    begun_ = true;
    more_ = next();
  }

  struct Held {
    double value = 0;
    bool known = false, single = false;
    std::uint32_t every_ticks = 1;
  };
  const std::vector<Held>& now() const noexcept { return held_; }       // with the rows of time_ns()
  const std::vector<Held>& before() const noexcept { return before_; }  // from the step before until then

 private:
  // All rows up to the time of the first that waits: one that comes late repeats what holds.
  bool next() {
    if (ended_) return false;
    before_ = held_;
    time_ns_ = rows_.time_ns();
    tick_ = rows_.tick();
    do take();
    while (read() && rows_.time_ns() <= time_ns_);
    return true;
  }

  bool read() {
    while (rows_.next()) {
      if (!rows_.values().empty()) return true;
    }
    ended_ = true;
    return false;
  }

  void take() {
    const auto [known, added] = places_.try_emplace(rows_.channel());
    std::vector<std::size_t>& places = known->second;
    if (added) learn(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] == none) continue;
      Held& held = held_[places[i]];
      held.value = rows_.values()[i];
      held.known = true;
    }
  }

  void learn(std::vector<std::size_t>& places) {
    const TextMap& facts = rows_.reader().channels().at(rows_.channel()).metadata;
    const std::uint32_t every_ticks = std::max(1U, number_in(facts, "every_ticks"));
    for (const Signal& signal : rows_.topic().signals) {
      const auto known = signals_.find(signal.name);
      places.push_back(known == signals_.end() ? none : known->second);
      if (places.back() == none) continue;
      held_[places.back()].single = rows_.precision() == Precision::single;
      held_[places.back()].every_ticks = every_ticks;
    }
  }

  RecordRows rows_;
  const std::unordered_map<std::string, std::size_t>& signals_;
  std::unordered_map<std::uint16_t, std::vector<std::size_t>> places_;
  std::vector<Held> held_, before_;
  std::int64_t time_ns_ = 0;
  std::uint32_t tick_ = 0;
  bool ended_ = false, more_ = false, begun_ = false;
};

class Comparison {
 public:
  Comparison(const RecordOutline& a, const RecordOutline& b, double tolerance) : tolerance_(tolerance) {
    const std::vector<std::string> names_b = b.signal_names();
    const std::set<std::string> in_b(names_b.begin(), names_b.end());
    std::set<std::string> in_a;
    for (const TopicOutline& topic : a.topics) {
      for (const Signal& signal : topic.topic.signals) {
        in_a.insert(signal.name);
        if (!in_b.contains(signal.name))
          diff_.only_a.push_back(signal.name);
        else if (!is_upkeep(signal.name) && signals_.try_emplace(signal.name, partings_.size()).second)
          partings_.push_back({.name = signal.name, .unit = signal.unit});
      }
    }
    for (const std::string& name : names_b) {
      if (!in_a.contains(name)) diff_.only_b.push_back(name);
    }
    diff_.signals = partings_.size();
  }

  RecordDiff compare(const std::string& file_a, const std::string& file_b) {
    Rows a(file_a, signals_), b(file_b, signals_);
    while (a.more() || b.more()) {
      const bool step_a = a.more() && (!b.more() || a.time_ns() <= b.time_ns());
      const bool step_b = b.more() && (!a.more() || b.time_ns() <= a.time_ns());
      // One that has no row now holds what it had; but not before it begins, nor when it is over.
      if (step_a && (step_b || (b.begun() && b.more())))
        compare(a.now(), step_b ? b.now() : b.before(), a);
      else if (step_b && a.begun() && a.more())
        compare(a.before(), b.now(), b);
      else
        count(step_a ? a : b, step_a ? diff_.rows_only_a : diff_.rows_only_b,
              step_a ? diff_.row_only_a_ns : diff_.row_only_b_ns);
      if (step_a) a.step();
      if (step_b) b.step();
    }
    for (SignalParting& parting : partings_) {
      if (parting.rows > 0) diff_.partings.push_back(std::move(parting));
    }
    std::ranges::stable_sort(diff_.partings, {}, &SignalParting::first_ns);
    return std::move(diff_);
  }

 private:
  static void count(const Rows& rows, std::uint64_t& times, std::int64_t& first_ns) {
    if (times++ == 0) first_ns = rows.time_ns();
  }

  void compare(const std::vector<Rows::Held>& a, const std::vector<Rows::Held>& b, const Rows& at) {
    ++diff_.rows;
    for (std::size_t i = 0; i < partings_.size(); ++i) {
      const bool due = at.tick() % a[i].every_ticks == 0 && at.tick() % b[i].every_ticks == 0;
      if (due && a[i].known && b[i].known) compare(a[i], b[i], partings_[i], at.time_ns());
    }
  }

  void compare(const Rows::Held& held_a, const Rows::Held& held_b, SignalParting& parting, std::int64_t time_ns) const {
    const double a = held_a.value, b = held_b.value;
    const bool rounded = held_a.single || held_b.single;  // then what both can say counts
    if (same_value(a, b) || (rounded && static_cast<float>(a) == static_cast<float>(b))) return;
    const double apart = std::isfinite(a) && std::isfinite(b) ? std::abs(a - b) : INFINITY;
    if (apart <= tolerance_) return;
    if (parting.rows++ == 0) {
      parting.first_ns = time_ns;
      parting.first_a = a;
      parting.first_b = b;
    }
    if (parting.rows > 1 && !(apart > parting.most)) return;
    parting.most = apart;
    parting.most_ns = time_ns;
    parting.most_a = a;
    parting.most_b = b;
  }

  double tolerance_;
  std::unordered_map<std::string, std::size_t> signals_;
  std::vector<SignalParting> partings_;
  RecordDiff diff_;
};

std::string event_line(std::int64_t time_ns, const std::string& text) {
  return printed("%9.3f s  ", seconds(time_ns)) + text;
}

std::vector<std::string> event_lines(const RecordOutline& record) {
  std::vector<std::pair<std::int64_t, std::string>> events;
  for (const Transition& t : record.transitions) events.emplace_back(t.time_ns, transition_text(t));
  for (const ToldFault& f : record.faults) events.emplace_back(f.time_ns, "fault " + fault_text(f));
  for (const Event& e : record.log) events.emplace_back(e.transition.time_ns, e.transition.behavior + ": " + e.text);
  std::ranges::stable_sort(events, {}, [](const auto& event) { return event.first; });
  std::vector<std::string> lines;
  for (const auto& [time_ns, text] : events) lines.push_back(event_line(time_ns, text));
  return lines;
}

// Those of `lines` beyond what `others` has of them too, in their order.
std::vector<std::string> without(const std::vector<std::string>& lines, const std::vector<std::string>& others) {
  std::multiset<std::string> unmatched(others.begin(), others.end());
  std::vector<std::string> rest;
  for (const std::string& line : lines) {
    const auto found = unmatched.find(line);
    if (found == unmatched.end())
      rest.push_back(line);
    else
      unmatched.erase(found);
  }
  return rest;
}

// From signals that are compared themselves, or from the machine.
bool is_derived(const std::string& schema) {
  return schema.starts_with("sensor_msgs/") || schema.starts_with("geometry_msgs/") ||
         schema.starts_with("tf2_msgs/") || schema == "foxglove.FrameTransforms" || schema == "kadans.Timing" ||
         schema == "kadans.Inputs";
}

std::vector<std::string> differing_topics(const RecordOutline& a, const RecordOutline& b) {
  std::map<std::string, std::uint64_t> hashes_a, hashes_b;
  for (const auto& [record, hashes] : {std::pair{&a, &hashes_a}, std::pair{&b, &hashes_b}}) {
    for (const TopicOutline& topic : record->topics) {
      if (topic.hash != 0 && !is_derived(topic.topic.schema)) (*hashes)[topic.topic.name] = topic.hash;
    }
  }
  std::vector<std::string> differing;
  for (const auto& [name, hash] : hashes_a) {
    if (!hashes_b.contains(name) || hashes_b.at(name) != hash) differing.push_back(name);
  }
  for (const auto& [name, hash] : hashes_b) {
    if (!hashes_a.contains(name)) differing.push_back(name);
  }
  return differing;
}

}  // namespace

RecordDiff diff_records(const RecordOutline& a, const RecordOutline& b, double tolerance) {
  RecordDiff diff = Comparison(a, b, tolerance).compare(a.file, b.file);
  const std::vector<std::string> lines_a = event_lines(a), lines_b = event_lines(b);
  diff.events_only_a = without(lines_a, lines_b);
  diff.events_only_b = without(lines_b, lines_a);
  diff.other_topics = differing_topics(a, b);
  return diff;
}

std::vector<std::string> differing_facts(const RecordOutline& a, const RecordOutline& b) {
  std::vector<std::string> facts;
  for (const char* const name : {"run", "program", "inputs"}) {
    std::set<std::string> keys;
    for (const RecordOutline* record : {&a, &b}) {
      const auto found = record->metadata.find(name);
      if (found == record->metadata.end()) continue;
      for (const auto& [key, value] : found->second) keys.insert(key);
    }
    for (const std::string& key : keys) {
      const std::string in_a = a.fact(name, key), in_b = b.fact(name, key);
      if (in_a == in_b) continue;
      const bool hashes = std::string_view(name) != "run";
      facts.push_back(hashes ? key : key + ": " + in_a + ", " + in_b);
    }
  }
  return facts;
}

}  // namespace kadans
