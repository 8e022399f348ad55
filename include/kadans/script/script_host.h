// Plays behaviors. Each lane plays a list, one behavior after the other, as long as they end with "done"; several lanes
// play at the same time, in their order within a tick. Every behavior has a Lua state of its own, so one that fails
// stops its lane and nothing else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kadans/engine/behavior_host.h"
#include "kadans/script/behavior.h"

namespace kadans {

struct ScriptPlay {
  std::filesystem::path file;
  std::uint32_t lane = 0;
};

class ScriptHost final : public BehaviorHost {
 public:
  struct Settings {
    std::filesystem::path root;    // of the project
    std::vector<ScriptPlay> play;  // in order
    std::uint64_t seed = 1;
    ScriptLimits limits{};
    std::vector<std::string> feet{"left", "right"};
  };
  // Loads all behaviors; throws InputError with every file's problems. Catalog and log must outlive the host.
  ScriptHost(const Settings& settings, const Catalog& catalog, BehaviorLog& log);
  ~ScriptHost() override;

  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;
  // Behavior thread: stops what plays; each leaves its states.
  void stop(const Snapshot& snapshot, CommandSender& commands) noexcept;

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

  BehaviorLog& log_;
  std::vector<Played> behaviors_;
};

}  // namespace kadans
