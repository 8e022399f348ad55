// What `kadans behavior check` finds in a behavior without running it: each mistake with its line and what was meant.
#include <doctest/doctest.h>

#include "app/assembly/robot.h"
#include "app/program.h"
#include "script/check/check_behavior.h"

using namespace kadans;

namespace {

struct Mistake {
  std::string code;     // of the file's line 5 on
  std::string message;  // how it begins; "" for none
};

// In `enter` of a state, from line 5 on, with m, s, k and P.
const Mistake in_a_function[] = {
    {"m.postur:move('stand', { time_s = 1 })", "5: m has no 'postur', did you mean 'posture'?"},
    {"m.posture:mov('stand', { time_s = 1 })", "5: a control object has no 'mov', did you mean 'move'?"},
    {"m.posture.move('stand', { time_s = 1 })", "5: call it with a colon: m.posture:move(...)"},
    {"if s.time_s > 99 then\nm.posture:move('stnd', { time_s = 1 }) end",
     "6: unknown pose 'stnd', did you mean 'stand'?"},
    {"m.posture:move('stand')", "5: move needs { time_s = seconds } at the end"},
    {"m.posture:move('stand', { time = 1 })", "5: move has no key 'time', did you mean 'time_s'?"},
    {"m.posture:move({ l_kne = 0.1 }, { time_s = 1 })", "5: 'posture' moves no joint 'l_kne', did you mean 'l_knee'?"},
    {"m.posture:move({\nl_knee = 9 }, { time_s = 1 })", "6: posture.l_knee.position_rad = 9 is outside its range"},
    {"m.posture:set('l_knee.position', 1)", "5: 'posture' has no set-point 'l_knee.position', did you mean"},
    {"m.posture:set('l_knee.position_rad', -9)", "5: posture.l_knee.position_rad = -9 is outside its range"},
    {"m.posture:set_parameter('l_knee.kp_Nm_per_rd', 1)",
     "5: 'posture' has no parameter 'l_knee.kp_Nm_per_rd', did you"},
    {"m.posture:set_parameter('l_knee.kp_Nm_per_rad', -1)",
     "5: posture.l_knee.kp_Nm_per_rad = -1 is outside its range"},
    {"m.posture:set_gains 'stif'", "5: 'posture' has no gains 'stif', did you mean 'stiff'?"},
    {"local p = m.posture\np:set_gains('stif')", "6: 'posture' has no gains 'stif', did you mean 'stiff'?"},
    {"local x = s.joints.l_kne.position_rad", "5: s.joints has no 'l_kne', did you mean 'l_knee'?"},
    {"local x = s.joints.l_knee.position", "5: s.joints.l_knee has no 'position', did you mean 'position_rad'?"},
    {"local x = s.base.pitch", "5: s.base has no 'pitch', did you mean 'pitch_rad'?"},
    {"local j = s.joints\nprint(j.l_knee.angle_rad)", "6: s.joints.l_knee has no 'angle_rad'"},
    {"local x = s.bse", "5: s has no 'bse', did you mean 'base'?"},
    {"m.tries = 1", "5: m is read-only: 'tries' cannot be set; keep it in m.vars"},
    {"s.base.pitch_rad = 1", "5: s is read-only: 'pitch_rad' cannot be set"},
    {"print(m.vars.tires)", "5: m.vars has no 'tires', did you mean 'tries'?: declare it in vars = { }"},
    {"print(P.settle)", "5: k.params has no 'settle', did you mean 'settle_s'?"},
    {"P.settle_s = 1", "5: a behavior does not set its own parameters"},
    {"m:emit 'gogo'", "5: nothing in this behavior waits for the event 'gogo'"},
    {"m:wai(1)", "5: m has no 'wai', did you mean 'wait'?"},
    {"print(k.pose('stnd').l_knee)", "5: unknown pose 'stnd', did you mean 'stand'?"},
    {"print(k.psoe)", "5: kadans has no 'psoe', did you mean 'pose'?"},
    {"print(maths.pi)", "5: unknown name 'maths', did you mean 'math'?"},
    {"count = 1", "5: 'count' would be a global: write local count"},
    {"helper(m, s)", "2: s.base has no 'roll', did you mean 'roll_rad'?"},
    {"m.vars.tries = m.vars.tries + 1\nm.vars.new = { 2 }\nprint(m.vars.new, m.args.x, m.time_s, P.settle_s)", ""},
    {"for i, v in ipairs({ 1 }) do print(i, v) end\nrepeat local done = true until done\ngoto out\n::out::", ""},
    {"local a, b = 1, 2\nlocal function f(x, ...) return x + a + b, ... end\nprint(f(1), #s.safety.level, math.pi)",
     ""},
    {"-- s.nothing\nprint('s.nothing', [[m.nothing]])", ""},
    {"local pose = k.pose 'stand'\npose.l_knee = 1\nm.posture:move(pose, { time_s = 1 })", ""},
};

// A whole chart, after `local k = require 'kadans'` in line 1.
const Mistake in_the_chart[] = {
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' { { to = 'b' } },\nk.state 'b' { { after = 0, to = 'a' } } }",
     "3: states 'b' and 'a' lead to each other and take no time: give one of these transitions a condition of its own, "
     "an "
     "event or after > 0"},
    {"return k.behavior 't' {\nk.state 'a' { { when = function() return true end, to = 'a' } } }",
     "3: state 'a' leads to itself and takes no time"},
    {"local function near(s) return s.time_s > 1 end\nreturn k.behavior 't' { initial = 'a',\nk.state 'a' { { when = "
     "near, "
     "to = 'b' } },\nk.state 'b' { { when = near, to = 'a' } } }",
     "4: states 'b' and 'a' lead to each other and take no time while their condition holds"},
    {"local function over(_, m) return m.time_s > 1 end\nreturn k.behavior 't' { initial = 'a',\n"
     "k.state 'a' { { when = over, to = 'b' } },\nk.state 'b' { { when = over, to = 'a' } } }",
     ""},
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' { enter = function(m) m:emit 'go' end,\n{ on = 'go', to = "
     "'b' } },"
     "\nk.state 'b' { enter = function(m)\nm:emit('back')\nend, { on = 'back', to = 'a' } } }",
     "4: states 'b' and 'a' lead to each other and take no time"},
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' { { when = function(s) return s.time_s > 1 end, to = 'b' } "
     "},\n"
     "k.state 'b' { { to = 'a' } } }",
     ""},
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' { enter = function(m) if m.time_s > 1 then m:emit 'go' end "
     "end,\n{ "
     "on = 'go', to = 'b' } },\nk.state 'b' { { to = 'a' } } }",
     ""},
    {"return k.behavior 't' { k.state 'a' { endless = true, enter = function(m) m:emit 'heat.knee' m:emit 'heated' "
     "end,\n"
     "{ on = { 'heat.*', 'heated' }, action = function() end },\n{ on = 'haet.*', to = 'a' } } }",
     "4: nobody emits an event like 'haet.*' here"},
    {"return k.behavior 't' {\nk.state 'a' { { after = 1, action = function() end } } }",
     "3: state 'a' has no way out: give it a transition, or say endless = true"},
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' { { after = 1, to = 'b' } },\nk.state 'b' {} }",
     "4: state 'b' has no way out: give it a transition, or say endless = true"},
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' { { after = 1, to = 'a' } },\nk.state 'b' { { to = 'a' } } }",
     "4: state 'b' is never entered: no transition leads to it"},
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' { { after = 1, to = 'b' } },\nk.final 'b' {} }",
     "4: final 'b' does not say how it ended: outcome = \"done\"?"},
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' {\n{ to = 'b' },\n{ after = 1, to = 'c' } },\n"
     "k.final 'b' { outcome = 'done' }, k.final 'c' { outcome = 'failed' } }",
     "5: this transition is never looked at: the one before it, to 'b', is always taken"},
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' {\n{ on = 'run.done', to = 'b' } },\n"
     "k.final 'b' { outcome = 'done' } }",
     "4: state 'a' waits for \"run.done\", but it has no run"},
    {"return k.behavior 't' { vars = { n = 0 },\nk.state 'a' {\n"
     "{ when = function(s, m) m.vars.n = 1 return true end, to = 'a' } } }",
     "4: a guard writes: 'm.vars.n' must not change while it is asked"},
    {"local n = 0\nlocal function count() n = n + 1 return n > 3 end\nreturn k.behavior 't' {\n"
     "k.state 'a' { { when = count, to = 'a' } } }",
     "3: a guard writes: 'n' must not change while it is asked"},
    {"local function act(m)\nm.posture:set_gains('soft') end\nreturn k.behavior 't' {\n"
     "k.state 'a' { { when = function(_, m) act(m) return true end, to = 'a' } } }",
     "3: a guard acts: 'set_gains' belongs into enter, during, run or action"},
    {"return k.behavior 't' { k.state 'a' { endless = true } }", ""},
    {"return k.behavior 't' { initial = 'p', k.parallel 'p' {\nk.region 'x' { k.state 'a' {} },\n"
     "k.region 'y' { k.state 'b' {} }, { after = 1, to = 'q' } },\nk.final 'q' { outcome = 'done' } }",
     ""},
};

class Checked {
 public:
  Checked() : robot_(read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json")), system_(make_control_system(robot_)) {}
  // The problems of this text as a file, one a line, without the file's name.
  std::string problems(const std::string& text) const {
    const auto folder = program::fresh_folder("check");
    std::filesystem::create_directories(folder / "behaviors/lib");
    program::write(folder / "behaviors/t.lua", text);
    std::string all;
    for (const InputProblem& problem : check_behavior(folder, "behaviors/t.lua", system_->catalog)) {
      const std::string full = problem.text();
      all += full.substr(full.find(':') + 1) + "\n";
    }
    return all;
  }

 private:
  Robot robot_;
  std::unique_ptr<ControlSystem> system_;
};

void compare(const std::string& found, const Mistake& mistake) {
  INFO(mistake.code);
  INFO(found);
  CHECK(found.substr(0, mistake.message.empty() ? std::string::npos : mistake.message.size()) == mistake.message);
}

}  // namespace

TEST_CASE("behavior check finds unknown names and values out of range in any branch of any function") {
  const Checked checked;
  for (const Mistake& mistake : in_a_function) {
    const std::string text =
        "local k = require 'kadans' local P = k.params { settle_s = 1 }\n" +
        std::string(mistake.code.starts_with("helper") ? "local function helper(_, t) return t.base.roll end\n"
                                                       : "\n") +
        "return k.behavior 't' { controls = 'posture', vars = { tries = 0 }, k.state 'a' {\n"
        "endless = true, enter = function(m, s)\n" +
        mistake.code + "\nend } }\n";
    compare(checked.problems(text), mistake);
  }
}

TEST_CASE("behavior check finds states that nothing leads to or out of, and guards that write or act") {
  const Checked checked;
  for (const Mistake& mistake : in_the_chart)
    compare(checked.problems("local k = require 'kadans'\n" + mistake.code), mistake);
}

TEST_CASE("behavior check tells everything that is wrong at once and exits 2, the shipped behaviors are clean") {
  const auto project = program::project_copy("behavior_check");
  CHECK(program::run("behavior check behaviors/tulip/squat.lua", project).exit_code == 0);
  REQUIRE(program::edit(project / "behaviors/tulip/squat.lua", "m.posture:set_gains(\"stiff\")",
                        "m.posture:set_gains(\"stif\")"));
  REQUIRE(program::edit(project / "behaviors/tulip/squat.lua", "m:wait(P.hold_s)", "m:wait(P.hold)"));
  const auto outcome = program::run("behavior check behaviors/tulip/squat.lua", project);
  CHECK(outcome.exit_code == 2);
  CHECK(
      program::has(outcome.err, "behaviors/tulip/squat.lua:33: 'posture' has no gains 'stif', did you mean 'stiff'?"));
  CHECK(program::has(outcome.err, "behaviors/tulip/squat.lua:41: k.params has no 'hold', did you mean 'hold_s'?"));
}
