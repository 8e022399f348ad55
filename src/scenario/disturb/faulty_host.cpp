#include "faulty_host.h"

#include <limits>

namespace kadans {

void FaultyHost::tick(const Snapshot& snapshot, CommandSender& commands) noexcept {
  host_.tick(snapshot, own_);
  collect(snapshot.time_ns);
  forward(commands);
  ++tick_;
}

// Takes what the host sent in this tick and applies the faults of this moment to it.
void FaultyHost::collect(std::int64_t time_ns) {
  const std::size_t before = under_way_.size();
  Command command;
  while (queue_->try_pop(command)) {
    if (command.kind == CommandKind::transaction) {
      under_way_.push_back({.due_tick = tick_, .time_ns = command.time_ns, .commands = {}});
    } else {
      under_way_.back().commands.push_back(command);
    }
  }
  for (const Fault& fault : faults_) {
    if (time_ns < fault.from_ns || time_ns >= fault.until_ns) continue;
    for (std::size_t i = before; i < under_way_.size(); ++i) {
      Batch& batch = under_way_[i];
      if (fault.kind == Kind::late) batch.due_tick += fault.ticks;
      if (fault.kind == Kind::lost) batch.commands.clear();
      if (fault.kind != Kind::not_finite) continue;
      for (Command& each : batch.commands) each.value = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

void FaultyHost::forward(CommandSender& commands) {
  while (!under_way_.empty() && under_way_.front().due_tick <= tick_) {
    const Batch& batch = under_way_.front();
    commands.begin(batch.time_ns);
    for (const Command& command : batch.commands) (void)commands.add(command);  // refused whole when it does not fit
    (void)commands.commit();
    under_way_.pop_front();
  }
}

}  // namespace kadans
