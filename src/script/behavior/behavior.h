// One behavior that plays: its file, its Lua state, its chart and the run of the chart.
//
// Loading reads and checks everything and throws InputError before anything has moved. A tick is one transaction. An
// error in a tick stops the behavior: the transaction is dropped, and error() says where and why. After an error in the
// script the states are left with their `exit`, as always. After a breach of the budget nothing of the script runs
// again.
//
// A reload replaces the Lua state by a new one between two ticks; the control engine does not notice. The old version
// writes what it is doing as bytes, and the new one goes on from them; a process that replaces another does the same.
// These are carried over: the active states with their time, waiting events, histories, `vars` (plain data and motions,
// 256 kB in all; another `version` goes through `migrate`, or starts with the declared ones), changed parameters that
// are still in range, and random numbers. Motions under way go on. A coroutine cannot be carried into another Lua
// state, so the `run` of a state that stays begins anew, unless it was over. When the text of all files is the same,
// nothing changes at all. Any failure leaves the old version as it was; the new version's guards are tried against the
// present snapshot, too. An error in the first second of the new version brings back the old version with the vars that
// it had at the swap.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "behavior_status.h"
#include "config/scenario/play_item.h"
#include "engine/behavior_log.h"
#include "engine/transaction.h"
#include "kadans/control/set_partition.h"
#include "kadans/signal/status.h"
#include "script/chart/chart.h"
#include "script/host/play_report.h"
#include "script/host/script_declarations.h"
#include "script/lua/budget.h"
#include "script/lua/script_error.h"

namespace kadans {

class ByteReader;
class ByteWriter;
struct GuardSource;
struct TransitionReason;

class Behavior {
 public:
  struct Settings {
    std::filesystem::path root;  // of the project
    std::filesystem::path file;
    std::uint64_t seed = 1;
    ScriptLimits limits{};
    std::vector<PlayArgument> arguments{};  // for its `args` or its parameters
    std::string source{};                   // where the arguments were written, for messages
    std::string chunk{};                    // name of `file` when it was first read; set by Behavior
    PlayFolders folders{};                  // of a k.decisions: where the behaviors are found that it plays
  };
  // `catalog` and `log` must outlive the behavior. Throws InputError.
  Behavior(const Settings& settings, const Catalog& catalog, BehaviorLog& log);
  ~Behavior();
  Behavior(const Behavior&) = delete;
  Behavior& operator=(const Behavior&) = delete;

  // Behavior thread. False once the behavior is over: finished, or stopped by an error.
  bool tick(const Snapshot& snapshot, CommandSender& commands) noexcept;
  // Behavior thread, shortly before a tick; optional. Brings the memory that the tick will need into the caches.
  // Nothing of the script runs.
  void prepare(const Snapshot& newest) noexcept;
  // Behavior thread: leaves all states, in a transaction of its own.
  void stop(const Snapshot& snapshot, CommandSender& commands) noexcept;
  // Behavior thread, between ticks. Reads the files again and logs the result; the behavior itself is read from `file`
  // when one is given. Afterwards chart() and name() are those of the new version. `elsewhere` are the control sets of
  // other behaviors that play at the same time.
  enum class Reload : std::uint8_t { unchanged, taken, refused };
  Reload reload(const Snapshot& snapshot, CommandSender& commands, const std::filesystem::path& file = {},
                SetMask elsewhere = 0) noexcept;
  const std::string& complaint() const noexcept;  // why the last reload was refused
  std::vector<std::filesystem::path> files() const;
  // Behavior thread, between ticks: writes what a reload would carry over as bytes, for another process that continues
  // where this one ended. Returns "", or why it is impossible: vars hold something that is no plain data.
  std::string keep(ByteWriter& bytes);
  // Before the first tick: continues from bytes of keep(). False: error() says why.
  [[nodiscard]] bool go_on(ByteReader& bytes, const Snapshot& snapshot, CommandSender& commands) noexcept;
  const Settings& settings() const noexcept;  // as they were given, but with the file that was last read
  // Behavior thread, between ticks (behavior_why.h). Throws InputError: the guards cannot be asked.
  std::vector<TransitionReason> why(const Snapshot& snapshot) const;
  std::vector<GuardSource> guards() const;  // of each transition of its chart
  // Behavior thread, between ticks. From now on the chart's clock, which `after`, m.time_s and motions use, is held_ns
  // behind the engine's clock.
  void hold_clock(std::int64_t held_ns) noexcept;

  // Its events that may come from outside, and those of the behaviors that it calls (k.events).
  const std::vector<ScriptEvent>& events() const noexcept;
  // Behavior thread, between ticks. The event waits for the next tick. Returns "", or why it is refused.
  std::string post(const PlayedEvent& event);
  // Whether an active state has a transition for this event.
  bool waits_for(const std::string& event) const noexcept;
  // What it sent to other behaviors in its last tick; the caller takes it.
  std::vector<SentEvent>& sent_events() noexcept;
  // Of a k.decisions: what it asked for in its last tick; the caller takes it.
  std::vector<PlayOrder>& decided() noexcept;
  // Of a k.decisions, before a tick: what plays now. It must live as long as the tick runs.
  void show_plays(const PlayReport* report) noexcept;
  // False: the behavior does not know the event, or its queue is full.
  [[nodiscard]] bool post(const std::string& event) noexcept;

  const std::string& name() const noexcept;
  const Chart& chart() const noexcept;
  bool finished() const noexcept;  // reached a final state
  bool failed() const noexcept;    // error() says why
  std::string result() const;      // once it is finished: that of its final state, { steps = 3 }; "" when it has none
  std::string outcome() const;     // outcome of the final state; "error" when it failed; "" while it runs
  std::string state() const;       // path of the innermost active state; the first when there are several
  // The paths of all innermost active states, in document order; none when it has not begun, is over or failed.
  std::vector<std::string> active() const;
  bool active(StateIndex state) const noexcept;  // of its chart, also one around others
  const ScriptError& error() const noexcept;     // of the last failure
  std::uint64_t transactions_refused() const noexcept;
  std::uint64_t events_unhandled() const noexcept;
  std::size_t heap_bytes() const noexcept;
  const BehaviorStatus& status() const noexcept { return *status_; }
  // Before its first tick: its status is the other one's from now on, which is only destroyed after that. So signals
  // that were declared go on, and states have the numbers that they had.
  void take_place_of(Behavior& other);
  // The control sets of this behavior and of those that it calls, and the objects that they may move (all objects when
  // one of them has no set).
  SetMask control_sets() const noexcept;
  ObjectMask objects() const noexcept;
  std::vector<ScriptParameter> parameters() const;
  std::vector<ScriptArgument> arguments() const;  // of k.args, by name; throws InputError
  // Behavior thread, between ticks. False, and nothing changes, on an unknown name or a value outside its range.
  [[nodiscard]] bool set_parameter(const std::string& name, double value) noexcept;

  struct Parts;
  Parts& parts() noexcept { return *parts_; }  // for a debugger (script/debug)

 private:
  struct Past;  // the earlier version, until the new one has run for a second

  bool take_back(const Snapshot& snapshot, CommandSender& commands) noexcept;
  void swap(std::unique_ptr<Parts> fresh, const Snapshot& snapshot, CommandSender& commands) noexcept;
  Reload refuse(std::int64_t time_ns, const std::string& why) noexcept;
  std::int64_t clock_ns(const Snapshot& snapshot) const noexcept;
  void forget_past(std::int64_t now_ns) noexcept;
  void publish_status() noexcept;
  void tell_active(std::int64_t time_ns) noexcept;
  void number_states();

  std::unique_ptr<Parts> parts_;
  std::unique_ptr<Past> past_;
  std::unique_ptr<BehaviorStatus> status_ = std::make_unique<BehaviorStatus>();
  std::vector<std::string> first_paths_;      // of the states of its first chart; status_ numbers them
  std::vector<std::uint32_t> numbers_;        // by state of another chart: the state of the first one; empty: the same
  std::vector<StateIndex> region_states_;     // in the order of status_->region_paths
  std::vector<StateIndex> told_;              // active states as they were told last
  std::vector<std::string_view> told_paths_;  // of the innermost ones
};

}  // namespace kadans
