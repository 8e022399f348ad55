// The rights that a process needs to run in real time, and whether it has them: by a capability or by a limit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kadans/plant/plant_type.h"

namespace kadans {

struct Rights {
  bool any_priority = false;           // CAP_SYS_NICE
  bool any_memory = false;             // CAP_IPC_LOCK
  std::uint64_t priority_max = 0;      // RLIMIT_RTPRIO
  std::uint64_t locked_bytes_max = 0;  // RLIMIT_MEMLOCK; UINT64_MAX: unlimited

  bool priority(int wanted) const noexcept { return any_priority || priority_max >= static_cast<unsigned>(wanted); }
  bool memory() const noexcept { return any_memory || locked_bytes_max == UINT64_MAX; }
};

// Of this process, from proc/self below `root`. What cannot be read counts as missing.
Rights read_rights(const std::filesystem::path& root);

extern const char* const how_to_get_priority;
extern const char* const how_to_lock_memory;

// One line for each right that is missing: which, and how to get it.
std::vector<std::string> missing_rights(const Rights& rights, int priority);

// Examines whether a machine can keep a 1 kHz loop: each finding says what is, what it should be and how to change it.
// Everything is read from /proc and /sys, so that any machine can be examined from a copy of these.
using MachineFinding = PlantType::Finding;  // `how` is "" when it is good

// `root` stands for "/"; `folder` is where records would go.
std::vector<MachineFinding> examine_machine(const std::filesystem::path& root, const std::filesystem::path& folder);

// The CPU that real-time threads go to: the first that the kernel was told to isolate, else the last.
int real_time_cpu(const std::filesystem::path& root);

}  // namespace kadans
