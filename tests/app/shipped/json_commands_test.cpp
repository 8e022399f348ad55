// --json of every command that has it, found in the program's table of commands: JSON lines, or one value, and nothing
// else on stdout, whatever else is asked for and however it ends. And what was not written, there or into a file, is
// told and leaves an exit code that is not 0.
#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "app/command_line.h"
#include "app/program.h"
#include "signal/utf8.h"

namespace json_commands_test {

using namespace kadans;
using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

// Command lines by the command's words; --json is added. Those of ctl run beside a run, in their order.
const std::map<std::string, std::vector<std::string>> samples{
    {"sim",
     {"sim config/scenarios/knee.json", "sim config/scenarios/knee.json --no-record --hash-every 0.1 -v",
      "sim config/scenarios/knee.json --report pages --film never", "sim config/scenarios/fails.json --no-record",
      "sim config/scenarios/knee.json --checkpoint 0.1=at.mcap --no-record",
      "sim --from at.mcap --branch same: --branch 'waved: play wave'", "sim nowhere.json",
      "sim config/scenarios/knee.json --no-record --live=0", "sim config/scenarios/knee.json --record /dev/full"}},
    {"test",
     {"test knee fails", "test --list", "test --rerun-failed --list", "test --rerun-failed", "test knee",
      "test knee --rerun-failed", "test --renew-golden", "test --golden", "test --report pages --film never",
      "test knee --fail-fast --junit results.xml", "test nothing_like_it"}},
    {"replay", {"replay knee.mcap", "replay knee.mcap --from-record", "replay nowhere.mcap"}},
    {"sweep", {"sweep config/sweeps/plan.json --out part", "sweep config/sweeps/plan.json --out part --shard 0/2"}},
    {"merge", {"merge part", "merge part --csv t.csv --sqlite t.db", "merge nowhere"}},
    {"margin",
     {"margin config/tulip/robot.json knee --quantity delay=0.05 --seeds 1", "margin config/tulip/robot.json fails",
      "margin config/tulip/robot.json nothing_like_it"}},
    {"shrink",
     {"shrink config/scenarios/fails.json", "shrink config/scenarios/fails.json", "shrink config/scenarios/knee.json",
      "shrink config/scenarios/fails.json --out /dev/full"}},
    {"tune", {"tune config/tuning/plan.json --out tuned", "tune config/tuning/plan.json --out tuned"}},
    {"behavior test",
     {"behavior test behaviors/lib", "behavior test behaviors/lib --only timing --junit results.xml",
      "behavior test behaviors/tulip/mine_test.lua", "behavior test behaviors/lib --only nothing_like_it"}},
    {"params", {"params config/tulip/robot.json", "params behaviors/tulip/squat.lua"}},
    {"run",
     {"run config/tulip/robot.json --plant ideal --threads-on-virtual-time --duration 0.3 -v --play squat --no-ctl",
      "run config/tulip/robot.json --plant ideal --threads-on-virtual-time --duration 0.3 --record /dev/full "
      "--no-ctl"}},
    {"plant", {}},  // the case below
    {"jitter",
     {"jitter --seconds 0.1 --no-keep-awake", "jitter --seconds 0.1 --no-keep-awake --svg j.svg --sleep-only"}},
    {"log info", {"log info knee.mcap", "log info nowhere.mcap"}},
    {"log diff", {"log diff knee.mcap knee.mcap", "log diff knee.mcap at.mcap"}},
    {"doctor", {"doctor", "doctor --root machine"}},
    {"dynamixel scan", {"dynamixel scan nowhere"}},
    {"dynamixel info", {"dynamixel info nowhere 1"}},
    {"ctl status", {"ctl status"}},
    {"ctl list",
     {"ctl list behaviors", "ctl list parameters --names", "ctl list signals", "ctl list sets", "ctl list objects"}},
    {"ctl drives", {"ctl drives"}},
    {"ctl world", {"ctl world"}},
    {"ctl get", {"ctl get posture.l_knee.kp_Nm_per_rad", "ctl get base.tilt_rad", "ctl get nothing"}},
    {"ctl watch", {"ctl watch joint.l_knee.position_rad --count 3", "ctl watch nothing"}},
    {"ctl why", {"ctl why", "ctl why nothing"}},
    {"ctl emit", {"ctl emit nothing"}},
    {"ctl play", {"ctl play wave", "ctl play nothing"}},
    {"ctl pause", {"ctl pause"}},
    {"ctl resume", {"ctl resume"}},
    {"ctl stop", {"ctl stop"}},
    {"ctl estop", {"ctl estop"}},
    {"ctl switch", {"ctl switch posture", "ctl switch nothing"}},
    {"ctl lead", {"ctl lead posture.l_knee.position_rad=0.2 --time 1", "ctl lead nothing=1"}},
    {"ctl drive enable", {"ctl drive enable", "ctl drive enable nothing"}},
    {"ctl drive disable", {"ctl drive disable l_knee"}},
    {"ctl drive reset", {"ctl drive reset 'l_*'"}},
    {"ctl drive home", {"ctl drive home"}},
    {"ctl drive brake", {"ctl drive brake l_knee"}},
    {"ctl drive release", {"ctl drive release l_knee"}},
    {"ctl fault list", {"ctl fault list"}},
    {"ctl fault clear", {"ctl fault clear"}},
    {"ctl odometry reset", {"ctl odometry reset"}},
    {"ctl mark", {"ctl mark 'here it stumbles'"}},
    {"ctl record start", {"ctl record start seen.mcap"}},
    {"ctl record stop", {"ctl record stop"}},
    {"ctl record dump", {"ctl record dump"}},
    {"ctl set", {"ctl set posture.l_knee.kp_Nm_per_rad 123", "ctl set posture.l_knee.kp_Nm_per_rad -1"}},
    {"ctl save", {"ctl save"}},
    {"ctl undo", {"ctl undo", "ctl undo"}},
    {"ctl reload", {"ctl reload"}},
    {"ctl repl", {"ctl repl"}},
};

fs::path project(const std::string& name) {
  const auto folder = project_copy(name);
  fs::remove_all(folder / "config/scenarios");
  const auto scenario = [&](const std::string& file, const std::string& that) {
    write(folder / ("config/scenarios/" + file + ".json"),
          R"({"$schema": "../schema/scenario.schema.json", "name": ")" + file +
              R"(", "robot": "config/tulip/robot.json", "plant": "ideal", "duration_s": 0.3, "behaviors": ["stand"],
                  "checks": [{"name": "bent", "kind": "at_end", "that": ")" +
              that + "\"}]}");
  };
  fs::create_directories(folder / "config/scenarios");
  scenario("knee", "joint.l_knee.position_rad > 0.2");
  scenario("fails", "joint.l_knee.position_rad < 0.1");
  write(folder / "config/sweeps/plan.json",
        R"({"name": "short", "scenarios": ["config/scenarios/knee.json"], "cases": 2,
            "vary": {"joint.l_knee.start_rad": {"uniform": [-0.1, 0.1]}},
            "metrics": {"knee_rad": {"kind": "end", "signal": "joint.l_knee.position_rad"}}})");
  write(folder / "config/tuning/plan.json",
        R"({"name": "knee", "scenarios": ["config/scenarios/knee.json"],
            "tune": {"control.posture.l_knee.kd_Nms_per_rad": {"min": 0.05, "max": 5, "log": true}},
            "runs": 1, "check_runs": 1, "population": 3, "generations": 1,
            "metrics": {"error_rad": {"kind": "rms", "signal": "control.posture.l_knee.error_rad"}},
            "score": "error_rad", "failed_score": 1})");
  write(folder / "behaviors/tulip/mine_test.lua",
        "it('fails', function() expect(1).to_equal(2) end)\nit('prints', function() print('a word') end)\n");
  write(folder / "behaviors/tulip/broken_test.lua", "it('is not Lua'\n");
  return folder;
}

// Each line is JSON by itself, strictly, or all of it is one value; nothing is both.
void check_is_json(const std::string& command, const Outcome& outcome) {
  CAPTURE(command);
  CAPTURE(outcome.out);
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code >= 0);
  CHECK(outcome.exit_code <= 2);
  if (outcome.out.empty()) {  // no line, and why
    CHECK_FALSE(outcome.err.empty());
    return;
  }
  CHECK(outcome.out.back() == '\n');
  if (nlohmann::json::accept(outcome.out)) return;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) CHECK_MESSAGE(nlohmann::json::accept(line), line);
}

// The exit code of a line of bash, in which `kadans` is the program.
int shell(const std::string& line, const fs::path& where) {
  write(where / "line.sh",
        "export XDG_STATE_HOME=\"$PWD/state\" XDG_RUNTIME_DIR=\"$PWD/none\"\nkadans() { '" KADANS_BINARY_DIR
        "/kadans' \"$@\"; }\n" +
            line + "\n");
  const int status =
      std::system(("cd '" + where.string() + "' && bash line.sh </dev/null").c_str());  // NOLINT: the point
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool has_json(const CommandEntry& entry) {
  return std::ranges::any_of(entry.options, [](const CLI::Option* option) { return option->check_name("--json"); });
}

std::vector<std::string> commands_with_json() {
  const CommandLine line;
  std::vector<std::string> all;
  for (const CommandEntry& entry : commands_of(line)) {
    if (has_json(entry)) all.push_back(entry.words);
  }
  return all;
}

}  // namespace

TEST_CASE("every command that has --json is tried here") {
  const std::vector<std::string> all = commands_with_json();
  CHECK(all.size() > 30);
  for (const std::string& words : all) CHECK_MESSAGE(samples.contains(words), "no command line of " << words);
  for (const auto& [words, lines] : samples) {
    const std::string name = words;
    CHECK_MESSAGE(std::ranges::find(all, name) != all.end(), "no command, or without --json: " << name);
  }
}

TEST_CASE("--json is JSON and nothing else, however the command ends") {
  const auto folder = project("json_commands");
  for (const std::string& words : commands_with_json()) {  // in the order of the help: replay reads what sim left
    const bool built = words != "tune" || fs::exists(KADANS_BINARY_DIR "/kadans-tune");
    if (words.starts_with("ctl") || !samples.contains(words) || !built) continue;
    for (const std::string& command : samples.at(words)) check_is_json(command, run(command + " --json", folder));
  }
}

TEST_CASE("what stdout does not take is told, and the exit code is not 0") {
  const auto folder = project("json_full");
  REQUIRE(run("sim config/scenarios/knee.json", folder).exit_code == 0);
  for (const char* command : {"sim config/scenarios/knee.json --no-record --json",
                              "sim config/scenarios/knee.json --no-record",
                              "test knee",
                              "test knee --json",
                              "test --list",
                              "replay knee.mcap",
                              "log info knee.mcap",
                              "log csv knee.mcap joint.l_knee",
                              "log cat knee.mcap",
                              "log plot knee.mcap joint.l_knee",
                              "params config/tulip/robot.json",
                              "params behaviors/tulip/squat.lua --json",
                              "behavior check behaviors/tulip/squat.lua",
                              "behavior test behaviors/lib/timing_test.lua",
                              "behavior graph behaviors/tulip/squat.lua",
                              "check models",
                              "lua-stubs --markdown",
                              "completion bash",
                              "--help",
                              "sim --help",
                              "--version",
                              "sweep config/sweeps/plan.json --out part",
                              "merge part",
                              "merge part --json",
                              "margin config/tulip/robot.json fails"}) {
    CAPTURE(command);
    const int code = shell("kadans " + std::string(command) + " >/dev/full 2>err", folder);
    CHECK(code != 0);
    CHECK(code < 3);
    CHECK_MESSAGE(has(read(folder / "err"), "written"), read(folder / "err"));
  }
  CHECK(shell("kadans log cat knee.mcap | head -c 10 >/dev/null; exit ${PIPESTATUS[0]}", folder) == 0);
}

TEST_CASE("--json of every verb of ctl is one object a line, whether it is done or refused") {
  const auto folder = project("json_ctl");
  const std::string program = (fs::path(KADANS_BINARY_DIR) / "kadans").string();
  const std::vector<std::string> order{"ctl status",         "ctl list",          "ctl get",
                                       "ctl watch",          "ctl drives",        "ctl set",
                                       "ctl save",           "ctl undo",          "ctl play",
                                       "ctl pause",          "ctl resume",        "ctl switch",
                                       "ctl lead",           "ctl why",           "ctl emit",
                                       "ctl reload",         "ctl record start",  "ctl record stop",
                                       "ctl record dump",    "ctl repl",          "ctl stop",
                                       "ctl fault list",     "ctl estop",         "ctl fault clear",
                                       "ctl drive disable",  "ctl drive enable",  "ctl drive reset",
                                       "ctl drive home",     "ctl drive release", "ctl drive brake",
                                       "ctl odometry reset", "ctl mark",          "ctl world"};
  std::string script = "export XDG_STATE_HOME=\"$PWD/state\" XDG_RUNTIME_DIR=\"$PWD/none\"\n'" + program +
                       "' run config/tulip/robot.json --plant ideal --play squat --threads-on-virtual-time --ctl c "
                       ">out 2>err &\nrun=$!\nuntil '" +
                       program + "' ctl --socket c status >/dev/null 2>&1; do kill -0 $run || exit 9; done\n";
  std::vector<std::string> tried;
  for (const std::string& words : order) {
    for (const std::string& command : samples.at(words)) {
      const std::string number = std::to_string(tried.size());
      tried.push_back(command);
      script += "'" + program + "' " + command + " --json --socket c </dev/null >out" + number + " 2>err" + number +
                "; echo $? >code" + number + "\n";
    }
  }
  write(folder / "all.sh", script + "kill -TERM $run; wait $run\nexit 0\n");
  REQUIRE(std::system(("cd '" + folder.string() + "' && bash all.sh 2>wrong").c_str()) == 0);
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const std::string number = std::to_string(i);
    check_is_json(tried[i], {std::stoi(read(folder / ("code" + number))), read(folder / ("out" + number)),
                             read(folder / ("err" + number))});
  }
  for (const auto& sample : samples) {
    const auto& words = sample.first;
    CHECK_MESSAGE((!words.starts_with("ctl ") || std::ranges::find(order, words) != order.end()), words);
  }
}

TEST_CASE("--json of a plant that is served, and of the run that drives it, is one object each") {
  const auto folder = project("json_plant");
  const std::string place = "127.0.7.62:27300";
  const std::string program = "'" KADANS_BINARY_DIR "/kadans' ";
  write(folder / "both.sh",
        "export XDG_RUNTIME_DIR=\"$PWD/none\"\n" + program +
            "plant config/tulip/robot.json --plant ideal --soft --once --json --listen " + place +
            " >plant.out 2>plant.err &\n" + program +
            "run config/tulip/robot.json --plant udp --soft --no-ctl --duration 0.2 --json --peer " + place +
            " >run.out 2>run.err || kill %1\nwait\n");
  REQUIRE(std::system(("cd '" + folder.string() + "' && bash both.sh").c_str()) == 0);
  const std::string out = read(folder / "plant.out"), drove = read(folder / "run.out");
  CHECK_MESSAGE(nlohmann::json::accept(out), out << read(folder / "plant.err"));
  CHECK_MESSAGE(nlohmann::json::accept(drove), drove << read(folder / "run.err"));
}

TEST_CASE("names of files that are no UTF-8 leave JSON and XML that every reader takes") {
  const auto folder = project("json_bytes");
  const std::string name =
      "kn\xff\xfe"
      "e";
  fs::rename(folder / "config/scenarios/fails.json", folder / ("config/scenarios/" + name + ".json"));
  write(folder / ("behaviors/tulip/" + name + "_test.lua"), "it('a\\255', function() error('b\\254') end)\n");
  for (const std::string& command :
       {std::string("test --junit a.xml"), std::string("test --list"),
        "sim 'config/scenarios/" + name + ".json' --record '" + name + ".mcap'", "log info '" + name + ".mcap'",
        "log diff '" + name + ".mcap' '" + name + ".mcap'", "replay '" + name + ".mcap'",
        std::string("behavior test behaviors/tulip --only a --junit b.xml")}) {
    check_is_json(command, run(command + " --json", folder));
  }
  REQUIRE(run("log plot '" + name + ".mcap' joint.l_knee.position_rad -o plot.svg", folder).exit_code == 0);
  REQUIRE(run("test --report pages --film never", folder).exit_code == 1);
  std::string page;
  for (const auto& entry : fs::directory_iterator(folder / "pages")) page += read(entry.path());
  for (const std::string& text : {read(folder / "a.xml"), read(folder / "b.xml"), read(folder / "plot.svg"), page}) {
    CHECK_FALSE(text.empty());
    CHECK(find_invalid_utf8(text) == std::string::npos);
  }
}

TEST_CASE("a record that does not fit the disk, and what else is not left behind, is no success") {
  const auto folder = project("json_disk");
  fs::create_symlink("/dev/full", folder / "full");  // a program that replaces what it should write to takes the link
  const std::string small = "trap '' XFSZ; ulimit -f 40; ";  // kB: a longer file fails as on a full disk
  const std::string longer = "sim config/scenarios/knee.json --duration 5 ";
  CHECK(shell(small + "kadans " + longer + " >out 2>err", folder) == 1);
  CHECK(has(read(folder / "err"), "the record is not complete"));
  CHECK(has(read(folder / "out"), "PASSED"));
  CHECK(shell(small + "kadans " + longer + " --json >out 2>err", folder) == 1);
  CHECK(has(nlohmann::json::parse(read(folder / "out"))["errors"].dump(), "the record is not complete"));
  CHECK(shell(small + "kadans " + longer + "--no-record --flight 30 >out 2>err", folder) == 0);  // no fault, no dump
  const std::string live =
      "kadans run config/tulip/robot.json --plant ideal --threads-on-virtual-time --no-ctl --duration ";
  CHECK(shell(small + live + "5 --record r.mcap >out 2>err", folder) == 1);
  CHECK(has(read(folder / "err"), "the record is not complete"));
  CHECK(shell("kadans sim config/scenarios/knee.json --no-record --checkpoint 9=late.mcap >out 2>err", folder) == 1);
  CHECK(has(read(folder / "err"), "the run was over before the checkpoint at 9 s"));
  CHECK(shell("kadans sim config/scenarios/knee.json --no-record --report /dev/null/pages >out 2>err", folder) == 2);
  CHECK(has(read(folder / "err"), "/dev/null/pages"));
  REQUIRE(
      shell("kadans sim config/scenarios/knee.json >out && kadans sweep config/sweeps/plan.json --out part >out 2>err",
            folder) == 0);
  for (const char* command :
       {"test knee --junit full", "test knee --junit nowhere/x.xml", "test knee --report /dev/null/x --film never",
        "log csv knee.mcap joint.l_knee -o full --force", "log cut knee.mcap -o full --force",
        "log plot knee.mcap joint.l_knee -o nowhere/x.svg",
        "lua-stubs --robot config/tulip/robot.json --output /dev/null/x", "new control-object mine --in /dev/null",
        "jitter --seconds 0.1 --no-keep-awake --svg full", "merge part --csv full", "merge part --csv nowhere/x.csv",
        "merge part --sqlite nowhere/x.db", "behavior test behaviors/lib/timing_test.lua --junit full"}) {
    CAPTURE(command);
    CHECK(shell("kadans " + std::string(command) + " >out 2>err", folder) == 2);
    CHECK_FALSE(read(folder / "err").empty());
  }
  CHECK(fs::is_symlink(folder / "full"));
  fs::create_symlink("/proc/self/fd/1", folder / "stdout");  // as /dev/stdout
  CHECK(shell("kadans log csv knee.mcap joint.l_knee -o stdout --force >out", folder) == 0);
  CHECK(has(read(folder / "out"), "joint.l_knee"));
  CHECK(
      shell(
          "kadans log csv knee.mcap joint.l_knee -o stdout --force | cat >out && kadans merge part --json --csv stdout "
          "| cat >table",
          folder) == 0);
  CHECK(has(read(folder / "out"), "joint.l_knee"));
  CHECK(has(read(folder / "table"), "knee_rad"));
  CHECK(fs::is_symlink(folder / "stdout"));
}

}  // namespace json_commands_test
