#include "signal_topics.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>

namespace kadans {
namespace {

constexpr std::array<std::byte, cdr_head_bytes> cdr_beginning{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
constexpr SignalId no_signal = 0xffffffff;
constexpr std::string_view objects = "control.";

bool is_small(char c) noexcept { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
char small(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// A part of a name and what stands below it: a field when `signal` is one, else a message type.
struct Part {
  std::string name;   // as in the signal table
  std::string field;  // as ROS allows it
  SignalId signal = no_signal;
  std::vector<Part> parts;
};

// ROS 2 wants small letters and digits, a letter first, single underscores between.
std::string field_name(std::string_view name) {
  std::string field;
  for (const char any : name) {
    const char c = small(any);
    const bool allowed = is_small(c) || is_digit(c);
    if (allowed) field += c;
    if (!allowed && !field.empty() && field.back() != '_') field += '_';
  }
  if (!field.empty() && field.back() == '_') field.pop_back();
  return !field.empty() && is_small(field[0]) ? field : "n" + field;
}

std::string unique_field(const std::vector<Part>& siblings, std::string_view name) {
  const std::string wanted = field_name(name);
  std::string field = wanted;
  const auto taken = [&] { return std::ranges::any_of(siblings, [&](const Part& p) { return p.field == field; }); };
  for (int i = 2; taken(); ++i) field = wanted + "_" + std::to_string(i);
  return field;
}

Part& add_part(std::vector<Part>& to, std::string_view name, SignalId signal) {
  if (signal == no_signal) {
    const auto known = std::ranges::find_if(to, [&](const Part& p) { return p.name == name && p.signal == no_signal; });
    if (known != to.end()) return *known;
  }
  to.push_back({.name = std::string(name), .field = unique_field(to, name), .signal = signal, .parts = {}});
  return to.back();
}

// Where the part of a name ends that is its topic: the first part. A control object has a topic of its own, because all
// of it stands still while it is not active, and what stands still is not written.
std::size_t topic_end(std::string_view name) {
  const std::size_t first = name.find('.');
  const std::size_t second = name.starts_with(objects) ? name.find('.', objects.size()) : std::string_view::npos;
  return second == std::string_view::npos ? first : second;
}

// Of the signals with that rate.
std::vector<Part> tree_of(const SignalTable& table, std::span<const std::uint32_t> every_ticks, std::uint32_t rate) {
  std::vector<Part> topics;
  for (SignalId id = 0; id < table.size(); ++id) {
    if (!every_ticks.empty() && every_ticks[id] != rate) continue;
    std::string_view rest = table.info(id).name;
    std::vector<Part>* level = &topics;
    for (std::size_t dot = topic_end(rest); dot != std::string_view::npos; dot = rest.find('.')) {
      level = &add_part(*level, rest.substr(0, dot), no_signal).parts;
      rest.remove_prefix(dot + 1);
    }
    if (level == &topics) {
      level = &add_part(topics, rest, no_signal).parts;
      rest = "value";
    }
    add_part(*level, rest, id);
  }
  return topics;
}

std::string one_line(std::string_view text) {
  std::string line(text);
  std::ranges::replace_if(
      line, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return line;
}

// "l_knee" -> "LKnee"
std::string type_name(std::string_view field) {
  std::string type;
  bool upper = true;
  for (const char c : field) {
    if (c == '_') {
      upper = true;
      continue;
    }
    type += upper && is_small(c) ? static_cast<char>(c - 'a' + 'A') : c;
    upper = false;
  }
  return type;
}

// Walks the tree of one topic in the order of the wire: depth first, fields in the order of the table.
class Definition {
 public:
  Definition(const SignalTable& table, Precision precision, SignalTopic& topic)
      : table_(table), number_(precision == Precision::full ? "float64" : "float32"), topic_(topic) {}

  void add(const Part& root) {
    const std::string type = unique_type(type_name(root.field));
    topic_.topic = "/" + root.field;
    if (root.name.starts_with(objects)) topic_.topic[objects.size()] = '/';
    topic_.type = "kadans_msgs/msg/" + type;
    topic_.definition = body(root, type);
    for (const std::string& nested : nested_) {
      topic_.definition.append(80, '=').append("\nMSG: ").append(nested);
    }
  }

 private:
  std::string unique_type(const std::string& wanted) {
    std::string type = wanted;
    for (int i = 2; std::ranges::find(types_, type) != types_.end(); ++i) type = wanted + std::to_string(i);
    types_.push_back(type);
    return type;
  }

  std::string body(const Part& part, const std::string& type) {
    std::string text;
    for (const Part& field : part.parts) {
      if (field.signal != no_signal) {
        text += number_ + " " + field.field + comment(field.signal) + "\n";
        continue;
      }
      const std::string nested = unique_type(type + type_name(field.field));
      text += "kadans_msgs/" + nested + " " + field.field + "\n";
      const std::size_t place = nested_.size();
      nested_.emplace_back();
      nested_[place] = "kadans_msgs/" + nested + "\n" + body(field, nested);
    }
    return text;
  }

  std::string comment(SignalId id) {
    const Signal& signal = table_.info(id);
    const std::string unit = one_line(signal.unit), doc = one_line(signal.doc);
    topic_.signals.push_back(id);
    topic_.description += one_line(signal.name) + "\t" + unit + "\t" + doc + "\n";
    return "  # [" + (unit.empty() ? "1" : unit) + "] " + doc;
  }

  const SignalTable& table_;
  std::string number_;
  SignalTopic& topic_;
  std::vector<std::string> types_;
  std::vector<std::string> nested_;
};

// Returns what is behind.
std::byte* write_numbers(std::byte* to, std::span<const double> values, Precision precision) noexcept {
  if (precision == Precision::full) {
    std::memcpy(to, values.data(), values.size_bytes());
    return to + values.size_bytes();
  }
  for (const double value : values) {
    const auto single = static_cast<float>(value);
    std::memcpy(to, &single, sizeof single);
    to += sizeof single;
  }
  return to;
}

}  // namespace

std::vector<SignalTopic> signal_topics(const SignalTable& table, Precision precision,
                                       std::span<const std::uint32_t> every_ticks) {
  std::set<std::uint32_t> rates(every_ticks.begin(), every_ticks.end());
  if (every_ticks.empty()) rates.insert(1);
  rates.erase(0);
  std::vector<SignalTopic> topics;
  for (const std::uint32_t rate : rates) {
    for (const Part& root : tree_of(table, every_ticks, rate)) {
      SignalTopic topic;
      Definition(table, precision, topic).add(root);
      topic.every_ticks = rate;
      for (const SignalId id : topic.signals) {
        if (topic.runs.empty() || topic.runs.back().first + topic.runs.back().count != id)
          topic.runs.push_back({id, 0});
        ++topic.runs.back().count;
      }
      const auto same = [&](const SignalTopic& other) { return other.topic == topic.topic; };
      if (std::ranges::any_of(topics, same)) {
        topic.topic += "/every_" + std::to_string(rate);
        topic.type += "Every" + std::to_string(rate);
      }
      topics.push_back(std::move(topic));
    }
  }
  return topics;
}

void write_cdr(std::span<std::byte> payload, const SignalTopic& topic, std::span<const double> row,
               Precision precision) noexcept {
  std::byte* to = std::ranges::copy(cdr_beginning, payload.data()).out;
  for (const auto& [first, count] : topic.runs) to = write_numbers(to, row.subspan(first, count), precision);
}

bool is_cdr(std::span<const std::byte> payload, const SignalTopic& topic, std::span<const double> row,
            Precision precision) noexcept {
  const std::byte* at = payload.data() + cdr_head_bytes;
  return std::ranges::all_of(topic.runs, [&](const SignalTopic::Run& run) {
    const std::span<const double> values = row.subspan(run.first, run.count);
    const std::byte* from = std::exchange(at, at + cdr_bytes(run.count, precision) - cdr_head_bytes);
    if (precision == Precision::full) return std::memcmp(from, values.data(), values.size_bytes()) == 0;
    return std::ranges::all_of(values, [&](double value) {
      const auto single = static_cast<float>(value);
      return std::memcmp(std::exchange(from, from + sizeof single), &single, sizeof single) == 0;
    });
  });
}

void write_cdr(std::span<std::byte> payload, std::span<const double> values, Precision precision) noexcept {
  (void)write_numbers(std::ranges::copy(cdr_beginning, payload.data()).out, values, precision);
}

std::optional<Precision> read_cdr(std::span<const std::byte> payload, std::span<double> values) noexcept {
  const bool full = payload.size() == cdr_bytes(values.size(), Precision::full);
  if (!full && payload.size() != cdr_bytes(values.size(), Precision::single)) return std::nullopt;
  if (!std::ranges::equal(payload.first(cdr_head_bytes), cdr_beginning)) return std::nullopt;
  const std::byte* from = payload.data() + cdr_head_bytes;
  if (full) {
    std::memcpy(values.data(), from, values.size_bytes());
    return Precision::full;
  }
  for (double& value : values) {
    float single = 0;
    std::memcpy(&single, from, sizeof single);
    value = static_cast<double>(single);
    from += sizeof single;
  }
  return Precision::single;
}

}  // namespace kadans
