#include <algorithm>
#include <cctype>
#include <set>
#include <system_error>

#include "machine_findings.h"
#include "system_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

const fs::path cpu_folder = "sys/devices/system/cpu";

bool is_number(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

// cpu0, cpu1, ...
std::vector<fs::path> cpus(const fs::path& root) {
  std::vector<fs::path> all = entries_of(root / cpu_folder);
  std::erase_if(all, [](const fs::path& entry) {
    const std::string name = entry.filename().string();
    return !name.starts_with("cpu") || !is_number(name.substr(3));
  });
  return all;
}

// "0-2,5": 0, 1, 2, 5.
std::set<int> cpu_list(const std::string& text) {
  std::set<int> all;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    const auto dash = part.find('-');
    const auto first = static_cast<int>(number_in(part));
    const int last = dash == std::string::npos ? first : static_cast<int>(number_in(part.substr(dash + 1)));
    for (int cpu = first; cpu <= last && is_number(part.substr(0, 1)); ++cpu) all.insert(cpu);
    at = end + 1;
  }
  return all;
}

MachineFinding governor(const fs::path& root) {
  std::set<std::string> governors;
  for (const fs::path& cpu : cpus(root)) {
    const std::string name = first_line_of(cpu / "cpufreq/scaling_governor");
    if (!name.empty()) governors.insert(name);
  }
  std::string is = governors.empty() ? "no frequency scaling" : "";
  for (const std::string& name : governors) is += (is.empty() ? "" : ", ") + name;
  const bool good = governors.empty() || governors == std::set<std::string>{"performance"};
  return finding("governor", good, is, "performance",
                 "cpupower frequency-set -g performance, or write it to cpu*/cpufreq/scaling_governor");
}

// The exit latency of the deepest state that is not disabled.
MachineFinding idle_states(const fs::path& root) {
  constexpr std::uint64_t enough_us = 10;
  std::uint64_t deepest_us = 0;
  for (const fs::path& cpu : cpus(root)) {
    for (const fs::path& state : entries_of(cpu / "cpuidle")) {
      if (first_line_of(state / "disable") == "1") continue;
      deepest_us = std::max(deepest_us, number_in(first_line_of(state / "latency")));
    }
  }
  return finding("idle states", deepest_us <= enough_us,
                 deepest_us == 0 ? "none that the kernel chooses" : "as deep as " + std::to_string(deepest_us) + " us",
                 "at most " + std::to_string(enough_us) + " us to wake",
                 "processor.max_cstate=1 intel_idle.max_cstate=0 on the kernel's command line; kadans run holds "
                 "/dev/cpu_dma_latency at 0 while it runs, where it may");
}

MachineFinding clock_source(const fs::path& root) {
  const std::string name = first_line_of(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  const std::set<std::string> fast{"tsc", "kvm-clock", "arch_sys_counter", "hyperv_clocksource_tsc_page"};
  return finding("clock source", fast.contains(name), name.empty() ? "unknown" : name, "tsc",
                 "clocksource=tsc tsc=reliable on the kernel's command line, if the processor's counter is invariant: "
                 "others cost a system call or a slow read each time");
}

MachineFinding interrupts(const fs::path& root) {
  const int cpu = real_time_cpu(root);
  const std::string name = "CPU " + std::to_string(cpu);
  if (cpus(root).size() < 2) return finding("interrupts", true, "one CPU: they cannot go elsewhere", "threaded", "");
  std::size_t all = 0, here = 0;
  for (const fs::path& interrupt : entries_of(root / "proc/irq")) {
    const std::string effective = first_line_of(interrupt / "effective_affinity_list");
    const std::string list = effective.empty() ? first_line_of(interrupt / "smp_affinity_list") : effective;
    if (list.empty()) continue;
    ++all;
    here += cpu_list(list).contains(cpu) ? 1U : 0U;
  }
  return finding("interrupts", here == 0, std::to_string(here) + " of " + std::to_string(all) + " go to " + name,
                 "none go to " + name + ", where the control thread runs",
                 "irqaffinity=0 isolcpus=" + std::to_string(cpu) +
                     " on the kernel's command line, or write the other " +
                     "CPUs to /proc/irq/*/smp_affinity_list; stop irqbalance");
}

}  // namespace

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) entries.push_back(entry.path());
  std::ranges::sort(entries);
  return entries;
}

int real_time_cpu(const fs::path& root) {
  const std::set<int> isolated = cpu_list(first_line_of(root / cpu_folder / "isolated"));
  if (!isolated.empty()) return *isolated.begin();
  const std::set<int> online = cpu_list(first_line_of(root / cpu_folder / "online"));
  return online.empty() ? 0 : *online.rbegin();
}

void add_cpu_findings(const fs::path& root, std::vector<MachineFinding>& findings) {
  findings.insert(findings.end(), {governor(root), idle_states(root), clock_source(root), interrupts(root)});
}

}  // namespace kadans
