// k.log: lines for people, with severity and a bound.
#include <doctest/doctest.h>

#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

TEST_CASE("k.log says a line with its severity, formatted when there is more than a text") {
  Stage stage(on_enter("k.log.info('50 %') k.log.warning('%s at %.2f m', 'low', 0.5) k.log.error('gone: %s', true)"));
  stage.tick();
  CHECK(stage.said() == "50 %\nlow at 0.50 m\ngone: true\n");
  CHECK(stage.log.errors == 1);
  CHECK_FALSE(stage.behavior->failed());
}

TEST_CASE("k.log tells its mistakes at the line") {
  for (const auto& [code, message] : {std::pair{"k.log.info()", "behaviors/test.lua:3: log needs a text"},
                                      std::pair{"k.log.warn('x')",
                                                "behaviors/test.lua:3: kadans.log has no 'warn', did "
                                                "you mean 'warning'?"},
                                      std::pair{"k.log.info('%d', 'x')", "behaviors/test.lua:3: "}}) {
    const std::string line = code;  // clang captures no structured binding
    CAPTURE(line);
    Stage stage(on_enter(line));
    stage.tick();
    const std::string error = stage.behavior->error().text();
    CHECK_MESSAGE(error.starts_with(message), error);
  }
}

TEST_CASE("a flood of lines is cut at a hundred a second, visibly, and what was dropped is counted") {
  Stage stage(
      "local k = require 'kadans'\nreturn k.behavior 'test' { k.state 'a' { during = function(m)\n"
      "for i = 1, 10 do k.log.info('line') end end } }");
  stage.tick(100);
  REQUIRE(stage.log.messages.size() == 101);
  CHECK(stage.log.messages[100] == "test: says more than 100 lines in a second; the rest is dropped");
  stage.tick(1);
  CHECK(stage.log.messages[101] == "test: 900 lines were dropped");
  CHECK(stage.log.messages[102] == "test: line");
}

TEST_CASE("lines dropped before the end of a behavior are counted at its end") {
  Stage stage(on_enter("for i = 1, 105 do k.log.info('line') end error('enough')"));
  stage.tick();
  REQUIRE(stage.log.messages.size() == 102);
  CHECK(stage.log.messages[101] == "test: 5 lines were dropped");
}
