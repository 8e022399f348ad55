#include "behavior_status.h"

#include <algorithm>

namespace kadans {

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

std::string BehaviorStatus::declare_numbered(SignalTable& signals, const std::string& name) const {
  std::string free = name;
  for (int number = 2; signals.find("behavior." + free + ".state"); ++number)
    free = name + "_" + std::to_string(number);
  const std::string prefix = "behavior." + free + ".";
  signals.add({prefix + "heap_bytes", "B", "Memory of the behavior's Lua state."}, &heap_bytes);
  signals.add({prefix + "instructions", "", "Lua instructions of its last tick, in steps of a thousand."},
              &instructions);
  signals.add({prefix + "gc_pause_ns", "ns", "Pause of the collector after its last tick; 0 in virtual time."},
              &gc_pause_ns);
  signals.add({prefix + "state", "", "Number of its innermost active state; 0: the behavior itself."}, &state);
  for (std::size_t i = 0; i < region_paths.size(); ++i) {
    signals.add({prefix + "region." + region_paths[i], "", "Number of the region's innermost active state; 0: none."},
                &regions[i]);
  }
  signals.add({prefix + "reloads", "", "New versions taken since the start."}, &reloads);
  return free;
}

bool BehaviorStatus::is_region_path(std::string_view path) noexcept {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  };
  return !path.empty() && path.size() <= region_path_max && path.front() != '.' && path.back() != '.' &&
         path.find("..") == std::string_view::npos && std::ranges::all_of(path, fits);
}

}  // namespace kadans
