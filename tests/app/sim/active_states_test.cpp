// All active states of a run as its user sees them: in tests, checks, records, reports, consoles, and through ctl.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace active_states_test {

using namespace kadans::program;
using Json = nlohmann::json;

namespace {

constexpr const char* greet = R"(local k = require 'kadans'
return k.behavior 'greet' { controls = 'posture', initial = 'wait',
  k.state 'wait' { { after = 0.2, to = 'act' } },
  k.parallel 'act' {
    k.region 'arm' { initial = 'lift',
      k.state 'lift' { { after = 0.3, to = 'wave' } },
      k.state 'wave' { endless = true,
        { when = function(s) return s.base.height_m > 5 end, to = 'lift' } } },
    k.region 'look' { k.state 'ahead' { endless = true } } } }
)";

std::filesystem::path greeting(const std::string& name) {
  const auto project = project_copy(name);
  write(project / "behaviors/tulip/greet.lua", greet);
  return project;
}

std::string scenario(const std::string& that) {
  return "{\n  \"name\": \"greet\", \"robot\": \"../tulip/robot.json\", \"plant\": \"ideal\", \"duration_s\": 1,\n"
         "  \"behaviors\": [\"greet\"],\n"
         "  \"checks\": [{ \"name\": \"waves\", \"kind\": \"eventually\",\n"
         "    \"that\": \"" +
         that + "\" }]\n}\n";
}

Outcome checked(const std::filesystem::path& project, const std::string& that) {
  write(project / "config/scenarios/greet.json", scenario(that));
  return run("sim config/scenarios/greet.json --no-record --json", project);
}

}  // namespace

TEST_CASE("run.active lists all innermost active states, and advance_to takes the path of any active state") {
  const auto project = greeting("active_run");
  write(project / "behaviors/tulip/my_test.lua", R"(local k = require 'kadans'
it('sees all', function()
  local run = k.play 'greet.lua'
  run:advance(0.1)
  expect(run.active).to_equal { 'wait' }
  run:advance_to 'act'
  expect(run.active).to_equal { 'act.arm.lift', 'act.look.ahead' }
  run:advance_to 'act.look'
  run:advance_to 'act.arm.wave'
  expect(run.active).to_equal { 'act.arm.wave', 'act.look.ahead' }
  expect(run.state).to_equal 'act.arm.wave'
  run:advance_to 'act.look.ahead'
end)
it('a', function() k.play('greet.lua'):advance_to 'act.arm.wav' end)
it('b', function() k.play('greet.lua'):advance_to('wait', 0.1) k.play('greet.lua'):advance_to('act.arm.wave', 0.3) end)
)");
  const Outcome outcome = run("behavior test behaviors/tulip/my_test.lua", project);
  CHECK(has(outcome.out, "ok      sees all"));
  CHECK(has(outcome.out, "my_test.lua:14: the behavior has no state 'act.arm.wav', did you mean 'act.arm.wave'?"));
  CHECK(has(outcome.out,
            "my_test.lua:15: \"act.arm.wave\" was not reached within 0.3 s: the behavior is in "
            "act.arm.lift, act.look.ahead"));
  CHECK(has(outcome.out, "1 passed, 2 failed"));
}

TEST_CASE("a check asks for states of any region, and its report names all that are active at the end") {
  const auto project = greeting("active_check");
  const Json passes = Json::parse(checked(project, "state('act.arm.wave') and state('greet.act.look.ahead')").out);
  CHECK(passes["passed"] == true);
  CHECK(passes["active"]["greet"] == Json::array({"act.arm.wave", "act.look.ahead"}));
  CHECK(Json::parse(checked(project, "state('act.arm.lift') and state('act.arm.wave')").out)["passed"] == false);
  const std::string text = run("sim config/scenarios/greet.json --no-record", project).out;
  CHECK(has(text, "at the end"));
  CHECK(has(text, "greet in act.arm.wave, act.look.ahead"));
  (void)run("sim config/scenarios/greet.json --no-record --report pages", project);
  CHECK(has(read(project / "pages/greet-1.html"), "At the end greet was in act.arm.wave, act.look.ahead."));
}

TEST_CASE("a misspelt state of a check is refused with file, line, column and what was meant") {
  const auto project = greeting("active_check_wrong");
  const Outcome plain = checked(project, "time_s > 0 and state('act.arm.waev')");
  CHECK(plain.exit_code == 2);
  CHECK(has(plain.err, "greet.json:5:36: no behavior has the state 'act.arm.waev', did you mean 'act.arm.wave'?"));
  const Outcome escaped = checked(project, "state(\\\"wait\\\") and state(\\\"act.arm.waev\\\")");
  CHECK(has(escaped.err, "greet.json:5:42: no behavior has"));
  CHECK(has(run("check config/scenarios/greet.json", project).err, "did you mean 'act.arm.wave'?"));
}

TEST_CASE("a record has the active states as a topic and a signal for each region") {
  const auto project = greeting("active_record");
  write(project / "config/scenarios/greet.json", scenario("state('act')"));
  REQUIRE(run("sim config/scenarios/greet.json --record r.mcap", project).exit_code == 0);
  const std::string told = run("log cat r.mcap --topic active", project).out;
  CHECK(has(told, "\"states\":[\"wait\"]"));
  CHECK(has(told, "\"states\":[\"act.arm.lift\",\"act.look.ahead\"]"));
  CHECK(has(told, "\"states\":[\"act.arm.wave\",\"act.look.ahead\"]"));
  CHECK(has(run("log info r.mcap", project).out, "/active"));
  CHECK(run("replay r.mcap", project).exit_code == 0);
}

TEST_CASE("the console tells what the transitions of the active states wait for") {
  const auto project = greeting("active_why");
  write(project / "config/scenarios/greet.json", scenario("state('act')"));
  write(project / "lines.txt", ":run 0.35\n:status\n:why\n:run 0.5\n:why greet\nbehaviors.greet.active\n:why gret\n");
  const Outcome outcome = run("repl config/scenarios/greet.json <lines.txt", project);
  CHECK(has(outcome.out, "greet: in act.arm.lift, act.look.ahead"));
  CHECK(has(outcome.out, "act.arm.lift -> act.arm.wave  after 0.3 s: 0.1"));
  CHECK(has(outcome.out, " s left of 0.3 s"));
  CHECK(has(outcome.out, "act.arm.wave -> act.arm.lift  [when]: the guard gives false"));
  CHECK(has(outcome.out, "behaviors/tulip/greet.lua:8  { when = function(s) return s.base.height_m > 5 end"));
  CHECK(has(outcome.out, "s.base.height_m = "));
  CHECK(has(outcome.out, "{ \"act.arm.wave\", \"act.look.ahead\" }"));
  CHECK(has(outcome.err, "did you mean 'greet'?"));
}

}  // namespace active_states_test
