// The control tick on the wall clock: what it takes between waking up and having published, on a CPU that works for
// others between two ticks; and what it asks of the system: calls, by name, page faults, heap.
//
// System calls are those that strace sees the thread `control` make, in a run of the program on its own. All of them
// count, also those of the wait and of what comes after the tick: so none between waking up and publishing is missed.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bench/control/chain_rig.h"
#include "kadans/testing/allocation_count.h"
#include "realtime/engine_tasks.h"
#include "realtime/posix_wait.h"
#include "report.h"
#include "telemetry/record/recorder.h"

namespace kadans::bench {
namespace {

namespace fs = std::filesystem;

// A squat on the Bullet model with a record; what the program says on stdout. `tracer` goes before the program.
nlohmann::json squat(const std::string& tracer, int duration_s, const fs::path& folder) {
  const std::string command =
      "cd " KADANS_SOURCE_DIR " && " + tracer +
      " " KADANS_PROGRAM " run config/tulip/robot.json --play squat --soft --no-ctl --duration " +
      std::to_string(duration_s) + " --record " + (folder / "wall.mcap").string() + " --json 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> output(popen(command.c_str(), "r"), pclose);
  if (!output) throw std::runtime_error("cannot start kadans");
  std::string text;
  for (int c = 0; (c = std::fgetc(output.get())) != EOF;) text += static_cast<char>(c);
  if (text.empty()) throw std::runtime_error("no result of: " + command);
  return nlohmann::json::parse(text);
}

// What a call is named in a line "4711 clock_nanosleep(...": empty when the line tells of something else.
std::string call_of(const std::string& rest) {
  const std::size_t bracket = rest.find('(');
  const bool name = bracket != std::string::npos && rest.find_first_of(" <+") > bracket;
  return name ? rest.substr(0, bracket) : "";
}

struct Calls {
  std::map<std::string, double> by_name;
  double ticks = 0;
};

// Of the thread that was named `control`, from its 101st sleep to its last.
Calls calls_of_control(const fs::path& trace) {
  constexpr int warm_up = 100;
  std::ifstream lines(trace);
  std::string named, control, thread, rest;
  std::map<std::string, double> since_sleep;
  Calls calls;
  int sleeps = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream(line) >> thread;
    rest = line.substr(std::min(line.size(), line.find_first_not_of(' ', thread.size())));
    const std::size_t task = rest.find("/task/");
    if (task != std::string::npos && rest.find("/comm\"") != std::string::npos) {
      named = rest.substr(task + 6, rest.find("/comm") - task - 6);
    }
    if (control.empty() && rest.find("\"control\"") != std::string::npos) control = named;
    const std::string name = call_of(rest);
    if (thread != control || name.empty()) continue;
    ++since_sleep[name];
    if (name != "clock_nanosleep") continue;
    if (++sleeps > warm_up) {
      for (const auto& [call, count] : since_sleep) calls.by_name[call] += count;
      ++calls.ticks;
    }
    since_sleep.clear();
  }
  if (calls.ticks == 0) throw std::runtime_error("strace saw no control thread; is it installed (scripts/setup)?");
  return calls;
}

// The control task, and how often its thread goes to the heap in it.
class Counted final : public Task {
 public:
  explicit Counted(ControlTask& task) : task_(task) {}
  bool beat(const Beat& beat) override {
    const kadans::testing::AllocationCount heap;
    const bool goes_on = task_.beat(beat);
    allocations += heap.count();
    return goes_on;
  }
  void prepare() noexcept override {
    const kadans::testing::AllocationCount heap;
    task_.prepare();
    allocations += heap.count();
  }
  long allocations = 0;

 private:
  ControlTask& task_;
};

// The plant's step, after each tick.
class Steps final : public BesideTick {
 public:
  Steps(World& world, std::int64_t period_ns) : world_(world), period_ns_(period_ns) {}
  void beside_tick(std::int64_t /*time_ns*/) override { world_.step(period_ns_); }

 private:
  World& world_;
  std::int64_t period_ns_;
};

struct ChainRun {
  double allocations, page_faults, tick_us, prepare_us;
};

// 14 PID, safety and record on a real-time thread, as kadans run has it.
ChainRun run_chain() {
  constexpr int behavior_ticks = 400;
  constexpr std::int64_t period_ns = 1'000'000;
  ChainRig rig(14, read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json").types);
  Recorder recorder(rig.catalog.signals);
  rig.control.record_to(&recorder);
  Steps steps(rig.plant, period_ns);
  ControlTask task(rig.control, &steps);
  Counted counted(task);
  const std::int64_t origin_ns = PosixWait().now_ns() + period_ns;
  PosixWait wait(default_spin_ns, origin_ns), slow(0, origin_ns);
  const int last_cpu = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)) - 1;
  TaskThread thread({.name = "control", .period_ns = period_ns, .prepare_ns = 25'000, .priority = 90, .cpu = last_cpu},
                    counted, wait);
  thread.start();
  for (int i = 1; i <= behavior_ticks; ++i) {
    slow.until(10 * period_ns * i);
    rig.behaviors.tick(slow.now_ns());
    (void)recorder.drain();
  }
  thread.stop();
  thread.join();
  expect_normal(rig.control);
  return {static_cast<double>(counted.allocations), static_cast<double>(thread.page_faults()),
          1e-3 * task.tick_cost().percentile_ns(0.5), 1e-3 * thread.preparation().percentile_ns(0.5)};
}

}  // namespace

void bench_wall(Report& report) {
  const fs::path folder = fs::temp_directory_path() / ("kadans_wall_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const ChainRun chain = run_chain();
  report.add("wall.chain.tick_us", "14 PID, safety, record on the wall clock: tick, median", chain.tick_us, "us");
  report.add("wall.chain.prepare_us", "the rehearsals before it, in the wait", chain.prepare_us, "us");
  report.add("wall.chain.allocations", "heap allocations in 4,000 of these", chain.allocations, "");
  report.add("wall.chain.page_faults", "page faults after the first 100 of these", chain.page_faults, "");

  const nlohmann::json run = squat("", 10, folder);
  const nlohmann::json& control = run.at("threads").at("control");
  report.add("wall.tulip.tick_us", "TULip squats on Bullet: tick, median", run.at("tick_us").at("p50"), "us");
  report.add("wall.tulip.tick_p99_us", "the same, p99", run.at("tick_us").at("p99"), "us");
  report.add("wall.tulip.prepare_us", "the rehearsals before it", control.at("preparation_us").at("p50"), "us");
  report.add("wall.tulip.page_faults", "page faults of the control thread", control.at("page_faults"), "");

  const fs::path trace = folder / "trace";
  (void)squat("strace -f -o " + trace.string(), 3, folder);
  const Calls calls = calls_of_control(trace);
  for (const auto& [name, count] : calls.by_name) {
    report.add("wall.tulip.calls_per_tick." + name, "system calls a tick: " + name, count / calls.ticks, "");
  }
  report.add("wall.tulip.calls_ticks", "ticks traced", calls.ticks, "");
  fs::remove_all(folder);
}

}  // namespace kadans::bench
