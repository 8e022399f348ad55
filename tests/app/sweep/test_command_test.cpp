// kadans test: what it chooses, runs, tells and leaves.
#include <algorithm>

#include <doctest/doctest.h>

#include "app/program.h"

namespace test_command_test {

using namespace kadans::program;

namespace {

// Half a second on the ideal plant, with one check.
std::string scenario(const std::string& name, const std::string& that, const std::string& more = "") {
  return R"({"$schema": "../schema/scenario.schema.json", "name": ")" + name +
         R"(", "robot": "config/tulip/robot.json", "plant": "ideal", "duration_s": 0.5, "behaviors": ["stand"],)" +
         more + R"("checks": [{"name": "bent", "kind": "at_end", "that": ")" + that + "\"}]}\n";
}

std::filesystem::path project() {
  const auto folder = project_copy("test_command");
  std::filesystem::remove_all(folder / "config/scenarios");
  std::filesystem::create_directories(folder / "config/scenarios");
  write(folder / "config/scenarios/bent.json",
        scenario("bent", "joint.l_knee.position_rad > 0.2", R"("tags": ["knee"], "repeat": 2,)"));
  write(folder / "config/scenarios/straight.json", scenario("straight", "joint.l_knee.position_rad < 0.1"));
  return folder;
}

Outcome run_test(const std::filesystem::path& folder, const std::string& options) {
  return run("test " + options, folder);
}

}  // namespace

TEST_CASE("test refuses scenarios whose names are one in what is kept of their runs, before any runs") {
  const auto folder = project();
  for (const auto& [file, name] : {std::pair{"x.json", "bent"}, {"y.json", "a/b"}, {"z.json", "a_b"}})
    write(folder / "config/scenarios" / file, scenario(name, "time_s > 0"));
  const Outcome outcome = run_test(folder, "");
  CHECK(outcome.exit_code == 2);
  CHECK_MESSAGE(has(outcome.err, "x.json: name 'bent': "), outcome.err);
  CHECK(has(outcome.err, "bent.json has the name 'bent'"));
  CHECK(has(outcome.err, "has the name 'a/b'"));
  CHECK(!has(outcome.out, "passed"));
}

TEST_CASE("test runs what is chosen by name, tag, pattern and path, and its exit code tells whether all passed") {
  const auto folder = project();
  for (const char* chosen : {"knee", "ben", "b*t", "config/scenarios/bent.json"}) {
    CAPTURE(chosen);
    const Outcome outcome = run_test(folder, chosen);
    CHECK(outcome.exit_code == 0);
    CHECK(has(outcome.out, "2 runs, all passed"));  // it repeats
    CHECK(has(outcome.out, "bent (seed 2)"));
  }
  const Outcome all = run_test(folder, "--repeat 1");
  CHECK(all.exit_code == 1);
  CHECK(has(all.out, "2 runs, 1 failed"));
}

TEST_CASE("A failed run shows its check, the signal, and the command that fails in the same way") {
  const auto folder = project();
  const Outcome failed = run_test(folder, "straight --seed 7");
  CHECK(failed.exit_code == 1);
  CHECK(has(failed.out, "straight (seed 7): failed"));
  CHECK(has(failed.out, "joint.l_knee.position_rad, rad"));
  const std::size_t again = failed.out.find("again: kadans ");
  REQUIRE(again != std::string::npos);
  const std::string command = failed.out.substr(again + 14, failed.out.find('\n', again) - again - 14);
  CHECK(run(command + " --no-record", folder).exit_code == 1);
}

TEST_CASE("With --json each run is one line, with --junit the results are left as XML") {
  const auto folder = project();
  const Outcome outcome = run_test(folder, "--json --junit results.xml --jobs 1 --repeat 1");
  CHECK(std::count(outcome.out.begin(), outcome.out.end(), '\n') == 2);
  CHECK(has(outcome.out, R"("status":"failed")"));
  CHECK(has(outcome.out, R"("state_hash":")"));
  const std::string xml = read(folder / "results.xml");
  CHECK(has(xml, "tests=\"2\" failures=\"1\" errors=\"0\""));
  CHECK(has(xml, "again: kadans sim"));
}

TEST_CASE("What failed the last time can be run alone, until it passes") {
  const auto folder = project();
  CHECK(run_test(folder, "--repeat 1").exit_code == 1);
  const Outcome again = run_test(folder, "--repeat 1 --rerun-failed");
  CHECK(again.exit_code == 1);
  CHECK(has(again.out, "1 runs, 1 failed"));
  REQUIRE(edit(folder / "config/scenarios/straight.json", "< 0.1", "> 0.1"));
  CHECK(run_test(folder, "--repeat 1 --rerun-failed").exit_code == 0);
  CHECK(has(run_test(folder, "--repeat 1 --rerun-failed").out, "nothing failed the last time"));
}

TEST_CASE("--list tells what would run, with --rerun-failed only that, with the seeds that failed") {
  const auto folder = project();
  CHECK(has(run_test(folder, "--rerun-failed --list").out, "nothing failed the last time"));
  const Outcome all = run_test(folder, "--list");
  CHECK(all.exit_code == 0);
  CHECK(has(all.out, "bent (seed 1) #knee"));
  CHECK(has(all.out, "bent (seed 2) #knee"));
  CHECK(has(all.out, "straight (seed 1)"));
  CHECK(run_test(folder, "--seed 7 --repeat 2").exit_code == 1);
  const Outcome failed = run_test(folder, "--rerun-failed --list");
  CHECK(has(failed.out, "straight (seed 7)"));
  CHECK(has(failed.out, "straight (seed 8)"));
  CHECK_FALSE(has(failed.out, "bent"));
  CHECK_FALSE(has(run_test(folder, "--rerun-failed --list --seed 8 --repeat 1").out, "seed 7"));
  CHECK(has(run_test(folder, "--rerun-failed").out, "2 runs, 2 failed"));  // with those seeds
}

TEST_CASE("A failure says what was wanted, and its command works in a shell, whatever the file is called") {
  const auto folder = project();
  std::filesystem::rename(folder / "config/scenarios/straight.json", folder / "config/scenarios/it's straight.json");
  const Outcome failed = run_test(folder, "straight --repeat 1 --junit results.xml --report pages --film never");
  CHECK(has(failed.out, ", wanted at the end joint.l_knee.position_rad < 0.1\n"));
  CHECK(has(read(folder / "results.xml"), "wanted at the end joint.l_knee.position_rad &lt; 0.1"));
  CHECK(has(read(folder / "pages/index.html"), "wanted at the end joint.l_knee.position_rad &lt; 0.1"));
  CHECK(has(run_test(folder, "straight --repeat 1 --json").out, R"("wanted":"at the end joint.l_knee)"));
  const std::size_t again = failed.out.find("again: kadans ");
  REQUIRE(again != std::string::npos);
  const std::string command = failed.out.substr(again + 14, failed.out.find('\n', again) - again - 14);
  CHECK(run(command + " --no-record", folder).exit_code == 1);
}

TEST_CASE("Fail-fast stops at the first failure, a wrong scenario or selector is refused before anything runs") {
  const auto folder = project();
  const Outcome first = run_test(folder, "straight bent --fail-fast --jobs 1 --repeat 1");
  CHECK(has(first.out, "1 runs, 1 failed"));
  const Outcome unknown = run_test(folder, "straigt");
  CHECK(unknown.exit_code == 2);
  CHECK(has(unknown.err, "did you mean 'straight'?"));
  write(folder / "config/scenarios/wrong.json", scenario("wrong", "true", R"("sed": 1,)"));
  const Outcome wrong = run_test(folder, "");
  CHECK(wrong.exit_code == 2);
  CHECK(has(wrong.err, "wrong.json:1:"));
  CHECK(has(wrong.err, "did you mean 'seed'?"));
}

TEST_CASE("A run that takes too long is stopped and has failed, the others go on") {
  const auto folder = project();
  write(folder / "config/scenarios/straight.json", scenario("straight", "true", R"("wall_limit_s": 0.1, "seed": 1,)"));
  REQUIRE(edit(folder / "config/scenarios/straight.json", "\"duration_s\": 0.5", "\"duration_s\": 100000"));
  const Outcome outcome = run_test(folder, "--repeat 1");
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "straight (seed 1): timed out"));
  CHECK(has(outcome.out, "2 runs, 1 failed"));
}

TEST_CASE("A control object that crashes the process is one failed row, the suite goes on") {
  const auto folder = project();
  const std::string plugin = KADANS_BINARY_DIR "/tests/plugins/crashing_step_plugin.so";
  std::filesystem::copy(folder / "config/tulip/robot.json", folder / "config/tulip/crashing.json");
  const auto robot = folder / "config/tulip/crashing.json";
  REQUIRE(edit(robot, "\"name\": \"tulip\",", "\"name\": \"tulip\", \"plugins\": [\"" + plugin + "\"],"));
  REQUIRE(edit(robot, "\"objects\": [", R"("objects": [{ "name": "bomb", "type": "hostile", "joints": ["l_knee"] },)"));
  REQUIRE(edit(robot, "\"sets\": {", R"("sets": { "bomb": { "objects": ["bomb"] },)"));
  REQUIRE(edit(robot, "\"initial_set\": \"posture\"", "\"initial_set\": \"bomb\""));
  write(folder / "config/scenarios/crashing.json", R"({"name": "crashing", "robot": "config/tulip/crashing.json",
    "plant": "ideal", "duration_s": 0.5, "checks": [{"name": "runs", "kind": "at_end", "that": "true"}]})");
  const Outcome outcome = run_test(folder, "bent crashing --jobs 1 --repeat 1 --junit results.xml");
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "crashing (seed 1): crashed"));
  CHECK(has(outcome.out, "2 runs, 1 failed"));
  CHECK(has(read(folder / "results.xml"), "errors=\"1\""));
}

TEST_CASE("The shipped suite passes and ends with its golden hashes") {
  const auto folder = project_copy("test_command_shipped");
  Outcome outcome = run_test(folder, "--golden");
  // The hashes are those of one architecture and of one build of Bullet.
  for (const char* other : {": the golden hashes are those of ", "holds the hashes of "}) {
    if (outcome.exit_code == 0 || !has(outcome.out + outcome.err, other)) continue;
    MESSAGE("the golden hashes are not for this machine");
    outcome = run_test(folder, "");
  }
  CAPTURE(outcome.out);
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(has(outcome.out, "all passed"));
}

}  // namespace test_command_test
