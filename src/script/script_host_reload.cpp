#include <algorithm>

#include "kadans/script/script_host.h"

namespace kadans {

void ScriptHost::watch() {
  watch_ = std::make_unique<FileWatch>();
  watch_folders();
}

void ScriptHost::watch_folders() {
  (void)watch_->add(root_ / "behaviors/lib");
  for (const Played& played : behaviors_) {
    for (const std::filesystem::path& file : played.behavior->files()) (void)watch_->add(file.parent_path());
  }
}

void ScriptHost::reload(const Snapshot& snapshot, CommandSender& commands) noexcept {
  for (; reloads_done_ < reloads_.size() && reloads_[reloads_done_].at_ns <= snapshot.time_ns; ++reloads_done_) {
    const ScriptReload& wanted = reloads_[reloads_done_];
    for (Played& played : behaviors_) {
      if (!played.over && played.behavior->name() == wanted.behavior)
        (void)played.behavior->reload(snapshot, commands, wanted.file);
    }
  }
  if (watch_ == nullptr || !watch_->poll()) return;
  for (Played& played : behaviors_) {
    if (!played.over) (void)played.behavior->reload(snapshot, commands);
  }
  watch_folders();  // of modules that are new
}

bool ScriptHost::plays_with(std::uint32_t object) const noexcept {
  return std::any_of(behaviors_.begin(), behaviors_.end(), [object](const Played& played) {
    if (played.over) return false;
    const ControlSetInfo* set = played.behavior->control_set();
    return set == nullptr || std::find(set->objects.begin(), set->objects.end(), object) != set->objects.end();
  });
}

void ScriptHost::declare_signals(SignalTable& signals) const {
  for (const Played& played : behaviors_) {
    std::string name = played.behavior->name();
    for (int number = 2; signals.find("behavior." + name + ".state"); ++number) {
      name = played.behavior->name() + "_" + std::to_string(number);
    }
    played.behavior->status().declare(signals, name);
  }
}

}  // namespace kadans
