// What is read from a run's process, and how a suite tells it.
#include "campaign/suite/run_outcome.h"

#include <doctest/doctest.h>

#include "campaign/suite/suite_report.h"
#include "signal/utf8.h"

namespace run_outcome_test {

using namespace kadans;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const char* failed_report =
    R"json({"scenario":"push","seed":7,"passed":false,"checks":[{"name":"stays up","passed":false,"value":0.4,"at_s":1.5,"wanted":">= 0.6"},
       {"name":"calm","passed":true,"value":null,"at_s":0}],"duration_s":2.0,"state_hash":"12ab","errors":[],
       "quantities":{"ground.friction":0.5},"transitions":["   1.20 s  squat: stand -> fall (safety)"],
       "evidence":[{"check":"stays up","signal":"plant.base.height_m","unit":"m","from_s":0.5,"to_s":2.0,
                    "values":[0.8,0.7,null,0.4]}]})json";

RunOutcome failed_run() {
  RunOutcome run = read_run_outcome({.exit_code = 1, .wall_s = 0.5, .out = failed_report});
  run.repeat = "kadans sim push.json --seed 7";
  return run;
}

}  // namespace

TEST_CASE("The report of a run is read, whatever the process ended with") {
  const RunOutcome run = failed_run();
  CHECK(run.status == RunStatus::failed);
  CHECK(run.seed == 7);
  CHECK(run.state_hash == "12ab");
  REQUIRE(run.checks.size() == 2);
  CHECK_FALSE(run.checks[0].passed);
  REQUIRE(run.traces.size() == 1);
  CHECK(run.traces[0].values.size() == 4);
  REQUIRE(run.quantities.size() == 1);
  CHECK(run.quantities[0].value == 0.5);
}

TEST_CASE("A process that was refused, crashed, hung or was stopped is none that passed") {
  CHECK(read_run_outcome({.exit_code = 2, .err = "error: x.json:1:1: wrong\n"}).errors.front() ==
        "error: x.json:1:1: wrong");
  CHECK(read_run_outcome({.exit_code = 2}).status == RunStatus::refused);
  CHECK(read_run_outcome({.exit_code = 0}).status == RunStatus::crashed);  // says it passed and leaves no report
  CHECK(read_run_outcome({.exit_code = 0, .out = "{ half a rep"}).status == RunStatus::crashed);
  const RunOutcome crashed = read_run_outcome({.signal = 11});
  CHECK(crashed.status == RunStatus::crashed);
  CHECK(has(crashed.errors.front(), "signal 11"));
  CHECK(read_run_outcome({.signal = 9, .timed_out = true}).status == RunStatus::timed_out);
  CHECK(read_run_outcome({.signal = 9, .cancelled = true}).status == RunStatus::cancelled);
}

TEST_CASE("A failure shows the check, its moment, the signal, the transitions, what was drawn and how to repeat it") {
  const std::string text = failure_report(failed_run(), {.color = false, .unicode = false});
  CHECK(has(text, "push (seed 7): failed"));
  CHECK(has(text, "stays up: 0.4 at 1.500 s, wanted >= 0.6\n"));
  CHECK(has(text, "plant.base.height_m, m"));
  CHECK(has(text, "stand -> fall (safety)"));
  CHECK(has(text, "ground.friction=0.5"));
  CHECK(has(text, "again: kadans sim push.json --seed 7"));
  CHECK_FALSE(has(text, "calm"));
}

TEST_CASE("JUnit XML counts failures and errors apart and escapes what it tells") {
  RunOutcome crashed = read_run_outcome({.signal = 11});
  crashed.scenario = "a<b>\"c\"";
  const std::string xml = junit_xml({failed_run(), crashed}, 1.5);
  CHECK(has(xml, "tests=\"2\" failures=\"1\" errors=\"1\""));
  CHECK(has(xml, "<failure type=\"failed\" message=\"failed: stays up is 0.4, wanted &gt;= 0.6\">"));
  CHECK(has(xml, "a&lt;b&gt;&quot;c&quot; seed 0"));
}

TEST_CASE("JUnit XML and JSON lines hold no byte that their readers refuse") {
  RunOutcome run = failed_run();
  run.file =
      "kn\xff\xfe\x01"
      "ee.json";
  run.errors = {"said \xc0\xaf and \xef\xbf\xbf and \x1b[31m"};
  const std::string xml = junit_xml({run}, 1);
  CHECK(find_invalid_utf8(xml) == std::string::npos);
  CHECK(xml.find('\x01') == std::string::npos);
  CHECK(xml.find('\x1b') == std::string::npos);
  CHECK(xml.find("\xef\xbf\xbf") == std::string::npos);
  CHECK(has(xml,
            "kn\xef\xbf\xbd\xef\xbf\xbd"
            "ee.json"));
  CHECK(find_invalid_utf8(run_json(run)) == std::string::npos);
}

}  // namespace run_outcome_test
