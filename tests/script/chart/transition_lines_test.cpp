// The line that is told for a transition is the one it is written in.
#include <doctest/doctest.h>

#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

std::vector<int> lines_of(const std::string& text) {
  const Stage stage(text);
  std::vector<int> lines;
  for (const Chart::Transition& transition : stage.behavior->chart().transitions) lines.push_back(transition.line);
  return lines;
}

}  // namespace

TEST_CASE("a transition's line is its own, whatever holds its target's name before it") {
  CHECK(lines_of("local k = require 'kadans'\n"
                 "local b = 'b'\n"
                 "return k.behavior 'test' {\n"
                 "  initial = 'a',\n"
                 "  always = { { when = function() return b == 'c' end, to = 'b' },\n"
                 "    { on = 'x', to = 'c' } },\n"
                 "  k.state 'a' {  -- b comes next, then c\n"
                 "    enter = function(m) print 'b' m.vars.b = { to = 'b' } end,\n"
                 "    { on = 'b', to = 'c' },\n"
                 "    k.state 'inner' { { on = 'b',\n"
                 "      to = 'b' } },\n"
                 "    { on = 'c', to = 'b' },\n"
                 "    { on = 'd', to = 'b' },\n"
                 "  },\n"
                 "  k.state 'b' {}, k.state 'c' { endless = true },\n"
                 "}\n") == std::vector<int>{5, 6, 9, 12, 13, 11});
}

TEST_CASE("a transition without a target, and one with several, have their own lines, too") {
  CHECK(lines_of("local k = require 'kadans'\n"
                 "return k.behavior 'test' { k.parallel 'p' {\n"
                 "  { on = 'x', action = print },\n"
                 "  { on = { 'y', 'z' },\n"
                 "    to = { 'a', 'b' } },\n"
                 "  { on = 'u', action = print },\n"
                 "  k.region 'l' { k.state 'a' {} }, k.region 'r' { k.state 'b' {} },\n"
                 "  { on = 'a', to = 'a' } } }\n") == std::vector<int>{3, 5, 5, 6, 8});
}

TEST_CASE("an unknown target is told at its transition's line") {
  CHECK(load_error("local k = require 'kadans'\nreturn k.behavior 'test' { initial = 'a', k.state 'a' {\n"
                   "enter = function() print 'ris' end,\n{ after = 1, to = 'ris' } }, k.state 'rise' {} }")
            .starts_with("behaviors/test.lua:4: unknown state 'ris'"));
}
