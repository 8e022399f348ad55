// Behaviors: what a tick costs when it is hot, and cold, at a real 100 Hz with other work between.
#include <filesystem>
#include <fstream>
#include <thread>

#include "kadans/script/behavior.h"
#include "report.h"

namespace kadans::bench {
namespace {

class Silence final : public BehaviorLog {
 public:
  void transition(const Transition& /*transition*/) override { ++transitions; }
  void message(std::int64_t /*time_ns*/, Severity /*severity*/, const std::string& /*behavior*/,
               const std::string& text) override {
    last = text;
  }
  std::uint64_t transitions = 0;
  std::string last;
};

// Ten states in a ring; `during` reads 14 joints; every state is left after `ticks` ticks of 10 ms.
std::string ring(double after_s, bool reads) {
  std::string text = "local k = require 'kadans'\nlocal total = 0\n";
  text += "local function look(m, s)\n  local j, sum = s.joints, 0\n";
  for (int i = 0; i < 14; ++i) text += "  sum = sum + j.joint_" + std::to_string(i) + ".position_rad\n";
  text += "  total = sum\nend\nreturn k.behavior 'ring' { initial = 's0', " +
          std::string(reads ? "during = look,\n" : "\n");
  for (int i = 0; i < 10; ++i) {
    text += "k.state 's" + std::to_string(i) + "' { { after = " + std::to_string(after_s) + ", to = 's" +
            std::to_string((i + 1) % 10) + "' } },\n";
  }
  return text + "}\n";
}

struct Played {
  explicit Played(const std::string& text) : folder(std::filesystem::temp_directory_path() / "kadans_lua_bench") {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "ring.lua") << text;
    for (int i = 0; i < 14; ++i) model.joints.push_back({.name = "joint_" + std::to_string(i)});
    catalog.model = &model;
    behavior =
        std::make_unique<Behavior>(Behavior::Settings{.root = folder, .file = folder / "ring.lua"}, catalog, log);
  }
  ~Played() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
  Played(const Played&) = delete;
  Played& operator=(const Played&) = delete;
  void tick() {
    (void)behavior->tick(snapshot, sender);
    snapshot.time_ns += 10'000'000;
  }

  std::filesystem::path folder;
  RobotModel model;
  Catalog catalog;
  Silence log;
  CommandQueue queue;
  CommandSender sender{queue};
  Snapshot snapshot;
  std::unique_ptr<Behavior> behavior;
};

// At a real 100 Hz: whatever the machine does meanwhile takes the caches. With `wiped`, 4 MB are written before each
// tick.
double cold_ns(Played& played, bool wiped) {
  std::vector<double> each;
  std::vector<char> other(std::size_t{4} << 20);
  auto next = std::chrono::steady_clock::now();
  for (int i = 0; i < 300; ++i) {
    for (std::size_t at = 0; wiped && at < other.size(); at += 64) other[at] = static_cast<char>(other[at] + 1);
    keep(other);
    next += std::chrono::milliseconds(10);
    std::this_thread::sleep_until(next);
    const double began = now_ns();
    played.tick();
    each.push_back(now_ns() - began);
  }
  return median(std::move(each));
}

}  // namespace

void bench_behavior(Report& report) {
  {
    Played played(ring(0.095, true));
    report.add("behavior_tick_ns.hot", "behavior tick: 10 states, 14 joint readings, hook on, hot",
               time_ns([&] { played.tick(); }, 100), "ns");
    report.add("behavior_tick_ns.cold", "the same, cold at a real 100 Hz", cold_ns(played, false), "ns");
    report.add("behavior_tick_ns.wiped", "the same, 4 MB written before each", cold_ns(played, true), "ns");
  }
  Played slow(ring(1e6, false)), every(ring(0.095, false));
  report.add("chart_step_ns.still", "chart of 10 states, nothing to do", time_ns([&] { slow.tick(); }, 100), "ns");
  report.add("chart_step_ns.average", "the same with a transition every 10 ticks", time_ns([&] { every.tick(); }, 100),
             "ns");
}

}  // namespace kadans::bench
