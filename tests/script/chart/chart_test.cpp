// What a chart means, one sentence of the description after the other.
#include <doctest/doctest.h>

#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

// `log` appends to m.vars.log when called with a name: log 'x' gives a function for enter, exit, during.
const std::string head = R"(
local k = require 'kadans'
local function log(text) return function(m) print(text) end end
local function after(s, time_s) return s.time_s >= time_s - 1e-9 end
local function never() return false end
)";

std::string words(const Stage& stage) {
  std::string all = stage.said();
  for (char& c : all) {
    if (c == '\n') c = ' ';
  }
  return all;
}

std::string played(const std::string& text, int ticks) {
  Stage stage(head + text);
  stage.play(ticks);
  INFO(stage.behavior->error().text());
  CHECK_FALSE(stage.behavior->failed());
  return words(stage);
}

}  // namespace

TEST_CASE("states nest: entry goes from outer to inner, exit from inner to outer") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a', enter = log 'B+', exit = log 'B-',
    k.state 'a' { enter = log 'a+', exit = log 'a-', initial = 'b',
      k.state 'b' { enter = log 'b+', exit = log 'b-', k.state 'c' { enter = log 'c+', exit = log 'c-' } },
      { after = 0.02, to = 'd' } },
    k.final 'd' { enter = log 'd+' } })",
               10) == "B+ a+ b+ c+ c- b- a- d+ B- ");
}

TEST_CASE("the first tick enters the initial states and nothing else, during runs from the outside in") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a', during = log 'B',
    k.state 'a' { enter = log 'a+', during = log 'a', { to = 'b' } }, k.state 'b' { during = log 'b' } })",
               2) == "a+ B a B b ");
}

TEST_CASE("always is looked at first, outermost first, whatever the state") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a',
    always = { { when = function(s) return after(s, 0.02) end, to = 'safe' } },
    k.state 'a' { initial = 'b', always = { { when = function(s) return after(s, 0.02) end, to = 'x' } },
      k.state 'b' { { when = function(s) return after(s, 0.02) end, to = 'x' } } },
    k.state 'x' { enter = log 'x' }, k.state 'safe' { enter = log 'safe' } })",
               10) == "safe ");
}

TEST_CASE("an always transition whose state is active already is not taken again") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a', always = { { when = function() return true end, to = 'b' } },
    k.state 'a' {}, k.state 'b' { enter = log 'b' } })",
               10) == "b ");
}

TEST_CASE("transitions are looked at innermost first, and in the order written") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { k.state 'inner' { { when = never, to = 'x' }, { to = 'y' }, { to = 'z' } }, { to = 'x' } },
    k.state 'x' { enter = log 'x' }, k.state 'y' { enter = log 'y' }, k.state 'z' { enter = log 'z' } })",
               2) == "y ");
}

TEST_CASE("at most one transition is taken in a tick") {
  Stage stage(head +
              "return k.behavior 't' { initial = 'a', k.state 'a' { { to = 'b' } }, k.state 'b' { { to = 'a' } } }");
  stage.tick();
  CHECK(stage.behavior->state() == "a");
  stage.tick();
  CHECK(stage.behavior->state() == "b");
  stage.tick();
  CHECK(stage.behavior->state() == "a");
  CHECK(stage.log.transitions.size() == 2);
}

TEST_CASE("after counts seconds in the state, on the engine's clock, exactly") {
  Stage stage(head +
              "return k.behavior 't' { initial = 'a', k.state 'a' { { after = 0.3, to = 'b' } }, k.state 'b' {} }");
  stage.tick(30);
  CHECK(stage.behavior->state() == "a");
  stage.tick();
  CHECK(stage.behavior->state() == "b");
}

TEST_CASE("after follows a parameter that changes while the state waits") {
  Stage stage(head +
              "local P = k.params { wait = { 0.1, min = 0.05, max = 5, unit = 's', doc = 'x' } }\n"
              "return k.behavior 't' { initial = 'a', k.state 'a' { { after = P.wait, to = 'b' } }, k.state 'b' { "
              "enter = function() print(P.wait) end } }");
  CHECK_FALSE(stage.behavior->set_parameter("wait", 9));
  CHECK_FALSE(stage.behavior->set_parameter("weight", 1));
  CHECK(stage.behavior->set_parameter("wait", 0.2));
  stage.tick(20);
  CHECK(stage.behavior->state() == "a");
  stage.tick();
  CHECK(stage.said() == "0.2\n");
}

TEST_CASE("a guard and a timeout together must both hold") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { { after = 0.05, when = function(s) return after(s, 0.1) end, to = 'b' } },
    k.state 'b' { enter = function(m, s) print(s.time_s) end } })",
               20) == "0.1 ");
}

TEST_CASE("every state knows m.time_s, its own") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { during = function(m) if m.time_s == 0.03 then print('a', m.time_s) end end, initial = 'b',
      k.state 'b' { { after = 0.02, to = 'c' } }, k.state 'c' { enter = function(m) print('c', m.time_s) end,
        run = function(m) m:wait(0.01) print('run', m.time_s) end } } })",
               5) == "c 0 a 0.03 run 0.01 ");
}

TEST_CASE("a final state ends the behavior with its outcome, and all is left") {
  Stage stage(head +
              "return k.behavior 't' { initial = 'a', exit = log 'B-', k.state 'a' { { to = 'bad' } }, k.final 'bad' { "
              "outcome = 'failed' } }");
  CHECK(stage.tick());
  CHECK(stage.behavior->outcome() == "");
  CHECK_FALSE(stage.tick());
  CHECK(stage.behavior->outcome() == "failed");
  CHECK(stage.said() == "B-\n");
  CHECK_FALSE(stage.tick());
}

TEST_CASE("a final state inside a state is an event for it, in the same tick") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { initial = 'i', k.state 'i' { { to = 'f' } }, k.final 'f' { outcome = 'tired' },
      { on = 'done', to = 'x' }, { on = 'tired', to = 'y' } },
    k.state 'x' {}, k.state 'y' { enter = function(m, s) print('y', s.time_s) end } })",
               9) == "y 0.01 ");
}

TEST_CASE("regions of a parallel tick in the listed order, each with its own transition") {
  CHECK(played(R"(return k.behavior 't' { k.parallel 'p' {
      k.region 'l' { initial = 'l1', k.state 'l1' { enter = log 'l1+', exit = log 'l1-', { to = 'l2' } }, k.state 'l2' { enter = log 'l2+' } },
      k.region 'r' { initial = 'r1', k.state 'r1' { enter = log 'r1+', exit = log 'r1-', { to = 'r2' } }, k.state 'r2' { enter = log 'r2+' } } } })",
               2) == "l1+ r1+ r1- l1- l2+ r2+ ");
}

TEST_CASE("a parallel is done when all its regions are, and its outcome is the first that is not done") {
  const auto outcome = [](const char* left, const char* right) {
    return played(
        std::string(
            "return k.behavior 't' { initial = 'p', k.parallel 'p' {\n"
            "k.region 'l' { initial = 'a', k.state 'a' { { after = 0.05, to = 'e' } }, k.final 'e' { outcome = '") +
            left + "' } }, k.region 'r' { k.final 'f' { outcome = '" + right +
            "' } },\n"
            "{ on = 'done', to = 'good' }, { on = 'failed', to = 'bad' } },\n"
            "k.state 'good' { enter = log 'good' }, k.state 'bad' { enter = log 'bad' } }",
        20);
  };
  CHECK(outcome("done", "done") == "good ");
  CHECK(outcome("done", "failed") == "bad ");
  CHECK(outcome("failed", "done") == "bad ");
}

TEST_CASE("a transition out of one region leaves the whole parallel, last region first") {
  CHECK(played(R"(return k.behavior 't' { initial = 'p', k.parallel 'p' { exit = log 'p-',
      k.region 'l' { exit = log 'l-', k.state 'l1' { exit = log 'l1-', { to = 'out' } } },
      k.region 'r' { exit = log 'r-', initial = 'r1', k.state 'r1' { exit = log 'r1-', { to = 'r2' } }, k.state 'r2' { enter = log 'r2+' } } },
    k.state 'out' { enter = log 'out' } })",
               2) == "r1- r- l1- l- p- out ");
}

TEST_CASE("a transition into a region starts the other regions too") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a', k.state 'a' { { to = 'r2' } },
    k.parallel 'p' { enter = log 'p', k.region 'l' { k.state 'l1' { enter = log 'l1' } },
      k.region 'r' { initial = 'r1', k.state 'r1' { enter = log 'r1' }, k.state 'r2' { enter = log 'r2' } } } })",
               2) == "p l1 r2 ");
}

TEST_CASE("shallow history returns to the child, deep history to the innermost state") {
  const auto back_through = [](const char* deep) {
    return played(std::string("return k.behavior 't' { initial = 'work', k.state 'work' { initial = 'one',\n"
                              "k.history 'back' { deep = ") +
                      deep +
                      " }, k.state 'one' { { to = 'two' } },\n"
                      "k.state 'two' { initial = 'x', k.state 'x' { enter = log 'x', { to = 'y' } }, k.state 'y' { "
                      "enter = log 'y' } },\n"
                      "{ after = 0.05, to = 'pause' } }, k.state 'pause' { enter = log 'pause', { after = 0.05, to = "
                      "'back' } } }",
                  11);
  };
  CHECK(back_through("false") == "x y pause x ");
  CHECK(back_through("true") == "x y pause y ");
}

TEST_CASE("history that was never left leads to its default") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a', k.state 'a' { { to = 'back' } },
    k.state 'work' { initial = 'one', k.history 'back' { to = 'two' }, k.state 'one' { enter = log 'one' }, k.state 'two' { enter = log 'two' } } })",
               2) == "two ");
}

TEST_CASE("an action runs between the exits and the entries") {
  CHECK(played(
            R"(return k.behavior 't' { initial = 'a', k.state 'a' { exit = log 'a-', { action = log 'act', to = 'b' } },
    k.state 'b' { enter = log 'b+' } })",
            2) == "a- act b+ ");
}

TEST_CASE("a transition to the same state leaves and enters it, and its time starts anew") {
  CHECK(
      played(R"(return k.behavior 't' { k.state 'a' { enter = log '+', exit = log '-', { after = 0.05, to = 'a' } } })",
             11) == "+ - + - + ");
}

TEST_CASE("the transition log tells from, to and why") {
  Stage stage(
      head +
      R"(return k.behavior 't' { initial = 'a', k.state 'a' { k.state 'b' { { after = 0.01, to = 'c', why = 'bored' } } },
    k.state 'c' { { when = function() return true end, to = 'd' } }, k.state 'd' { run = function() end, { on = 'run.done', to = 'a' } } })");
  stage.tick(4);
  CHECK(stage.log.transitions == std::vector<std::string>{"a.b>c:bored", "c>d:when", "d>a:run.done"});
}

TEST_CASE("targets are found among the nearest states first, or by their path") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { initial = 'x', k.state 'x' { { to = 'y' } }, k.state 'y' { enter = log 'a.y', { to = 'b.y' } } },
    k.state 'b' { k.state 'y' { enter = log 'b.y' } } })",
               3) == "a.y b.y ");
}
