// What the behaviors have sent on its way: for each set-point its target and when it arrives there, by the behaviors'
// clock. Known from the transactions as they are committed, so that whoever halts the robot needs no behavior's help.
//
// A set-point of a velocity that is not zero, and a trapezoid without a duration, are under way until another takes
// their place: to rest where one rests, and to go to where one is, does no harm. Behavior thread only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kadans/control/set_partition.h"
#include "kadans/engine/transaction.h"
#include "kadans/signal/command.h"

namespace kadans {

class ByteReader;
class ByteWriter;

class MotionsUnderWay {
 public:
  explicit MotionsUnderWay(const Catalog& catalog);  // which must outlive it

  void note(std::span<const Command> transaction, std::int64_t now_ns);  // throws std::bad_alloc
  void forget() noexcept;
  bool any(std::int64_t now_ns) const noexcept;
  // What is under way, as bytes and back, for another process.
  void keep(ByteWriter& bytes, std::int64_t now_ns) const;
  void restore(ByteReader& bytes);
  // Adds to the transaction that all of them stay where they are, coming to rest; or that they go on to their targets,
  // in the time that was left. False: there was no place for it.
  [[nodiscard]] bool rest(std::int64_t now_ns, CommandSender& commands) const noexcept;
  [[nodiscard]] bool go_on(std::int64_t now_ns, CommandSender& commands) const noexcept;

 private:
  struct Leg {
    Command command;
    std::int64_t end_ns = 0;
  };
  using Motion = std::vector<Leg>;  // one after the other
  static bool under_way(const Motion& motion, std::int64_t now_ns) noexcept {
    return !motion.empty() && motion.back().end_ns > now_ns;
  }
  void begin(const Command& command, std::int64_t now_ns);
  void switch_to(std::uint32_t set) noexcept;
  static bool go_on(const Motion& motion, std::int64_t now_ns, CommandSender& commands) noexcept;

  const Catalog& catalog_;
  SetPartition partition_;
  SetMask active_;               // as far as what was sent tells
  std::vector<Motion> motions_;  // one a set-point
  std::vector<bool> velocity_;   // the set-point is one
};

}  // namespace kadans
