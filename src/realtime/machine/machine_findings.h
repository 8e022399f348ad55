// The parts of the examination of a machine.
#pragma once

#include "realtime/machine/machine.h"

namespace kadans {

inline MachineFinding finding(std::string topic, bool good, std::string is, std::string should, std::string how) {
  return {std::move(topic), good, std::move(is), std::move(should), good ? std::string() : std::move(how)};
}

// What a folder holds, sorted by name; empty when there is no such folder.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

// Governor, idle states, clock source, interrupts.
void add_cpu_findings(const std::filesystem::path& root, std::vector<MachineFinding>& findings);

}  // namespace kadans
