// Plays behaviors. Each lane plays a list, one behavior after the other, as long as they end with "done"; several lanes
// play at the same time, in their order within a tick. Every behavior has a Lua state of its own, so one that fails
// stops its lane and nothing else; what it moved goes to the safe posture.
//
// Files are read again between ticks: at times given beforehand, so that a run repeats, or when somebody saved them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kadans/engine/behavior_host.h"
#include "kadans/script/behavior.h"
#include "kadans/script/file_watch.h"
#include "kadans/script/safe_posture.h"

namespace kadans {

struct ScriptPlay {
  std::filesystem::path file;
  std::uint32_t lane = 0;
};

// At this time a behavior goes on with the text of another file.
struct ScriptReload {
  std::int64_t at_ns = 0;
  std::string behavior;  // its name
  std::filesystem::path file;
};

class ScriptHost final : public BehaviorHost {
 public:
  struct Settings {
    std::filesystem::path root;    // of the project
    std::vector<ScriptPlay> play;  // in order
    std::uint64_t seed = 1;
    ScriptLimits limits{};
    std::vector<std::string> feet{"left", "right"};
    std::vector<ScriptReload> reloads{};  // in any order
    SafePosture::Settings safe{};
  };
  // Loads all behaviors; throws InputError with every file's problems. Catalog and log must outlive the host.
  ScriptHost(const Settings& settings, const Catalog& catalog, BehaviorLog& log);
  ~ScriptHost() override;

  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;
  // Behavior thread: stops what plays; each leaves its states.
  void stop(const Snapshot& snapshot, CommandSender& commands) noexcept;

  // Before the loop. Reloads what somebody saves; throws std::runtime_error when nothing can be watched.
  void watch();
  // Before the loop. Declares the signals behavior.<name>.*; a name that plays twice gets a number.
  void declare_signals(SignalTable& signals) const;
  bool in_safe_posture() const noexcept { return safe_.moved(); }  // sent there after a failure

  bool finished() const noexcept;  // every lane is at its end, or stopped
  // In the order of Settings::play.
  std::size_t size() const noexcept { return behaviors_.size(); }
  Behavior& behavior(std::size_t index) noexcept { return *behaviors_[index].behavior; }
  const Behavior& behavior(std::size_t index) const noexcept { return *behaviors_[index].behavior; }

 private:
  struct Played {
    std::unique_ptr<Behavior> behavior;
    std::uint32_t lane = 0;
    bool over = false;
  };
  void play(Played& played, const Snapshot& snapshot, CommandSender& commands) noexcept;
  void report_failure(const Behavior& behavior, std::int64_t time_ns) noexcept;
  void close_lane(std::uint32_t lane) noexcept;
  void reload(const Snapshot& snapshot, CommandSender& commands) noexcept;
  void watch_folders();
  bool plays_with(std::uint32_t object) const noexcept;

  BehaviorLog& log_;
  std::vector<Played> behaviors_;
  std::filesystem::path root_;
  std::vector<ScriptReload> reloads_;  // by time
  std::size_t reloads_done_ = 0;
  std::unique_ptr<FileWatch> watch_;
  SafePosture safe_;
};

}  // namespace kadans
