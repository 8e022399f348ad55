// Plays behaviors: a list (play_list.h) that the supervisor can extend, replace, pause and stop. Every behavior has a
// Lua state of its own, so a failure stops only the behavior's lane; the objects that it moved go to the safe posture.
//
// Orders take effect at the beginning of a tick. Events are orders given beforehand with a time, so that a run repeats;
// other orders come while it runs. The files of an order are loaded first, so a wrong list is refused as a whole and
// nothing moves. A list whose control sets share a joint with those of another lane is refused, too. Files are read
// again when an order says so, or when somebody has saved them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/behavior_inputs.h"
#include "engine/behavior_log.h"
#include "event_delivery.h"
#include "file_watch.h"
#include "pause.h"
#include "safe_posture.h"
#include "script/bindings/signal_expressions.h"
#include "served_host.h"

namespace kadans {

// The states of a chart, each with the signal of the region that it is in, by which conditions know them; not those in
// regions that have no signal. `name`: that of its signals.
void add_signal_states(const Chart& chart, const std::string& name, const SignalTable& signals,
                       std::vector<SignalState>& to);

class ScriptHost final : public ServedHost {
 public:
  struct Event {
    std::int64_t at_ns = 0;
    PlayOrder order;
  };
  struct Settings {
    std::filesystem::path root;  // of the project
    std::vector<PlayItem> play;  // with absolute files, or files relative to the root
    std::uint64_t seed = 1;
    ScriptLimits limits{};
    std::vector<Event> events{};  // in any order
    std::vector<PlayItem>
        ordered_later{};  // lists that orders will bring: loaded once, to find what is wrong with them
    SafePosture::Settings safe{};
    std::vector<InputEvent> inputs{};
    // Bytes from keep() of another process's host: the host plays these instead of `play` and continues where that one
    // ended. They are read in the constructor and in the first tick.
    std::span<const std::byte> kept{};
    std::string (*describe)(const ScriptHost* host) = nullptr;  // the charts for viewers
  };
  // Loads all behaviors, also those of events. Throws InputError with the problems of all files. `catalog` and `log`
  // must outlive the host.
  ScriptHost(const Settings& settings, const Catalog& catalog, BehaviorLog& log);
  ~ScriptHost() override;

  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;
  void prepare(const Snapshot& newest) noexcept override;
  // Throws InputError for a wrong file or argument, a clash of control sets, an unknown behavior, and an event that
  // nobody who plays can take.
  void order(const PlayOrder& order) override;
  // Behavior thread, between ticks: notes commands that another sender has just committed, so that a pause halts their
  // motions, too.
  void note(const Snapshot& snapshot, const CommandSender& commands) noexcept {
    if (inputs_ != nullptr) inputs_->asked(BehaviorInputs::Asked::note, {});
    pause_.note(snapshot, commands);
  }

  // Before the loop: what people ask, and what scripts take from outside of their tick, goes by these.
  void take_inputs_by(BehaviorInputs* inputs) noexcept { inputs_ = inputs; }
  // Before the loop: a debugger hears of every line of all behaviors.
  void watch_lines_by(LineWatch* watch) noexcept { line_watch_ = watch; }
  // In a run that repeats a record: the question that was asked there. False: the bytes are damaged.
  [[nodiscard]] bool repeat_question(std::span<const std::byte> bytes, const Snapshot& snapshot);

  // Behavior thread, between ticks: reports, reasons, charts, and changes of parameters. Throws InputError.
  BehaviorReply reply(const BehaviorQuestion& question, const Snapshot& snapshot) override;
  std::vector<BehaviorReasons> why(const std::string& name, const Snapshot& snapshot) const;

  // Behavior thread, between ticks: writes the state of everything that plays.
  std::string keep(ByteWriter& bytes, std::int64_t time_ns) override;
  const std::string& lost() const noexcept override { return lost_; }

  // Before the loop. From now on saved files are reloaded. Throws std::runtime_error when nothing can be watched.
  void watch();
  // Before the loop. Declares play.* and behavior.<name>.* for all loaded behaviors. A name that plays twice gets a
  // number.
  void declare_signals(SignalTable& signals);
  // The states of these behaviors, for conditions. After declare_signals().
  std::span<const SignalState> signal_states() const noexcept { return signal_states_; }

  // Behavior thread, between ticks.
  void report(PlayReport& report) const noexcept override;

  bool in_safe_posture() const noexcept { return safe_.moved(); }  // the robot was sent there after a failure
  bool paused() const noexcept { return pause_.paused(); }
  bool finished() const noexcept { return list_.over(); }  // every lane has ended
  const PlayStatus& status() const noexcept override { return list_.status(); }
  // Before the loop. Why no behavior that is loaded takes this event; "": one does.
  WrongData wrong_event(const PlayedEvent& event) const;
  std::vector<std::string> names() const;  // names of the loaded behaviors that are still in the list or in events
  // Before the loop. All files that it may read: behaviors with their modules, also those of events, and files that
  // events reload.
  std::vector<std::filesystem::path> files() const;

  // The list: behaviors that play, wait or have played, in order. Behaviors of an event are in it from the event on.
  std::size_t size() const noexcept override { return list_.entries().size(); }
  Behavior& behavior(std::size_t index) noexcept { return *list_.entries()[index].behavior; }
  const Behavior& behavior(std::size_t index) const noexcept override { return *list_.entries()[index].behavior; }
  bool over(std::size_t index) const noexcept { return list_.entries()[index].over; }

 private:
  struct Due {  // an order with its loaded behaviors
    std::int64_t at_ns = 0;
    PlayOrder order;
    std::vector<PlayList::Entry> loaded{};
  };
  void check_ordered_later(std::vector<InputProblem>& problems);
  std::vector<PlayList::Entry> load(const std::vector<PlayItem>& list, bool lasting,
                                    std::vector<InputProblem>& problems);

  void step(PlayList::Entry& entry, const Snapshot& snapshot, CommandSender& commands) noexcept;
  void report_failure(const Behavior& behavior, std::int64_t time_ns) noexcept;
  ObjectMask objects_played_with() const noexcept;
  // Why the loaded behaviors cannot play beside those in the list; "" when they can.
  std::string clash(const std::vector<PlayList::Entry>& loaded) const;
  // Those of the list and of events.
  std::vector<const Behavior*> loaded() const;
  void check_event(const PlayOrder& order);

  std::vector<BehaviorReport> reports() const;
  BehaviorReply set_parameter(const std::string& name, double value);

  std::vector<PlayList::Entry> load_kept(std::vector<InputProblem>& problems);
  void go_on(const Snapshot& snapshot, CommandSender& commands) noexcept;

  void take_orders(const Snapshot& snapshot, CommandSender& commands) noexcept;
  void carry_out(Due& due, const Snapshot& snapshot, CommandSender& commands) noexcept;
  void leave_all(const Snapshot& snapshot, CommandSender& commands) noexcept;
  void begin(std::vector<PlayList::Entry>& entries);
  void reload(const PlayOrder& order, const Snapshot& snapshot, CommandSender& commands) noexcept;
  void reload_saved(const Snapshot& snapshot, CommandSender& commands) noexcept;
  void watch_folders();

  Settings settings_;
  const Catalog& catalog_;
  BehaviorLog& log_;
  PlayList list_;
  Pause pause_;
  std::vector<Due> events_;  // by time
  std::size_t events_done_ = 0;
  std::vector<Due> orders_;  // given since the last tick
  std::unique_ptr<FileWatch> watch_;
  SafePosture safe_;
  EventDelivery delivery_;
  std::vector<SignalState> signal_states_;
  std::string lost_;
  BehaviorInputs* inputs_ = nullptr;
  std::vector<std::filesystem::path> later_files_;  // of what orders will bring
  LineWatch* line_watch_ = nullptr;
};

}  // namespace kadans
