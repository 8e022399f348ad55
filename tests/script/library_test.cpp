// What the sandbox wrote anew of Lua's library does what Lua's own does.
#include <doctest/doctest.h>
#include <lua.hpp>

#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

// What the function `f` of the code gives or raises, as a text.
std::string shown(const std::string& code) {
  return "local f = function()\n" + code +
         "\nend\nlocal function show(...) local all = {} for i = 1, select('#', ...) do all[i] = tostring(select(i, "
         "...)) "
         "end return table.concat(all, ' ') end\nlocal text = show(pcall(f))";
}

std::string in_sandbox(const std::string& code) { return output_of(shown(code) + "\nprint(text)"); }

std::string in_lua(const std::string& code) {
  lua_State* state = luaL_newstate();
  luaL_openlibs(state);
  const std::string text = "\n\n" + shown(code) + " return text";  // on the same lines
  const bool raised =
      luaL_loadbuffer(state, text.data(), text.size(), "@behaviors/test.lua") != 0 || lua_pcall(state, 0, 1, 0) != 0;
  std::string result = lua_tostring(state, -1);
  lua_close(state);
  return raised ? "broken: " + result : result + "\n";
}

}  // namespace

TEST_CASE("table functions and error do and raise as in LuaJIT itself") {
  for (const char* code : {
           "local t = { 1, 2, 3 } table.insert(t, 9) return unpack(t)",
           "local t = { 1, 2, 3 } table.insert(t, 2, 9) return unpack(t)",
           "local t = { 1, 2, 3 } table.insert(t, 4, 9) return unpack(t)",
           "local t = { 1, 2, 3 } table.insert(t, 0, 9) return t[0], unpack(t)",
           "local t = { 1, 2, 3 } table.insert(t, -3, 9) return t[-3], t[-2], t[0], unpack(t)",
           "local t = { 1, 2, 3 } table.insert(t, 7, 9) return #t, t[7]",
           "local t = { 1, 2, 3 } table.insert(t, 2.9, 9) return unpack(t)",
           "local t = { 1, 2, 3 } table.insert(t, 2, nil) return t[2], t[3], t[4]",
           "table.insert({}) return 1",
           "table.insert({}, 1, 2, 3) return 1",
           "table.insert({}, 'x', 2) return 1",
           "table.insert(5, 2) return 1",
           "return table.remove({ 1, 2, 3 }, 1), table.remove({ 1, 2, 3 }), table.remove({}), table.remove({ 1 }, 5)",
           "return (table.concat({ 1, 'a', 2.5 }, ', ')), (table.concat({}, 'x')), (table.concat({ 1, 2, 3 }, '-', 2))",
           "return (table.concat({ 1, 2, 3 }, '-', 2, 2)), (table.concat({ 1, 2 }, ',', 2, 1)), (table.concat({ 7 }, "
           "5))",
           "return (table.concat({ [-1] = 'a', [0] = 'b', 'c' }, '', -1, 1)), (table.concat({ 1, 2 }, 5, '2', '2'))",
           "local x = table.concat({ 1, {}, 3 }, ',') return x",
           "local x = table.concat({ 1, 2 }, ',', 1, 4) return x",
           "local x = table.concat({ 1, 2 }, ',', -2147483649, 1) return x",
           "local x = table.concat({ 1, true }) return x",
           "local x = table.concat({ 1 }, {}) return x",
           "local x = table.concat(5) return x",
           "local t = { 3, 1, 2 } table.sort(t) return unpack(t)",
           "local t = { 'b', 'c', 'a', '', 'ab' } table.sort(t) return unpack(t)",
           "local t = { 3, 1, 2, 5, 4, 9, 0 } table.sort(t, function(a, b) return a > b end) return unpack(t)",
           "local mt = { __lt = function(a, b) return a[1] < b[1] end }\n"
           "local t = { setmetatable({ 2 }, mt), setmetatable({ 1 }, mt) } table.sort(t) return t[1][1], t[2][1]",
           "table.sort({ 3, {}, 1 }) return 1",
           "table.sort({ 3, 2, 1 }, 5) return 1",
           "table.sort(5) return 1",
           "local t = { 2, 1 } pcall(table.sort, t, function() error('x') end) return t[1] + t[2]",
           "return table.maxn({ 1, 2, [7.5] = 1, x = 3 }), table.maxn({})",
           "error('x')",
           "error('x', 0)",
           "error('x', 2)",
           "local _, e = pcall(error, {}) return type(e)",
           "error()",
           "error('x', -1)",
           "error(7)",
           "local function deep(n) if n == 0 then error('x', 3) end deep(n - 1) return 1 end deep(5)",
           "local w = coroutine.wrap(function(a, b) local c = coroutine.yield(a + b) return c, nil, 3 end) return w(1, "
           "2), w(5)",
           "local w = coroutine.wrap(function() error('x') end) w()",
           "local w = coroutine.wrap(function() end) w() w() return 1",
           "local w = coroutine.wrap(function() error(nil) end) w() return 1",
           "local c = coroutine.create(function() coroutine.yield(1) end) return coroutine.resume(c)",
           "return math.fmod(7, 3), math.fmod(-7, 3), math.fmod(7, -3), math.fmod(1e308, 3.1), math.fmod(5, 1 / 0)",
           "return math.fmod('7', 3), math.fmod(0, 5) == 0",
           "local x = math.fmod({}, 1) return x",
           "return ('%5.2f|%-4d|%s|%q|%%|%c|%x'):format(1.234, 5, true, 'a\\nb', 65, 255)",
           "return ('abc'):byte(1, -1), ('abc'):byte(-1), ('abc'):byte(9), ('x'):rep(3), ('x'):rep(-1), ('ab'):upper()",
           "return string.char(72, 105), ('x'):rep('2'), ('hello'):sub(2, -2), ('hello'):reverse(), ('Hi'):lower()",
           "return tonumber('0x1F'), tonumber('zz', 36), tonumber(' 12 '), tonumber('1e'), tonumber('7', 8)",
       }) {
    CAPTURE(std::string(code));
    CHECK(in_sandbox(code) == in_lua(code));
  }
}

TEST_CASE("a sort keeps the order of what is equal, and an order that contradicts itself loses nothing") {
  CHECK(output_of(
            "local t = {} for i = 1, 100 do t[i] = { i % 3, i } end\n"
            "table.sort(t, function(a, b) return a[1] < b[1] end)\n"
            "for i = 2, 100 do if t[i - 1][1] == t[i][1] then assert(t[i - 1][2] < t[i][2]) end end print('kept')") ==
        "kept\n");
  CHECK(output_of("local t = {} for i = 1, 1000 do t[i] = i end\n"
                  "table.sort(t, function() return true end) local sum = 0 for i = 1, 1000 do sum = sum + t[i] end "
                  "print(sum)") == "500500\n");
}
