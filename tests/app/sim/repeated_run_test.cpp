// kadans replay of a run on threads: it happens again from the inputs in its record.
#include <algorithm>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace repeated_run_test {

using namespace kadans::program;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

const std::string on_threads = " --threads-on-virtual-time --record run.mcap --flight 0 ";

// Whether the record is repeated to its last tick.
void check_same(const fs::path& project, std::uint64_t ticks_min, bool whole = true,
                const std::string& record = "run.mcap") {
  const Outcome outcome = run("replay " + record + " --json", project);
  REQUIRE_MESSAGE(!outcome.out.empty(), outcome.err);
  CHECK_MESSAGE(outcome.exit_code == 0, outcome.out);
  const Json json = Json::parse(outcome.out);
  CHECK(json["same"] == true);
  CHECK(json["ticks"].get<std::uint64_t>() >= ticks_min);
  CHECK_MESSAGE(has(json["notes"].dump(), "not whole") != whole, outcome.out);
}

}  // namespace

TEST_CASE("Runs on threads of every robot are repeated bit for bit from their inputs") {
  for (const char* what :
       {"jiwiy/robot.json --plant ideal --play sine", "jiwiy/robot.json --plant bullet --play look",
        "head/robot.json --plant bullet --play wander", "tulip/robot.json --plant bullet --play squat",
        "tulip/robot.json --plant ideal --play wave --seed 7"}) {
    CAPTURE(what);
    const fs::path project = project_copy("repeat_robots");
    const Outcome made = run(std::string("run config/") + what + " --duration 1.5" + on_threads, project);
    REQUIRE_MESSAGE(made.exit_code == 0, made.err);
    check_same(project, 1500);
  }
}

TEST_CASE("A run whose behaviors play in a process of their own is repeated with their commands") {
  const fs::path project = project_copy("repeat_process");
  const Outcome made =
      run("run config/tulip/robot.json --play squat --behaviors process --duration 1.5" + on_threads, project);
  REQUIRE_MESSAGE(made.exit_code == 0, made.err);
  check_same(project, 1500);
}

TEST_CASE("What people order, reload and stop in a run is repeated, with the files as they were then") {
  const fs::path project = project_copy("repeat_orders");
  Running robot(project, "run config/head/robot.json --plant bullet --play wander --duration 1000 --ctl ctl -v" +
                             on_threads + "2>&1");
  REQUIRE(robot.says("wander: "));
  CHECK(edit(project / "behaviors/head/wander.lua", "return", "-- another version\nreturn"));
  for (const char* order : {"reload", "pause", "resume", "play saccade --replace", "estop", "fault clear", "stop"})
    (void)run(std::string("ctl --socket ctl ") + order, project);
  robot.end(SIGTERM);
  check_same(project, 500);
  CHECK(edit(project / "behaviors/head/wander.lua", "-- another version\n", ""));  // the record has its own
  check_same(project, 500);
}

TEST_CASE("A record that was cut short is repeated up to its end, and damage never ends the program otherwise") {
  const fs::path project = project_copy("repeat_cut");
  REQUIRE(run("run config/jiwiy/robot.json --plant ideal --play sine --duration 3" + on_threads, project).exit_code ==
          0);
  check_damaged(project / "run.mcap");
  const std::string whole = read(project / "run.mcap");
  write(project / "run.mcap", whole.substr(0, whole.size() * 3 / 4));
  check_same(project, 500, false);
}

TEST_CASE(
    "A record that went on in further files is repeated through all of them, and a later one says that it begins "
    "late") {
  const fs::path project = project_copy("repeat_files");
  REQUIRE(edit(project / "config/jiwiy/robot.json", "{", "{ \"record\": { \"file_MB\": 0.3 },"));
  fs::create_directory(project / "records");
  REQUIRE(
      run("run config/jiwiy/robot.json --plant bullet --play sine --duration 6 --threads-on-virtual-time --flight 0 "
          "--record records/",
          project)
          .exit_code == 0);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(project / "records")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() > 2);
  const Outcome all = run("replay '" + files.front().string() + "' --json", project);
  CHECK_MESSAGE(all.exit_code == 0, all.out);
  CHECK(Json::parse(all.out)["ticks"].get<int>() >= 6000);
  const Outcome later = run("replay '" + files[1].string() + "'", project);
  CHECK(later.exit_code == 2);
  CHECK_MESSAGE(has(later.err, "of its run: only a record from the first tick on can be repeated"), later.err);
}

TEST_CASE("A run with another file says where its commands part, and that the robot does not answer") {
  const fs::path project = project_copy("repeat_with");
  REQUIRE(run("run config/tulip/robot.json --play squat --duration 2.7" + on_threads, project).exit_code == 0);
  const Outcome same = run("replay run.mcap --with behaviors/tulip/squat.lua", project);
  CHECK_MESSAGE(same.exit_code == 0, same.out);
  REQUIRE(edit(project / "behaviors/tulip/squat.lua", "0.10", "0.11"));
  const Outcome other = run("replay run.mcap --with behaviors/tulip/squat.lua", project);
  CHECK(other.exit_code == 1);
  CHECK_MESSAGE(has(other.out, "the behaviors send "), other.out);
  CHECK(has(other.out, "the robot does not answer"));
  CHECK(has(run("replay run.mcap --with nothing.lua", project).err, "nothing.lua: there is no such file"));
  check_same(project, 2700);
}

TEST_CASE("A record without inputs says in a sentence why it is not repeated") {
  const fs::path project = project_copy("repeat_none");
  const std::string robot = read(project / "config/jiwiy/robot.json");
  REQUIRE(edit(project / "config/jiwiy/robot.json", "{", "{ \"record\": { \"inputs\": false },"));
  REQUIRE(run("run config/jiwiy/robot.json --plant ideal --duration 0.3" + on_threads, project).exit_code == 0);
  const Outcome none = run("replay run.mcap", project);
  CHECK(none.exit_code == 2);
  CHECK_MESSAGE(has(none.err, "holds no inputs"), none.err);
}

TEST_CASE("A record whose inputs are of another version says so") {
  const fs::path project = project_copy("repeat_version");
  REQUIRE(run("run config/jiwiy/robot.json --plant ideal --duration 0.3" + on_threads, project).exit_code == 0);
  std::string record = read(project / "run.mcap");
  const std::string format("format\x01\0\0\0", 10);
  const std::size_t at = record.find(format);
  REQUIRE(at != std::string::npos);
  record[at + format.size()] = '1';
  write(project / "run.mcap", record);
  const Outcome other = run("replay run.mcap", project);
  CHECK(other.exit_code == 2);
  CHECK_MESSAGE(has(other.err, "run.mcap: holds inputs that this kadans cannot read"), other.err);
  CHECK(has(run("log cut run.mcap --inputs -o none.mcap", project).err, "of another version of kadans"));
}

TEST_CASE("Positions that pass zero are repeated bit for bit, with the sign of each zero") {
  const fs::path project = project_copy("repeat_zeros");
  // Its hips stand at zero: their encoders read 0.0 and -0.0 by turns.
  REQUIRE(run("run config/tulip/robot.json --plant bullet --play stand --duration 4 --seed 2" + on_threads, project)
              .exit_code == 0);
  check_same(project, 4000);
}

TEST_CASE("A record that is cut with its inputs is repeated to where it was cut, also with fewer signals") {
  const fs::path project = project_copy("repeat_trimmed");
  REQUIRE(run("run config/tulip/robot.json --play squat --duration 2" + on_threads, project).exit_code == 0);
  for (const char* signals : {"", " --signals 'joint.*' --signals actuation"}) {
    CAPTURE(signals);
    const Outcome cut = run("log cut run.mcap --to 1.234 --inputs -o cut.mcap --force" + std::string(signals), project);
    REQUIRE_MESSAGE(cut.exit_code == 0, cut.err);
    check_same(project, 1233, true, "cut.mcap");
    CHECK(fs::file_size(project / "cut.mcap") < fs::file_size(project / "run.mcap") * 2 / 3);
  }
  CHECK(has(run("log cut run.mcap --from 1 --inputs -o late.mcap", project).err, "--from: does not go with --inputs"));
  REQUIRE(run("log cut run.mcap --to 1 -o plain.mcap", project).exit_code == 0);
  CHECK(has(run("replay plain.mcap", project).err, "holds no inputs"));
  CHECK(has(run("log cut plain.mcap --inputs -o none.mcap", project).err, "has no inputs to be kept"));
  CHECK_FALSE(fs::exists(project / "none.mcap"));
}

TEST_CASE("Private files are left out of a record, and who repeats it needs them as they were") {
  const fs::path project = project_copy("repeat_private");
  REQUIRE(edit(project / "config/head/robot.json", "{", "{ \"record\": { \"private\": [\"behaviors/head/wan*\"] },"));
  REQUIRE(run("run config/head/robot.json --plant bullet --play wander --duration 1" + on_threads, project).exit_code ==
          0);
  const std::string record = read(project / "run.mcap");
  CHECK(has(record, "inputs/config/head/robot.json.zst"));
  CHECK_FALSE(has(record, "inputs/behaviors/head/wander.lua.zst"));
  check_same(project, 1000);
  REQUIRE(edit(project / "behaviors/head/wander.lua", "return", "-- another version\nreturn"));
  const Outcome other = run("replay run.mcap", project);
  CHECK(other.exit_code == 2);
  CHECK_MESSAGE(has(other.err, "run.mcap: needs behaviors/head/wander.lua, a private file"), other.err);
  CHECK(run("replay run.mcap --with behaviors/head/wander.lua", project).exit_code == 0);
  fs::remove(project / "behaviors/head/wander.lua");
  CHECK(has(run("replay run.mcap", project).err, "is not in the project"));
  REQUIRE(edit(project / "config/head/robot.json", "wan*", "wonder*"));
  const Outcome unknown = run("run config/head/robot.json --plant bullet --duration 1" + on_threads, project);
  CHECK(unknown.exit_code == 2);
  CHECK_MESSAGE(has(unknown.err, "robot.json:1:"), unknown.err);
  CHECK(has(unknown.err, "is called 'behaviors/head/wonder*'"));
}

}  // namespace repeated_run_test
