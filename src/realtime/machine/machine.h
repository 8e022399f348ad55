// Examines whether a machine can keep a 1 kHz loop: each finding says what is, what it should be and how to change it.
// Everything is read from /proc and /sys, so that any machine can be examined from a copy of these.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kadans {

struct MachineFinding {
  std::string topic;  // "governor"
  bool good = false;
  std::string is;
  std::string should;
  std::string how;  // "" when it is good
};

// `root` stands for "/"; `folder` is where records would go.
std::vector<MachineFinding> examine_machine(const std::filesystem::path& root, const std::filesystem::path& folder);

// The CPU that real-time threads go to: the first that the kernel was told to isolate, else the last.
int real_time_cpu(const std::filesystem::path& root);

}  // namespace kadans
