#include "realtime/machine/machine.h"

#include <algorithm>
#include <fstream>

#include <doctest/doctest.h>
#include <unistd.h>

using namespace kadans;
namespace fs = std::filesystem;

namespace {

// A tree of /proc and /sys that tells of a machine as it should be.
class Machine {
 public:
  Machine() : root_(fs::temp_directory_path() / ("kadans_machine_" + std::to_string(getpid()))) {
    fs::remove_all(root_);
    put("proc/version", "Linux version 6.1.0-18-rt-amd64 (x) #1 SMP PREEMPT_RT Debian 6.1.76-1\n");
    put("proc/sys/kernel/osrelease", "6.1.0-18-rt-amd64\n");
    put("proc/cpuinfo", "flags\t\t: fpu tsc constant_tsc\n");
    put("proc/self/limits",
        "Limit                     Soft Limit           Hard Limit           Units     \n"
        "Max locked memory         unlimited            unlimited            bytes     \n"
        "Max realtime priority     95                   95                             \n");
    put("proc/self/status", "Name:\tkadans\nCapEff:\t0000000000000000\n");
    put("proc/sys/kernel/sched_rt_runtime_us", "950000\n");
    put("proc/sys/kernel/sched_rt_period_us", "1000000\n");
    put("proc/sys/kernel/nmi_watchdog", "0\n");
    put("proc/swaps", "Filename\tType\tSize\tUsed\tPriority\n");
    put("proc/irq/24/smp_affinity_list", "0\n");
    put("sys/devices/system/cpu/online", "0-1\n");
    put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
    for (const char* cpu : {"cpu0", "cpu1"}) {
      put(std::string("sys/devices/system/cpu/") + cpu + "/cpufreq/scaling_governor", "performance\n");
      put(std::string("sys/devices/system/cpu/") + cpu + "/cpuidle/state0/latency", "2\n");
    }
  }
  ~Machine() { fs::remove_all(root_); }
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  void put(const std::string& file, const std::string& text) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  MachineFinding look(const std::string& topic) const {
    const std::vector<MachineFinding> all = examine_machine(root_, root_);
    const auto found = std::ranges::find(all, topic, &MachineFinding::topic);
    REQUIRE(found != all.end());
    return *found;
  }
  const fs::path& root() const { return root_; }

 private:
  fs::path root_;
};

}  // namespace

TEST_CASE("A machine as it should be gives nothing to change") {
  const Machine machine;
  for (const MachineFinding& finding : examine_machine(machine.root(), machine.root())) {
    if (finding.topic == "disk") continue;  // the free room is this machine's
    CHECK_MESSAGE(finding.good, finding.topic);
    CHECK(finding.how.empty());
  }
}

TEST_CASE("Each thing that is in the way is found, with what is, what should be and how to change it") {
  struct Wrong {
    const char* topic;
    const char* file;
    const char* text;
    const char* is;
  };
  for (const Wrong& wrong : {
           Wrong{"kernel", "proc/version", "Linux version 6.1.0 #1 SMP PREEMPT_DYNAMIC Debian", "PREEMPT_DYNAMIC"},
           Wrong{"governor", "sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave\n", "powersave"},
           Wrong{"idle states", "sys/devices/system/cpu/cpu1/cpuidle/state3/latency", "133\n", "133 us"},
           Wrong{"clock source", "sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet\n", "hpet"},
           Wrong{"interrupts", "proc/irq/25/smp_affinity_list", "0-1\n", "1 of 2"},
           Wrong{"real-time priority", "proc/self/limits", "Max realtime priority     0    0\n", "at most 0"},
           Wrong{"memory lock", "proc/self/limits", "Max locked memory     8388608    8388608\n", "8192 kB"},
           Wrong{"real-time throttling", "proc/sys/kernel/sched_rt_runtime_us", "-1\n", "off"},
           Wrong{"NMI watchdog", "proc/sys/kernel/nmi_watchdog", "1\n", "on"},
           Wrong{"sessions", "proc/sys/kernel/sched_autogroup_enabled", "1\n", "evenly"},
           Wrong{"hypervisor", "proc/cpuinfo", "flags : fpu hypervisor lahf_lm\n", "virtual"},
           Wrong{"swap", "proc/swaps", "Filename Type\n/dev/sda2 partition\n", "1 in use"},
           Wrong{"disk", "sys/block/sda/queue/rotational", "1\n", "sda"},
       }) {
    CAPTURE(wrong.topic);
    Machine machine;
    machine.put("sys/block/sda/size", "1000\n");
    machine.put(wrong.file, wrong.text);
    const MachineFinding finding = machine.look(wrong.topic);
    CHECK_FALSE(finding.good);
    CHECK(finding.is.find(wrong.is) != std::string::npos);
    CHECK_FALSE(finding.should.empty());
    CHECK_FALSE(finding.how.empty());
  }
}

TEST_CASE("Files that are not there are no reason to fail") {
  const fs::path nowhere = "/nonexistent/kadans";
  CHECK(examine_machine(nowhere, nowhere).size() == 13);
  CHECK(real_time_cpu(nowhere) == 0);
}

TEST_CASE("The real-time CPU is an isolated one, else the last") {
  Machine machine;
  CHECK(real_time_cpu(machine.root()) == 1);
  machine.put("sys/devices/system/cpu/online", "0-7\n");
  machine.put("sys/devices/system/cpu/isolated", "2-3,6\n");
  CHECK(real_time_cpu(machine.root()) == 2);
}

TEST_CASE("Rights come from a capability or from a limit, and what is missing says how to get it") {
  Machine machine;
  CHECK(missing_rights(read_rights(machine.root()), 90).empty());
  machine.put("proc/self/limits", "Max locked memory  65536 65536\nMax realtime priority  10 10\n");
  const auto missing = missing_rights(read_rights(machine.root()), 90);
  REQUIRE(missing.size() == 2);
  CHECK(missing[0].find("LimitRTPRIO=95") != std::string::npos);
  CHECK(missing[1].find("64 kB") != std::string::npos);
  machine.put("proc/self/status", "CapEff:\t0000000000804000\n");
  CHECK(missing_rights(read_rights(machine.root()), 90).empty());
}
