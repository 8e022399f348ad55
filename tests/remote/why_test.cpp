// Why transitions wait, asked of a run that goes on.
#include <doctest/doctest.h>

#include "remote/live_instance.h"

using namespace kadans;
using namespace kadans::remote_test;

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
