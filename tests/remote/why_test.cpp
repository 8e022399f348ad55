// Why transitions wait, asked of a run that goes on; and how viewers get the transitions.
#include <doctest/doctest.h>

#include "remote/instance/run_description.h"
#include "remote/live_instance.h"

namespace why_test {

using namespace kadans;
using namespace kadans::remote_test;
using kadans::remote_test::Json;

TEST_CASE("why tells what the transitions of a behavior wait for, and an unknown behavior is refused") {
  const auto has = [](const Json& answer, const char* text) { return answer.dump().find(text) != std::string::npos; };
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "why"}})["text"] == "nothing plays");
  (void)live.ask({{"verb", "play"}, {"list", "wait"}});
  CHECK(live.ask({{"verb", "why"}})["text"] == "wait: no transition waits");
  live.project.write(
      "behaviors/bench/wait.lua",
      "local k = require 'kadans'\nlocal P = k.params { level = { 1, min = 0, max = 5, unit = 'm', doc = 'a level' } "
      "}\n"
      "return k.behavior 'wait' { initial = 'a', k.state 'a' { during = function() local x = P.level end,\n"
      "  { when = function(s) return s.time_s < 0 end, to = 'b' } }, k.final 'b' {} }\n");
  const Json before = live.ask({{"verb", "why"}});
  CHECK(before["ok"] == false);
  CHECK(has(before, "reload it first"));
  (void)live.ask({{"verb", "reload"}});
  const Json answer = live.ask({{"verb", "why"}, {"behavior", "wait"}});
  REQUIRE(answer["reasons"].size() == 1);
  CHECK(answer["reasons"][0]["why"] == "the guard gives false");
  CHECK(answer["reasons"][0]["guard"]["line"] == 4);
  CHECK(has(answer, "s.time_s = "));
  CHECK(has(live.ask({{"verb", "why"}, {"behavior", "wiat"}}), "did you mean 'wait'"));
  CHECK(live.ask({{"verb", "why"}}, Role::read)["ok"] == false);  // it costs the behavior thread time
}

TEST_CASE("a chart is described with actions alone, internal transitions and an entry for each of several targets") {
  const Project project;
  project.write(
      "behaviors/bench/forms.lua",
      "local k = require 'kadans'\n"
      "local function side(name) return k.region(name) { initial = 'x', k.state 'x' {}, k.state 'y' {} } end\n"
      "return k.behavior 'forms' { initial = 'a',\n"
      "  k.state 'a' { initial = 'b', k.state 'b' {}, k.state 'c' {},\n"
      "    { on = 'warning.*', action = function() end },\n"
      "    { on = 'go', to = 'c', internal = true },\n"
      "    { on = 'both', to = { 'l.y', 'r.y' } } },\n"
      "  k.parallel 'p' { side 'l', side 'r' } }\n");
  const LiveRobot robot;
  BehaviorLog log;
  const ScriptHost host({.root = project.root, .play = {{.file = "behaviors/bench/forms.lua"}}}, robot.catalog, log);
  const Json chart = Json::parse(behaviors_description(&host))[0]["chart"];
  const Json& transitions = chart["transitions"];
  REQUIRE(transitions.size() == 4);
  CHECK(transitions[0]["label"] == "warning.*");
  CHECK(transitions[0]["target"].is_null());
  CHECK(transitions[1]["internal"] == true);
  CHECK_FALSE(transitions[0].contains("internal"));
  CHECK(transitions[2]["number"] == transitions[3]["number"]);
  const auto target = [&](std::size_t entry) {
    return chart["states"][transitions[entry]["target"].get<std::size_t>()]["path"];
  };
  CHECK(target(2) == "p.l.y");
  CHECK(target(3) == "p.r.y");
}

}  // namespace why_test
