// What a process of its own plays, as its server asks it (script/process/behavior_server.h): behaviors, or the
// decisions over them. The thread of that process.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "behavior_tables.h"
#include "config/scenario/play_item.h"
#include "engine/behavior_host.h"
#include "play_list.h"
#include "play_report.h"
#include "script/behavior/behavior.h"

namespace kadans {

class ServedHost : public BehaviorHost, public OrderTaker {
 public:
  // Those of which it reports the status.
  virtual std::size_t size() const noexcept = 0;
  virtual const Behavior& behavior(std::size_t index) const noexcept = 0;
  virtual const PlayStatus& status() const noexcept = 0;

  // After the first tick: why it could not continue from the kept bytes; "" when it could.
  virtual const std::string& lost() const noexcept = 0;
  // Between two ticks. Throws InputError.
  virtual BehaviorReply reply(const BehaviorQuestion& question, const Snapshot& snapshot) = 0;
  // Writes what the next process goes on with. Returns "", or why it is impossible; then the bytes cannot be used.
  virtual std::string keep(ByteWriter& bytes, std::int64_t time_ns) = 0;
  // Of behaviors: what plays after the tick; the counts of orders are the caller's.
  virtual void report(PlayReport& /*plays*/) const noexcept {}
  // Of decisions, before a tick: what plays now. After it: what they decided in it, as bytes.
  virtual void show(const PlayReport& /*plays*/) noexcept {}
  virtual std::span<const std::byte> decided() const noexcept { return {}; }
  // Of decisions whose run is recorded: what they took in it, and before.
  virtual std::span<const std::byte> told() noexcept { return {}; }
};

}  // namespace kadans
