#include "machine.h"

#include <algorithm>
#include <system_error>

#include "realtime/machine/machine_findings.h"
#include "realtime/machine/system_file.h"
#include "rights.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

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
