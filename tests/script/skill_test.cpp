// Skills: states with arguments that a library offers, and the reference that lists them.
#include <doctest/doctest.h>

#include "script/bindings/api.h"
#include "script/cast.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

const std::string library = R"(local k = require 'kadans'
local arms = {}
arms.wave = k.skill 'wave' {
  doc = 'Waves', args = k.args { times = { 2, min = 1, max = 9, doc = 'how often' }, side = { 'left', one_of = { 'left', 'right' } },
    after_s = { 0.05, min = 0, max = 1, unit = 's' } },
  make = function(a) return k.state 'waving' { initial = 'w', enter = function() print(a.times, a.side, a.after_s) end,
    k.state 'w' { { after = a.after_s, to = 'f' } }, k.final 'f' { outcome = 'done' } } end,
}
arms.broken = k.skill 'broken' { doc = 'Returns nothing', make = function() end }
return arms
)";

struct Skilled : Cast {
  Skilled() { scripts.write("behaviors/lib/arms.lua", library); }
  std::string refused(const std::string& states, const std::string& before = "") {
    write("main",
          "local arms = require 'arms'\n" + before + "return k.behavior 'main' { initial = 'a',\n" + states + " }");
    return refusal({"main"});
  }
};

}  // namespace

TEST_CASE("a skill is a state of the caller's with its arguments, and its end is one of the caller's events") {
  Skilled cast;
  REQUIRE(
      cast.refused("arms.wave 'a' { times = 3, { on = 'done', to = 'b' } },\n"
                   "arms.wave 'b' { side = 'right', after_s = P.wait_s, { on = 'done', to = 'c' } }, k.state 'c' {}",
                   "local P = k.params { wait_s = { 0.5, min = 0, max = 1 } }\n") == "");
  cast.tick(10);
  CHECK(cast.host->behavior(0).state() == "b.waving.w");
  REQUIRE(cast.host->behavior(0).set_parameter("wait_s", 0.1));
  cast.tick(10);
  CHECK(cast.host->behavior(0).state() == "c");
  CHECK(cast.log.joined() == "3 left 0.05\n2 right 0.5\n");
}

TEST_CASE("mistakes with a skill are told at the caller's line") {
  Skilled cast;
  CHECK(cast.refused("arms.wave 'a' {\ntimse = 3 }") ==
        "behaviors/main.lua:5: skill 'wave' takes no argument 'timse', did you mean 'times'?");
  CHECK(cast.refused("arms.wave 'a' {\ntimes = 30 }") ==
        "behaviors/main.lua:5: argument 'times' of skill 'wave' = 30 is outside its range 1..9");
  CHECK(cast.refused("arms.wave 'a' {\n{ on = 'done', to = 'nowhere' } }") ==
        "behaviors/main.lua:5: unknown state 'nowhere' in 'to'; there is: a, waving, w, f");
  CHECK(cast.refused("arms.wave 'a' {\n{ on = 'done' } }").find("behaviors/main.lua:") == 0);
  CHECK(cast.refused("arms.wave 'a b' {}") ==
        "behaviors/main.lua:4: a skill's state: a name is letters, digits and '_', not \"a b\"");
  CHECK(cast.refused("arms.wave 'a' {\nk.state 'x' {} }") ==
        "behaviors/main.lua:5: a skill takes arguments and transitions, not a k.state");
  CHECK(cast.refused("arms.broken 'a' {}") ==
        "behaviors/main.lua:4: skill 'broken': its make must return a k.state, k.parallel or k.call");
  CHECK(
      cast.refused("arms.wave 'a' { times = P.n }", "local P = k.params { n = { 5, min = 1, max = 10 } }\n") ==
      "behaviors/main.lua:5: parameter 'n', which 'times' follows, may be 10: argument 'times' of skill 'wave' = 10 is "
      "outside its range 1..9");
}

TEST_CASE("a skill is declared with what it does and a function that makes it") {
  const auto error = [](const std::string& spec) {
    return load_error("local k = require 'kadans'\nlocal s = k.skill 's' {\n" + spec + " }\nreturn k.behavior 't' {}");
  };
  CHECK(error("make = print").find("needs doc = \"what it does\"") != std::string::npos);
  CHECK(error("doc = 'x'").find("needs make = function(a) return k.state") != std::string::npos);
  CHECK(error("doc = 'x', mkae = print") == "behaviors/test.lua:3: k.skill has no key 'mkae', did you mean 'make'?");
}

TEST_CASE("the reference lists the skills of the library with their arguments") {
  Skilled cast;
  cast.scripts.write("behaviors/lib/arms_test.lua", "describe('x', function() end)");
  CHECK(skill_reference(cast.scripts.root)
            .find("\n### `arms.wave`\n\nWaves.\n\n| argument | default | allowed | |\n|---|---|---|---|\n"
                  "| `after_s` | 0.05 | 0..1 s |  |\n| `side` | \"left\" | \"left\", \"right\" |  |\n| `times` | 2 | "
                  "1..9 | how "
                  "often |\n") != std::string::npos);
}
