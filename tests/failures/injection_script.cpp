// Mistakes in a script, wherever a behavior's code runs: guard, enter, during, run.
#include <algorithm>
#include <array>
#include <filesystem>

#include "app/program.h"
#include "injection_run.h"
#include "scenario/run.h"
#include "script/host/script_host.h"

namespace kadans::failures {
namespace {

enum class Kind : std::uint8_t { error, loop, memory, wrong, flood };

struct Mistake {
  Kind kind;
  const char* name;
  const char* code;
};

constexpr std::array mistakes{
    Mistake{Kind::error, "an error", "error('injected')"},
    Mistake{Kind::error, "an index of nil", "local nothing = nil; nothing.field = 1"},
    Mistake{Kind::error, "a call of a number", "local one = 1; one()"},
    Mistake{Kind::error, "an error that is a table", "error({})"},
    Mistake{Kind::loop, "an endless loop", "while true do end"},
    Mistake{Kind::loop, "a loop around pcall", "while true do pcall(function() while true do end end) end"},
    Mistake{Kind::loop, "a loop in a coroutine", "coroutine.wrap(function() while true do end end)()"},
    Mistake{Kind::loop, "tail calls without end", "local function f() return f() end f()"},
    Mistake{Kind::memory, "a table that grows", "local t = {} for i = 1, 1e9 do t[i] = { i } end"},
    Mistake{Kind::memory, "a string that doubles", "local x = 'x' while true do x = x .. x end"},
    Mistake{Kind::memory, "memory under pcall", "local t = {} while true do pcall(function() t[#t + 1] = {} end) end"},
    // The following act, which a guard cannot.
    Mistake{Kind::wrong, "a set-point that is NaN", "m.posture:set('l_hip.position_rad', 0 / 0)"},
    Mistake{Kind::wrong, "an endless set-point", "m.posture:set('l_hip.position_rad', 1 / 0)"},
    Mistake{Kind::wrong, "a set-point out of range", "m.posture:set('l_hip.position_rad', 1.6)"},
    Mistake{Kind::wrong, "a set-point that is a word", "m.posture:set('l_hip.position_rad', 'far')"},
    Mistake{Kind::wrong, "an unknown set-point", "local n = 'l_hop' m.posture:set(n .. '.position_rad', 0)"},
    Mistake{Kind::wrong, "a time that is NaN", "m.posture:set('l_hip.position_rad', 0.1, { time_s = 0 / 0 })"},
    Mistake{Kind::wrong, "a parameter out of range", "m.posture:set_parameter('l_hip.kp_Nm_per_rad', -1)"},
    Mistake{Kind::flood, "a flood", "for i = 1, 600 do m.posture:set('l_hip.position_rad', -1 + 1e-4 * i) end"},
};
constexpr std::size_t without_acting = 11;
constexpr std::array places{"enter", "during", "run", "guard"};
constexpr std::size_t guard = 3;
constexpr int code_line = 9;

std::string behavior(std::size_t place, const std::string& code, double after_s) {
  const std::string open =
      place == guard ? "{ to = \"over\", when = function(s)" : std::string(places[place]) + " = function(m, s)";
  const std::string close = place == guard ? "return false end }," : "end,";
  return "local k = require \"kadans\"\n"
         "return k.behavior \"injected\" {\n"
         "  controls = \"posture\", initial = \"work\",\n"
         "  k.state \"work\" {\n"
         "    enter = function(m) m.posture:move(\"there\", { time_s = 0.3 }) end,\n"
         "    { after = " +
         std::to_string(after_s) +
         ", to = \"bad\" },\n"
         "  },\n"
         "  k.state \"bad\" { " +
         open + "\n" + code + "\n" + close +
         "\n"
         "    { after = 100, to = \"over\" },\n"
         "  },\n"
         "  k.final \"over\" { outcome = \"done\" },\n"
         "}\n";
}

std::filesystem::path write_behavior(const std::string& text) {
  static const std::filesystem::path folder = program::fresh_folder("injection");
  program::write(folder / "injected.lua", text);
  return folder;
}

bool said(const RunLog& log, const std::string& what) {
  return std::ranges::any_of(log.lines(), [&](const LogLine& line) { return program::has(line.text, what); });
}

}  // namespace

void Injection::script() {
  const Mistake& mistake = mistakes[pick(mistakes.size())];
  const bool acts = &mistake >= &mistakes[without_acting];
  const std::size_t place = pick(acts ? guard : guard + 1);
  const double after_s = 0.01 * static_cast<double>(2 + pick(23));
  begin(std::string(mistake.name) + " in " + places[place] + " after " + std::to_string(after_s) + " s");
  RunLog log;
  ScriptHost host({.root = write_behavior(behavior(place, mistake.code, after_s)),
                   .play = {{.file = "injected.lua"}},
                   .seed = seed_,
                   .safe = {.pose = "safe", .after_s = 0.5, .time_s = 0.4}},
                  robot_.catalog, log);
  robot_.play(host);
  const Behavior& played = host.behavior(0);
  const bool stops = mistake.kind != Kind::flood;
  // It begins with the next behavior tick; a state is entered in one, its code has run in the next at the latest.
  const auto due_ticks = static_cast<int>(1000 * after_s) + 10 + 10 + 10;
  robot_.run(due_ticks);
  require(played.failed() == stops, stops ? "the behavior was not stopped" : "the behavior was stopped");
  const ScriptLimits limits;  // the block that passes the limit is granted, and the last
  require(played.heap_bytes() <= limits.memory_bytes + limits.block_bytes, "the behavior has too much memory");
  const std::string line = "injected.lua:" + std::to_string(code_line);
  require(stops ? said(log, line) : said(log, "queue_full"), "the log does not say " + line);
  robot_.run(480 - 20);
  const auto near = [&](double l_hip_rad) { return std::abs(robot_.position_rad(0) - l_hip_rad) < 0.01; };
  require(near(0.4), "the last set-points were not held");
  robot_.run(600);
  require(near(stops ? 0 : 0.4), "the safe posture was not reached");
  require(robot_.control.inbox().state().refused == 0, "a command was sent that had to be refused");
  require(robot_.faults.empty(), "the control loop noticed: " + robot_.codes());
  require_level(robot_.safety.robot_level(), SafetyLevel::normal, "the robot");
  robot_.play_nothing();
}

}  // namespace kadans::failures
