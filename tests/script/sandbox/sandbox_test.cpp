// No way out: what a script must not reach, and what it must not change.
#include <doctest/doctest.h>

#include "script/fixture.h"

using namespace kadans::script_test;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a script sees no name that leads out of the sandbox") {
  for (const char* name : {"io", "os", "debug", "ffi", "jit", "package", "getfenv", "setfenv", "newproxy", "loadfile",
                           "dofile", "loadstring", "collectgarbage", "next", "module", "gcinfo"}) {
    CAPTURE(name);
    CHECK(contains(output_of(std::string("print(") + name + ")"), std::string("unknown name '") + name + "'"));
    CHECK(contains(output_of(std::string("print(_G['") + name + "'])"), "unknown name"));
  }
}

TEST_CASE("require finds no library of the host") {
  for (const char* name :
       {"ffi", "jit", "io", "os", "debug", "string.buffer", "table.new", "jit.opt", "../secret", "/etc/passwd"}) {
    CAPTURE(name);
    CHECK(contains(load_error(std::string("require '") + name + "'"), "no module"));
  }
}

TEST_CASE("require finds files beside the script and in behaviors/lib, each loaded once, and nothing elsewhere") {
  Stage stage(on_enter("print('x')"));
  stage.scripts.write("behaviors/near.lua", "return { n = 1 }");
  stage.scripts.write("behaviors/lib/far.lua", "return { n = 2 }");
  stage.scripts.write("other/hidden.lua", "return { n = 3 }");
  const auto play = [&](const std::string& text) {
    kadans::Behavior loaded({.root = stage.scripts.root, .file = stage.scripts.write("behaviors/main.lua", text)},
                            stage.robot.catalog, stage.log);
  };
  play(
      "local k = require 'kadans' local a, b = require 'near', require 'far' assert(a.n + b.n == 3)\n"
      "assert(require 'near' == a) return k.behavior 'x' { k.state 'a' {} }");
  CHECK_THROWS(play("require 'hidden'"));
  CHECK_THROWS(play("require '../other/hidden'"));
}

TEST_CASE("bytecode is not loaded, neither from a file nor from a string") {
  CHECK(contains(output_of("print(load('\\27LJ\\2'))"), "nil"));
  CHECK(contains(output_of("print(string.dump)"), "string has no 'dump'"));
  CHECK(contains(load_error("\x1bLJ\x02\x02"), "test.lua"));
}

TEST_CASE("load compiles text inside the sandbox only") {
  CHECK(output_of("print(load('return 1 + 1')())") == "2\n");
  CHECK(contains(output_of("load('return os')()"), "unknown name 'os'"));
  CHECK(contains(output_of("load('x = 1')()"), "would be a global"));
}

TEST_CASE("the string metatable is closed and its methods are the sandbox's") {
  CHECK(output_of("print(getmetatable('').__index)").find("attempt to index") != std::string::npos);
  CHECK(contains(output_of("print(('').dump)"), "string has no 'dump'"));
  CHECK(contains(output_of("print(('x'):rep(1e9))"), "at most 64 kB"));
  CHECK(contains(output_of("string.rep = nil"), "read-only"));
  CHECK(contains(output_of("setmetatable(getmetatable(''), nil)"), "test.lua"));
}

TEST_CASE(
    "no function of the host is reached through an error, a coroutine, a metatable or an argument that is ignored") {
  CHECK(output_of("print(load('return 1', 'x', 'b', { })(), load('return _G', 'x', 't', { })() == _G)") == "1 true\n");
  CHECK(contains(output_of("load(function() return 'x' end)"), "string expected, got function"));
  CHECK(output_of(
            "print(getmetatable(print), getmetatable(coroutine.create(print)), getmetatable(1), getmetatable(nil))") ==
        "nil nil nil nil\n");
  CHECK(output_of("print(getmetatable(m.posture), getmetatable(_G), getmetatable(s))") == "false false false\n");
  CHECK(contains(output_of("rawset(getmetatable('').__index, 'x', 1)"), "attempt to index"));
  CHECK(contains(output_of("setmetatable(string, nil)"), "protected metatable"));
  CHECK(contains(output_of("coroutine.wrap(function() print(os) end)()"), "unknown name 'os'"));
  CHECK(output_of("print(pcall(require, 'ffi'))").find("false") == 0);
  CHECK(output_of("local _, e = pcall(error, print) print(type(e), rawequal(e, print))") == "function true\n");
  CHECK(contains(output_of("print(rawget(s, 'joints'), rawget(_G, 'print'), #_G)"), "nil nil 0"));
  CHECK(contains(output_of("coroutine.close(1)"), "coroutine has no 'close'"));
  CHECK(contains(output_of("print(select(-1, 1, 2), select('#'))"), "2 0"));
  CHECK(contains(output_of("string.buffer = 1"), "read-only"));
  CHECK(contains(load_error("setfenv(1, {})"), "unknown name 'setfenv'"));
}

TEST_CASE("library tables, the globals, s and m are read-only, by any means") {
  for (const char* table : {"string", "table", "math", "coroutine", "bit", "_G", "s", "s.joints.l_knee", "s.base", "m",
                            "require 'kadans'"}) {
    CAPTURE(table);
    const std::string local = std::string("local t = ") + table + "\n";
    CHECK(output_of(local + "t.x = 1").find("test.lua:4: ") != std::string::npos);
    CHECK(contains(output_of(local + "rawset(t, 'x', 1)"), "read-only"));
    CHECK(contains(output_of(local + "table.insert(t, 1)"), "read-only"));
    CHECK(contains(output_of(local + "setmetatable(t, {})"), "protected metatable"));
    CHECK(output_of(local + "print(getmetatable(t))") == "false\n");
  }
  CHECK(contains(output_of("print = nil"), "global"));
  CHECK(contains(output_of("s.time_s = 3"), "s is read-only: 'time_s' cannot be set"));
}

TEST_CASE("two behaviors share no table") {
  Stage one(on_enter("m.vars.x = 1 getmetatable(setmetatable(m.vars, {})).y = 2 print(m.vars.x)"));
  Stage two(on_enter("print(m.vars.x, getmetatable(m.vars))"));
  one.tick();
  two.tick();
  CHECK(two.said() == "nil nil\n");
}

TEST_CASE("no address shows, since it would differ from run to run") {
  for (const char* code :
       {"print({})", "print(tostring(print))", "print(string.format('%s', {}))", "print(m)", "print(m.posture)",
        "print(coroutine.create(print))", "print(tostring(s))", "print(('%s'):format(print))"}) {
    CAPTURE(code);
    const std::string text = output_of(code);
    CHECK_MESSAGE(text.find("0x") == std::string::npos, text);
    CHECK(contains(output_of("error({})"), "not a string"));
  }
}

TEST_CASE("a __gc on a table never runs, and no userdata can be made to have one") {
  CHECK(output_of("setmetatable({}, { __gc = function() while true do end end }) print('on')") == "on\n");
  CHECK(contains(output_of("getmetatable(m.posture).__gc = print"), "attempt to index"));
}

TEST_CASE("pairs visits numbers, then strings, each sorted") {
  CHECK(output_of("local t = { b = 1, a = 1, [3] = 1, [1] = 1, [-2] = 1, [2.5] = 1, B = 1, [true] = 1 }\n"
                  "local keys = {} for key in pairs(t) do keys[#keys + 1] = tostring(key) end print(table.concat(keys, "
                  "' '))") == "-2 1 2.5 3 B a b true\n");
  CHECK(output_of(
            "local names = {} for name in pairs(s.joints) do names[#names + 1] = name end print(#names, names[1])") ==
        "14 l_ankle_pitch\n");
  CHECK(contains(output_of("for _ in pairs({ [{}] = 1 }) do end"), "have no order"));
}

TEST_CASE("pairs passes over what the loop removes") {
  CHECK(output_of("local t, seen = { a = 1, b = 2, c = 3 }, ''\n"
                  "for key in pairs(t) do seen = seen .. key t.b = nil end print(seen)") == "ac\n");
}

TEST_CASE("math.random repeats with the seed and differs with another") {
  const std::string code = on_enter("print(math.random(), math.random(6), math.random(10, 20))");
  const auto said = [&](std::uint64_t seed) {
    Stage stage(code, {}, seed);
    stage.tick();
    return stage.said();
  };
  CHECK(said(1) == said(1));
  CHECK(said(1) != said(2));
  CHECK(contains(output_of("math.randomseed(1)"), "math has no 'randomseed'"));
  CHECK(contains(output_of("print(math.random(2, 1))"), "interval is empty"));
  CHECK(output_of("for _ = 1, 1000 do local n = math.random(3) assert(n == 1 or n == 2 or n == 3) end print('ok')") ==
        "ok\n");
}

TEST_CASE("pcall, xpcall, error, assert and coroutines work as authors expect") {
  CHECK(output_of("print(pcall(error, 'x', 0))") == "false x\n");
  CHECK(output_of("print(pcall(function(...) return ... end, 1, nil, 3))") == "true 1 nil 3\n");
  CHECK(output_of("print(xpcall(function() error('x', 0) end, function(e) return e .. '!' end))") == "false x!\n");
  CHECK(output_of("local c = coroutine.wrap(function(a) local b = coroutine.yield(a + 1) print(b) return 9 end)\n"
                  "print(c(1)) print(c(5))") == "2\n5\n9\n");
  CHECK(output_of("local c = coroutine.create(function() pcall(coroutine.yield, 7) return 8 end)\n"
                  "print(coroutine.resume(c)) print(coroutine.resume(c))") == "true 7\ntrue 8\n");
}
