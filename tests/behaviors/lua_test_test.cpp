// Tests of behaviors, as their authors write and run them.
#include <doctest/doctest.h>

#include "app/program.h"

using namespace kadans::program;

namespace {

Outcome tested(const std::string& name, const std::string& text) {
  const auto project = project_copy(name);
  write(project / "behaviors/tulip/my_test.lua", text);
  return run("behavior test behaviors/tulip/my_test.lua", project);
}

}  // namespace

TEST_CASE("behavior test tells a failed expectation with its line and what was there, and exits 1") {
  const Outcome outcome = tested("lua_test_fails",
                                 "local k = require 'kadans'\n"
                                 "describe('squat', function()\n"
                                 "  it('is down at once', function()\n"
                                 "    local run = k.play 'squat.lua'\n"
                                 "    run:advance(0.5)\n"
                                 "    expect(run.state).to_equal 'squat'\n"
                                 "  end)\n"
                                 "  it('begins at rest', function()\n"
                                 "    local run = k.play 'squat.lua'\n"
                                 "    run:advance(0.5)\n"
                                 "    expect(run.state).never.to_equal 'squat'\n"
                                 "  end)\n"
                                 "end)\n");
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "behaviors/tulip/my_test.lua:6: expected \"settle\" to equal \"squat\""));
  CHECK(has(outcome.out, "FAILED  squat is down at once"));
  CHECK(has(outcome.out, "ok      squat begins at rest"));
  CHECK(has(outcome.out, "1 passed, 1 failed"));
}

TEST_CASE("a mistake in a test is told with its line and what there is") {
  const Outcome outcome =
      tested("lua_test_mistakes",
             "local k = require 'kadans'\n"
             "it('a', function() expect(1).to_equals(1) end)\n"
             "it('b', function() k.play 'squt.lua' end)\n"
             "it('c', function() k.play('squat.lua'):set_sensor('base.pitch', 1) end)\n"
             "it('d', function() k.play('squat.lua'):emit('jump') end)\n"
             "it('e', function() k.play('squat.lua'):set_parameter('repeats', 1000) end)\n"
             "it('f', function() local x = k.play('squat.lua').joints.l_kne end)\n"
             "it('g', function() local run = k.play('squat.lua') run:advance_to('rise', 0.1) end)\n");
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "my_test.lua:2: expect(...) has no 'to_equals'"));
  CHECK(has(outcome.out, "my_test.lua:3: "));
  CHECK(has(outcome.out, "my_test.lua:4: no sensor 'base.pitch'"));
  CHECK(has(outcome.out, "my_test.lua:5: nothing waits for the event 'jump'"));
  CHECK(has(outcome.out, "my_test.lua:6: no parameter 'repeats', or the value is outside its range"));
  CHECK(has(outcome.out, "my_test.lua:7: s.joints has no 'l_kne', did you mean 'l_knee'?"));
  CHECK(has(outcome.out, "my_test.lua:8: \"rise\" was not reached within 0.1 s"));
  CHECK(has(outcome.out, "0 passed, 7 failed"));
}

TEST_CASE("a test file that does not load exits 2 with its line") {
  const Outcome outcome = tested("lua_test_syntax", "local k =\n= 1\n");
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "behaviors/tulip/my_test.lua:2: "));
}

TEST_CASE("a behavior that errors in a test is told by its outcome and error") {
  const auto project = project_copy("lua_test_error");
  write(project / "behaviors/tulip/broken.lua",
        "local k = require 'kadans'\nreturn k.behavior 'broken' { k.state 'a' { endless = true,\n"
        "enter = function() error('oh') end } }\n");
  write(project / "behaviors/tulip/broken_test.lua",
        "local k = require 'kadans'\nit('says so', function()\n  local run = k.play 'broken.lua'\n"
        "  expect(run:finish(1)).to_equal 'error'\n  expect(run.error).to_contain 'broken.lua:3: oh'\nend)\n");
  const Outcome outcome = run("behavior test behaviors/tulip/broken_test.lua", project);
  INFO(outcome.out);
  CHECK(outcome.exit_code == 0);
}
