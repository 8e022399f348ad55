#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "config/json/name_pattern.h"
#include "telemetry/reading/record_text.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

std::string quoted(const std::string& text) { return json_text(text); }

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
    line += ",\"message\":" + quoted(std::string(text));
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
  constexpr std::uint64_t ns_per_s = 1'000'000'000;
  const bool negative = time_ns < 0;
  const std::uint64_t ns = negative ? 0 - static_cast<std::uint64_t>(time_ns) : static_cast<std::uint64_t>(time_ns);
  if (negative) text += '-';
  text += std::to_string(ns / ns_per_s);
  std::string rest = std::to_string(ns_per_s + ns % ns_per_s);
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
  for (const Signal& signal : rows_.topic().signals) known->second.push_back("," + quoted(signal.name) + ":");
  return known->second;
}

void JsonLines::write(std::string& line) {
  const RecordTopic& topic = rows_.topic();
  line += "{\"time_s\":";
  append_seconds(line, rows_.time_ns());
  line += ",\"topic\":" + quoted(topic.name);
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
    line += ",\"data\":" + quoted(*text);
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

}  // namespace kadans
