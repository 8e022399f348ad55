// The chart of lua_bench.cpp in rFSM, the state machines of the Orocos project, for comparison: the same ten states in
// a ring, in the same LuaJIT with its compiler off, an event every ten steps. KADANS_RFSM names a checkout of
// github.com/kmarkus/rFSM; without it nothing is measured.
//
// rFSM's figure is of rfsm.step alone, called from C. Ours is of a whole behavior tick: snapshot, budget with its hook,
// transaction and collector too.
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <lua.hpp>

#include "report.h"

namespace kadans::bench {
namespace {

const char program[] = R"(
local root = ...
package.path = root .. "/src/?.lua;" .. root .. "/src/?/init.lua;" .. package.path
local rfsm = require "rfsm"
local silent = function() end
local chart = { dbg = silent, info = silent, warn = silent }
for i = 0, 9 do chart["s" .. i] = rfsm.state {} end
chart[1] = rfsm.transition { src = "initial", tgt = "s0" }
for i = 0, 9 do chart[i + 2] = rfsm.transition { src = "s" .. i, tgt = "s" .. (i + 1) % 10, events = { "next" } } end
local fsm = rfsm.init(rfsm.state(chart))
rfsm.run(fsm)
return function() rfsm.step(fsm) end, function() rfsm.send_events(fsm, "next") end, function() return fsm._act_leaf._fqn end
)";

struct Close {
  void operator()(lua_State* state) const { lua_close(state); }
};
using State = std::unique_ptr<lua_State, Close>;

void call(lua_State* state, int index) {
  lua_pushvalue(state, index);
  lua_call(state, 0, 0);
}

}  // namespace

void bench_rfsm(Report& report) {
  const char* root = std::getenv("KADANS_RFSM");  // NOLINT(concurrency-mt-unsafe): before any thread is started
  if (root == nullptr) return;
  const State owner(luaL_newstate());
  lua_State* state = owner.get();
  luaL_openlibs(state);
  luaJIT_setmode(state, 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_OFF);
  if (luaL_loadstring(state, program) != 0 || (lua_pushstring(state, root), lua_pcall(state, 1, 3, 0)) != 0) {
    std::fprintf(stderr, "rFSM is not compared: %s\n", lua_tostring(state, -1));
    return;
  }
  int steps = 0;
  report.add("rfsm_step_ns.still", "rFSM, the same chart: a step without event", time_ns([&] { call(state, 1); }, 100),
             "ns");
  report.add("rfsm_step_ns.event", "rFSM, a transition by an event every 10 steps",
             time_ns(
                 [&] {
                   if (++steps % 10 == 0) call(state, 2);
                   call(state, 1);
                 },
                 100),
             "ns");
}

}  // namespace kadans::bench
