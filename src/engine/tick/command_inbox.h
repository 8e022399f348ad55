// The control engine's end of the command queue. It applies whole transactions only, checks each before its first
// effect, and takes at most a fixed number of commands per tick. A transaction with one bad command is refused as a
// whole and counted; the snapshot says why (kadans/signal/command.h).
//
// While the safety layer holds the robot, or worse, the set-points, parameters and control sets stay as they are:
// commands that would change them are refused, unless the same transaction clears the faults first. A motion under way
// goes on to its end.
//
// When the safety layer holds a single joint, the following is refused: its set-points; set-points without a joint, and
// parameters, of the objects that drive it; a switch of control sets that concerns it. A joint that damps or is off
// causes no refusal, so that the others can go on; when it comes back, it starts from where it is.
//
// A switch of a control set or object whose least time is not over (kadans/control/switch_dwell.h) is
// refused with the whole transaction, whoever sends it. The safety layer switches no sets, so nothing keeps it waiting.
//
// Orders to drives are carried out while the robot is held, because they can end the cause. Under the emergency stop,
// orders that let a joint move are refused.
#pragma once

#include <cstdint>
#include <utility>

#include "armed_transactions.h"
#include "engine/motion/setpoint_motions.h"
#include "kadans/control/control_sets.h"
#include "kadans/signal/command.h"
#include "safety/safety.h"

namespace kadans {

class CommandInbox {
 public:
  CommandInbox(CommandQueue& queue, Catalog& catalog, ControlSets& sets, std::uint32_t commands_per_tick_max,
               std::int64_t age_max_ns);

  // Control thread. Applies the transactions that have arrived, oldest first; what exceeds the commands per tick waits
  // for the next tick. A refusal raises a fault of the safety layer. The objects of a set that comes in start at once,
  // so that set-points behind the switch in the same transaction act on them.
  void apply(std::uint64_t tick, const ControlInput& input, Safety& safety) noexcept;

  // Control thread, after apply(): carries out the armed transactions whose conditions became true. One that the
  // robot's state forbids now is refused as one that arrives now.
  void carry_out_armed(std::uint64_t tick, const ControlInput& input, Safety& safety) noexcept;

  struct State {
    std::uint32_t last_transaction = 0;  // number of the last one applied
    std::uint32_t applied = 0;           // commands, headers not counted
    std::uint32_t refused = 0;           // commands of refused transactions
  };
  const State& state() const noexcept { return state_; }
  std::uint32_t arrived() const noexcept { return arrived_; }  // that waited at the last apply(), headers included
  // The number of the last transaction that arrived and waits no more, whether it was applied or refused.
  std::uint32_t last_taken() const noexcept { return last_taken_; }
  // Between ticks: all that changes from tick to tick (kadans/control/state_bytes.h), the parameters' values among it,
  // but not what waits in the queue. Restoring tells the objects of their parameters.
  void pass_state(StateBytes& bytes) noexcept;
  // Writes into the snapshot which transactions were applied and which refused.
  void fill(Snapshot& snapshot) const noexcept;
  SetpointMotions& motions() noexcept { return motions_; }
  const DriveRequests& drive_requests() const noexcept { return drive_requests_; }
  // Whether a command of this tick resets the odometry. Told once.
  bool odometry_resets() noexcept { return std::exchange(odometry_resets_, false); }
  // Control thread, when the emergency stop comes: orders that let a joint move and are not carried out yet count no
  // more, nor do armed transactions.
  void revoke_orders(const SensorFrame& sensors) noexcept;

 private:
  RefusalReason judge(const Command& command) const noexcept;
  // Whether the safety layer holds what the command would change, and which joint. `active`: the control sets before
  // the command.
  RefusalReason held(const Command& command, const Safety& safety, SetMask active, std::uint16_t& joint) const noexcept;
  // The refusal of the first of the `count` commands that is refused; with the reason none: there is no such command.
  // `at(i)` is the i-th, from 0.
  template <typename At>
  Refusal judge_all(std::uint32_t count, std::int64_t time_ns, const Safety& safety, At at) const noexcept;
  // An arm with what belongs to it: at(0) is the arm, and `rest` commands follow.
  template <typename At>
  Refusal judge_arm(std::uint32_t rest, std::uint32_t armed_before, At at) const noexcept;
  void execute_all(const Command& header, const ControlInput& input, Safety& safety) noexcept;
  void refuse(const Command& header, Refusal refusal, std::uint64_t tick, Safety& safety) noexcept;
  bool orders_again(std::uint32_t count) const noexcept;
  void execute(const Command& command, const ControlInput& input, Safety& safety) noexcept;
  void notify_owners() noexcept;

  CommandQueue& queue_;
  Catalog& catalog_;
  ControlSets& sets_;
  std::uint32_t commands_per_tick_max_;
  std::int64_t age_max_ns_;
  SetpointMotions motions_;
  ArmedTransactions armed_;
  DriveRequests drive_requests_{};
  bool odometry_resets_ = false;
  JointMask ordered_ = 0;  // joints whose drives were ordered in this tick
  State state_;
  std::uint32_t arrived_ = 0, last_taken_ = 0;
  std::uint32_t transactions_refused_ = 0;
  std::array<Refusal, refusals_shown> refusals_{};
  std::array<bool, max_objects + 1> retuned_{};  // by owner; the last one: parameters of control sets
};

}  // namespace kadans
