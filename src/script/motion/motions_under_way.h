// The motions that behaviors have started: for each set-point its target and its time of arrival, by the behaviors'
// clock. They are taken from the committed transactions, so the robot can be halted without the help of any behavior.
//
// A velocity set-point that is not zero, and a trapezoid without a duration, count as under way until another command
// replaces them. This is harmless: to stop a joint that rests, or to send it where it is, has no effect. Behavior
// thread only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/transaction.h"
#include "kadans/control/set_partition.h"
#include "kadans/signal/command.h"

namespace kadans {

class ByteReader;
class ByteWriter;

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

}  // namespace kadans
