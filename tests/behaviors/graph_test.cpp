#include <doctest/doctest.h>

#include "app/program.h"

using namespace kadans::program;

namespace {

constexpr const char* nested =
    "local k = require \"kadans\"\n"
    "return k.behavior \"nested\" {\n"
    "  initial = \"work\",\n"
    "  always = { { when = function(s) return s.safety.level ~= \"normal\" end, to = \"done\", why = \"safety\" } },\n"
    "  k.parallel \"work\" {\n"
    "    k.region \"left\"  { controls = \"posture\", initial = \"a\", k.state \"a\" { { after = 1.5, to = \"b\" } }, "
    "k.final \"b\" { outcome "
    "= \"ok\" } },\n"
    "    k.region \"right\" { initial = \"c\", k.state \"c\" { { on = \"go\", to = \"d\" } }, k.final \"d\" { outcome "
    "= \"ok\" } },\n"
    "    { on = \"done\", to = \"done\" },\n"
    "  },\n"
    "  k.final \"done\" { outcome = \"done\" },\n"
    "}\n";

std::string graph(const char* name, const char* options) {
  const auto project = project_copy(name);
  write(project / "behaviors/tulip/nested.lua", nested);
  const Outcome outcome = run(std::string("behavior graph behaviors/tulip/nested.lua ") + options, project);
  REQUIRE_MESSAGE(outcome.exit_code == 0, outcome.err);
  return outcome.out;
}

}  // namespace

TEST_CASE("behavior graph draws states, regions and what takes each transition, as Mermaid") {
  const std::string text = graph("graph_mermaid", "");
  CHECK(text.rfind("stateDiagram-v2\n", 0) == 0);
  CHECK(has(text, "state \"work\" as s1 {"));
  CHECK(has(text, "--\n"));  // between the regions
  CHECK(has(text, "s3 --> s4: after 1.5 s"));
  CHECK(has(text, "s6 --> s7: go"));
  CHECK(has(text, "[*] --> s8: «always» [when] (safety)"));
  CHECK(has(text, "s8 --> [*]"));
}

TEST_CASE("behavior graph draws the same for Graphviz") {
  const std::string text = graph("graph_dot", "--format dot");
  CHECK(text.rfind("digraph \"nested\" {", 0) == 0);
  CHECK(has(text, "subgraph cluster_s1 {"));
  CHECK(has(text, "label=\"left [posture]\"; style=dashed;"));
  CHECK(has(text, "s4 [label=\"b: ok\", shape=doublecircle];"));
  CHECK(has(text, "s3 -> s4 [label=\"after 1.5 s\"];"));
}

TEST_CASE("behavior graph draws actions alone, local transitions, histories and forks as UML does") {
  const auto project = project_copy("graph_forms");
  write(project / "behaviors/tulip/forms.lua", R"(local k = require "kadans"
    local function f() end
    return k.behavior "forms" { initial = "w",
      k.state "w" { initial = "p", { on = "x.*", action = f }, { on = "in", to = "q", internal = true },
        { on = "out", to = "q" }, always = { { after = 5, to = "q" } },
        k.parallel "p" { k.history "h" { deep = true, to = { "b", "d" } },
          k.region "l" { initial = "a", k.state "a" {}, k.state "b" {} },
          k.region "r" { initial = "c", k.state "c" {}, k.state "d" {} } },
        k.state "q" { { on = "back", to = { "a", "d" } }, { on = "again", to = "h" } } } })");
  const std::string dot = run("behavior graph behaviors/tulip/forms.lua --format dot", project).out;
  CHECK(has(dot, R"(label="w\nx.* / action"; style=rounded;)"));
  CHECK(has(dot, "subgraph cluster_s1 { p1 [shape=point, width=0.03]; }\n  p1 -> s10 [label=\"in {local}\"];"));
  CHECK(has(dot, "s5 -> p2 [ltail=cluster_s1, arrowhead=none];\n  p2 -> s10 [label=\"out\"];"));
  CHECK(has(dot, "p3 -> s10 [label=\"«always» after 5 s\"];"));
  CHECK(has(dot, "s3 [label=\"H*\", shape=circle];"));
  CHECK(has(dot, "s3 -> s6;"));
  CHECK(has(dot, "s10 -> f4 [label=\"back\"];"));
  CHECK(has(dot, "f4 -> s5 [];\n  f4 -> s9 [];"));
  const std::string mermaid = run("behavior graph behaviors/tulip/forms.lua", project).out;
  CHECK(has(mermaid, "state \"w<br/>x.* / action\" as s1 {"));
  CHECK(has(mermaid, "state f4 <<fork>>\n  s10 --> f4: back\n  f4 --> s5\n  f4 --> s9\n"));
  CHECK(has(mermaid, "s3 --> s6\n"));
  CHECK(has(mermaid, "s10 --> s3: again"));
}

TEST_CASE("behavior graph refuses a format that it does not know and a file that is wrong") {
  const auto project = project_copy("graph_wrong");
  CHECK(run("behavior graph behaviors/tulip/squat.lua --format png", project).exit_code == 2);
  write(project / "behaviors/tulip/squat.lua", "return 1");
  CHECK(run("behavior graph behaviors/tulip/squat.lua", project).exit_code == 2);
}
