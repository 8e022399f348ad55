// The forms of transitions: without a target, internal, to several regions, for names with a star; where states begin;
// histories of parallels; and states that follow each other without taking time.
#include <doctest/doctest.h>

#include "script/fixture.h"

namespace form_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

const std::string head =
    "local k = require 'kadans'\nlocal function log(text) return function() print(text) end end\n"
    "local function at(time_s) return function(s) return s.time_s >= time_s - 1e-9 end end\n";

std::string in_one_line(const Stage& stage) {
  INFO(stage.behavior->error().text());
  CHECK_FALSE(stage.behavior->failed());
  std::string all = stage.said();
  for (char& c : all) c = c == '\n' ? ' ' : c;
  return all;
}

// What the behavior prints, in one line; the events come in the second tick.
std::string played(const std::string& text, int ticks, const std::vector<std::string>& events = {}) {
  Stage stage(head + text);
  stage.tick();
  for (const std::string& event : events) CHECK(stage.behavior->post(event));
  stage.play(ticks - 1);
  return in_one_line(stage);
}

long told(const Stage& stage, const std::string& part) {
  return std::ranges::count_if(stage.log.messages,
                               [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("a transition without a target does its action, and its state and what is in it stay, with their clocks") {
  CHECK(played(R"(return k.behavior 't' { initial = 'w',
      k.state 'w' { enter = log 'w+', exit = log 'w-', { on = 'x', action = log 'w!' }, { after = 0.05, to = 'over' },
        k.state 'i' { enter = log 'i+', exit = log 'i-', run = function(m) m:wait(0.03) print 'run' end } },
      k.state 'over' { enter = function(_, s) print(s.time_s) end } })",
               8, {"x"}) == "w+ i+ w! run i- w- 0.05 ");
}

TEST_CASE("an event that an inner state takes without a target is not seen by the states around it") {
  CHECK(played(R"(return k.behavior 't' { initial = 'w', k.state 'out' { enter = log 'out' },
      k.state 'w' { { on = 'x', to = 'out' }, k.state 'i' { { on = 'x', action = log 'i!' } } } })",
               3, {"x"}) == "i! ");
}

TEST_CASE("without an event an action alone takes nobody's turn, in always neither") {
  CHECK(played(R"(return k.behavior 't' { initial = 'w', always = { { when = at(0.01), action = log '!' } },
      k.state 'w' { { when = at(0.02), to = 'out' }, k.state 'i' { { when = at(0.02), action = log 'i!' } } },
      k.state 'out' { enter = log 'out' } })",
               4) == "! ! i! out ! ");
}

TEST_CASE("an action alone after a time or at the end of run comes once each time its state is entered") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a',
      k.state 'a' { enter = log 'a', run = function() end, { after = 0.02, action = log '!' },
        { on = 'run.done', action = log 'done' }, { after = 0.05, to = 'a' } } })",
               9) == "a done ! a done ! ");
}

TEST_CASE("an action alone of an outer state comes when it is due, whatever inner states do") {
  CHECK(played(R"(return k.behavior 't' { initial = 'w', k.state 'w' { { after = 0.02, action = log '!' },
      k.state 'i' { enter = log 'i', { to = 'i' } } } })",
               5) == "i i i ! i i ");
}

TEST_CASE("a transition to a state inside its own leaves that state, with internal = true it does not") {
  const auto to_b = [](const char* internal) {
    return played(std::string("return k.behavior 't' { k.state 'w' { enter = log 'w+', exit = log 'w-', initial = 'a', "
                              "{ on = 'x', to = 'b'") +
                      internal + "}, k.state 'a' { exit = log 'a-' }, k.state 'b' { enter = log 'b+' } } }",
                  3, {"x"});
  };
  CHECK(to_b("") == "w+ a- w- w+ b+ ");
  CHECK(to_b(", internal = false") == "w+ a- w- w+ b+ ");
  CHECK(to_b(", internal = true") == "w+ a- b+ ");
}

TEST_CASE("a region's transition inwards leaves the whole parallel, with internal = true only what is in the region") {
  const auto to_b = [](const char* internal) {
    return played(
        std::string(
            "return k.behavior 't' { k.parallel 'p' { exit = log 'p-', k.region 'l' { initial = 'a', { on = 'x', "
            "to = 'b'") +
            internal +
            "}, k.state 'a' { exit = log 'a-' }, k.state 'b' { enter = log 'b+' } }, "
            "k.region 'r' { enter = log 'r+', k.state 'c' {} } } }",
        3, {"x"});
  };
  CHECK(to_b("") == "r+ a- p- b+ r+ ");
  CHECK(to_b(", internal = true") == "r+ a- b+ ");
}

TEST_CASE("a name with a star takes the events that begin with its words, a star alone all, and neither takes an end") {
  const auto taken = [](const std::string& on, const std::string& event) {
    return played("return k.behavior 't' { initial = 'a', k.state 'a' { { on = '" + on +
                      "', to = 'b', action = function(_, s) print(s.event.name) end }, { on = { 'heat', 'heat.hot', "
                      "'heaty', 'heat.hot.knee' }, to = 'b' } }, k.state 'b' {} }",
                  3, {event});
  };
  CHECK(taken("heat.*", "heat") == "heat ");
  CHECK(taken("heat.*", "heat.hot") == "heat.hot ");
  CHECK(taken("heat.*", "heat.hot.knee") == "heat.hot.knee ");
  CHECK(taken("heat.*", "heaty") == "");
  CHECK(taken("heat.hot.*", "heat") == "");
  CHECK(taken("*", "heaty") == "heaty ");
  CHECK(played(R"(return k.behavior 't' { k.state 'w' { initial = 'f', { on = '*', action = log 'star' },
      { on = 'heat.*', action = log 'words' }, { on = 'heat.end', action = log 'end' },
      k.state 'f' { { on = 'go', to = 'g' } }, k.final 'g' { outcome = 'heat.end' } } })",
               3, {"go"}) == "end ");
}

TEST_CASE("a name with a star takes events whose names nobody wrote down, up to 64 of them") {
  Stage stage(head + R"(return k.behavior 't' { k.state 'a' { { on = 'heat.*',
    action = function(m, s) print(s.event.name, s.event.data and s.event.data.n) end },
    enter = function(m) local which = 'knee' m:emit('heat.' .. which, { n = 3 }) end } })");
  stage.tick();
  CHECK(stage.said() == "heat.knee 3\n");
  CHECK(stage.behavior->post("heat.hip"));
  stage.tick();
  CHECK(stage.said() == "heat.knee 3\nheat.hip nil\n");
  CHECK_FALSE(stage.behavior->post("warning.hip"));
  CHECK_FALSE(stage.behavior->post("heat.*"));
  CHECK_FALSE(stage.behavior->post("heat." + std::string(60, 'x')));
  for (int i = 2; i < 64; ++i)
    CHECK(stage.behavior->post("heat." + std::to_string(i)) == (i < 34));  // the queue has 32
  stage.tick();
  CHECK(stage.behavior->post("heat.63"));
  CHECK_FALSE(stage.behavior->post("heat.64"));
  CHECK(output_of("m:emit 'heat.*'").find("nothing in this behavior waits") != std::string::npos);
}

TEST_CASE("a transition leads into several regions, and the others begin as ever") {
  CHECK(played(R"(
    local function region(name, a, b)
      return k.region(name) { initial = a, k.state(a) { enter = log(a) }, k.state(b) { enter = log(b) } }
    end
    return k.behavior 't' { initial = 'o', k.state 'o' { { on = 'x', to = { 'r.f', 'l.b' } } },
      k.parallel 'p' { enter = log 'p', region('l', 'a', 'b'), region('m', 'c', 'd'), region('r', 'e', 'f') } })",
               3, {"x"}) == "p b c f ");
}

TEST_CASE("initial names a state further inside, or one for each of some regions") {
  const auto begins = [](const std::string& outer, const std::string& parallel) {
    return played(
        "return k.behavior 't' { initial = " + outer + ", k.state 'w' { enter = log 'w', initial = 'v', " +
            "k.state 'v' {}, k.parallel 'p' { " + parallel +
            "k.region 'l' { initial = 'a', k.state 'a' { enter = log 'a' }, k.state 'b' { enter = log 'b' } }, "
            "k.region 'r' { k.state 'c' { initial = 'd', k.state 'd' { enter = log 'd' }, k.state 'e' { enter "
            "= log 'e' } } } } } }",
        2);
  };
  CHECK(begins("'w.p'", "") == "w a d ");
  CHECK(begins("'w.p.l.b'", "") == "w b d ");
  CHECK(begins("{ 'w.p.r.c.e', 'w.p.l.b' }", "") == "w b e ");
  CHECK(begins("'w.p'", "initial = 'r.c.e', ") == "w a e ");
  CHECK(begins("'w'", "") == "w ");
}

TEST_CASE("the history of a parallel brings back the states of all its regions") {
  const std::string left =
      "return k.behavior 't' { initial = 'p', k.parallel 'p' { k.history 'h' { deep = true }, "
      "k.region 'l' { initial = 'a', k.state 'a' { enter = log 'a', { on = 'x', to = 'b' } }, "
      "k.state 'b' { enter = log 'b' } }, k.region 'r' { initial = 'c', k.state 'c' { enter = log "
      "'c' }, k.state 'd' { enter = log 'd' } }, { after = 0.03, to = 'pause' } }, "
      "k.state 'pause' { { to = 'h' } } }";
  CHECK(played(left, 6, {"x"}) == "a c b b c ");
  const std::string first =
      "return k.behavior 't' { initial = 'o', k.state 'o' { { on = 'x', to = 'h' } }, "
      "k.parallel 'p' { k.history 'h' { deep = true, to = { 'l.b', 'd' } }, "
      "k.region 'l' { initial = 'a', k.state 'a' {}, k.state 'b' { enter = log 'b' } }, "
      "k.region 'r' { initial = 'c', k.state 'c' {}, k.state 'd' { enter = log 'd' } } } }";
  CHECK(played(first, 3, {"x"}) == "b d ");
}

TEST_CASE("a parallel with a history is over when its regions are") {
  CHECK(played(R"(return k.behavior 't' { initial = 'p', k.parallel 'p' { k.history 'h' { deep = true },
      k.region 'l' { k.final 'a' { outcome = 'done' } }, k.region 'r' { k.final 'b' { outcome = 'done' } },
      { on = 'done', action = function(_, s) for r in pairs(s.event.data.outcomes) do print(r) end end, to = 'q' } },
      k.state 'q' { enter = log 'q' } })",
               2)
            .ends_with("q "));
}

TEST_CASE("shallow history in a region brings back its child, which begins anew, deep history what was in it") {
  const auto back = [](const char* deep) {
    return played(std::string("return k.behavior 't' { initial = 'p', k.parallel 'p' { k.region 'l' { initial = 'a', "
                              "k.history 'h' { deep = ") +
                      deep +
                      R"( }, k.state 'a' { { to = 'b.d' } },
        k.state 'b' { initial = 'c', k.state 'c' { enter = log 'c' }, k.state 'd' { enter = log 'd' } } },
      k.region 'r' { k.state 'e' { enter = log 'e' } }, { after = 0.03, to = 'pause' } }, k.state 'pause' { { to = 'h' } } })",
                  6);
  };
  CHECK(back("false") == "e d c e ");
  CHECK(back("true") == "e d d e ");
}

TEST_CASE("initial may be a history") {
  CHECK(played(R"(return k.behavior 't' { initial = 'w', k.state 'w' { initial = 'h', k.history 'h' { to = 'a' },
      k.state 'a' { enter = log 'a', { after = 0.01, to = 'b' } }, k.state 'b' { enter = log 'b' },
      { after = 0.03, to = 'pause' } }, k.state 'pause' { { to = 'w' } } })",
               6) == "a b b ");
}

TEST_CASE("a path of a target begins at the root, or where it leads anywhere, nearest first") {
  const auto leads = [](const char* to) {
    return played(
        std::string("return k.behavior 't' { initial = 'u', k.state 'u' { initial = 'i', k.state 'i' { { to = '") + to +
            "' } }, k.state 'w' { initial = 'y', k.state 'x' { enter = log 'u.w.x' }, k.state 'y' {} } }, "
            "k.state 'w' { initial = 'y', k.state 'x' { enter = log 'w.x' }, k.state 'z' { k.state 'q' { enter "
            "= log 'q' } }, k.state 'y' {} } }",
        2);
  };
  CHECK(leads("w.x") == "w.x ");  // the whole path counts first
  CHECK(leads("u.w.x") == "u.w.x ");
  CHECK(leads("z.q") == "q ");
}

TEST_CASE("what a reload carries over: actions that came once, and events of names that nobody wrote down") {
  const std::string text = head + R"(return k.behavior 'test' { k.state 'a' { { after = 0.02, action = log '!' },
    { on = 'x.*', action = function(_, s) print(s.event.name) end }, during = function(m, s)
      if s.time_s > 0.045 and s.time_s < 0.055 then m:emit('x.' .. 'late') end end } })";
  Stage stage(text);
  stage.tick(6);
  stage.scripts.write("behaviors/test.lua", text + "-- another\n");
  REQUIRE(stage.behavior->reload(stage.snapshot, stage.sender) == Behavior::Reload::taken);
  stage.tick(3);
  CHECK(stage.said() == "!\nreloaded behaviors/test.lua\nx.late\n");
}

TEST_CASE("a reload that writes transitions in another order neither loses nor repeats an action that comes once") {
  const auto chart = [](const std::string& transitions) {
    return head + "local P = k.params { late_s = { 0.06, min = 0, max = 1 }, early_s = { 0.02, min = 0, max = 1 } }\n" +
           "return k.behavior 'test' { k.state 'a' { endless = true,\n" + transitions + " } }";
  };
  const std::string early = "{ after = P.early_s, action = log 'early' },\n",
                    late = "{ after = P.late_s, action = log 'late' },\n";
  const auto said = [&](const std::string& after) {
    Stage stage(chart(early + late));
    stage.tick(5);
    stage.scripts.write("behaviors/test.lua", chart(after));
    REQUIRE(stage.behavior->reload(stage.snapshot, stage.sender) == Behavior::Reload::taken);
    stage.tick(4);
    return in_one_line(stage);
  };
  const std::string once = "early reloaded behaviors/test.lua late ";
  CHECK(said(early + late + "-- the same\n") == once);
  CHECK(said(late + early) == once);
  CHECK(said("{ after = 0.03, action = log 'new' },\n" + early + late) ==
        "early reloaded behaviors/test.lua new late ");
  CHECK(said("{ after = 0.03, action = log 'early' },\n" + late) == once);  // its time alone is another
  CHECK(said(late + "{ after = 0.03, action = log 'new' },\n") == "early reloaded behaviors/test.lua new late ");
}

TEST_CASE("states that follow each other in every tick for 5 s are told once, with both and the line") {
  const auto warnings = [](const std::string& states, bool event = false) {
    Stage stage(head + "return k.behavior 't' { initial = 'a',\n" + states + " }");
    for (int i = 0; i < 1100; ++i) {
      if (event) (void)stage.behavior->post("x");
      stage.tick();
    }
    CHECK_FALSE(stage.behavior->failed());
    CHECK(told(stage, "(told once)") ==
          told(stage, "behaviors/test.lua:5: for 500 ticks a state followed another at once"));
    return told(stage, "'a' after 'b'") + told(stage, "'b' after 'a'") + 10 * told(stage, "'a' after 'a'");
  };
  const std::string back = "k.state 'b' { { when = function() return true end, to = 'a' } }";
  CHECK(warnings("k.state 'a' { { to = 'b' } }, " + back) == 1);
  CHECK(warnings("k.state 'a' { { after = 0, to = 'b' } }, " + back) == 1);
  CHECK(warnings("k.state 'a' { { to = 'a' } }") == 10);
  CHECK(warnings("k.state 'a' { run = function() end, { on = 'run.done', to = 'b' } }, " + back) == 1);
  CHECK(warnings("k.state 'a' { { after = 0.01, to = 'b' } }, " + back) == 0);
  CHECK(warnings("k.state 'a' { { on = 'x', to = 'b' } }, " + back, true) == 0);
  CHECK(warnings("k.state 'a' { { when = function(s) return s.time_s < 4.9 or s.time_s > 5.1 end, to = 'b' } }, " +
                 back) == 1);
  CHECK(warnings(
            "k.state 'a' { { when = function(s) return math.floor(s.time_s * 100 + 0.5) % 401 > 0 end, to = 'b' } }, " +
            back) == 0);
}

}  // namespace form_test
