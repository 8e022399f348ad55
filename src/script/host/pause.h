// A pause of the playing behaviors: charts do not step, their clock stands still, and motions under way come to rest
// where they are. At the end of the pause the motions go on to their targets in the time that was left. The charts step
// again once the control engine has taken these commands. So `after`, m:wait and a motion's handle do not notice the
// pause. Behavior thread only.
#pragma once

#include <cstdint>

#include "engine/transaction.h"
#include "kadans/signal/status.h"
#include "script/motion/motions_under_way.h"

namespace kadans {

class Pause {
 public:
  explicit Pause(const Catalog& catalog) : motions_(catalog) {}

  void begin() noexcept;
  void end() noexcept;
  // To be called first in each tick: sends the commands of the pause. True: charts must not step in this tick.
  bool holds(const Snapshot& snapshot, CommandSender& commands) noexcept;
  // Notes that the motions which the sender has just committed are under way.
  void note(const Snapshot& snapshot, const CommandSender& commands) noexcept;
  // To be called when what plays was ended: brings motions to rest, forgets them, and ends a pause.
  void finish(const Snapshot& snapshot, CommandSender& commands) noexcept;

  // Writes the pause as bytes, and reads it back in another process.
  void keep(ByteWriter& bytes, std::int64_t time_ns) const;
  void restore(ByteReader& bytes);

  bool paused() const noexcept { return phase_ == Phase::coming || phase_ == Phase::resting; }
  std::int64_t held_ns() const noexcept { return held_ns_; }  // how much the charts' clock is behind the engine's

 private:
  // coming: motions must still be stopped; going: they must still be sent on; sent: they were sent on, and it is not
  // yet known that the commands were applied.
  enum class Phase : std::uint8_t { none, coming, resting, going, sent };
  std::int64_t now_ns(const Snapshot& snapshot) const noexcept { return snapshot.time_ns - held_ns_; }
  void run_on() noexcept;
  bool send_rest(const Snapshot& snapshot, CommandSender& commands) noexcept;
  bool send_on(const Snapshot& snapshot, CommandSender& commands) noexcept;

  MotionsUnderWay motions_;
  Phase phase_ = Phase::none;
  bool standing_ = false;       // the charts' clock stands still
  std::int64_t stands_ns_ = 0;  // the time that it shows then
  std::int64_t held_ns_ = 0;
  std::int64_t sent_ns_ = 0;
  std::uint32_t sequence_ = 0;
};

}  // namespace kadans
