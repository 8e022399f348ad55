// Mistakes of newcomers with events, arguments and calls: each with its line and what is written here.
#include <algorithm>

#include <doctest/doctest.h>

#include "check_project.h"

using namespace kadans;
using namespace kadans::check_tests;

namespace {

struct EventMistake {
  std::string text;
  std::string message;  // begins behind "t.lua:"
};

const EventMistake events_and_calls[] = {
    {"return k.behavior 't' { args = { n = 1 }, k.state 'a' { endless = true, enter = function()\nprint(args.n) end } "
     "}",
     "3: unknown name 'args': the arguments are a field of m: m.args"},
    {"return k.behavior 't' { k.state 'a' { endless = true, enter = function()\nemit('go') end } }",
     "3: unknown name 'emit': write m:emit(\"name\")"},
    {"return k.behavior 't' { k.state 'a' { endless = true, enter = function()\nk.emit('go') end } }",
     "3: kadans has no 'emit': write m:emit(\"name\")"},
    {"return k.behavior 't' { k.state 'a' { endless = true, enter = function(m)\nm:send('go') end } }",
     "3: m has no 'send', did you mean 'emit'?"},
    {"return k.behavior 't' { k.state 'a' { endless = true, run = function(m)\nm:call('takes') end } }",
     "3: m has no 'call': a state calls a behavior: k.call \"name\" { ... } in its table"},
    {"return k.behavior 't' { k.state 'a' { endless = true, run = function(m)\nm:wait_for('go') end } }",
     "3: m has no 'wait_for': a transition waits for an event: { on = \"name\", to = \"state\" }"},
    {"return k.behavior 't' { k.state 'a' { k.call 'takes',\n"
     "{ on = 'done', when = function(s) return s.event.result.x > 1 end, to = 'a' } } }",
     "3: s.event has no 'result': it is a field of the event's data: s.event.data.result"},
    {"return k.behavior 't' { k.state 'a' { k.call 'takes',\n"
     "{ on = 'done', when = function(s, m) return m.event.data.result.x > 1 end, to = 'a' } } }",
     "3: m has no 'event': it is a field of s: s.event"},
    {"return k.behavior 't' { k.state 'a' { k.call 'takes',\non_done = 'a' } }",
     "3: k.state has no key 'on_done': a transition is a table of its own: { on = \"event\", to = \"state\" }"},
    {"return k.behavior 't' { k.state 'a' {\n{ on_error = 'a' } } }",
     "3: a transition has no key 'on_error': a transition is a table of its own"},
    {"return k.behavior 't' { k.state 'a' {\n{ on = 'go, come', to = 'a' } } }",
     "3: nobody emits the event 'go, come' here: several are a list: on = { \"a\", \"b\" }"},
    {"k.events { seen = {\nwaves = 'bool' } }\nreturn k.behavior 't' { k.state 'a' { { on = 'seen', to = 'a' } } }",
     "3: field 'waves': 'bool' is no unit: write k.flag"},
    {"k.events { seen = {\nwho = 'string' } }\nreturn k.behavior 't' { k.state 'a' { { on = 'seen', to = 'a' } } }",
     "3: field 'who': 'string' is no unit: write k.text"},
    {"k.events { seen = {\nfar = 'number' } }\nreturn k.behavior 't' { k.state 'a' { { on = 'seen', to = 'a' } } }",
     "3: field 'far': 'number' is no unit: write its unit, \"\" for none"},
    {"return k.behavior 't' { args = k.args {\nn = { default = 1, min = 0 } }, k.state 'a' { endless = true } }",
     "3: an argument has no key 'default': it stands first: { 1, min = 0 }"},
    {"return k.behavior 't' { args = k.args {\nside = { 'l', values = { 'l', 'r' } } }, k.state 'a' { endless = true } "
     "}",
     "3: an argument has no key 'values', did you mean 'one_of'?"},
    {"k.events { seen = { far_m = 'm' } }\nreturn k.behavior 't' { k.state 'a' {\n{ when = function(s) return "
     "s.event.data.far_m > 1 end, to = 'a' },\n{ on = 'seen', to = 'a' } } }",
     "4: s.event.data is nil here: only a transition with `on` sees an event"},
    {"k.events { seen = { far_m = 'm' } }\nreturn k.behavior 't' { vars = { far_m = 0 }, k.state 'a' {\n{ after = 1, "
     "action = function(m, s)\nm.vars.far_m = s.event.data.far_m end },\n{ on = 'seen', to = 'a' } } }",
     "5: s.event.data is nil here: only a transition with `on` sees an event"},
    {"return k.behavior 't' { k.state 'a' { run = function() end,\n{ on = 'run.done', when = function(s) return "
     "s.event.data.result > 1 end, to = 'a' } } }",
     "3: s.event.data is nil here: the end of a run brings no data"},
    {"k.events { seen = { far_m = { 'm', optional = true } } }\nreturn k.behavior 't' { k.state 'a' {\n"
     "{ on = 'seen', when = function(s) return s.event.data.far_m > 1 end, to = 'a' } } }",
     "4: s.event.data.far_m may be nil, k.events says optional: test it, or write (s.event.data.far_m or 0)"},
    {"local P = k.params { rest_ms = { 500, min = 0, max = 1000, unit = 'ms' } }\n"
     "return k.behavior 't' { k.state 'a' {\n{ after = P.rest_ms, to = 'a' } } }",
     "4: after takes seconds, and rest_ms is in ms"},
    {"local P = k.params { rest_ms = { 500, min = 0, max = 1000, unit = 'ms' } }\n"
     "return k.behavior 't' { k.state 'a' { endless = true, run = function(m)\nm:wait(P.rest_ms) end } }",
     "4: wait takes seconds, and rest_ms is in ms"},
    {"return k.behavior 't' { k.state 'a' {\n"
     "{ when = function(s) return s.joints.l_knee.position_rad == 0.5 end, to = 'a' } } }",
     "3: s.joints.l_knee.position_rad is measured, it is hardly ever exactly 0.5: compare with < or >"},
    {"return k.behavior 't' { k.state 'a' {\n{ when = function(s) return 0 ~= s.base.pitch_rad end, to = 'a' } } }",
     "3: s.base.pitch_rad is measured, it is hardly ever exactly 0: compare with < or >"},
};

const char* const right_reads[] = {
    "k.events { seen = { far_m = { 'm', optional = true } }, heard = {} }\nreturn k.behavior 't' { k.state 'a' {\n"
    "{ on = 'seen', when = function(s) return (s.event.data.far_m or 0) > 1 end, to = 'a' },\n"
    "{ on = 'seen', when = function(s) return s.event.data.far_m and s.event.data.far_m > 1 end, to = 'a' },\n"
    "{ on = 'heard', when = function(s) return s.event.data and s.event.data.far_m > 1 end, to = 'a' } } }",
    "k.events { seen = { far_m = 'm' } }\nlocal function far(s) return s.event.data.far_m > 1 end\n"
    "local function named(s) return s.event.name == 'seen' and s.event.data.far_m > 1 end\n"
    "return k.behavior 't' { k.state 'a' { { on = 'seen', when = far, to = 'a' }, { when = named, to = 'a' } } }",
    "local P = k.params { rest_ms = { 500, min = 0, max = 1000, unit = 'ms' } }\n"
    "return k.behavior 't' { k.state 'a' { endless = true, run = function(m) m:wait(P.rest_ms / 1000) end } }",
    "return k.behavior 't' { k.state 'a' { { when = function(s)\n"
    "return s.feet.left.force_N == 0 and s.tick ~= 5 and s.joystick.x == 0 end, to = 'a' } } }",
};

}  // namespace

TEST_CASE("events, arguments and calls of other frameworks are told with how they are written here") {
  const Project project;
  for (const EventMistake& one : events_and_calls) {
    CAPTURE(one.text);
    const std::string found = project.problems(one.text);
    CAPTURE(found);
    CHECK(found.starts_with("behaviors/t.lua:" + one.message));
    CHECK(std::count(found.begin(), found.end(), '\n') == 1);
  }
}

TEST_CASE("what is tested first, belongs to an event or is in another unit by intent is no mistake") {
  const Project project;
  for (const char* text : right_reads) {
    CAPTURE(text);
    CHECK(project.problems(text) == "");
  }
}
