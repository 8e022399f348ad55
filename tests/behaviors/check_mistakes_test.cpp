// Mistakes of authors who come from other languages, or mean something else than they write: each with its line and
// what was meant. And beside each kind what looks alike, but is right.
#include <algorithm>

#include <doctest/doctest.h>

#include "check_project.h"

using namespace kadans;
using namespace kadans::check_tests;

namespace {

struct Row {
  std::string text;
  std::string message;  // begins behind "t.lua:"
};

// In `run` of a state, from line 3 on.
const Row syntax_in_run[] = {
    {"if s.time_s != 1 then end", "3: 'then' expected near '!': Lua writes ~= for 'is not'"},
    {"local n = 0\nn += 1", "4: '=' expected near '+': Lua has no +=: write n = n + ..."},
    {"m.vars.n -= 1", "3: '=' expected near '-': Lua has no -=: write m.vars.n = m.vars.n - ..."},
    {"local n = 0\nn++", "4: '=' expected near '+': Lua has no ++: write n = n + 1"},
    {"local n = 0\nn--\nm:wait(n)", "4: '=' expected near 'm': -- begins a comment, Lua has no --: write n = n - 1"},
    {"if s.feet.left.contact && s.feet.right.contact then end", "3: 'then' expected near '&': Lua writes and"},
    {"if s.feet.left.contact || s.feet.right.contact then end", "3: 'then' expected near '|': Lua writes or"},
    {"if !s.feet.left.contact then end", "3: unexpected symbol near '!': Lua writes not"},
    {"local x = s.feet.left.contact ? 1 : 2", "3: unexpected symbol near '?': Lua has no ?: :"},
    {"// comment\nlocal x = 1", "3: unexpected symbol near '/': a comment begins with --"},
    {"# comment\nlocal x = 1", "3: unexpected symbol near '#': a comment begins with --"},
    {"/* comment */", "3: unexpected symbol near '/': a comment begins with --"},
    {"if m.time_s > 1 then\nelse if m.time_s > 2 then\nend",
     "4: unexpected symbol near ',': Lua writes elseif in one word; 'else if' needs one more end"},
    {"if m.time_s > 1 then\nelif m.time_s > 2 then\nend", "4: '=' expected near 'm': Lua writes elseif ... then"},
    {"for i = 1, 3 do\nif i == 2 then continue end\nend",
     "4: '=' expected near 'end': Lua has no continue: put the rest of the loop into an if"},
    {"local x = 1\nif x = 1 then end", "4: 'then' expected near '=': = assigns, == compares"},
    {"if m.time_s > 1:\nm:wait(1)", "3: 'then' expected near ':': Lua writes if ... then ... end, without ':'"},
    {"if (m.time_s > 1) {\nm:wait(1)\n}",
     "3: 'then' expected near 'end': Lua writes if ... then ... end, without braces"},
    {"while true\nm:wait(1)\nend", "3: 'do' expected near 'm': Lua writes while ... do ... end"},
    {"for (i = 1; i < 3; i = i + 1) do end", "3: '<name>' expected near '(': Lua writes for i = 1, n do ... end"},
    {"var x = 1", "3: '=' expected near 'x': Lua writes local x = ..."},
    {"local l = [1, 2]", "3: unexpected symbol near '[': a list is written { 1, 2, 3 }"},
    {"local x = 2 ** 3", "3: unexpected symbol near '*': Lua writes ^ for a power"},
    {"m->wait(1)", "3: '=' expected near '-': Lua writes function(m) ... end, and a.b for a->b"},
    {"m.posture:move \"stand\", { time_s = 1 }",
     "3: unexpected symbol near ',': only one text or table goes without brackets: write move(..., ...)"},
    {"m.posture:move(\"stand\" { time_s = 1 })", "3: ')' expected near '{': a comma is missing behind \"stand\""},
    {"m.posture:move(\"stand\", { time_s = 1 }\nm:wait(1)",
     "3: ')' expected (to close '(' at line 3) near 'm': the '(' is not closed"},
    {"local t = s:time_s",
     "3: function arguments expected near 'end': ':' calls a method with (...), a field is read by"},
    {"local t = { print {}, \"x\" {} }", "3: '}' expected near '{': a comma is missing behind \"x\""},
    {"k.log.info(\"up)", "3: unfinished string near '\"up)': the quotes of a text close in its line"},
    {"m:wait(1) end", "4: '}' expected (to close '{' at line 2) near 'end': there is one end too many"},
};

// A whole chart, from line 2 on.
const Row syntax_in_chart[] = {
    {"return k.behavior 't' { initial = 'a',\nk.state 'a' { { after = 1, to = 'z' } }\nk.final 'z' {} }",
     "3: '}' expected (to close '{' at line 2) near 'k': a comma is missing behind }"},
    {"return k.behavior 't' { k.state 'a' {\n{ after = 1 to = 'a' } } }",
     "3: '}' expected near 'to': a comma is missing behind 1"},
    {"return k.behavior 't' { k.state 'a' {\nenter = function(m) end\n{ after = 1, to = 'a' } } }",
     "3: '}' expected (to close '{' at line 2) near '{': a comma is missing behind end"},
    {"return k.behavior 't' { k.state 'a' {\n{ after: 1, to: 'a' } } }",
     "3: '<name>' expected near '1': a table is written { after = value }"},
    {"return k.behavior 't' { k.state 'a' {\n{ \"after\" = 1, to = 'a' } } }",
     "3: '}' expected near '=': a table is written { after = value }"},
    {"return k.behavior 't' { k.state 'a' {\nenter = (m) => m.posture:hold() } }",
     "3: '}' expected (to close '{' at line 2) near '=': Lua writes function(m) ... end"},
    {"return k.behavior 't' { k.state 'a' {\nenter = function(m): m.posture:hold() end } }",
     "3: unexpected symbol near ':': Lua writes function(m) ... end, without ':'"},
    {"return k.behavior 't' { k.state 'a' {\nenter = function(m) { m.posture:hold() } } }",
     "3: unexpected symbol near '{': Lua writes function(m) ... end, without braces"},
    {"return k.behavior 't' { k.state 'a' {\nfunction enter(m) m.posture:hold() end } }",
     "3: '(' expected near 'enter': in a table write enter = function(m) ... end"},
    {"return k.behavior 't' { k.state 'a' {\nenter = function(m) m.posture:hold(), { after = 1, to = 'a' } } }",
     "3: unexpected symbol near ',': the 'function' of line 3 has no end"},
    {"return k.behavior 't' {\n  k.state 'a' {\n    run = function(m)\n      if m.time_s > 1 then\n        m:wait(1)\n"
     "    end,\n  },\n}",
     "7: unexpected symbol near ',': the 'if' of line 5 has no end"},
    {"return k.behavior 't' {\n  k.state 'a' {\n    { after = 1, to = 'a' }\n}\n",
     "3: '}' expected (to close '{' at line 2) near '<eof>': the '{' of line 3 is not closed"},
    {"return k.behavior 't' { k.state 'a' {\n{ when = function(s) return s.time_s = 5 end, to = 'a' } } }",
     "3: 'end' expected near '=': = assigns, == compares"},
    {"return k.behavior 't' { k.state 'a' {\n{ when = function(s) s.time_s > 5 end, to = 'a' } } }",
     "3: '=' expected near '>': a condition alone does nothing: return it, or ask it by if"},
    {"return k.behavior 't' { k.state 'a' { endless = true } }\nlocal function go() end",
     "3: '<eof>' expected near 'local': return ends the file: what it uses stands above it"},
    {"return k.behavior 't' {\nlocal x = 1,\nk.state 'a' { endless = true } }",
     "3: unexpected symbol near 'local': statements stand in functions, or above the table"},
    {"def go(m)\nend\nreturn {}", "2: '=' expected near 'go': Lua writes local function f(m) ... end"},
    {"import arms\nreturn {}", "2: '=' expected near 'arms': Lua writes local name = require \"name\""},
};

const Row names_in_run[] = {
    {"if s.joystick == null then end", "3: unknown name 'null': Lua writes nil"},
    {"local x = True", "3: unknown name 'True': Lua writes true"},
    {"self.posture:hold()", "3: unknown name 'self': the functions of a state get m and s"},
    {"sleep(1)", "3: unknown name 'sleep': write m:wait(seconds) inside run, or a transition with after"},
    {"local t = os.clock()", "3: unknown name 'os': the time is m.time_s, since the state was entered, or s.time_s"},
    {"local f = io.open('x')", "3: unknown name 'io': a behavior opens no files"},
    {"printf('x')", "3: unknown name 'printf': write k.log.info(format, ...) or print(...)"},
    {"local x = sin(1)", "3: unknown name 'sin': it is a field of math"},
    {"local x = radians(45)", "3: unknown name 'radians': write math.rad(degrees)"},
    {"local x = math.PI", "3: math has no 'PI', did you mean 'pi'?"},
    {"switch (m.time_s) {}", "3: unknown name 'switch': Lua has no switch"},
    {"posture:hold()", "3: unknown name 'posture': it is a field of m: m.posture"},
    {"if base.tilt_rad > 1 then end", "3: unknown name 'base': it is a field of s: s.base"},
    {"local x = vars.n", "3: unknown name 'vars': it is a field of m: m.vars"},
    {"s.posture:hold()", "3: s has no 'posture'; the order is (m, s) in enter"},
    {"if m.base.tilt_rad > 1 then end", "3: m has no 'base'; the order is (m, s) in enter"},
};

const Row in_chart[] = {
    {"return k.behavior 't' { k.state 'a' {\n{ after = 1, to = a } } }",
     "3: unknown name 'a': a name is a text: to = \"a\""},
    {"return k.behavior 't' { k.state 'a' {\n{ when = s.time_s > 1, to = 'a' } } }",
     "3: unknown name 's': only functions have it: function(s, m) in when"},
    {"return k.behavior 't' { controls = 'posture', k.state 'a' {\nenter = m.posture:hold(), endless = true } }",
     "3: unknown name 'm': only functions have it: function(m, s) in enter"},
    {"local function up(s) return s.time_s > 1 end\nreturn k.behavior 't' { k.state 'a' { { when = up(), to = 'a' } } "
     "}",
     "2: attempt to index local 's' (a nil value): this function is called while the file is loaded"},
    {"local P = k.params { t = { 1 } }\nif P.t > 1 then end\nreturn {}",
     "3: attempt to compare number with userdata: a parameter has its value when the behavior runs"},
    {"local P = k.params { t = 1 }\nreturn k.behavior 't' { k.state 'a' {\n{ when = P.t, to = 'a' } } }",
     "4: 'when' must be a function, not a parameter: ask it in a function"},
    {"return k.behavior 't' { k.state 'a' {\nendless = 'true' } }",
     "3: 'endless' must be a boolean, not a string: true has no quotes"},
    {"return k.behavior 't' { k.state 'a' {\n{ event = 'x', to = 'a' } } }",
     "3: a transition has no key 'event', did you mean 'on'?"},
    {"return k.behavior 't' { k.state 'a' {\n{ after = 1, target = 'a' } } }",
     "3: a transition has no key 'target', did you mean 'to'?"},
    {"return k.behavior 't' { k.state 'a' {\n{ guard = function() return true end, to = 'a' } } }",
     "3: a transition has no key 'guard', did you mean 'when'?"},
    {"return k.behavior 't' { k.state 'a' {\n{ timeout = 1, to = 'a' } } }",
     "3: a transition has no key 'timeout', did you mean 'after'?"},
    {"return k.behavior 't' { k.state 'a' { endless = true,\non_entry = function(m) end } }",
     "3: k.state has no key 'on_entry', did you mean 'enter'?"},
    {"return k.behavior 't' { k.state 'a' { endless = true,\nupdate = function(m) end } }",
     "3: k.state has no key 'update', did you mean 'during'?"},
    {"return k.behavior 't' { k.state 'a' {\ntransitions = { { after = 1, to = 'a' } } } }",
     "3: k.state has no key 'transitions': states and transitions stand directly in the table"},
    {"return k.behavior 't' {\nstates = { k.state 'a' { endless = true } } }",
     "3: k.behavior has no key 'states': states and transitions stand directly in the table"},
    {"return k.behavior 't' { initial = 'a', k.state 'a' { { after = 1, to = 'z' } },\n"
     "k.final 'z' { outcome = 'done', { after = 1, to = 'a' } } }",
     "3: a k.final is an end: no transition leaves it, and no state is in it"},
    {"return k.behavior 't' { initial = 'a',\nalways = { when = function(s) return s.time_s > 5 end, to = 'a' },\n"
     "k.state 'a' { endless = true } }",
     "3: 'always' is a list of transitions: always = { { when = ... } }"},
    {"return k.behavior('t', {\nk.state 'a' { endless = true } })",
     "2: k.behavior \"t\" { ... } takes its table behind the name, without a comma"},
    {"return k.behavior 't' { k.state 'a' { endless = true,\ncontrols = { posture = true } } }",
     "3: 'controls' is a list of 1..32 names of control sets, not of 0: controls = { \"legs\", \"arms\" }"},
    {"return k.behavior 't' { initial = 'a', k.state 'a' { { after = 1, to = 'a' } }\n{ after = 1, to = 'a' } }",
     "3: only k.call takes arguments, in a table { ... }; is a comma missing before this table?"},
    {"return k.behavior 't' { k.state 'a' { run = function(m) m:wait(1) end,\n{ on = 'run_done', to = 'a' } } }",
     "3: nobody emits the event 'run_done' here, did you mean 'run.done'?"},
    {"return k.behavior 't' { k.state 'a' { run = function(m) m:wait(1) end,\n{ on = 'done', to = 'a' } } }",
     "3: nothing in 'a' ends with 'done'; there is: run.done"},
    {"local P = k.params {\nt = { 1, min = 3, max = 0 } }\nreturn {}",
     "3: parameter 't': min = 3 is greater than max = 0"},
    {"local arms = require 'arm'\nreturn k.behavior 't' { k.state 'a' { endless = true } }",
     "2: no module 'arm': it is neither \"kadans\", nor beside this script, nor in behaviors/lib, did you mean "
     "'arms'?"},
    {"return k.behavior 't' { k.state 'a' { endless = true,\nenter = function() end,\nenter = function() end } }",
     "4: 'enter' stands twice in this table: the one in line 3 is lost"},
    {"return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true, during = function(m)\n"
     "m.posture:move('squat', { time_s = 1 }) end } }",
     "3: during begins this move anew in each tick, so that it never arrives: move in enter, or use follow(...)"},
    {"local count = 0\nreturn k.behavior 't' { k.state 'a' { enter = function()\ncount = count + 1 end,\n"
     "{ after = 1, to = 'a' } } }",
     "4: 'count' is a local of the file, which a reload forgets: keep it in vars = { count = 0 } as m.vars.count"},
    {"return k.behavior 't' { k.state 'a' { endless = true, enter = function(m)\nm.vars.n = 1 end } }",
     "3: m.vars has no 'n': declare it in vars = { }"},
    {"return k.behavior 't' { vars = { count = 0 }, k.state 'a' { endless = true, enter = function(m)\n"
     "m.vars.cuont = m.vars.cuont + 1 end } }",
     "3: m.vars has no 'cuont', did you mean 'count'?: declare it in vars = { }"},
    {"return k.behavior 't' { k.state 'a' { endless = true, enter = function()\nwhile true do end end } }",
     "3: this loop never ends: nothing changes until it waits"},
};

const Row values_in_run[] = {
    {"m.vars = { n = 1 }", "3: m is read-only: 'vars' cannot be set; give its fields values: m.vars.name = 1"},
    {"m.posture:move_to('stand', { time_s = 1 })", "3: a control object has no 'move_to', did you mean 'move'?"},
    {"m.posture:move('stand', { time_s = '1' })", "3: move: time_s must be a number, without quotes"},
    {"if s.safety.level == 'HOLDING' then end",
     "3: s.safety.level is never \"HOLDING\"; it is normal, limited, hold, damp or off"},
    {"if s.safety.level == 'HOLD' then end", "3: s.safety.level is never \"HOLD\", did you mean 'hold'?; it is normal"},
    {"local level = s.safety.level\nif 'halt' ~= level then end", "4: level is never \"halt\""},
    {"if s.base.posture == 'lying' then end",
     "3: s.base.posture is never \"lying\"; it is upright, prone, supine, left, right or falling"},
    {"if s.safety.level > 1 then end",
     "3: s.safety.level is normal, limited, hold, damp or off, it is compared with a number"},
    {"if s.safety.level > 'hold' then end",
     "3: s.safety.level is normal, limited, hold, damp or off: texts are compared with == or ~="},
    {"if not s.safety.level == 'hold' then end", "3: not binds closer than ==: write s.safety.level ~= ..."},
    {"local a = m.posture:move('stand', { time_s = 1 })\nif a.outcome == 'finished' then end",
     "4: a.outcome is never \"finished\"; it is moving, done, cancelled, queue_full, refused or expired"},
    {"if s.base.height_m < '1' then end", "3: s.base.height_m is a number, it is compared with a text"},
    {"if m.time_s > '1' then end", "3: m.time_s is a number, it is compared with a text"},
    {"if s.feet.left.contact == 1 then end",
     "3: s.feet.left.contact is true or false, it is compared with a number: write s.feet.left.contact or not"},
    {"if s.base.tilt_rad == true then end", "3: s.base.tilt_rad is a number, it is compared with true or false"},
    {"local n = s.feet.left.contact + 1", "3: s.feet.left.contact is true or false, no number"},
    {"k.log.info('x ' .. s.feet.left.contact)",
     "3: s.feet.left.contact is true or false, which .. does not join: write tostring(s.feet.left.contact)"},
    {"k.log.info('x ' .. nil)", "3: .. joins texts and numbers, not nil"},
    {"k.log.info('a' + 'b')", "3: + adds numbers, .. joins texts"},
    {"k.log.info('%d' % 3)", "3: % does not fill a text: write string.format(text, ...)"},
    {"print(s.base.height_m())", "3: s.base.height_m is a value: it stands without brackets"},
    {"for n, j in ipairs(s.joints) do print(n, j) end",
     "3: s.joints goes by names, not by numbers: for name, one in pairs(s.joints) do"},
    {"print(#s.joints)", "3: s.joints goes by names, not by numbers"},
    {"print(s.joints[1])", "3: s.joints goes by names, not by numbers"},
    {"k.log('hi')", "3: k.log is a table: write k.log.info(...), .warning or .error"},
    {"k.log.info('%d %s', 1)", "3: k.log.info: the format wants 2 values, 1 value is given"},
    {"k.log.info('height', s.base.height_m)", "3: k.log.info: the format has places for no value, 1 value is given"},
    {"print(string.format('%d', 'one'))", "3: string.format: %d wants a number, value 1 is none"},
    {"k.log.info('%y', 1)", "3: k.log.info: the format has a '%' that Lua does not know"},
    {"print('x %d', 1)", "3: print writes its values as they are: k.log.info(\"...\", ...) takes a format"},
    {"m.wait(1)", "3: call it with a colon: m:wait(...)"},
    {"m.emit('x')", "3: call it with a colon: m:emit(...)"},
    {"m.posture:move('stand', { time_s = 1 }).wait()", "3: call it with a colon: move(...):wait()"},
    {"local a = m.posture:move('stand', { time_s = 1 })\na.wait()", "4: call it with a colon: a:wait()"},
    {"m:wait('1')", "3: m:wait takes seconds, a number without quotes: m:wait(1)"},
    {"m:wait(-1)", "3: m:wait takes seconds >= 0"},
    {"m:wait()", "3: m:wait needs seconds: m:wait(1)"},
    {"local a = m.posture:move('stand', { time_s = 1 })\nm:wait(a)",
     "4: m:wait takes seconds; a motion waits for itself: a:wait()"},
    {"m.posture:move({ l_knee = 45 }, { time_s = 1 })",
     "3: posture.l_knee.position_rad = 45 is outside its range 0..2.35 rad; 45 degrees are 0.785 rad"},
    {"m.posture:move('stand', 1):wait()",
     "3: move: the last argument must be a table { ... }, not a number: { time_s = 1 }"},
    {"m.posture:move('stand', { profile = 'trapezoid' }):wait()",
     "3: move: a trapezoid needs time_s, or velocity_max and acceleration_max"},
    {"m.posture:set_gains({ kp = 3 })", "3: set_gains takes the name of gains; one number goes by set_parameter"},
    {"m:on('foot.right.contct', function(c) c.posture:hold() end, { within_s = 1 })", "3: m:on: unknown signal 'foot."},
    {"m:on('feet.right.contact', function(c) c.posture:hold() end, { within_s = 1 })",
     "3: m:on: unknown signal 'feet.right.contact', did you mean 'foot.right.contact'?"},
    {"m:on('foot.right.force_N = 3', function(c) c.posture:hold() end, { within_s = 1 })",
     "3: m:on: a condition compares with < or >, not with ="},
    {"m:on('plant.base.height_m < 0.5', function(c) c.posture:hold() end, { within_s = 1 })",
     "3: m:on: 'plant.base.height_m' is the truth of a simulation, which no robot knows"},
    {"m:on('foot.right.contact', m.posture:hold(), { within_s = 1 })", "3: m:on needs a function that says what to do"},
    {"m:on('foot.right.contact', function(c) c.posture:hold() end)", "3: m:on needs { within_s = seconds } at the end"},
    {"m:on('foot.right.contact', function(c) c:wait(1) end, { within_s = 1 })",
     "3: m:on: the function runs once, when it is armed, and only records what to send: it cannot wait"},
    {"m:on('foot.right.contact', function(c) c.posture:hold() end, { within = 1 })",
     "3: m:on has no option 'within', did you mean 'within_s'?"},
    {"while not s.feet.left.contact do\nend", "3: this loop never ends: nothing changes until it waits"},
    {"while true do\nlocal x = s.base.tilt_rad\nend", "3: this loop never ends: nothing changes until it waits"},
    {"local a = m.posture:move('stand', { time_s = 1 })\nrepeat m.posture:set_gains('soft') until a.done",
     "4: this loop never ends: nothing changes until it waits"},
    {"local down = s.feet.left.contact\nwhile not down do m:wait(0.01) end",
     "4: 'down' was read before the loop and stays the same while it waits: ask s.feet.left.contact in the condition"},
    {"m.posture:move('squat', { time_s = 1 })\nm.posture:move('stand', { time_s = 1 })",
     "3: this move is replaced at once by the one in line 4: wait for it in run, move(...):wait()"},
};

// Looks alike, and is right.
const char* const right_in_run[] = {
    "if m.time_s > 1 then\nelse if m.time_s > 2 then\nend end",
    "local t = { [\"after\"] = 1, to = 2 }\nprint(t)",
    "local null, sleep = nil, print\nsleep(null)",
    "if s.safety.level == 'hold' or 'limited' == s.safety.level or s.safety.level ~= m.args.level then end",
    "if not (s.safety.level == 'hold') and not s.feet.left.contact == s.feet.right.contact then end",
    "if s.feet.left.contact == true or s.feet.left.contact == s.feet.right.contact then end",
    "if s.safety.level .. '!' == 'hold!' or 'x' .. s.safety.level == 'xhold' then end",
    "local level = s.safety.level\nlevel = 'mine'\nif level == 'other' then end",
    "if s.base.height_m * 2 < s.joystick.x + 1 and 1 < s.time_s then end",
    "print(1 + '2', '3' * 4, 'a' .. 1, #'abc', -'1')",
    "print('x ' .. tostring(s.feet.left.contact), s.feet.left.contact and 1 or 0)",
    "for name, joint in pairs(s.joints) do print(name, joint.position_rad) end",
    "k.log.info('100 %')\nk.log.info('%d %%', 3)\nprint('100 %')",
    "local function two() return 1, 2 end\nk.log.info('%d %d', two())\nk.log.info('%s', m.name)",
    "k.log.info('%5.2f %-4d %s %q', s.time_s, 1, true, 'x')\nprint(('%d'):format(1))",
    "m.wait(m, 1)\nlocal w = m.wait\nw(m, 1)",
    "m:wait(1 - 0.5)\nm:wait(m.args.pause or 1)\nm:wait('1' + 1)",
    "local a = m.posture:move('stand', { time_s = 1 })\na.wait(a)",
    "m.posture:move('stand', m.args.how)\nm:wait(1)",
    "local how = { time_s = 1 }\nm.posture:move('stand', how):wait()",
    "m.posture:move({ l_knee = 1 }, { time_s = 1 })\nm.posture:move({ r_knee = 1 }, { time_s = 1 }):wait()",
    "m.posture:move('stand', { time_s = 0 })\nm.posture:move('squat', { time_s = 1 }):wait()",
    "m.posture:move('stand', { time_s = 1 })\nif m.time_s > 1 then m.posture:move('squat', { time_s = 1 }) end",
    "m.posture:move('stand', { time_s = 1 })\nm:wait(0.2)\nm.posture:move('squat', { time_s = 1 }):wait()",
    "m.posture:move('stand', { profile = 'trapezoid', velocity_max_rad_s = 1, acceleration_max_rad_s2 = 4 }):wait()",
    "m:on('not foot.right.contact', function(c) c.posture:hold() end, { within_s = 1, every_time = true })",
    "m:on({ after_s = 0.1 }, function(c) c.posture:hold() end, { within_s = 1 })",
    "local function act(c) c.posture:hold() end\nm:on('foot.right.contact', act, { within_s = 1 })",
    "while true do\nif s.feet.left.contact then break end\nm:wait(0.01)\nend",
    "while true do if s.time_s > 1 then return end print(1) end",
    "local i = 0\nwhile i < 3 do i = i + 1 end",
    "repeat local n = math.random() until n > 0.5",
    "local list = { 1, 2 }\nwhile #list > 0 do table.remove(list) end",
    "local function step() m:wait(1) end\nwhile not s.feet.left.contact do step() end",
    "while not s.feet.left.contact do coroutine.yield() end",
    "local down = s.feet.left.contact\nwhile not down do\nm:wait(0.01)\ndown = s.feet.left.contact\nend",
    "local base = s.feet.left\nwhile not base.contact do m:wait(0.01) end",
    "local quick = s.joystick.button_1\nwhile quick do\nm.posture:move('stand', { time_s = 1 }):wait()\nend",
    "local a = { x = 1, y = 2, { x = 3 }, f = function() local x, y = 1, 2 x = y end }\nprint(a)",
    "repeat print(1) until true\nwhile false do print(1) end",
};

const char* const right_in_chart[] = {
    "return k.behavior 't' { initial = 'a', k.state 'a' { { after = 1, to = 'z' } },\n"
    "k.final 'z' { outcome = 'done', enter = function() print 'over' end } }",
    "return k.behavior('t') { k.state('a')({ endless = true }) }",
    "return k.behavior 't' { always = {}, k.state 'a' { endless = true } }",
    "return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true, during = function(m, s)\n"
    "m.posture:move({ l_knee = 0.1 + 0.1 * s.joystick.x }, { time_s = 0.2 })\n"
    "if m.time_s > 1 then m.posture:move('stand', { time_s = 1 }) end end } }",
    "return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true, during = function(m)\n"
    "if m.time_s > 0.02 then return end\nm.posture:move('stand', { time_s = 1 }) end } }",
    "local later = false\nreturn k.behavior 't' { k.state 'a' { endless = true, enter = function(m)\n"
    "later = m.posture end, exit = function() print(later) end } }",
    "local count = 0\nfor i = 1, 3 do count = count + i end\n"
    "return k.behavior 't' { k.state 'a' { endless = true, enter = function() print(count) end } }",
    "return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true, enter = function(m)\n"
    "m.vars.motion = m.posture:move('stand', { time_s = 1 }) end,\nexit = function(m) print(m.vars.motion) end } }",
    "local to = { stand = 'a' }\nreturn k.behavior 't' { k.state 'a' { { after = 1, to = to.stand } } }",
    "local s, m = 1, 2\nreturn k.behavior 't' { k.state 'a' { { after = s + m, to = 'a' } } }",
};

std::string in_run(const std::string& code) {
  return "return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true, run = function(m, s)\n" + code +
         "\nend, } }";
}

void compare(const Project& project, const Row& row, const std::string& chart) {
  CAPTURE(row.text);
  const std::string found = project.problems(chart);
  CAPTURE(found);
  CHECK(found.starts_with("behaviors/t.lua:" + row.message));
  CHECK(std::count(found.begin(), found.end(), '\n') == 1);
}

}  // namespace

TEST_CASE("a habit of another language is told behind Lua's own message, in the line to change") {
  const Project project;
  for (const Row& row : syntax_in_run) compare(project, row, in_run(row.text));
  for (const Row& row : syntax_in_chart) compare(project, row, row.text);
}

TEST_CASE("names and keys of elsewhere are told with what is written here") {
  const Project project;
  for (const Row& row : names_in_run) compare(project, row, in_run(row.text));
  for (const Row& row : in_chart) compare(project, row, row.text);
}

TEST_CASE("values that cannot be right are told with those that can") {
  const Project project;
  for (const Row& row : values_in_run) compare(project, row, in_run(row.text));
}

TEST_CASE("behavior check leaves alone what looks like a mistake, but is right") {
  const Project project;
  for (const std::string text : right_in_run) {
    CAPTURE(text);
    CHECK(project.problems(in_run(text)) == "");
  }
  for (const std::string text : right_in_chart) {
    CAPTURE(text);
    CHECK(project.problems(text) == "");
  }
}

TEST_CASE("a file that returns a behavior without its table is no module") {
  const Project project;
  CHECK(program::has(
      Project::told(project.script("behaviors/t.lua", "local k = require 'kadans'\nreturn k.behavior 't'\n").problems),
      "behaviors/t.lua:1: returns a k.behavior without its table: return k.behavior \"name\" { ... }"));
  CHECK(project.script("behaviors/t.lua", "return function(m) return m end\n").problems.empty());
}
