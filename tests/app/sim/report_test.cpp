// --report: pages about runs that need nothing but themselves.
#include <cstdlib>
#include <filesystem>

#include <doctest/doctest.h>

#include "app/program.h"

namespace report_test {

using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

bool gnuplot_is_here() { return std::system("gnuplot --version >/dev/null 2>&1") == 0; }  // NOLINT: the shell's PATH

// Whatever would make a browser ask somebody for something.
void check_alone(const std::string& page) {
  for (const char* request : {"src=\"http", "href=\"http", "url(http", "<script", "@import", "<link rel=\"stylesheet"})
    CHECK_MESSAGE(!has(page, request), request);
}

std::string scenario(const std::string& name, const std::string& that) {
  return R"({"$schema": "../schema/scenario.schema.json", "name": ")" + name + R"(", "doc": "Says <b> & waits.",
      "robot": "config/tulip/robot.json", "plant": "ideal", "duration_s": 0.5, "behaviors": ["stand"],
      "checks": [{"name": "bent", "kind": "at_end", "that": ")" +
         that + "\"}]}\n";
}

fs::path project(const std::string& name) {
  const fs::path folder = project_copy(name);
  fs::remove_all(folder / "config/scenarios");
  fs::create_directories(folder / "config/scenarios");
  write(folder / "config/scenarios/bent.json", scenario("bent", "joint.l_knee.position_rad > 0.2"));
  write(folder / "config/scenarios/straight.json", scenario("straight", "joint.l_knee.position_rad < 0.1"));
  return folder;
}

}  // namespace

TEST_CASE("sim --report leaves one page that tells what happened, with plots, checks and the line that repeats it") {
  const fs::path folder = project("report_sim");
  const Outcome outcome = run("sim config/scenarios/bent.json --seed 5 --report out --film never", folder);
  CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
  CHECK(has(outcome.out, "report: out/bent-5.html"));
  const std::string page = read(folder / "out/bent-5.html");
  for (const char* part :
       {"PASSED", "tulip ran bent with seed 5 for 0.5 simulated seconds", "Says &lt;b&gt; &amp; waits.",
        "joint.l_knee.position_rad &gt; 0.2", "kadans sim config/scenarios/bent.json --seed 5", "kadans view bent.mcap",
        "prefers-color-scheme: dark", "No pictures: not asked for"})
    CHECK_MESSAGE(has(page, part), part);
  check_alone(page);
  CHECK(fs::exists(folder / "bent.mcap"));
  if (!gnuplot_is_here()) return;
  CHECK(has(page, "<svg"));
  CHECK(has(page, "height of the base"));
}

TEST_CASE("the page of a failed run shows the check, the value that failed and when, and the signal it looked at") {
  const fs::path folder = project("report_failed");
  const Outcome outcome = run("sim config/scenarios/straight.json --no-record --report out --film never", folder);
  CHECK(outcome.exit_code == 1);
  const std::string page = read(folder / "out/straight-1.html");
  CHECK(has(page, "FAILED"));
  CHECK(has(page, "What failed"));
  CHECK(has(page, "<strong>bent</strong>: 0.3"));
  CHECK(has(page, "joint.l_knee.position_rad, rad: from"));
  CHECK(has(page, "1 of 1 checks did not hold"));
  CHECK_FALSE(has(page, "kadans view"));
  for (const auto& file : fs::directory_iterator(folder / "out")) CHECK(file.path().extension() == ".html");
  CHECK_FALSE(fs::exists(folder / "straight.mcap"));
}

TEST_CASE("without gnuplot and Chromium the page is there all the same, and says what is missing") {
  const fs::path folder = project("report_bare");
  const std::string path = std::getenv("PATH");  // NOLINT: no thread
  setenv("PATH", "/nonexistent", 1);             // NOLINT: no thread
  const Outcome outcome = run("sim config/scenarios/bent.json --report out", folder);
  setenv("PATH", path.c_str(), 1);  // NOLINT: no thread
  CHECK(outcome.exit_code == 0);
  const std::string page = read(folder / "out/bent-1.html");
  CHECK(has(page, "No plots: plots are drawn by gnuplot, which is not here: install the package gnuplot-nox"));
  CHECK(has(page, "No pictures: "));
  CHECK(has(page, "scripts/page") + has(page, "chromium") > 0);
}

TEST_CASE("test --report leaves a page a run and an index of all, those that failed first") {
  const fs::path folder = project("report_test");
  const Outcome outcome = run("test --report out --film never --repeat 1", folder);
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "report: out/index.html"));
  const std::string index = read(folder / "out/index.html");
  CHECK(has(index, "1 of 2 runs passed"));
  const std::size_t failed = index.find("<a href=\"straight-1.html\">"),
                    passed = index.find("<a href=\"bent-1.html\">");
  CHECK(failed < passed);
  CHECK(passed != std::string::npos);
  CHECK(has(index, "kadans sim "));
  check_alone(index);
  for (const char* page : {"straight-1.html", "bent-1.html"}) {
    CHECK(fs::exists(folder / "out" / page));
    check_alone(read(folder / "out" / page));
  }
}

}  // namespace report_test
