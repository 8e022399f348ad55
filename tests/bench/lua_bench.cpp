// Behaviors: what a tick costs when it is hot, and cold, at a real 100 Hz with other work between.
#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <thread>

#include <lua.hpp>
#include <sched.h>

#include "chart_rig.h"
#include "kadans/signal/random.h"
#include "realtime/machine/keep_awake.h"
#include "realtime/machine/machine.h"
#include "report.h"

namespace kadans::bench {
namespace {

// A chain through as many cache lines as a tick touches (269 of data, 211 of code, counted with valgrind's lackey),
// over as many pages: what the machine asks for memory alone, however busy it is.
class Walk {
 public:
  Walk() : lines_(pages * page_lines) {
    std::vector<std::uint32_t> order(lines_.size());
    std::iota(order.begin(), order.end(), 0U);
    RandomStream random(1, "bench.walk");
    for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random.next() % (i + 1)]);
    order.resize(steps);
    for (std::size_t i = 0; i < steps; ++i) lines_[order[i]].next = order[(i + 1) % steps];
    at_ = order[0];
  }
  void go() {
    for (int i = 0; i < steps; ++i) at_ = lines_[at_].next;
    keep(at_);
  }

 private:
  static constexpr int steps = 480, pages = 68, page_lines = 64;
  struct alignas(64) Line {
    std::uint32_t next = 0;
  };
  std::vector<Line> lines_;
  std::uint32_t at_ = 0;
};

// The least that any use of Lua does: C++ refills a table of 14 numbers, a function adds them up; compiler off, no
// hook, no chart, nothing around it.
class BareLua {
 public:
  BareLua() : state_(luaL_newstate()) {
    luaJIT_setmode(state_.get(), 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_OFF);
    lua_createtable(state_.get(), 14, 0);
    (void)luaL_loadstring(state_.get(), "local t, sum = ..., 0 for i = 1, 14 do sum = sum + t[i] end return sum");
  }
  void go() {
    lua_State* const state = state_.get();
    for (int i = 1; i <= 14; ++i) {
      lua_pushnumber(state, 0.1 * i);
      lua_rawseti(state, 1, i);
    }
    lua_pushvalue(state, 2);
    lua_pushvalue(state, 1);
    lua_call(state, 1, 1);
    sum_ = lua_tonumber(state, -1);
    keep(sum_);
    lua_settop(state, 2);
  }

 private:
  struct Close {
    void operator()(lua_State* state) const { lua_close(state); }
  };
  std::unique_ptr<lua_State, Close> state_;
  double sum_ = 0;
};

struct Cold {
  std::vector<double> ticks_ns, walks_ns, bare_ns;
};

// What there is between two ticks: whatever the machine does; the same with 4 MB written before each tick; a thread
// that keeps the CPU from idling, as `kadans run` has one; the thread wakes a little early, prepares the tick and
// spins, as that of `kadans run` does.
enum class Between { asleep, wiped, awake, prepared };
constexpr auto prepare_before = std::chrono::microseconds(100);

// At a real 100 Hz, thirty ticks, walks and calls of bare Lua in turn: what takes the caches takes them from all three.
Cold run_cold(Played& played, Between between) {
  const bool wiped = between == Between::wiped;
  std::unique_ptr<KeepAwake> awake;
  cpu_set_t before, one;
  sched_getaffinity(0, sizeof before, &before);
  if (between == Between::awake) {
    const int cpu = real_time_cpu("/");
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(cpu), &one);
    sched_setaffinity(0, sizeof one, &one);
    awake = std::make_unique<KeepAwake>(cpu);
  }
  Cold cold;
  Walk walk;
  BareLua bare;
  std::vector<char> other(std::size_t{4} << 20);
  auto next = std::chrono::steady_clock::now();
  for (int i = 0; i < 900; ++i) {
    for (std::size_t at = 0; wiped && at < other.size(); at += 64) other[at] = static_cast<char>(other[at] + 1);
    keep(other);
    next += std::chrono::milliseconds(10);
    if (between == Between::prepared) {
      std::this_thread::sleep_until(next - prepare_before);
      if (i / 30 % 3 == 0) played.prepare();
      while (std::chrono::steady_clock::now() < next) __builtin_ia32_pause();
    } else {
      std::this_thread::sleep_until(next);
    }
    const double began = now_ns();
    const int turn = i / 30 % 3;
    turn == 0 ? played.tick() : turn == 1 ? walk.go() : bare.go();
    (turn == 0 ? cold.ticks_ns : turn == 1 ? cold.walks_ns : cold.bare_ns).push_back(now_ns() - began);
  }
  sched_setaffinity(0, sizeof before, &before);
  return cold;
}

void add_cold(Report& report, Played& played, Between between) {
  const auto which = static_cast<std::size_t>(between);
  const std::string key = std::array{".asleep", ".wiped", ".awake", ".prepared"}.at(which);
  const std::string how = std::array{", at a real 100 Hz", ", at a real 100 Hz, 4 MB written before each",
                                     ", at a real 100 Hz, the CPU kept awake as kadans run does",
                                     ", at a real 100 Hz, prepared 0.1 ms before as kadans run does"}
                              .at(which);
  const Cold cold = run_cold(played, between);
  const double tick_ns = median(cold.ticks_ns), walk_ns = median(cold.walks_ns);
  report.add("behavior_cold_ns" + key, "the same" + how, tick_ns, "ns");
  report.add("behavior_cold_min_ns" + key, "  the fastest", *std::ranges::min_element(cold.ticks_ns), "ns");
  report.add("memory_walk_ns" + key, "  a walk over as many cache lines, in turn with it", walk_ns, "ns");
  report.add("behavior_cold_walks" + key, "  tick per walk", tick_ns / walk_ns, "");
  const double bare_ns = median(cold.bare_ns);
  report.add("bare_lua_ns" + key, "  bare Lua: a table of 14 refilled and added up, in turn with it", bare_ns, "ns");
  report.add("behavior_cold_bare_lua" + key, "  tick per bare Lua", tick_ns / bare_ns, "");
}

// Median of a step of this chart with "next" sent before every tenth.
double with_events_ns(Played& played) {
  int ticks = 0;
  return time_ns(
      [&] {
        if (++ticks % 10 == 0) (void)played.behavior->post("next");
        played.tick();
      },
      100);
}

}  // namespace

void bench_lua(Report& report) {
  {
    Played played(ring(0.095, true));
    report.add("behavior_tick_ns", "behavior tick: 10 states, 14 joint readings, hook on, hot",
               time_ns([&] { played.tick(); }, 100), "ns");
    for (const Between between : {Between::asleep, Between::wiped, Between::awake, Between::prepared})
      add_cold(report, played, between);
  }
  Played slow(ring(1e6, false)), every(ring(0.095, false));
  report.add("chart_step_ns.still", "chart of 10 states, nothing to do", time_ns([&] { slow.tick(); }, 100), "ns");
  report.add("chart_step_ns.average", "the same with a transition every 10 ticks", time_ns([&] { every.tick(); }, 100),
             "ns");
  Played sent(ring(0, false, "on = 'next'"));
  report.add("chart_step_ns.event", "the same chart, a transition by an event every 10 ticks", with_events_ns(sent),
             "ns");
  bench_rfsm(report);
}

}  // namespace kadans::bench
