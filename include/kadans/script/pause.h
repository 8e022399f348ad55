// A pause of what plays: charts do not step and their clock stands still, motions under way come to rest where they
// are. When it is over they go on to their targets in the time that was left, and the charts step again once the
// control engine has taken that; so `after`, m:wait and a motion's handle see no pause. Behavior thread only.
#pragma once

#include <cstdint>

#include "kadans/engine/transaction.h"
#include "kadans/script/motions_under_way.h"
#include "kadans/signal/status.h"

namespace kadans {

class Pause {
 public:
  explicit Pause(const Catalog& catalog) : motions_(catalog) {}

  void begin() noexcept;
  void end() noexcept;
  // Each tick, first: sends what the pause asks for. True: nothing steps in this tick.
  bool holds(const Snapshot& snapshot, CommandSender& commands) noexcept;
  // What the sender has just committed is under way from now on.
  void note(const Snapshot& snapshot, const CommandSender& commands) noexcept;
  // What plays was ended: motions under way come to rest, and there is nothing to go on with. No pause is left.
  void finish(const Snapshot& snapshot, CommandSender& commands) noexcept;

  // As bytes and back, for another process.
  void keep(ByteWriter& bytes, std::int64_t time_ns) const;
  void restore(ByteReader& bytes);

  bool paused() const noexcept { return phase_ == Phase::coming || phase_ == Phase::resting; }
  std::int64_t held_ns() const noexcept { return held_ns_; }  // how far the charts' clock is behind the engine's

 private:
  // coming: motions are yet to be stopped; going: they are yet to be sent on; sent: not yet known to be applied.
  enum class Phase : std::uint8_t { none, coming, resting, going, sent };
  std::int64_t now_ns(const Snapshot& snapshot) const noexcept { return snapshot.time_ns - held_ns_; }
  void run_on() noexcept;
  bool send_rest(const Snapshot& snapshot, CommandSender& commands) noexcept;
  bool send_on(const Snapshot& snapshot, CommandSender& commands) noexcept;

  MotionsUnderWay motions_;
  Phase phase_ = Phase::none;
  bool standing_ = false;       // the charts' clock
  std::int64_t stands_ns_ = 0;  // what it shows then
  std::int64_t held_ns_ = 0;
  std::int64_t sent_ns_ = 0;
  std::uint32_t sequence_ = 0;
};

}  // namespace kadans
