// A pause of the playing behaviors: charts do not step, their clock stands still, and motions under way come to rest
// where they are. At the end of the pause the motions go on to their targets in the time that was left. The charts step
// again once the control engine has taken these commands. So `after`, m:wait and a motion's handle do not notice the
// pause. Behavior thread only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/transaction.h"
#include "kadans/control/set_partition.h"
#include "kadans/signal/command.h"
#include "kadans/signal/status.h"

namespace kadans {

class ByteReader;
class ByteWriter;

// The motions that behaviors have started: for each set-point its target and its time of arrival, by the behaviors'
// clock. They are taken from the committed transactions, so the robot can be halted without the help of any behavior.
//
// A velocity set-point that is not zero, and a trapezoid without a duration, count as under way until another command
// replaces them. This is harmless: to stop a joint that rests, or to send it where it is, has no effect. Behavior
// thread only.
class MotionsUnderWay {
 public:
  explicit MotionsUnderWay(const Catalog& catalog);  // `catalog` must outlive it

  void note(std::span<const Command> transaction, std::int64_t now_ns);  // throws std::bad_alloc
  void forget() noexcept;
  bool any(std::int64_t now_ns) const noexcept;
  // Writes the motions under way as bytes, and reads them back in another process.
  void keep(ByteWriter& bytes, std::int64_t now_ns) const;
  void restore(ByteReader& bytes);
  // rest adds commands to the transaction that bring all motions to rest where they are. go_on adds commands that
  // continue them to their targets in the time that was left. False: there was no place for them.
  [[nodiscard]] bool rest(std::int64_t now_ns, CommandSender& commands) const noexcept;
  [[nodiscard]] bool go_on(std::int64_t now_ns, CommandSender& commands) const noexcept;

 private:
  struct Leg {
    Command command;
    std::int64_t end_ns = 0;
  };
  using Motion = std::vector<Leg>;  // its legs, one after the other
  static bool under_way(const Motion& motion, std::int64_t now_ns) noexcept {
    return !motion.empty() && motion.back().end_ns > now_ns;
  }
  void begin(const Command& command, std::int64_t now_ns);
  void switch_to(std::uint32_t set) noexcept;
  static bool go_on(const Motion& motion, std::int64_t now_ns, CommandSender& commands) noexcept;

  const Catalog& catalog_;
  SetPartition partition_;
  SetMask active_;               // as far as the sent commands tell
  std::vector<Motion> motions_;  // one for each set-point
  std::vector<bool> velocity_;   // true for a velocity set-point
};

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
