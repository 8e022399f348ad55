// Injects faults into the commands of behaviors at planned times: they are lost, late or not finite. It stands between
// the behavior engine and the host that runs the behaviors. Behavior thread.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "engine/behavior_host.h"

namespace kadans {

class FaultyHost final : public BehaviorHost {
 public:
  enum class Kind : std::uint8_t { lost, late, not_finite };
  struct Fault {
    Kind kind = Kind::lost;
    std::int64_t from_ns = 0, until_ns = 0;  // not included
    std::size_t ticks = 0;                   // for late: the delay in behavior ticks
  };

  explicit FaultyHost(BehaviorHost& host) : host_(host), queue_(std::make_unique<CommandQueue>()), own_(*queue_) {}
  void add(const Fault& fault) { faults_.push_back(fault); }

  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;

 private:
  struct Batch {
    std::uint64_t due_tick = 0;
    std::int64_t time_ns = 0;
    std::vector<Command> commands;
  };
  void collect(std::int64_t time_ns);
  void forward(CommandSender& commands);

  BehaviorHost& host_;
  std::unique_ptr<CommandQueue> queue_;
  CommandSender own_;
  std::vector<Fault> faults_;
  std::deque<Batch> under_way_;
  std::uint64_t tick_ = 0;
};

}  // namespace kadans
