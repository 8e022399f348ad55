// The behavior engine: the soft-real-time side, 100 Hz. A tick runs the high level of the active control objects, then
// the behaviors, and tells the control engine that it is alive.
#pragma once

#include <cstdint>

#include "behavior_host.h"
#include "engine/tick/control_engine.h"
#include "kadans/control/control_sets.h"
#include "transaction.h"

namespace kadans {

class BehaviorEngine {
 public:
  // Keeps references. Without a host only the high levels run.
  BehaviorEngine(ControlSets& sets, EngineExchange& exchange, BehaviorHost* host) noexcept
      : sets_(sets), exchange_(exchange), host_(host), commands_(exchange.commands) {}

  // Behavior thread, shortly before a tick, or never: lets the host fetch what the tick is going to need.
  void prepare() noexcept;
  // Behavior thread. Throws what the high level of a control object throws.
  void tick(std::int64_t time_ns);

  std::uint64_t ticks() const noexcept { return tick_; }
  const CommandSender& commands() const noexcept { return commands_; }
  // Behavior thread, between ticks: for other senders of commands than the host, such as a console.
  CommandSender& sender() noexcept { return commands_; }

 private:
  ControlSets& sets_;
  EngineExchange& exchange_;
  BehaviorHost* host_;
  CommandSender commands_;
  std::uint64_t tick_ = 0;
};

}  // namespace kadans
