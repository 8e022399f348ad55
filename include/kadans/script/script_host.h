// Plays behaviors: a list (play_list.h) that the supervisor can lengthen, replace, pause and stop. Every behavior has a
// Lua state of its own, so one that fails stops its lane and nothing else; what it moved goes to the safe posture.
//
// Orders take effect at the beginning of a tick: those given beforehand, with a time, so that a run repeats, and those
// that somebody gives meanwhile. What an order names is loaded before it counts, so a wrong list is refused whole and
// nothing moves; so is one whose control sets share a joint with those of another lane. Files are read again when an
// order says so, or when somebody saved them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kadans/config/play_order.h"
#include "kadans/engine/behavior_host.h"
#include "kadans/script/file_watch.h"
#include "kadans/script/pause.h"
#include "kadans/script/play_list.h"
#include "kadans/script/safe_posture.h"

namespace kadans {

class ScriptHost final : public BehaviorHost, public OrderTaker {
 public:
  struct Event {
    std::int64_t at_ns = 0;
    PlayOrder order;
  };
  struct Settings {
    std::filesystem::path root;  // of the project
    std::vector<PlayItem> play;  // files absolute, or from the root
    std::uint64_t seed = 1;
    ScriptLimits limits{};
    std::vector<std::string> feet{"left", "right"};
    std::vector<Event> events{};  // in any order
    SafePosture::Settings safe{};
    // What keep() of another process's host left: plays that in place of `play`, and goes on where it was. Read within
    // the constructor and the first tick.
    std::span<const std::byte> kept{};
  };
  // Loads all behaviors, those of events too; throws InputError with every file's problems. Catalog and log must
  // outlive the host.
  ScriptHost(const Settings& settings, const Catalog& catalog, BehaviorLog& log);
  ~ScriptHost() override;

  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;
  void prepare(const Snapshot& newest) noexcept override;
  // What may be wrong in it: a file, an argument, a behavior that does not play.
  void order(const PlayOrder& order) override;
  // Behavior thread, between ticks: what somebody else has just committed, so that a pause halts its motions too.
  void note(const Snapshot& snapshot, const CommandSender& commands) noexcept { pause_.note(snapshot, commands); }

  // Behavior thread, between ticks: what plays and where it is. "", or why something cannot be kept: nobody can go
  // on with these bytes then.
  std::string keep(ByteWriter& bytes, std::int64_t time_ns);
  // After the first tick: why it could not go on with what was kept; "" when it did.
  const std::string& lost() const noexcept { return lost_; }

  // Before the loop. Reloads what somebody saves; throws std::runtime_error when nothing can be watched.
  void watch();
  // Before the loop. Declares play.*, and behavior.<name>.* of all that was loaded; a name that plays twice gets a
  // number.
  void declare_signals(SignalTable& signals) const;

  bool in_safe_posture() const noexcept { return safe_.moved(); }  // sent there after a failure
  bool paused() const noexcept { return pause_.paused(); }
  bool finished() const noexcept { return list_.over(); }  // every lane is at its end, or stopped
  const PlayStatus& status() const noexcept { return list_.status(); }
  std::vector<std::string> names() const;  // of what was loaded and is not forgotten
  // All that it may read: behaviors with their modules, those of events and what events reload too. Before the loop.
  std::vector<std::filesystem::path> files() const;

  // What plays, waits or played, in order; what events bring is there from then on.
  std::size_t size() const noexcept { return list_.entries().size(); }
  Behavior& behavior(std::size_t index) noexcept { return *list_.entries()[index].behavior; }
  const Behavior& behavior(std::size_t index) const noexcept { return *list_.entries()[index].behavior; }
  bool over(std::size_t index) const noexcept { return list_.entries()[index].over; }
  std::uint32_t lane(std::size_t index) const noexcept { return list_.entries()[index].lane; }

 private:
  struct Due {  // an order with what it names, loaded
    std::int64_t at_ns = 0;
    PlayOrder order;
    std::vector<PlayList::Entry> loaded{};
  };
  std::vector<PlayList::Entry> load(const std::vector<PlayItem>& list, bool lasting,
                                    std::vector<InputProblem>& problems);

  void step(PlayList::Entry& entry, const Snapshot& snapshot, CommandSender& commands) noexcept;
  void report_failure(const Behavior& behavior, std::int64_t time_ns) noexcept;
  ObjectMask objects_played_with() const noexcept;
  // Why the loaded ones cannot play beside what is there: "" when they can.
  std::string clash(const std::vector<PlayList::Entry>& loaded) const;

  // script_host_keeping.cpp
  std::vector<PlayList::Entry> load_kept(std::vector<InputProblem>& problems);
  void go_on(const Snapshot& snapshot, CommandSender& commands) noexcept;

  // script_host_orders.cpp
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
  std::string lost_;
};

}  // namespace kadans
