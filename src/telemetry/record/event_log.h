// A queue of the behaviors' transitions and messages, from the behavior thread to the thread that drains the record. It
// never blocks: events that do not fit are dropped and counted.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/behavior_host.h"
#include "kadans/exchange/ring.h"
#include "kadans/model/robot_model.h"
#include "signal/byte_order.h"

namespace kadans {

struct Event {
  enum class Kind : std::uint8_t { message, transition };
  Kind kind = Kind::message;
  Transition transition;  // both kinds use its time_ns and behavior
  BehaviorLog::Severity severity = BehaviorLog::Severity::info;
  std::string text;
};

// The JSON that viewers read, and its JSON schemas: foxglove.Log, kadans.Transition and kadans.Fault.
std::string json_of(const Event& event);
std::string json_of(const ToldFault& fault);
// The JSON that reports and ctl tell: {code, tick, text, joint, value, limit, words, key}; no joint and no words where
// there are none, and the key is of the robot's configuration.
nlohmann::ordered_json fault_json(const Fault& fault, const RobotModel& model);
extern const char* const log_schema;
extern const char* const transition_schema;
extern const char* const fault_schema;

class EventLog final : public BehaviorLog {
 public:
  EventLog();

  // Behavior thread only.
  void transition(const Transition& transition) override;
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override;

  // Draining thread only. False when no event up to `time_ns` is waiting.
  [[nodiscard]] bool pop(std::int64_t time_ns, Event& event);

  std::uint32_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }  // any thread

 private:
  using Bytes = Ring<std::byte, std::size_t{1} << 18U>;
  static constexpr std::size_t head_bytes = sizeof(std::uint32_t) + sizeof(std::int64_t);

  void begin(Event::Kind kind, std::int64_t time_ns);
  void push();

  std::unique_ptr<Bytes> ring_;
  ByteWriter outgoing_;              // behavior thread
  std::vector<std::byte> incoming_;  // draining thread
  std::atomic<std::uint32_t> dropped_{0};
};

}  // namespace kadans
