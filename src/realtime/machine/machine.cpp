// Examines a machine, and the rights that a process has on it.
#include "machine.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include "signal/number_text.h"

namespace kadans {
namespace {

// "" when it cannot be read
std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// without the blanks at its ends
std::string first_line_of(const std::filesystem::path& file) {
  const std::string text = text_of(file);
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string::npos) return {};
  const std::string line = text.substr(begin, text.find('\n', begin) - begin);
  return line.substr(0, line.find_last_not_of(" \t\r") + 1);
}

// at its beginning; 0 when there is none
std::uint64_t number_in(const std::string& text) {
  std::uint64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

MachineFinding finding(std::string topic, bool good, std::string is, std::string should, std::string how) {
  return {std::move(topic), good, std::move(is), std::move(should), good ? std::string() : std::move(how)};
}

constexpr unsigned cap_ipc_lock = 14, cap_sys_nice = 23;  // linux/capability.h

// "Max realtime priority     95      95      ": the first number behind the name, the soft limit.
std::uint64_t soft_limit(const std::string& limits, const std::string& name) {
  const auto at = limits.find(name);
  if (at == std::string::npos) return 0;
  std::istringstream line(limits.substr(at + name.size(), 40));
  std::string value;
  line >> value;
  return value == "unlimited" ? UINT64_MAX : number_in(value);
}

std::uint64_t effective_capabilities(const std::string& status) {
  const auto at = status.find("CapEff:");
  if (at == std::string::npos) return 0;
  std::istringstream line(status.substr(at + 7, 40));
  std::uint64_t mask = 0;
  line >> std::hex >> mask;
  return mask;
}

}  // namespace

const char* const how_to_get_priority =
    "in /etc/security/limits.d/kadans.conf: '@realtime - rtprio 95', and log in again; in a unit: LimitRTPRIO=95; or "
    "setcap cap_sys_nice,cap_ipc_lock+ep on the program";
const char* const how_to_lock_memory =
    "in /etc/security/limits.d/kadans.conf: '@realtime - memlock unlimited', and log in again; in a unit: "
    "LimitMEMLOCK=infinity; or setcap cap_sys_nice,cap_ipc_lock+ep on the program";

Rights read_rights(const std::filesystem::path& root) {
  const std::string limits = text_of(root / "proc/self/limits");
  const std::uint64_t capabilities = effective_capabilities(text_of(root / "proc/self/status"));
  return {.any_priority = (capabilities >> cap_sys_nice & 1U) != 0,
          .any_memory = (capabilities >> cap_ipc_lock & 1U) != 0,
          .priority_max = soft_limit(limits, "Max realtime priority"),
          .locked_bytes_max = soft_limit(limits, "Max locked memory")};
}

std::vector<std::string> missing_rights(const Rights& rights, int priority) {
  std::vector<std::string> missing;
  if (!rights.priority(priority)) {
    missing.push_back("real-time priority " + std::to_string(priority) + " (this user may have at most " +
                      std::to_string(rights.priority_max) + "): " + how_to_get_priority);
  }
  if (!rights.memory()) {
    missing.push_back("locking all memory (this user may lock " + std::to_string(rights.locked_bytes_max / 1024) +
                      " kB): " + how_to_lock_memory);
  }
  return missing;
}

namespace {

namespace fs = std::filesystem;

const fs::path cpu_folder = "sys/devices/system/cpu";

// What a folder holds, sorted by name; empty when there is no such folder.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) entries.push_back(entry.path());
  std::ranges::sort(entries);
  return entries;
}

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
  const std::string is = governors.empty() ? "no frequency scaling" : listed(governors);
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

// Governor, idle states, clock source, interrupts.
void add_cpu_findings(const fs::path& root, std::vector<MachineFinding>& findings) {
  findings.insert(findings.end(), {governor(root), idle_states(root), clock_source(root), interrupts(root)});
}

}  // namespace

int real_time_cpu(const fs::path& root) {
  const std::set<int> isolated = cpu_list(first_line_of(root / cpu_folder / "isolated"));
  if (!isolated.empty()) return *isolated.begin();
  const std::set<int> online = cpu_list(first_line_of(root / cpu_folder / "online"));
  return online.empty() ? 0 : *online.rbegin();
}

namespace {

constexpr int priority_wanted = 92;

MachineFinding kernel(const fs::path& root) {
  const std::string version = first_line_of(root / "proc/version");
  const bool realtime =
      first_line_of(root / "sys/kernel/realtime") == "1" || version.find("PREEMPT_RT") != std::string::npos;
  const auto preempt = version.find("PREEMPT");
  const std::string kind =
      preempt == std::string::npos ? "no preemption" : version.substr(preempt, version.find(' ', preempt) - preempt);
  const std::string release = first_line_of(root / "proc/sys/kernel/osrelease");
  return finding("kernel", realtime, release + ", " + (realtime ? "PREEMPT_RT" : kind), "PREEMPT_RT",
                 "apt install linux-image-rt-amd64 (i386: linux-image-rt-686-pae), reboot");
}

MachineFinding priority(const Rights& rights) {
  const std::string is = rights.any_priority ? "any (CAP_SYS_NICE)" : "at most " + std::to_string(rights.priority_max);
  return finding("real-time priority", rights.priority(priority_wanted), is,
                 "at least " + std::to_string(priority_wanted), how_to_get_priority);
}

MachineFinding memory(const Rights& rights) {
  const std::string limit = rights.locked_bytes_max == UINT64_MAX
                                ? "unlimited"
                                : "at most " + std::to_string(rights.locked_bytes_max / 1024) + " kB";
  return finding("memory lock", rights.memory(), rights.any_memory ? "any (CAP_IPC_LOCK)" : limit, "unlimited",
                 how_to_lock_memory);
}

MachineFinding throttling(const fs::path& root) {
  const std::string runtime_us = first_line_of(root / "proc/sys/kernel/sched_rt_runtime_us");
  const std::string period_us = first_line_of(root / "proc/sys/kernel/sched_rt_period_us");
  const std::uint64_t runtime = number_in(runtime_us), period = number_in(period_us);
  const bool good = runtime > 0 && runtime < period;
  const std::string is = runtime_us.starts_with('-') ? "off: a real-time thread that hangs takes the machine along"
                                                     : runtime_us + " of " + period_us + " us";
  return finding("real-time throttling", good, is, "950000 of 1000000 us, the last resort",
                 "sysctl kernel.sched_rt_period_us=1000000 kernel.sched_rt_runtime_us=950000");
}

MachineFinding hypervisor(const fs::path& root) {
  const bool virtual_cpu = text_of(root / "proc/cpuinfo").find(" hypervisor") != std::string::npos;
  return finding("hypervisor", !virtual_cpu, virtual_cpu ? "this is a virtual machine" : "none", "none",
                 "measure on the robot's computer: the latencies here are the host's");
}

MachineFinding nmi_watchdog(const fs::path& root) {
  const std::string on = first_line_of(root / "proc/sys/kernel/nmi_watchdog");
  return finding("NMI watchdog", on != "1", on == "1" ? "on" : "off", "off",
                 "sysctl kernel.nmi_watchdog=0, or nmi_watchdog=0 on the kernel's command line");
}

// With it a thread of the idle class is idle within its session only: our keep-awake thread takes its part from others.
MachineFinding sessions(const fs::path& root) {
  const bool grouped = first_line_of(root / "proc/sys/kernel/sched_autogroup_enabled") == "1";
  return finding("sessions", !grouped,
                 grouped ? "share the CPUs evenly, keep-awake threads included" : "are not told apart",
                 "not told apart", "sysctl kernel.sched_autogroup_enabled=0, or kadans run --no-keep-awake");
}

MachineFinding swap(const fs::path& root) {
  const std::string text = text_of(root / "proc/swaps");
  const auto lines = std::ranges::count(text, '\n');
  return finding("swap", lines <= 1, lines <= 1 ? "none" : std::to_string(lines - 1) + " in use", "none",
                 "swapoff -a, and take it out of /etc/fstab: the recorder's memory is not all locked");
}

MachineFinding disk(const fs::path& root, const fs::path& folder) {
  constexpr std::uintmax_t wanted = std::uintmax_t{1} << 30U;
  std::error_code unknown;
  const fs::space_info space = fs::space(folder, unknown);
  std::string spinning;
  for (const fs::path& device : entries_of(root / "sys/block")) {
    const bool counts =
        first_line_of(device / "queue/rotational") == "1" && number_in(first_line_of(device / "size")) > 0;
    const std::string name = device.filename().string();
    if (counts && !name.starts_with("loop") && !name.starts_with("ram"))
      spinning += (spinning.empty() ? "" : ", ") + name;
  }
  const bool room = !unknown && space.available >= wanted;
  std::string is = unknown ? "unknown" : std::to_string(space.available >> 20U) + " MB free for records";
  if (!spinning.empty()) is += ", " + spinning + " may be spinning";
  return finding("disk", room && spinning.empty(), is, "1 GB free, flash",
                 room ? "put records on flash: --record FILE; a slow disk costs rows of the record, never ticks"
                      : "make room, or --record FILE elsewhere; a full disk costs the record, never ticks");
}

}  // namespace

std::vector<MachineFinding> examine_machine(const fs::path& root, const fs::path& folder) {
  const Rights rights = read_rights(root);
  std::vector<MachineFinding> findings{kernel(root)};
  add_cpu_findings(root, findings);
  findings.insert(findings.end(), {priority(rights), memory(rights), throttling(root), nmi_watchdog(root),
                                   sessions(root), hypervisor(root), swap(root), disk(root, folder)});
  return findings;
}

}  // namespace kadans
