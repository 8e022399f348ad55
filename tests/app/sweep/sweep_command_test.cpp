// kadans sweep and kadans merge as a person runs them, on the ideal plant: shards, cuts, repeat lines, refusals.
#include <algorithm>
#include <csignal>
#include <thread>

#include <doctest/doctest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/program.h"

namespace sweep_command_test {

using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

// A fifth of a second on the ideal plant, in which the knee must not be stronger than the plan allows.
fs::path project(const std::string& plan_more = "") {
  const auto folder = project_copy("sweep_command");
  write(folder / "config/scenarios/short.json",
        R"({"$schema": "../schema/scenario.schema.json", "name": "short", "robot": "config/tulip/robot.json",
            "plant": "ideal", "duration_s": 0.2, "behaviors": ["stand"],
            "randomise": {"joint.*.start_rad": {"uniform": [-0.01, 0.01]}},
            "checks": [{"name": "low", "kind": "at_end", "that": "joint.l_knee.position_rad < 0.303"}]})");
  write(folder / "config/sweeps/plan.json",
        R"({"$schema": "../schema/sweep.schema.json", "name": "short", "scenarios": ["config/scenarios/short.json"],
            "sampling": "latin_hypercube", "cases": 12,
            "vary": {"joint.l_knee.start_rad": {"uniform": [-0.1, 0.1]}, "link.*.mass_scale": {"uniform": [0.9, 1.1], "together": true}},
            "metrics": {"knee_rad": {"kind": "end", "signal": "joint.l_knee.position_rad"},
                        "early": {"kind": "end", "that": "joint.l_knee.position_rad < 0.3"},
                        "low_s": {"kind": "first_time", "that": "joint.l_knee.position_rad < 0.303"}})" +
            plan_more + R"(, "time": "low_s", "first_try": "early", "worst": "knee_rad", "passed_min": 0.1})");
  return folder;
}

const std::string plan = "sweep config/sweeps/plan.json ";

std::size_t results_in(const fs::path& folder) {
  if (!fs::exists(folder)) return 0;
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) count += entry.path().filename().string()[0] != '.' ? 1 : 0;
  return count;
}

// The program started and not waited for.
pid_t start(const fs::path& folder, const std::string& arguments) {
  const std::string command = "cd '" + folder.string() + "' && exec '" KADANS_BINARY_DIR "/kadans' " + arguments +
                              " >/dev/null 2>/dev/null </dev/null";
  std::vector<std::string> words{"/bin/sh", "-c", command};
  std::vector<char*> list{words[0].data(), words[1].data(), words[2].data(), nullptr};
  pid_t pid = -1;
  REQUIRE(posix_spawn(&pid, "/bin/sh", nullptr, nullptr, list.data(), environ) == 0);
  return pid;
}

}  // namespace

TEST_CASE("Shards in any order make the same tables, byte for byte, as one process, and the last line is the count") {
  const auto folder = project();
  const Outcome whole = run(plan + "--out whole --json", folder);
  CHECK(whole.exit_code == 0);
  CHECK(std::count(whole.out.begin(), whole.out.end(), '\n') == 13);
  const std::string counts = last_line(whole.out);
  CHECK(has(counts, R"({"sweep":"short","cases":12,"passed":)"));
  CHECK_FALSE(has(counts, "null"));
  for (const char* part : {"2", "0", "1"}) {
    const Outcome outcome = run(plan + "--shard " + part + "/3 --out part" + part, folder);
    CHECK(has(outcome.out, " of 4, "));
  }
  const std::string files =
      " --csv table.csv --sqlite table.db --heat-map map.svg --x joint.l_knee.start_rad --y link.torso.mass_scale";
  const Outcome one = run("merge whole" + files, folder);
  CHECK(one.exit_code == 0);
  const std::string csv = read(folder / "table.csv"), db = read(folder / "table.db"), map = read(folder / "map.svg");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 13);
  const Outcome merged = run("merge part1 part0 part2" + files, folder);
  CHECK(merged.out == one.out);
  CHECK(read(folder / "table.csv") == csv);
  CHECK(read(folder / "table.db") == db);
  CHECK(read(folder / "map.svg") == map);
  CHECK(last_line(run("merge whole --json", folder).out) == counts);
  const Outcome nowhere = run("merge whole --csv none/table.csv", folder);
  CHECK(nowhere.exit_code == 2);
  CHECK(has(nowhere.err, "none/table.csv: cannot be written: No such file or directory"));
}

TEST_CASE("A sweep that was killed goes on where it was: at most what was running is lost") {
  const auto folder = project();
  // Runs that take a while, so that the kill comes in the middle.
  REQUIRE(edit(folder / "config/scenarios/short.json", "\"duration_s\": 0.2", "\"duration_s\": 3"));
  const pid_t sweep = start(folder, plan + "--out cut --jobs 2");
  while (results_in(folder / "cut/cases") < 3) std::this_thread::yield();
  REQUIRE(kill(sweep, SIGKILL) == 0);
  REQUIRE(waitpid(sweep, nullptr, 0) == sweep);
  const std::size_t kept = results_in(folder / "cut/cases");
  CHECK(kept >= 3);
  REQUIRE(kept < 12);
  const Outcome part = run("merge cut", folder);
  CHECK(part.exit_code == 1);
  CHECK(has(part.out, "missing: " + std::to_string(12 - kept) + " of 12 cases"));
  const Outcome rest = run(plan + "--out cut --json", folder);
  CHECK(static_cast<std::size_t>(std::count(rest.out.begin(), rest.out.end(), '\n')) == 12 - kept + 1);
  CHECK(run(plan + "--out whole", folder).exit_code == 0);
  (void)run("merge cut --csv cut.csv", folder);
  (void)run("merge whole --csv whole.csv", folder);
  CHECK(read(folder / "cut.csv") == read(folder / "whole.csv"));
  CHECK(last_line(rest.out) == last_line(run(plan + "--out whole --json", folder).out));  // nothing is left to run
}

TEST_CASE("The line that repeats a case makes the same run") {
  const auto folder = project();
  const Outcome sweep = run(plan + "--out whole", folder);
  const std::size_t again = sweep.out.find("again: kadans ");
  REQUIRE(again != std::string::npos);
  const std::string command = sweep.out.substr(again + 14, sweep.out.find('\n', again) - again - 14);
  CHECK(has(command, "'link.*.mass_scale="));
  const Outcome repeated = run(command + " --no-record --json", folder);
  const std::size_t hash = repeated.out.find("\"state_hash\":\"");
  REQUIRE(hash != std::string::npos);
  (void)run("merge whole --csv table.csv", folder);
  const std::string csv = read(folder / "table.csv");
  CHECK(has(csv, repeated.out.substr(hash + 14, 16)));
  const Outcome other = run(command + " --no-record --json --set joint.l_knee.start_rad=0.02", folder);
  CHECK_FALSE(has(csv, other.out.substr(other.out.find("\"state_hash\":\"") + 14, 16)));
}

TEST_CASE("A run that hangs is one failed case, the others go on") {
  const auto folder = project();
  write(folder / "config/scenarios/endless.json", read(folder / "config/scenarios/short.json"));
  REQUIRE(edit(folder / "config/scenarios/endless.json", "\"duration_s\": 0.2",
               "\"duration_s\": 100000, \"wall_limit_s\": 0.2"));
  REQUIRE(edit(folder / "config/scenarios/endless.json", "\"name\": \"short\"", "\"name\": \"endless\""));
  REQUIRE(edit(folder / "config/sweeps/plan.json", "[\"config/scenarios/short.json\"]",
               "[\"config/scenarios/short.json\", \"config/scenarios/endless.json\"]"));
  const Outcome sweep = run(plan + "--cases 4 --out whole", folder);
  CHECK(has(sweep.out, "endless: 0 of 2"));
  CHECK(has(sweep.out, "2  timed out"));
}

TEST_CASE(
    "Results of another seed, scenario or plan are never mixed, and a wrong plan is refused before anything runs") {
  const auto folder = project();
  CHECK(run(plan + "--out a --shard 0/2", folder).exit_code == 0);
  const Outcome other = run(plan + "--out a --seed 2", folder);
  CHECK(other.exit_code == 2);
  CHECK(has(other.err, "another sweep"));
  CHECK(has(other.err, "seed 1 and 2"));
  REQUIRE(edit(folder / "config/scenarios/short.json", "0.303", "0.304"));
  CHECK(run(plan + "--out b --shard 1/2", folder).exit_code == 0);
  const Outcome mixed = run("merge a b", folder);
  CHECK(mixed.exit_code == 2);
  CHECK(has(mixed.err, "plan "));
  REQUIRE(edit(folder / "config/sweeps/plan.json", "[0.9, 1.1]", "[0.9, 200]"));
  REQUIRE(edit(folder / "config/sweeps/plan.json", "joint.l_knee.start_rad", "joint.l_kne.start_rad"));
  const Outcome wrong = run(plan + "--out c", folder);
  CHECK(wrong.exit_code == 2);
  CHECK(has(wrong.err, "mass_scale is 200, must be 0.01..100"));
  CHECK(has(wrong.err, "did you mean 'joint.l_knee.start_rad'?"));
  CHECK_FALSE(fs::exists(folder / "c"));
  CHECK(run("check config/sweeps/plan.json", folder).exit_code == 2);
}

TEST_CASE("A task of a Slurm array takes its part by itself") {
  const auto folder = project();
  for (const char* task : {"1", "2"}) {
    setenv("SLURM_ARRAY_TASK_ID", task, 1);
    setenv("SLURM_ARRAY_TASK_COUNT", "2", 1);
    setenv("SLURM_ARRAY_TASK_MIN", "1", 1);
    CHECK(has(run(plan + "--cases 4 --out shared", folder).out, "this is part"));
  }
  for (const char* name : {"ID", "COUNT", "MIN"}) unsetenv((std::string("SLURM_ARRAY_TASK_") + name).c_str());
  CHECK(results_in(folder / "shared/cases") == 4);
  CHECK(has(run("merge shared", folder).out, " of 4, "));
}

}  // namespace sweep_command_test
