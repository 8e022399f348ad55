// A queue of transitions and messages: a sink of the log of one thread, drained by another thread. It never blocks:
// events that do not fit are dropped and counted.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/behavior_log.h"
#include "kadans/exchange/ring.h"
#include "kadans/model/robot_model.h"
#include "kadans/signal/fault.h"
#include "signal/byte_order.h"

namespace kadans {

// The JSON that viewers read, as the schemas of its channels say (viewer_messages.h).
std::string json_of(const Event& event);
std::string json_of(const ToldFault& fault);
// The JSON that reports and ctl tell: {code, tick, text, joint, value, limit, words, key}; no joint and no words where
// there are none, and the key is of the robot's configuration.
nlohmann::ordered_json fault_json(const Fault& fault, const ToldFault& what);

class EventLog final : public LineSink {
 public:
  EventLog();

  void tell(const Line& line) override;                   // filling thread only
  void tell_active(const ActiveStates& active) override;  // likewise
  void tell_emitted(const EmittedEvent& event) override;  // likewise

  // Draining thread only. False when no event up to `time_ns` is waiting.
  [[nodiscard]] bool pop(std::int64_t time_ns, Event& event);

  std::uint32_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }  // any thread

 private:
  void put(std::int64_t time_ns, const auto& told);
  void push() noexcept;

  using Bytes = Ring<std::byte, std::size_t{1} << 18U>;
  // Events from outside bring data of strangers: half of the ring is for all else.
  static constexpr std::size_t emitted_bytes_max = Bytes::capacity() / 2;
  static constexpr std::size_t head_bytes = sizeof(std::uint32_t) + sizeof(std::int64_t);

  std::unique_ptr<Bytes> ring_;
  ByteWriter outgoing_;              // filling thread
  std::vector<std::byte> incoming_;  // draining thread
  std::atomic<std::uint32_t> dropped_{0};
};

}  // namespace kadans
