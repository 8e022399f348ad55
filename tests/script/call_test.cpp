// What calls give to behaviors, what behaviors are called with, and what they give back.
#include <doctest/doctest.h>

#include "script/cast.h"
#include "signal/byte_order.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

// Says its depth on entering and ends after a while; P.depth_m 0.02..0.15, side, times.
const std::string squats = R"(local P = k.params { depth_m = { 0.1, min = 0.02, max = 0.15, unit = 'm' },
  hold_s = { 0.05, min = 0, max = 1 } }
return k.behavior 'squats' {
  args = k.args { side = { 'left', one_of = { 'left', 'right' }, doc = 'which leg' },
                  times = { 1, min = 1, max = 5 }, again = { false } },
  initial = 'down',
  k.state 'down' { enter = function(m) print(P.depth_m, m.args.side, m.args.times, m.args.again) end,
    { after = P.hold_s, to = 'up' } },
  k.final 'up' { outcome = 'done', result = function(m, s) return { depth_m = P.depth_m, at = { s.time_s, 'x' } } end },
}
)";

struct Called : Cast {
  Called() { scripts.write("behaviors/lib/squats.lua", "local k = require 'kadans'\n" + squats); }
  void open_with(const std::string& text, std::vector<PlayArgument> arguments = {}) {
    write("main", text);
    auto items = list({"main"});
    items[0].arguments = std::move(arguments);
    open({.play = items});
  }
  std::string refused(const std::string& call) {
    write("main",
          "local P = k.params { far_m = { 0.1, min = 0.05, max = 0.3 }, near_m = { 0.1, min = 0.05, max = 0.12 } }\n"
          "return k.behavior 'main' { k.state 'a' {\n" +
              call + " } }");
    return refusal({"main"});
  }
};

// Calls twice, with other values; `values` of the first call.
std::string twice(const std::string& values, const std::string& head = "") {
  return head + "return k.behavior 'main' { vars = { deep = 0.07 }, initial = 'a',\nk.state 'a' { k.call 'squats' " +
         values +
         ", { on = 'done', to = 'b' }, { on = 'error', to = 'c' } },\n"
         "k.state 'b' { k.call 'squats' { depth_m = 0.15, side = 'right' }, { on = 'done', to = 'c' } },\n"
         "k.final 'c' { outcome = 'done' } }";
}

}  // namespace

TEST_CASE("a call sets parameters and arguments for itself alone, beside another call of the same behavior") {
  Called cast;
  cast.open_with(twice("{ depth_m = 0.12, hold_s = 0.2, times = 2, again = true }"));
  cast.tick(21);
  CHECK(cast.log.joined() == "0.12 left 2 true\n0.15 right 1 false\n");
  CHECK(cast.host->behavior(0).parameters().front().value == 0.1);
}

TEST_CASE("in a call its values go before what is set, and a parameter that it does not give follows what is set") {
  Called cast;
  cast.open_with(twice("{ side = 'right' }"));
  REQUIRE(cast.host->behavior(0).set_parameter("depth_m", 0.05));
  cast.tick(20);
  CHECK(cast.log.joined() == "0.05 right 1 false\n0.15 right 1 false\n");
}

TEST_CASE("a parameter of the caller is followed while the callee runs, through a call in between") {
  Called cast;
  cast.scripts.write("behaviors/lib/between.lua",
                     "local k = require 'kadans'\nlocal P = k.params { deep_m = { 0.1, min = 0.02, max = 0.15 } }\n"
                     "return k.behavior 'between' { k.state 'x' { k.call 'looks' { depth_m = P.deep_m } } }");
  cast.scripts.write("behaviors/lib/looks.lua",
                     "local k = require 'kadans'\nlocal P = k.params { depth_m = { 0.1, min = 0.02, max = 0.15 } }\n"
                     "return k.behavior 'looks' { k.state 'y' { during = function() print(P.depth_m) end } }");
  cast.open_with(
      "local P = k.params { how_m = { 0.03, min = 0.02, max = 0.15 } }\n"
      "return k.behavior 'main' { k.state 'a' { k.call 'between' { deep_m = P.how_m } } }");
  cast.tick();
  REQUIRE(cast.host->behavior(0).set_parameter("how_m", 0.06));
  cast.tick();
  CHECK(cast.log.joined() == "0.03\n0.06\n");
}

TEST_CASE("a function gives its value when the callee is entered, with m and s of the caller") {
  Called cast;
  cast.open_with(
      twice("{ depth_m = function(m, s) return m.vars.deep + s.time_s end,\n"
            "side = function(m) return m.vars.deep > 0.05 and 'right' or 'left' end }"));
  cast.tick();
  CHECK(cast.log.joined() == "0.07 right 1 false\n");
}

TEST_CASE(
    "a function's value out of range is an error with the line of the call, and nothing of the callee is entered") {
  Called cast;
  cast.open_with(twice("{\ndepth_m = function(m) return 1 end }"));
  cast.tick();
  CHECK(cast.host->behavior(0).outcome() == "done");
  CHECK(cast.log.joined() ==
        "error taken as an event: behaviors/main.lua:4: parameter 'depth_m' of behavior 'squats' = 1 is outside its "
        "range "
        "0.02..0.15 m\n");
  Called ends;
  ends.open_with("return k.behavior 'main' { k.state 'a' { k.call 'squats' {\nside = function() return 'up' end } } }");
  ends.tick();
  CHECK(ends.host->behavior(0).error().text() ==
        "behaviors/main.lua:3: argument 'side' of behavior 'squats' cannot be 'up'; there is: left, right");
}

TEST_CASE("wrong values of a call are refused at its line, with what was meant") {
  Called cast;
  const auto refused = [&](const std::string& values) { return cast.refused("k.call 'squats' {\n" + values + " }"); };
  CHECK(refused("depth_m = 0.5") ==
        "behaviors/main.lua:5: parameter 'depth_m' of behavior 'squats' = 0.5 is outside its range 0.02..0.15 m");
  CHECK(refused("depth = 0.1") ==
        "behaviors/main.lua:5: behavior 'squats' takes no argument 'depth', did you mean "
        "'depth_m'?");
  CHECK(refused("depth_m = 'deep'") == "behaviors/main.lua:5: parameter 'depth_m' of behavior 'squats' is a number");
  CHECK(refused("side = 'lef'") ==
        "behaviors/main.lua:5: argument 'side' of behavior 'squats' cannot be 'lef', did you mean 'left'?");
  CHECK(refused("times = 9") ==
        "behaviors/main.lua:5: argument 'times' of behavior 'squats' = 9 is outside its range "
        "1..5");
  CHECK(refused("times = 0/0").find("is outside its range") != std::string::npos);
  CHECK(refused("again = 1") == "behaviors/main.lua:5: argument 'again' of behavior 'squats' is true or false");
  CHECK(refused("0.1") == "behaviors/main.lua:4: k.call takes values by their names: { depth_m = 0.1 }");
  CHECK(refused("depth_m = P.near_m") == "");
  CHECK(refused("depth_m = P.far_m") ==
        "behaviors/main.lua:5: parameter 'far_m', which 'depth_m' follows, may be 0.05..0.3, but 'depth_m' of behavior "
        "'squats' is 0.02..0.15");
  CHECK(refused("times = P.far_m") ==
        "behaviors/main.lua:5: parameter 'far_m', which 'times' follows, may be 0.05: argument 'times' of behavior "
        "'squats' = 0.05 is outside its range 1..5");
}

TEST_CASE("wrong declarations of arguments are told with their line") {
  const auto error = [](const std::string& declared) {
    return load_error("local k = require 'kadans'\nreturn k.behavior 't' { args = k.args {\n" + declared +
                      " }, k.state 'a' {} }");
  };
  CHECK(error("x = { 1, mni = 0 }") == "behaviors/test.lua:3: an argument has no key 'mni', did you mean 'min'?");
  CHECK(error("x = { 5, max = 2 }") ==
        "behaviors/test.lua:3: the default: argument 'x' of k.args = 5 is outside its range -inf..2");
  CHECK(error("x = { 'a', one_of = { 'b' } }") ==
        "behaviors/test.lua:3: the default: argument 'x' of k.args cannot be 'a', did you mean 'b'?");
  CHECK(error("x = { 'a', min = 2 }") ==
        "behaviors/test.lua:3: argument 'x': 'min' is a number, beside a default that is one");
  CHECK(error("x = { 2, one_of = { 'b' } }") ==
        "behaviors/test.lua:3: argument 'x': 'one_of' lists 1..32 texts, beside a default that is one");
  CHECK(error("x = {}").find("behaviors/test.lua:3: argument 'x' must be { default, min =") == 0);
  CHECK(error("x = print").find("argument 'x' must be") != std::string::npos);
}

TEST_CASE("k.args at the top of a file declares its behavior's arguments, and its fields are their values") {
  Called cast;
  const std::string text =
      "local A = k.args { side = { 'left', one_of = { 'left', 'right' } } }\n"
      "return k.behavior 'main' { k.state 'a' { enter = function(m) print(A.side, m.args.side, A.sied) end } }";
  cast.open_with(text, {{"side", std::string("right")}});
  cast.tick();
  CHECK(cast.host->behavior(0).error().text() == "behaviors/main.lua:3: k.args has no 'sied', did you mean 'side'?");
  cast.write("main", text);
  auto items = cast.list({"main"});
  items[0].arguments = {{"side", std::string("rigth")}};
  items[0].source = "--play";
  CHECK_THROWS_WITH(cast.open({.play = items}),
                    "--play: argument 'side' of behavior 'main' cannot be 'rigth', did you mean 'right'?");
}

TEST_CASE("the result of a final state is data of the end, in the caller and around a state") {
  Called cast;
  cast.open_with(
      "return k.behavior 'main' { initial = 'a',\nk.state 'a' { k.call 'squats' { depth_m = 0.12, hold_s = 0 },\n"
      "{ on = 'done', when = function(s) return s.event.data.result.depth_m == 0.12 end, to = 'b',\n"
      "action = function(m, s) print(s.event.data.result.at[2]) end } },\n"
      "k.state 'b' { initial = 'i', k.state 'i' { { to = 'f' } },\n"
      "k.final 'f' { outcome = 'tired', result = function() return { n = 3 } end },\n"
      "{ on = 'tired', to = 'c', action = function(m, s) print(s.event.data.result.n) end } },\n"
      "k.final 'c' { outcome = 'done', result = function() return { list = { 1, 'two' }, ['a b'] = 0.1, ok = true } "
      "end "
      "} }");
  cast.tick(5);
  CHECK(cast.log.joined() == "0.12 left 1 false\nx\n3\nresult { [\"a b\"] = 0.1, list = { 1, \"two\" }, ok = true }\n");
  CHECK(cast.host->behavior(0).result() == "{ [\"a b\"] = 0.1, list = { 1, \"two\" }, ok = true }");
}

TEST_CASE("the end of a parallel has the results of its regions") {
  Called cast;
  cast.open_with(
      "local function region(name, n) return k.region(name) { initial = 'i', k.state 'i' { { after = n / 100, to = 'f' "
      "} },\n"
      "k.final 'f' { outcome = 'done', result = function() return { n = n } end } } end\n"
      "return k.behavior 'main' { k.parallel 'p' { region('l', 1), region('r', 3), k.region 'x' { k.final 'y' {} },\n"
      "{ on = 'done', to = 'p', action = function(m, s) local d = s.event.data\n"
      "print(d.results.l.n, d.results.r.n, d.results.x, d.outcomes.x) end } } }");
  cast.tick(5);
  CHECK(cast.log.joined() == "1 3 nil done\n");
}

TEST_CASE("a result is a table of plain data, bounded") {
  const auto error = [](const std::string& code) {
    Stage stage(
        "local k = require 'kadans'\nreturn k.behavior 't' { k.final 'f' { outcome = 'done',\nresult = "
        "function() return " +
        code + " end } }");
    stage.tick();
    return stage.behavior->error().text();
  };
  CHECK(error("3") == "behaviors/test.lua:3: result returns a table { name = value }, not a number");
  CHECK(error("{ f = print }") == "behaviors/test.lua:3: an event's data is plain data, not a function");
  CHECK(error("{ ('x'):rep(300) }").find("longer than 256") != std::string::npos);
}

TEST_CASE("what calls have given is kept over a reload and in another process, and checked against the new version") {
  const std::string looks =
      "local k = require 'kadans'\nlocal P = k.params { deep_m = { 0.1, min = 0.02, max = MAX } }\n"
      "return k.behavior 'looks' { args = k.args { word = { 'no' } },\n"
      "k.state 'y' { during = function(m) print(P.deep_m, m.args.word) end } }";
  const auto with_max = [&](const std::string& max) {
    std::string text = looks;
    return text.replace(text.find("MAX"), 3, max);
  };
  Called cast;
  cast.scripts.write("behaviors/lib/looks.lua", with_max("0.2"));
  cast.open_with(
      "return k.behavior 'main' { vars = { n = 0 }, k.state 'a' { k.call 'looks' {\n"
      "deep_m = function(_, s) return 0.05 + s.time_s end, word = function(m) m.vars.n = m.vars.n + 1 return "
      "'w' .. m.vars.n end } } }");
  cast.tick();
  ByteWriter kept;
  REQUIRE(cast.host->keep(kept, cast.snapshot.time_ns) == "");
  const std::vector<std::byte> bytes(kept.bytes().begin(), kept.bytes().end());
  cast.host.reset();
  cast.open({.kept = bytes});
  cast.tick();
  CHECK(cast.host->lost() == "");
  Behavior& behavior = cast.host->behavior(0);
  cast.scripts.write("behaviors/lib/looks.lua", with_max("0.3"));
  REQUIRE(behavior.reload(cast.snapshot, cast.sender) == Behavior::Reload::taken);
  cast.tick();
  std::string less = with_max("0.04");
  cast.scripts.write("behaviors/lib/looks.lua", less.replace(less.find("0.1"), 3, "0.03"));
  REQUIRE(behavior.reload(cast.snapshot, cast.sender) == Behavior::Reload::taken);
  cast.tick();
  CHECK(cast.log.joined() ==
        "0.05 w1\n0.05 w1\nreloaded behaviors/main.lua\n0.05 w1\nreloaded behaviors/main.lua\n0.03 w1\n");
}

TEST_CASE("the result of a region that has ended is kept until the others end") {
  Called cast;
  cast.open_with(
      "local function region(name, n) return k.region(name) { initial = 'i', k.state 'i' { { after = n / 100, to = 'f' "
      "} },\n"
      "k.final 'f' { outcome = 'done', result = function() return { n = n } end } } end\n"
      "return k.behavior 'main' { initial = 'p', k.parallel 'p' { region('l', 1), region('r', 5),\n"
      "{ on = 'done', to = 'q', action = function(m, s) print(s.event.data.results.l.n) end } }, k.state 'q' {} }");
  cast.tick(3);
  ByteWriter kept;
  REQUIRE(cast.host->keep(kept, cast.snapshot.time_ns) == "");
  const std::vector<std::byte> bytes(kept.bytes().begin(), kept.bytes().end());
  cast.host.reset();
  cast.open({.kept = bytes});
  cast.tick(5);
  CHECK(cast.log.joined() == "1\n");
}

TEST_CASE("a parameter that calls hand on is charged by the way to its value") {
  const auto spent = [](int calls, int given) {
    Cast cast;
    const auto params = [&](int count) {
      std::string text = "local P = k.params { ";
      for (int i = 0; i < count; ++i) text += "p" + std::to_string(i) + " = { 0, min = 0, max = 1 }, ";
      return text + "}\n";
    };
    std::string follows;
    for (int i = given; i > 0; --i) follows += "p" + std::to_string(i - 1) + " = P.p" + std::to_string(i - 1) + ", ";
    cast.scripts.write("behaviors/lib/c0.lua",
                       "local k = require 'kadans'\n" + params(given) +
                           "return k.behavior 'c0' { k.state 'x' { during = function() local before = "
                           "k.budget().instructions for i = 1, 200 do local _ = P.p" +
                           std::to_string(given > 9 ? 9 : 0) +
                           " end "
                           "print(before - k.budget().instructions) end } }");
    for (int i = 1; i < calls; ++i)
      cast.scripts.write("behaviors/lib/c" + std::to_string(i) + ".lua",
                         "local k = require 'kadans'\n" + params(given) + "return k.behavior 'c" + std::to_string(i) +
                             "' { k.state 'x' { k.call 'c" + std::to_string(i - 1) + "' { " + follows + "} } }");
    cast.write("main", params(given) + "return k.behavior 'main' { k.state 'x' { k.call 'c" +
                           std::to_string(calls - 1) + "' { " + follows + "} } }");
    cast.play({"main"});
    cast.tick();
    return std::stod(cast.log.joined());
  };
  const double near = spent(1, 1), far = spent(6, 60);
  CHECK(far > near + 200 * 6 * 60 / 16);
  CHECK(near < 4000);
}
