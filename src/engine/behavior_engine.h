// The behavior engine: the soft-real-time side, 100 Hz. A tick runs the high level of the active control objects, then
// the behaviors, and tells the control engine that it is alive.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "behavior_host.h"
#include "behavior_inputs.h"
#include "engine/tick/control_engine.h"
#include "kadans/control/control_sets.h"
#include "transaction.h"

namespace kadans {

class BehaviorEngine {
 public:
  // Keeps references. Without a host only the high levels run.
  BehaviorEngine(ControlSets& sets, EngineExchange& exchange, BehaviorHost* host) noexcept
      : sets_(sets), exchange_(exchange), host_(host), commands_(exchange.commands) {}

  // Before the loop: what comes from outside goes by these. `up`: the storages of the control objects, in their order.
  void take_inputs_by(BehaviorInputs* inputs, std::vector<UpStorage*> up) {
    inputs_ = inputs;
    up_ = std::move(up);
    commands_.tell(inputs);
  }

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
  void pin(std::int64_t seen_ns);

  CommandSender commands_;
  BehaviorInputs* inputs_ = nullptr;
  std::vector<UpStorage*> up_;
  std::uint64_t tick_ = 0;
};

}  // namespace kadans
