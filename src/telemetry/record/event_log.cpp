#include "event_log.h"

#include <cstring>

namespace kadans {

// An event in the ring: its size in bytes (u32, the head not counted), its time (i64), its kind (u8), then its fields.

EventLog::EventLog() : ring_(std::make_unique<Bytes>()) {}

void EventLog::begin(Event::Kind kind, std::int64_t time_ns) {
  outgoing_.clear();
  outgoing_.put(std::uint32_t{0});
  outgoing_.put(time_ns);
  outgoing_.put(static_cast<std::uint8_t>(kind));
}

void EventLog::push() {
  outgoing_.set(0, static_cast<std::uint32_t>(outgoing_.size() - head_bytes));
  if (!ring_->try_push(outgoing_.bytes())) dropped_.fetch_add(1, std::memory_order_relaxed);
}

void EventLog::transition(const Transition& transition) {
  begin(Event::Kind::transition, transition.time_ns);
  outgoing_.put_string(transition.behavior);
  outgoing_.put_string(transition.from);
  outgoing_.put_string(transition.to);
  outgoing_.put_string(transition.why);
  push();
}

void EventLog::message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) {
  begin(Event::Kind::message, time_ns);
  outgoing_.put_string(behavior);
  outgoing_.put(static_cast<std::uint8_t>(severity));
  outgoing_.put_string(text);
  push();
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
  ByteReader fields(incoming_);
  event.kind = static_cast<Event::Kind>(fields.take<std::uint8_t>());
  event.transition = {.time_ns = event_time_ns, .behavior = fields.take_string(), .from = {}, .to = {}, .why = {}};
  event.text.clear();
  if (event.kind == Event::Kind::transition) {
    event.transition.from = fields.take_string();
    event.transition.to = fields.take_string();
    event.transition.why = fields.take_string();
  } else {
    event.severity = static_cast<BehaviorLog::Severity>(fields.take<std::uint8_t>());
    event.text = fields.take_string();
  }
  return true;
}

}  // namespace kadans
