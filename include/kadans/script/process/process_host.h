// Plays behaviors in a process of their own: the runtime's end. Whatever becomes of that process (it is killed,
// crashes, runs out of memory, hangs, writes rubbish), the behavior engine ticks on with its high levels and its
// heartbeat, so the control loop and the control objects hold the robot.
//
// A tick asks the process for one (behavior_link.h) and waits for the answer: on the wall clock for a part of the
// period, after which the answer counts in the tick in which it comes; on virtual time, which stands meanwhile, as long
// as patience lasts. The commands of an answer and the state that goes with them are taken together or not at all, and
// the state is kept here, out of the process's reach. So when the process dies, its tick has not been, and the next
// process goes on where the last complete answer ended: active states, their time, vars, the list; a coroutine of `run`
// begins anew, as after a reload.
//
// Until then the robot holds its last set-points; motions under way go on to their end. After safe.after_s it moves to
// the safe posture, unless nothing played. A process that dies is started again (restart_policy.h); one that does not
// answer within patience, or breaks the rules of the link, is killed first. When it dies too often in a row, or its
// state cannot be kept, it stays down: an error says so and the robot stays in its posture.
//
// All on the behavior thread, but for the constructor and attach(), which come before the threads.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kadans/config/play_order.h"
#include "kadans/control/catalog.h"
#include "kadans/engine/behavior_host.h"
#include "kadans/engine/clock.h"
#include "kadans/engine/tick_statistics.h"
#include "kadans/realtime/child_process.h"
#include "kadans/script/process/child_answer.h"
#include "kadans/script/process/restart_policy.h"
#include "kadans/script/safe_posture.h"

namespace kadans {

class ProcessHost final : public BehaviorHost, public OrderTaker {
 public:
  struct Settings {
    std::string program;
    std::vector<std::string> arguments;      // the program's name first
    bool time_stands = false;                // virtual time: a tick waits for the process, also while it starts
    std::int64_t answer_ns = 5'000'000;      // how long else a tick waits; wall time, as are the next two
    std::int64_t patience_ns = 300'000'000;  // for an answer
    std::int64_t start_patience_ns = 10'000'000'000;  // for a process that starts
    RestartPolicy::Settings restart{};
    BehaviorLink::Setup setup{};
  };
  // Starts the process; throws std::system_error. The log must outlive the host.
  ProcessHost(Settings settings, BehaviorLog& log);
  ~ProcessHost() override;

  // Waits until the process has read its files, declares the signals of its behaviors. Throws InputError when it could
  // not (why stands on standard error already) or read others than this process. The catalog must outlive the host.
  void attach(Catalog& catalog, const SafePosture::Settings& safe);

  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;
  // What is wrong in it the log will say; throws InputError only on one that is too long.
  void order(const PlayOrder& order) override;

  bool down() const noexcept { return phase_ == Phase::down; }
  std::uint64_t deaths() const noexcept { return policy_.deaths(); }
  std::uint64_t takeovers() const noexcept { return takeovers_; }
  // Behavior ticks from a death to the next answer, the one that was cut short included; by the engine's clock.
  const TickStatistics& outage() const noexcept { return outage_; }
  const TickStatistics& answer_cost() const noexcept { return answer_cost_; }  // from the request on, wall time

 private:
  enum class Phase : std::uint8_t { waiting, starting, playing, down };
  struct Incarnation;  // a process and the memory shared with it

  void start();
  void start_when_due() noexcept;
  void look_if_ready() noexcept;
  void ask(const Snapshot& snapshot, const CommandSender& commands) noexcept;
  void wait_for_answer(CommandSender& commands) noexcept;
  bool take_answer(CommandSender& commands) noexcept;
  void bury(const std::string& why, bool alive) noexcept;
  void give_up_order() noexcept;
  void stay_down(const std::string& why) noexcept;
  void say(BehaviorLog::Severity severity, const std::string& text) noexcept;

  Settings settings_;
  BehaviorLog& log_;
  RestartPolicy policy_;
  std::unique_ptr<Incarnation> child_;
  Phase phase_ = Phase::starting;
  std::uint64_t fingerprint_ = 0;
  std::optional<SafePosture> safe_;
  ChildAnswer answer_;
  std::optional<std::vector<std::byte>> kept_{std::in_place};  // empty: it has not ticked yet
  PlayStatus play_;
  std::deque<BehaviorStatus> behaviors_;
  std::deque<std::vector<std::byte>> orders_;
  WallClock clock_;

  std::int64_t now_ns_ = 0;         // of the engine's clock
  std::int64_t start_due_ns_ = 0;   // the same
  std::int64_t died_ns_ = -1;       // the same; -1: it lives
  std::uint32_t number_ = 0;        // of the last request
  bool asked_ = false;              // and it has not been answered
  bool asked_order_ = false;        // with the oldest order
  std::uint32_t order_deaths_ = 0;  // before an answer to it
  std::int64_t asked_wall_ns_ = 0, asked_for_ns_ = 0;
  std::uint32_t asked_sequence_ = 0;
  std::uint64_t takeovers_ = 0;
  TickStatistics outage_, answer_cost_;
};

}  // namespace kadans
