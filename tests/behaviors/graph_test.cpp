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
  CHECK(has(text, "[*] --> s8: [when] (safety)"));
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

TEST_CASE("behavior graph refuses a format that it does not know and a file that is wrong") {
  const auto project = project_copy("graph_wrong");
  CHECK(run("behavior graph behaviors/tulip/squat.lua --format png", project).exit_code == 2);
  write(project / "behaviors/tulip/squat.lua", "return 1");
  CHECK(run("behavior graph behaviors/tulip/squat.lua", project).exit_code == 2);
}
