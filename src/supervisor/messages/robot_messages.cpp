#include "robot_messages.h"

#include <algorithm>
#include <cmath>

#include "config/json/json_value.h"
#include "config/scenario/event_text.h"
#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

using Kind = JsonValue::Kind;

constexpr std::int64_t minute_ns = 60'000'000'000;
constexpr double clock_drift_ms_per_ms = 1e-4;  // of two robots' clocks, at most

[[noreturn]] void bad_message(const JsonValue& at, const std::string& what) { refuse("", at.place, what); }

const JsonValue& value_of(const JsonValue& object, const char* name, Kind kind) {
  const JsonMember* found = object.find(name);
  if (found == nullptr) bad_message(object, std::string("'") + name + "' is missing");
  if (found->value.kind != kind) bad_message(found->value, std::string("'") + name + "' is of another type");
  return found->value;
}

double whole(const JsonValue& object, const char* name, double most) {
  const JsonValue& value = value_of(object, name, Kind::number);
  if (!(value.number >= 0 && value.number <= most) || value.number != std::floor(value.number))
    bad_message(value, std::string("'") + name + "' is no whole number up to " + std::to_string(most));
  return value.number;
}

double ms(std::int64_t time_ns) { return std::floor(1e-6 * static_cast<double>(time_ns)); }

}  // namespace

bool RobotMessages::within_budget(std::size_t bytes, std::int64_t now_ns) {
  for (; !sent_.empty() && sent_.front().first <= now_ns - minute_ns; sent_.pop_front())
    sent_bytes_ -= sent_.front().second;
  if (sent_.size() >= config_.messages_per_minute || sent_bytes_ + bytes > config_.bytes_per_minute) return false;
  sent_.emplace_back(now_ns, bytes);
  sent_bytes_ += bytes;
  return true;
}

std::string RobotMessages::encode(const PlayedEvent& event, std::int64_t now_ns, std::string& why) {
  std::string text = "{\"kadans\":1,\"from\":\"" + config_.name + "\",\"boot\":" + std::to_string(boot_) +
                     ",\"number\":" + std::to_string(number_ + 1) +
                     ",\"sent_ms\":" + std::to_string(static_cast<std::uint64_t>(std::max(0.0, ms(now_ns)))) +
                     ",\"event\":\"" + event.name + "\"";
  if (!event.data.empty()) text += ",\"data\":" + data_json(event.data);
  text += "}";
  why.clear();
  if (text.size() > message_bytes_max) {
    why = "it has " + std::to_string(text.size()) + " bytes, more than " + std::to_string(message_bytes_max);
  } else if (!within_budget(text.size(), now_ns)) {
    why = "the budget of this minute is spent: " + std::to_string(config_.messages_per_minute) + " messages, " +
          std::to_string(config_.bytes_per_minute) + " bytes";
  } else {
    ++number_;
    return text;
  }
  return "";
}

RobotMessages::Answer RobotMessages::decode(std::string_view datagram, std::int64_t now_ns, PlayedEvent& event,
                                            std::string& why) {
  why.clear();
  try {
    if (datagram.size() > message_bytes_max) refuse("", {1, 1}, "it is too long");
    return read(datagram, now_ns, event);
  } catch (const InputError& error) {
    why = error.problems().front().text();
    return Answer::wrong;
  }
}

RobotMessages::Answer RobotMessages::read(std::string_view datagram, std::int64_t now_ns, PlayedEvent& event) {
  const JsonValue json = parse_json(datagram, "");
  if (json.kind != Kind::object) bad_message(json, "a message is one object");
  if (whole(json, "kadans", 1) != 1) bad_message(json, "'kadans' is not 1, the only version there is");
  const std::string& from = value_of(json, "from", Kind::string).text;
  if (from == config_.name) return Answer::own;
  if (std::ranges::find(config_.peers, from) == config_.peers.end()) return Answer::stranger;
  const auto boot = static_cast<std::uint32_t>(whole(json, "boot", 0xffffffffU));
  const auto number = static_cast<std::uint32_t>(whole(json, "number", 0xffffffffU));
  const double sent_ms = whole(json, "sent_ms", 1e15);
  const JsonValue& name = value_of(json, "event", Kind::string);
  if (!is_event_name(name.text) || !name.text.starts_with(message_event_prefix))
    bad_message(name, "'event' is no name that begins with 'robot.'");
  event = {.name = name.text, .who = from};
  std::size_t known = 6;
  if (const JsonMember* data = json.find("data")) {
    if (data->value.kind != Kind::object) bad_message(data->value, "'data' is an object");
    Problems problems("");
    event.data = read_event_data(data->value, problems);
    problems.throw_if_any();
    ++known;
  }
  if (json.members.size() != known) bad_message(json, "it has other keys");
  const auto [known_peer, is_new] = peers_.try_emplace(from);
  Peer& peer = known_peer->second;
  const double behind_ms = ms(now_ns) - sent_ms;
  if (is_new || peer.boot != boot) {
    peer = {.boot = boot, .number = number, .fastest_ms = behind_ms};
    return Answer::taken;
  }
  if (number <= peer.number) return Answer::repeated;
  peer.number = number;
  peer.fastest_ms = std::min(behind_ms, peer.fastest_ms + clock_drift_ms_per_ms * 1000);
  return behind_ms - peer.fastest_ms > 1e3 * config_.age_max_s ? Answer::too_old : Answer::taken;
}

}  // namespace kadans
