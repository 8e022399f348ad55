#include "event_log.h"

#include <cstring>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"

namespace kadans {
namespace {

void put_what(nlohmann::ordered_json& json, const ToldFault& fault) {
  if (!fault.joint.empty()) json["joint"] = fault.joint;
  json["value"] = fault.value;
  json["limit"] = fault.limit;
  if (!fault.words.empty()) json["words"] = fault.words;
}

}  // namespace

// An event in the ring: its size in bytes (u32, the head not counted), its time (i64), then as put_told() writes it.

EventLog::EventLog() : ring_(std::make_unique<Bytes>()) {}

void EventLog::tell(const Line& line) {
  put(line.time_ns, line);
  push();
}

void EventLog::tell_emitted(const EmittedEvent& event) {
  put(event.time_ns, event);
  if (ring_->size() + outgoing_.size() <= emitted_bytes_max) return push();
  dropped_.fetch_add(1, std::memory_order_relaxed);
}

void EventLog::tell_active(const ActiveStates& active) {
  put(active.time_ns, active);
  push();
}

void EventLog::put(std::int64_t time_ns, const auto& told) {
  outgoing_.clear();
  outgoing_.put(std::uint32_t{0});
  outgoing_.put(time_ns);
  put_told(told, outgoing_);
}

void EventLog::push() noexcept {
  outgoing_.set(0, static_cast<std::uint32_t>(outgoing_.size() - head_bytes));
  if (!ring_->try_push(outgoing_.bytes())) dropped_.fetch_add(1, std::memory_order_relaxed);
}

bool EventLog::pop(std::int64_t time_ns, Event& event) {
  if (ring_->size() < head_bytes) return false;
  incoming_.resize(head_bytes);
  for (std::size_t i = 0; i < head_bytes; ++i) incoming_[i] = ring_->peek(i);
  ByteReader head(incoming_);
  const auto size = head.take<std::uint32_t>();
  const auto event_time_ns = head.take<std::int64_t>();
  if (event_time_ns > time_ns) return false;

  incoming_.resize(size);
  for (std::size_t i = 0; i < size; ++i) incoming_[i] = ring_->peek(head_bytes + i);
  ring_->drop(head_bytes + size);
  ByteReader told(incoming_);
  (void)take_told(told, event_time_ns, event);
  return true;
}

std::string json_of(const Event& event) {
  const Transition& transition = event.transition;
  nlohmann::json json{{"timestamp", {{"sec", transition.time_ns / ns_per_s}, {"nsec", transition.time_ns % ns_per_s}}}};
  if (event.kind == Event::Kind::transition) {
    json["behavior"] = transition.behavior;
    json["from"] = transition.from;
    json["to"] = transition.to;
    json["why"] = transition.why;
  } else if (event.kind == Event::Kind::emitted) {
    const EmittedEvent& emitted = event.emitted;
    json["tick"] = emitted.tick;
    json["event"] = emitted.event;
    json["data"] = read_foreign_json(emitted.data).value_or(nlohmann::ordered_json::object());
    json["who"] = emitted.who;
    json["ordered"] = emitted.ordered;
  } else if (event.kind == Event::Kind::active) {
    json["behavior"] = transition.behavior;
    json["states"] = event.states;
  } else {
    json["level"] = 2 + static_cast<int>(event.severity);  // info 2, warning 3, error 4, as foxglove has them
    json["message"] = event.text;
    json["name"] = transition.behavior;
    json["file"] = "";
    json["line"] = 0;
  }
  // Scripts may say bytes that are no UTF-8.
  return json_text(json);
}

std::string json_of(const ToldFault& fault) {
  nlohmann::ordered_json json{{"timestamp", {{"sec", fault.time_ns / ns_per_s}, {"nsec", fault.time_ns % ns_per_s}}},
                              {"name", fault.name}};
  put_what(json, fault);
  return json_text(json);
}

nlohmann::ordered_json fault_json(const Fault& fault, const ToldFault& what) {
  nlohmann::ordered_json json{{"code", what.name}, {"tick", fault.tick}, {"text", fault_text(what)}};
  put_what(json, what);
  json["key"] = configuration_key(fault.code);
  return json;
}

}  // namespace kadans
