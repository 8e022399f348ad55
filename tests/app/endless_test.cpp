// `while true do end` in every place where an author can put it, under the whole robot: TULip in Bullet.
#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "program.h"

namespace endless_test {

using namespace kadans;

namespace {

const std::string loop = "while true do end";

// Goes down for 0.5 s, then enters `bad`.
std::string goes_down_then(const std::string& bad, const std::string& top = "") {
  return "local k = require 'kadans'\n" + top +
         "return k.behavior 'endless' { controls = 'posture', initial = 'down',\n"
         "k.state 'down' { enter = function(m) m.posture:move('squat', { time_s = 1.5 }) end, { after = 0.5, to = "
         "'bad' "
         "} },\n" +
         bad + " }\n";
}
std::string bad(const std::string& body) { return goes_down_then("k.state 'bad' { " + body + " }"); }

struct Place {
  const char* name;
  std::string text;      // behaviors/tulip/endless.lua
  std::string place;     // file:line of the loop
  std::string module{};  // behaviors/tulip/part.lua
};

const std::string f = "function() " + loop + " end";

// Where it is reached while the robot moves.
const Place in_a_tick[] = {
    {"enter", bad("enter = " + f), "endless.lua:4:"},
    {"exit", bad("exit = " + f + ", { after = 0, to = 'down' }"), "endless.lua:4:"},
    {"during", bad("during = " + f), "endless.lua:4:"},
    {"run", bad("run = " + f), "endless.lua:4:"},
    {"run, after a motion",
     bad("run = function(m)\nm.posture:move('stand', { time_s = 0.5 }):wait()\n" + loop + " end"), "endless.lua:6:"},
    {"a guard that catches", bad("{ when = function() while pcall(" + f + ") do end end, to = 'down' }"),
     "endless.lua:4:"},
    {"the guard of an event", bad("enter = function(m) m:emit 'go' end,\n{ on = 'go', when = " + f + ", to = 'down' }"),
     "endless.lua:5:"},
    {"an action", bad("{ action = " + f + ", to = 'down' }"), "endless.lua:4:"},
    {"an always", bad("always = { { when = " + f + ", to = 'down' } }"), "endless.lua:4:"},
    {"a region",
     goes_down_then("k.parallel 'bad' { k.region 'x' { k.state 'y' {} }, k.region 'z' {\nk.state 'w' { during = " + f +
                    " } } }"),
     "endless.lua:5:"},
    {"a final state", goes_down_then("k.final 'bad' { enter = " + f + " }"), "endless.lua:4:"},
    {"a comparison in a coroutine in a metamethod",
     bad("enter = function() local t = setmetatable({}, { __index = coroutine.wrap(function()\n"
         "table.sort({ 1, 2 }, " +
         f + ") end) }) return t.x end"),
     "endless.lua:5:"},
    {"a behavior that is called", goes_down_then("k.state 'bad' { k.call 'part' }"),
     "part.lua:2:", "local k = require 'kadans'\nreturn k.behavior 'part' { k.state 'a' { enter = " + f + " } }\n"},
    {"a function of a module",
     goes_down_then("k.state 'bad' { enter = function() require('part')() end }", "require 'part'\n"),
     "part.lua:1:", "return " + f + "\n"},
};

// Where it is reached while the file loads: nothing has moved then.
const Place while_loading[] = {
    {"the file", goes_down_then("", loop + "\n"), "endless.lua:2:"},
    {"the parameters",
     goes_down_then("", "k.params(setmetatable({}, { __index = 1 })) k.params { x = (" + f + ")() }\n"),
     "endless.lua:2:"},
    {"the module", goes_down_then("", "require 'part'\n"), "part.lua:1:", loop + "\n"},
    {"the arguments of a call", goes_down_then("k.state 'bad' { k.call 'part' { x = (" + f + ")() } }"),
     "endless.lua:4:", "local k = require 'kadans' return k.behavior 'part' { args = { x = 1 }, k.state 'a' {} }"},
};

std::filesystem::path project(const std::string& name, const Place& place) {
  const auto folder = program::project_copy(name);
  program::write(folder / "behaviors/tulip/endless.lua", place.text);
  if (!place.module.empty()) program::write(folder / "behaviors/tulip/part.lua", place.module);
  CHECK(program::edit(folder / "config/scenarios/squat.json", "behaviors/tulip/squat.lua",
                      "behaviors/tulip/endless.lua"));
  return folder;
}

// Saves another text over the squat while it goes down.
class Editor final : public RunObserver {
 public:
  Editor(std::filesystem::path file, std::string text) : file_(std::move(file)), text_(std::move(text)) {}
  void tick(double time_s, std::span<const double> /*row*/) override {
    if (time_s < 2.0 || done_) return;
    done_ = true;
    program::write(file_.string() + "~", text_);
    std::filesystem::rename(file_.string() + "~", file_);
  }

 private:
  std::filesystem::path file_;
  std::string text_;
  bool done_ = false;
};

struct Played {
  RunLog log;
  RunResult result;
  double height_m = 0, tilt_rad = 0;
  bool safe = false;
};

void play(const std::filesystem::path& folder, double duration_s, Played& played, RunObserver* observer = nullptr) {
  const ScenarioConfig scenario = read_scenario_config(folder / "config/scenarios/squat.json");
  Assembly robot(scenario, 3, played.log);
  if (observer != nullptr) robot.watch_behaviors();
  Checks checks(robot.catalog().signals);
  const RunParts parts = robot.parts();
  std::vector<RunObserver*> observers;
  if (observer != nullptr) observers.push_back(observer);
  played.result = run_scenario(parts, duration_s, checks, observers);
  const auto row = parts.control.row();
  played.height_m = row[robot.catalog().signals.find("plant.base.height_m").value()];
  played.tilt_rad = row[robot.catalog().signals.find("plant.base.tilt_rad").value()];
  played.safe = robot.host().in_safe_posture();
}

void check_stands(const Played& played) {
  CHECK(played.height_m > 0.85);
  CHECK(played.tilt_rad < 0.05);
  CHECK(played.result.faults.empty());
  CHECK(played.result.error == "");
}

}  // namespace

TEST_CASE("An endless loop that a tick reaches is stopped, told with its line, and leaves the robot standing") {
  for (const Place& place : in_a_tick) {
    CAPTURE(place.name);
    Played played;
    play(project("endless", place), 3.2, played);
    REQUIRE(played.log.has_errors());
    const std::string said = played.log.lines().front().text;
    CAPTURE(said);
    CHECK(program::has(said, place.place + " instruction budget exceeded"));
    CHECK(played.safe);
    check_stands(played);
  }
}

TEST_CASE("An endless loop that loading reaches is refused with its line before anything moves") {
  for (const Place& place : while_loading) {
    CAPTURE(place.name);
    const auto folder = project("endless_load", place);
    const program::Outcome outcome = program::run("sim config/scenarios/squat.json --no-record", folder);
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(program::has(outcome.err, place.place + " instruction budget exceeded"));
  }
}

TEST_CASE("An endless loop in a file that is saved over the squat is refused with its line, and the squat goes on") {
  const std::string squat = program::read(KADANS_SOURCE_DIR "/behaviors/tulip/squat.lua");
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = squat;
    return text.replace(text.find(from), from.size(), to);
  };
  const struct {
    const char* name;
    std::string text, line;
  } edits[] = {
      {"the file", loop + "\n" + squat, "squat.lua:1:"},
      {"migrate", replaced("  vars     =", "  version = 2, migrate = " + f + ",\n  vars     ="), "squat.lua:25:"},
      {"a guard that is tried", replaced("return s.safety.level ~= \"normal\" and s.safety.level ~= \"limited\"", loop),
       "squat.lua:"},
  };
  for (const auto& made : edits) {
    CAPTURE(made.name);
    const auto folder = program::project_copy("endless_reload");
    Editor editor(folder / "behaviors/tulip/squat.lua", made.text);
    Played played;
    play(folder, 7, played, &editor);
    REQUIRE(played.log.lines().size() == 1);
    const std::string said = played.log.lines().front().text;
    CAPTURE(said);
    CHECK(program::has(said, "reload refused, the old version goes on"));
    CHECK(program::has(said, made.line));
    CHECK(program::has(said, "instruction budget exceeded"));
    CHECK_FALSE(played.log.has_errors());
    check_stands(played);
  }
}

TEST_CASE("An endless loop outside the tests of a file ends that file with its line, the other files run") {
  const auto folder = program::project_copy("endless_test_file");
  program::write(folder / "behaviors/tulip/endless_test.lua", "describe('x', function()\n" + loop + " end)\n");
  const program::Outcome outcome =
      program::run("behavior test behaviors/tulip/endless_test.lua behaviors/lib/timing_test.lua", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(program::has(outcome.err, "endless_test.lua:2: instruction budget exceeded"));
  CHECK(program::has(outcome.out, "ok      timing"));
}

TEST_CASE("An endless loop in a test of a behavior fails that test, by its name and line, and the others run") {
  const auto folder = program::project_copy("endless_test");
  for (const std::string& text :
       {"it('b', function()\n" + loop + " end)\n",
        "describe('b', function() before_each(function()\n" + loop + " end) it('', function() end) end)\n",
        std::string("it('b', function() local run = k.play 'squat.lua'\nwhile true do run:advance(1) end end)\n"),
        std::string("it('b', function() local run = k.play 'squat.lua'\nwhile true do run:advance(0) end end)\n"),
        "it('b', function() local ok\nrepeat ok = pcall(function() " + loop + " end) until false end)\n"}) {
    CAPTURE(text);
    program::write(folder / "behaviors/tulip/endless_test.lua",
                   "local k = require 'kadans' it('a', function() end) " + text + "it('c', function() end)\n");
    const program::Outcome outcome = program::run("behavior test behaviors/tulip/endless_test.lua", folder);
    CAPTURE(outcome.out);
    CHECK(outcome.exit_code == 1);
    CHECK(program::has(outcome.out, "  ok      a\n"));
    CHECK(program::has(outcome.out, "  FAILED  b"));
    CHECK(program::has(outcome.out, "endless_test.lua:2: stopped, for it did not come to an end"));
    CHECK(program::has(outcome.out, "  ok      c\n"));
    CHECK(program::has(outcome.out, "2 passed, 1 failed"));
  }
}

}  // namespace endless_test
