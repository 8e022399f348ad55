// What a recorded robot observed, read from its record, and fed again to a simulation and by a detector.
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"
#include "kadans/signal/input_error.h"
#include "supervisor/world/perception_message.h"
#include "telemetry/reading/record_observations.h"

namespace observations_test {

using namespace kadans;
using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

// A record of TULip that walks to a ball, 8 s, and its folder with the project.
const fs::path& recorded() {
  static const fs::path project = [] {
    fs::path made = project_copy("observations");
    const Outcome outcome = run("sim config/scenarios/fetch.json --duration 8 --record fetch.mcap", made);
    REQUIRE_MESSAGE(outcome.exit_code <= 1, outcome.err);
    return made;
  }();
  return project;
}

double field(const RecordedObservation& one, const char* name) {
  for (const auto& [known, value] : one.fields) {
    if (known == name) return value;
  }
  return std::nan("");
}

ScenarioConfig fed(const std::string& file, double from_s = 0) {
  ScenarioConfig scenario = read_scenario_config((recorded() / "config/scenarios/fetch.json").string());
  scenario.checks.clear();
  scenario.perception = {{.entry = {"ball", {}}, .object = {}, .record = {file, {}}, .from_s = from_s}};
  return scenario;
}

std::string error_of(const std::string& file) {
  try {
    (void)read_observations(file);
  } catch (const InputError& error) {
    return error.problems().front().text();
  }
  return "";
}

}  // namespace

TEST_CASE("A record gives back what was observed: as often, as late, and from where the robot was then") {
  const std::vector<RecordedObservation> all = read_observations((recorded() / "fetch.mcap").string());
  CHECK(all.size() > 50);  // of 15 pictures a second, 20 % miss it, and it comes out from behind a box
  std::int64_t last_ns = 0;
  for (const RecordedObservation& one : all) {
    CHECK(one.entry == "ball");
    CHECK(one.came_ns > last_ns);
    last_ns = one.came_ns;
    CHECK(one.age_s >= 0.099);  // its latency, and what the supervisor's tick adds
    CHECK(one.age_s < 0.2);
    CHECK(std::hypot(field(one, "x_m"), field(one, "y_m")) < 6);
  }
}

TEST_CASE("What a record tells is perceived again: the same run, when the robot is the same") {
  RunLog first_log, again_log;
  ScenarioConfig first = fed((recorded() / "fetch.mcap").string());
  Assembly again(first, first.seed, again_log);
  Checks checks(again.catalog().signals,
                {{.name = "knows it", .kind = CheckKind::at_end, .that = "seen.ball.confidence > 0"},
                 {.name = "where it is, m",
                  .kind = CheckKind::always,
                  .that = "not (seen.ball.confidence > 0.9) or abs(seen.ball.x_m) < 6"}});
  const RunResult result = run_scenario(again.parts(), 6, checks, {});
  for (const auto& check : result.checks) CHECK_MESSAGE(check.passed, check.name);
  bool goes = false;
  for (const Transition& transition : again_log.transitions())
    goes = goes || (transition.behavior == "fetch" && transition.to == "go");
  CHECK(goes);
  CHECK(again.control().state().seen.entries[0].source == SeenSource::record);
}

TEST_CASE("The sequence of a record as text is read back the same, and a part of it from a time on") {
  const std::vector<RecordedObservation> all = read_observations((recorded() / "fetch.mcap").string());
  const Outcome made = run("log observations fetch.mcap -o ball.csv --force", recorded());
  REQUIRE_MESSAGE(made.exit_code == 0, made.err);
  const std::vector<RecordedObservation> again = read_observations((recorded() / "ball.csv").string());
  REQUIRE(again.size() == all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(again[i].came_ns == all[i].came_ns);
    CHECK(again[i].age_s == all[i].age_s);
    CHECK(again[i].confidence == all[i].confidence);
    CHECK(field(again[i], "x_m") == field(all[i], "x_m"));
  }
  const Outcome part = run("log observations fetch.mcap --from 5", recorded());
  CHECK(part.exit_code == 0);
  CHECK(part.out.starts_with("time_s,entry,age_s,confidence,x_m,y_m\n5"));
}

TEST_CASE("A scenario with perception from a record is repeated from its own record, which has the file in it") {
  write(recorded() / "config/scenarios/fed.json",
        R"({ "based_on": "config/scenarios/fetch.json", "name": "fed", "duration_s": 2, "checks": [],
  "perception": [{ "entry": "ball", "record": "fetch.mcap", "from_s": 1 }] })");
  const Outcome made = run("sim config/scenarios/fed.json --record fed.mcap", recorded());
  REQUIRE_MESSAGE(made.exit_code == 0, made.err);
  const fs::path elsewhere = fresh_folder("observations_elsewhere");
  fs::copy_file(recorded() / "fed.mcap", elsewhere / "fed.mcap");
  const Outcome outcome = run("replay fed.mcap --from-record", elsewhere);
  CHECK_MESSAGE(outcome.exit_code == 0, (outcome.out + outcome.err));
}

TEST_CASE("Perception from a record is refused with its place: no such file, entry or field, or what comes with it") {
  const auto refused = [](const std::string& perception) {
    write(recorded() / "config/scenarios/wrong.json",
          R"({ "based_on": "config/scenarios/fetch.json", "name": "wrong", "duration_s": 1, "checks": [],
  "perception": [)" +
              perception + "] }");
    return run("sim config/scenarios/wrong.json --no-record", recorded()).err;
  };
  CHECK(has(refused(R"({ "entry": "ball", "record": "nowhere.mcap" })"), "wrong.json:2:47: record: there is no file"));
  CHECK(has(refused(R"({ "entry": "ball" })"), "needs either an object of the world, or a record: it has none"));
  CHECK(has(refused(R"({ "entry": "ball", "object": "ball", "record": "fetch.mcap" })"), "it has both"));
  CHECK(has(refused(R"({ "entry": "ball", "record": "fetch.mcap", "missed": 0.5 })"), "missed: comes with the record"));
  CHECK(has(refused(R"({ "entry": "ball", "object": "ball", "from_s": 1 })"), "from_s: only perception from a record"));
  CHECK(has(refused(R"({ "entry": "bal", "record": "fetch.mcap" })"), "did you mean 'ball'?"));
  write(recorded() / "door.csv", "time_s,entry,age_s,x_m,y_m\n0,door,0,1,1\n");
  CHECK(has(refused(R"({ "entry": "ball", "record": "door.csv" })"), "door.csv tells nothing of 'ball'"));
  write(recorded() / "half.csv", "time_s,entry,age_s,x_m\n0,ball,0,1\n");
  CHECK(has(refused(R"({ "entry": "ball", "record": "half.csv" })"), "an observation of 'ball' has no y_m"));
}

TEST_CASE("A wrong sequence is refused with its line, and a record without a world model says so") {
  const fs::path folder = fresh_folder("observations_wrong");
  const auto wrong = [&](const std::string& text) {
    write(folder / "s.csv", text);
    return error_of((folder / "s.csv").string());
  };
  CHECK(has(wrong(""), "is empty"));
  CHECK(has(wrong("time_s,age_s\n"), "s.csv:1: the head has no column 'entry'"));
  CHECK(has(wrong("time_s,entry,age_s\n0,ball,x\n"), "s.csv:2: age_s must be a number, not 'x'"));
  CHECK(has(wrong("time_s,entry,age_s\n0,ball,-1\n"), "s.csv:2: age_s must be 0..60 s"));
  CHECK(has(wrong("time_s,entry,confidence\n0,ball,2\n"), "s.csv:2: confidence must be 0..1"));
  CHECK(has(wrong("time_s,entry,age_s\n0,,0\n"), "s.csv:2: names no entry"));
  CHECK(has(wrong("time_s,entry,age_s\n0,ball,0,1\n"), "s.csv:2: has more cells than the head"));
  CHECK(has(wrong("time_s,entry,age_s\n1,ball,0\n0,ball,0\n"), "s.csv:3: time_s is before that of the line above"));
  CHECK(has(wrong("time_s,entry\nnan,ball\n"), "s.csv:2: time_s must be a number"));
  CHECK(has(error_of((folder / "nowhere.csv").string()), "there is no such file"));
  const fs::path project = project_copy("observations_none");
  REQUIRE(run("sim config/scenarios/squat.json --duration 0.2 --record s.mcap", project).exit_code <= 1);
  const Outcome none = run("log observations s.mcap", project);
  CHECK(none.exit_code == 2);
  CHECK(has(none.err, "has no observations: its robot had no world model"));
}

TEST_CASE("The detector that plays sequences plays a record: a datagram for each time, which the supervisor reads") {
  const fs::path& project = recorded();
  const std::string command =
      "cd '" + project.string() +
      "' && KADANS='" KADANS_BINARY_DIR
      "/kadans' python3 -c \"import runpy\n"
      "play = runpy.run_path('" KADANS_SOURCE_DIR
      "/scripts/play_perception')\n"
      "for at_s, datagram in play['datagrams'](play['sequence_of']('fetch.mcap')): print(datagram.decode())\" >sent";
  REQUIRE(std::system(command.c_str()) == 0);  // NOLINT(concurrency-mt-unsafe): the point
  const std::vector<SeenInfo> declared{
      {.name = "ball", .places = 2, .fields = {{"x_m", "m", "", -100, 100}, {"y_m", "m", "", -100, 100}}}};
  const std::vector<RecordedObservation> all = read_observations((project / "fetch.mcap").string());
  std::vector<Observation> seen;
  std::istringstream lines(read(project / "sent"));
  for (std::string line; std::getline(lines, line);) CHECK(read_perception(line, declared, 60'000'000'000, seen) == "");
  REQUIRE(seen.size() == all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(seen[i].fields[0] == doctest::Approx(field(all[i], "x_m")));
    CHECK(1e-9 * static_cast<double>(60'000'000'000 - seen[i].time_ns) == doctest::Approx(all[i].age_s));
  }
}

}  // namespace observations_test
