// Plays behaviors, or runs decisions, in a process of their own: the runtime's side. Whatever happens to that process
// (it is killed, crashes, runs out of memory, hangs, writes rubbish), the behavior engine ticks on with its high levels
// and its heartbeat, so the control loop and the control objects hold the robot.
//
// Each tick asks the process for a tick (behavior_link.h) and waits for the answer. On the wall clock it waits for a
// part of the period; a later answer counts in the tick in which it comes. On virtual time, which stands still
// meanwhile, it waits up to patience_ns. The commands of an answer and the state that belongs to them are taken
// together or not at all, and the state is kept here, out of the process's reach. So when the process dies in a tick,
// that tick does not count, and the next process continues where the last complete answer ended: active states, their
// time, vars, the list. A coroutine of `run` begins anew, as after a reload.
//
// Until then the robot holds its last set-points, and motions under way go on to their end. After safe.after_s it moves
// to the safe posture, unless nothing played. A process that dies is started again (RestartPolicy). A process that
// does not answer within patience_ns, or breaks the rules of the link, is killed first. When it dies too often in a
// row, or when its state cannot be kept, it stays down: an error is logged, and the robot stays in its posture.
//
// Behavior thread, or the supervisor's for decisions, except for the constructor and attach(), which are called before
// the threads start.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "behavior_link.h"
#include "config/scenario/play_item.h"
#include "engine/behavior_host.h"
#include "engine/behavior_log.h"
#include "engine/clock.h"
#include "engine/tick/tick_statistics.h"
#include "kadans/control/catalog.h"
#include "realtime/machine/child_process.h"
#include "script/behavior/behavior_status.h"
#include "script/chart/event_queue.h"
#include "script/host/behavior_tables.h"
#include "script/host/play_list.h"
#include "script/host/play_report.h"
#include "script/host/safe_posture.h"

namespace kadans {

// Decides when a process that died is started again: the first time at once, then after growing delays, and no more
// when it dies too often in a row. A process that has answered enough ticks begins a new row. Times are of the engine's
// clock.
class RestartPolicy {
 public:
  struct Settings {
    std::uint32_t deaths_max = 8;         // deaths in a row after which it stays down
    std::uint32_t proved_ticks = 10;      // answered ticks after which the next death is the first of a row
    std::int64_t delay_ns = 100'000'000;  // before the second restart of a row; then twice as long each time
    std::int64_t delay_max_ns = 2'000'000'000;
  };
  explicit RestartPolicy(const Settings& settings) noexcept : settings_(settings) {}

  void answered() noexcept {
    if (++ticks_ == settings_.proved_ticks) in_a_row_ = 0;
  }
  // Returns when to start the next process; nullopt: it stays down.
  std::optional<std::int64_t> died(std::int64_t now_ns) noexcept {
    ticks_ = 0;
    ++deaths_;
    if (++in_a_row_ >= settings_.deaths_max) return std::nullopt;
    std::int64_t delay_ns = in_a_row_ > 1 ? settings_.delay_ns : 0;
    for (std::uint32_t i = 2; i < in_a_row_ && delay_ns < settings_.delay_max_ns; ++i) delay_ns *= 2;
    return now_ns + std::min(delay_ns, settings_.delay_max_ns);
  }
  std::uint32_t in_a_row() const noexcept { return in_a_row_; }
  std::uint64_t deaths() const noexcept { return deaths_; }

 private:
  Settings settings_;
  std::uint32_t in_a_row_ = 0, ticks_ = 0;
  std::uint64_t deaths_ = 0;
};

class ProcessHost final : public BehaviorHost, public OrderTaker {
 public:
  struct Settings {
    std::string program;
    std::vector<std::string> arguments;      // the first is the program's name
    bool time_stands = false;                // virtual time: a tick waits for the process, also when it starts
    std::int64_t answer_ns = 5'000'000;      // how long a tick waits otherwise; this and the next two are wall time
    std::int64_t patience_ns = 300'000'000;  // limit for an answer
    std::int64_t start_patience_ns = 10'000'000'000;  // limit for the start of a process
    RestartPolicy::Settings restart{};
    BehaviorLink::Setup setup{};  // says whether it decides
  };
  // Starts the process. Throws std::system_error. `log` must outlive the host.
  ProcessHost(Settings settings, BehaviorLog& log);
  ~ProcessHost() override;

  // Waits until the process has read its files, and declares the signals of its behaviors. Throws InputError when the
  // process could not read them (it has written the reason to standard error) or read other files than this process.
  // `catalog` must outlive the host. Of decisions there is no safe posture.
  void attach(Catalog& catalog, const SafePosture::Settings& safe);

  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;
  // What is wrong with the order comes with its reply, which nobody reads here. Throws InputError only when the order
  // is too long, when the process is down, and for an event that comes in a pause or finds too many waiting.
  void order(const PlayOrder& order) override { (void)send(order); }
  // The same, and a question. Returns the number by which reply() knows it. An order is carried out by the next process
  // when this one dies; a question is then answered with an error, but a report tells what was known last.
  std::uint32_t ask(const PlayOrder& order);
  std::uint32_t ask(const BehaviorQuestion& question);
  // Once: an order has been carried out, or a question answered. nullopt: not yet.
  std::optional<BehaviorReply> reply(std::uint32_t number);
  void forget(std::uint32_t number) { asked_for_.erase(number); }
  // As a report told them last, each with what is wrong with the process.
  BehaviorReply last_report() const;

  // Of behaviors, after a tick: what plays now; the counts of orders are the caller's.
  void report(PlayReport& plays) const noexcept;
  // Of decisions, before a tick: what plays now. After it: what they ask for and what they took, when answers() has
  // grown. requests() grows in the ticks whose snapshot an answer is about.
  void show(const PlayReport& plays) noexcept { shown_ = plays; }
  std::span<const std::byte> decided() const noexcept { return decided_; }
  std::span<const std::byte> told() const noexcept { return told_; }
  std::uint32_t requests() const noexcept { return number_; }
  std::uint64_t answers() const noexcept { return answers_; }
  // What they ask for breaks the rules: the process is killed and replaced.
  void end_for_rubbish() noexcept { bury("it wrote rubbish", true); }

  bool down() const noexcept { return phase_ == Phase::down; }
  std::uint64_t deaths() const noexcept { return policy_.deaths(); }
  std::uint64_t takeovers() const noexcept { return takeovers_; }
  // Time from a death to the next answer, by the engine's clock.
  const TickStatistics& outage() const noexcept { return outage_; }
  const TickStatistics& answer_cost() const noexcept { return answer_cost_; }  // time from request to answer, wall time

 private:
  enum class Phase : std::uint8_t { waiting, starting, playing, down };
  struct Sent {
    std::uint32_t number = 0;
    std::vector<std::byte> bytes;
    bool shares = false;  // a request with others: an event or a question
    bool report = false;  // a question for one
  };
  struct Queue {
    std::deque<Sent> sent;
    std::size_t asked = 0;  // the first of them are in the request
  };
  struct Incarnation;  // a process and the memory shared with it

  void start();
  void start_when_due() noexcept;
  void look_if_ready() noexcept;
  bool paused() const noexcept { return play_.phase.load(std::memory_order_relaxed) == 2; }
  std::uint32_t send(const PlayOrder& order);
  static std::uint32_t put(Queue& queue, std::span<std::byte> request) noexcept;
  bool take_replies();
  void fail(Queue& queue, std::size_t count, const std::string& why);
  void put_parameters(BehaviorLink::Request& request) noexcept;
  void ask(const Snapshot& snapshot, const CommandSender& commands) noexcept;
  void wait_for_answer(CommandSender& commands) noexcept;
  bool take_answer(CommandSender& commands) noexcept;
  void bury(const std::string& why, bool alive) noexcept;
  void give_up_order() noexcept;
  void stay_down(const std::string& why) noexcept;
  void say(BehaviorLog::Severity severity, const std::string& text) noexcept;
  bool decides() const noexcept { return settings_.setup.decides != 0; }
  std::string process_name() const { return decides() ? "the decisions' process" : "the behaviors' process"; }

  Settings settings_;
  BehaviorLog& log_;
  RestartPolicy policy_;
  std::unique_ptr<Incarnation> child_;
  Phase phase_ = Phase::starting;
  std::uint64_t fingerprint_ = 0;
  std::optional<SafePosture> safe_;
  std::optional<std::vector<std::byte>> kept_{std::in_place};  // empty: no answer yet; nullopt: cannot be kept
  PlayStatus play_;
  PlayReport plays_, shown_;
  std::vector<std::byte> decided_, told_;
  std::uint64_t answers_ = 0;
  std::deque<BehaviorStatus> behaviors_;
  Queue orders_, questions_;
  std::uint32_t sent_ = 0;
  std::map<std::uint32_t, std::optional<BehaviorReply>> asked_for_;  // by those who will ask for the reply
  std::vector<BehaviorReport> reported_;
  const Catalog* catalog_ = nullptr;
  struct Foreseen {  // a parameter of an object that foresees
    ParameterId id = 0;
    double sent = 0;  // NaN: this process has not got it
  };
  std::vector<Foreseen> foreseen_;
  bool stopping_ = false;  // the last order was to stop
  WallClock clock_;

  std::int64_t now_ns_ = 0;         // on the engine's clock
  std::int64_t start_due_ns_ = 0;   // on the engine's clock
  std::int64_t died_ns_ = -1;       // on the engine's clock; -1: the process lives
  std::uint32_t number_ = 0;        // of the last request
  bool asked_ = false;              // the last request has not been answered
  std::uint32_t order_deaths_ = 0;  // deaths before that order was answered
  std::int64_t asked_wall_ns_ = 0, asked_for_ns_ = 0;
  std::uint32_t asked_sequence_ = 0;
  std::uint64_t takeovers_ = 0;
  TickStatistics outage_, answer_cost_;
};

}  // namespace kadans
