// `kadans push` and `kadans ctl --host` as a person uses them. A script stands for ssh: it does what the other
// computer's shell does with the words that ssh sends.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "../program.h"

namespace push_test {

using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

const std::string binary = (fs::path(KADANS_BINARY_DIR) / "kadans").string();
const char* const squat = "behaviors/tulip/squat.lua";
const char* const there = "there/tulip/robot";
const char* const push =
    "kadans push robot config/tulip/robot.json --folder \"$PWD/there/tulip/robot\" --socket \"$PWD/c\"";

// A project with `ssh` and `kadans` in bin, and home.
fs::path project_with_ssh(const std::string& name) {
  fs::path project = project_copy(name);
  fs::create_directories(project / "bin");
  write(project / "bin/ssh",
        "#!/bin/sh\n"
        "echo \"$*\" >>\"$HOME/ssh.log\"\n"
        "[ -z \"$KADANS_TEST_NO_NETWORK\" ] || { echo 'ssh: no route to host' >&2; exit 255; }\n"
        "while [ \"$1\" != -- ]; do shift; done\n"
        "shift 2\n"
        "exec sh -c \"$*\"\n");
  fs::permissions(project / "bin/ssh", fs::perms::owner_all);
  fs::create_symlink(binary, project / "bin/kadans");
  return project;
}

// As typed in a shell whose PATH begins with bin.
Outcome shell(const fs::path& project, const std::string& commands) {
  write(project / "commands.sh",
        "export HOME=\"$PWD\" PATH=\"$PWD/bin:$PATH\" XDG_STATE_HOME=\"$PWD/state\" XDG_RUNTIME_DIR=\"$PWD/none\"\n" +
            commands + "\n");
  const int status = std::system(("cd '" + project.string() + "' && bash commands.sh >out 2>err").c_str());  // NOLINT
  return {.exit_code = WEXITSTATUS(status), .out = read(project / "out"), .err = read(project / "err")};
}

// Runs `commands` while a run goes on that drives what was pushed; it is found in the folder c.
Outcome beside_run(const fs::path& project, const std::string& options, const std::string& commands) {
  return shell(project,
               "kadans run there/tulip/robot/config/tulip/robot.json --plant ideal --play squat "
               "--threads-on-virtual-time -v --ctl c " +
                   options +
                   " >run.out 2>run.err &\n"
                   "run=$!\n"
                   "until kadans ctl --socket c status >/dev/null 2>&1; do kill -0 $run || exit 9; done\n" +
                   commands + "\ncode=$?\nkill -TERM $run; wait $run; exit $code");
}

}  // namespace

TEST_CASE("A push brings a robot with its behaviors, says what changed, and can be taken back and forth") {
  const fs::path project = project_with_ssh("push_files");
  Outcome first = shell(project, push);
  REQUIRE_MESSAGE(first.exit_code == 0, first.err);
  CHECK(has(first.out, "config/tulip/robot.json is new"));
  CHECK(has(first.out, "counts from the next start: no running instance"));
  const fs::path placed = project / there;
  CHECK(read(placed / squat) == read(project / squat));
  CHECK(fs::exists(placed / "models/tulip/tulip.urdf"));
  CHECK_FALSE(fs::exists(placed / "behaviors/tulip/squat_test.lua"));
  CHECK(has(read(placed / "run.conf"), "KADANS_ROBOT=" + (placed / "config/tulip/robot.json").string()));

  const std::string before = read(project / squat);
  write(project / squat, "-- another\n" + before);
  fs::remove(project / "behaviors/looking/watch.lua");
  const Outcome checked = shell(project, std::string(push) + " --check");
  CHECK(has(checked.out, "behaviors/tulip/squat.lua changed"));
  CHECK(has(checked.out, "behaviors/looking/watch.lua is gone"));
  CHECK(read(placed / squat) == before);
  CHECK(shell(project, push).exit_code == 0);
  CHECK(read(placed / squat) == "-- another\n" + before);
  CHECK_FALSE(fs::exists(placed / "behaviors/looking/watch.lua"));
  // Once more, and there is nothing to do: what was before is still what --undo gives back.
  CHECK(has(shell(project, push).out, "nothing has changed"));

  CHECK(shell(project, std::string(push) + " --undo").exit_code == 0);
  CHECK(read(placed / squat) == before);
  CHECK(fs::exists(placed / "behaviors/looking/watch.lua"));
  CHECK(shell(project, std::string(push) + " --undo").exit_code == 0);
  CHECK(read(placed / squat) == "-- another\n" + before);
  CHECK_FALSE(fs::exists(project / "there/tulip/robot.next"));
}

TEST_CASE("What is wrong in a push is told at its place in the project, and nothing changes there") {
  const fs::path project = project_with_ssh("push_wrong");
  REQUIRE(shell(project, push).exit_code == 0);
  const std::string before = read(project / squat);
  for (const auto& [file, from, into, told] : std::initializer_list<std::array<const char*, 4>>{
           {squat, "k.params {", "k.parms {", "error: behaviors/tulip/squat.lua:5"},
           {squat, "set_gains(\"stiff\")", "set_gains(\"stif\")", "error: behaviors/tulip/squat.lua:"},
           {"config/tulip/robot.json", "\"urdf\"", "\"urfd\"", "config/tulip/robot.json:"}}) {
    const std::string to = into;
    CAPTURE(to);
    const std::string good = read(project / file);
    REQUIRE(edit(project / file, from, to));
    const Outcome outcome = shell(project, push);
    CHECK(outcome.exit_code == 2);
    CHECK_MESSAGE(has(outcome.err, told), outcome.err);
    CHECK_FALSE(has(outcome.err, "robot.next"));
    write(project / file, good);
  }
  CHECK(read(project / there / squat) == before);
  CHECK_FALSE(fs::exists(project / "there/tulip/robot.next"));
  CHECK_FALSE(fs::exists(project / "there/tulip/robot.before"));
}

TEST_CASE("What comes in damaged, foreign or from outside of a project is refused, and nothing changes there") {
  const fs::path project = project_with_ssh("push_hostile");
  REQUIRE(shell(project, push).exit_code == 0);
  const std::string before = read(project / there / squat);
  const std::string receive = "kadans receive tulip --folder there/tulip/robot <";
  // What a push sends, kept by a script in the place of ssh.
  write(project / "bin/ssh", "#!/bin/sh\ncat >sent\n");
  edit(project / squat, "local k", "-- another\nlocal k");
  REQUIRE(shell(project, push).exit_code == 0);
  const std::string sent = read(project / "sent");
  REQUIRE(sent.size() > 10'000);
  write(project / "half", sent.substr(0, sent.size() / 2));
  write(project / "none", "");
  write(project / "text", "this is no delivery");
  std::string flipped = sent;
  flipped[sent.size() / 3] = static_cast<char>(flipped[sent.size() / 3] ^ 1);
  write(project / "flipped", flipped);
  std::string outside = sent;
  for (std::size_t at = 0; (at = outside.find("behaviors/tulip/wave.lua", at)) != std::string::npos;)
    outside.replace(at, 24, "behaviors/../../wave.lua");
  write(project / "outside", outside);
  for (const char* file : {"half", "none", "text", "flipped", "outside"}) {
    CAPTURE(file);
    const Outcome outcome = shell(project, receive + file);
    CHECK(outcome.exit_code == 2);
    CHECK(has(outcome.err, "error: "));
  }
  CHECK(read(project / there / squat) == before);
  CHECK(shell(project, "kadans receive ../tulip <sent").exit_code == 2);
  CHECK(shell(project, receive + "sent").exit_code == 0);
  CHECK(read(project / there / squat) != before);
}

namespace {

// Waits without end in a state, so that it plays whenever a push comes.
std::string waiting(const std::string& state, const std::string& enter = "") {
  return "local k = require \"kadans\"\n"
         "return k.behavior \"squat\" { controls = \"posture\", k.state \"" +
         state + "\" { endless = true, " + enter + "run = function(m) m:wait(1) end } }\n";
}

}  // namespace

TEST_CASE("A run takes what was pushed at once, and goes on as it was when it refuses") {
  const fs::path project = project_with_ssh("push_run");
  for (const char* options : {"", "--behaviors process"}) {
    CAPTURE(options);
    write(project / squat, waiting("here"));
    REQUIRE(shell(project, push).exit_code == 0);
    write(project / squat, waiting("here") + "-- another\n");
    const Outcome taken = beside_run(project, options, push);
    CHECK_MESSAGE(taken.exit_code == 0, taken.err);
    CHECK(has(taken.out, "squat: "));
    CHECK(has(read(project / "run.out") + read(project / "run.err"), "reload"));

    // The check finds nothing wrong with it; but it cannot be entered.
    const std::string good = read(project / squat);
    write(project / squat, waiting("elsewhere", "enter = function() error(\"not today\") end, "));
    const Outcome refused = beside_run(project, options, push);
    CHECK_MESSAGE(refused.exit_code == 1, (refused.out + refused.err));
    CHECK(has(refused.err, "the files are as they were"));
    CHECK(read(project / there / squat) == good);
    CHECK(read(project / "there/tulip/robot.before" / squat) == waiting("here"));
    CHECK(!fs::exists(project / "there/tulip/robot.older"));
  }
}

TEST_CASE("A push of what the whole suite has not passed is refused with --tested") {
  const fs::path project = project_with_ssh("push_tested");
  for (const fs::directory_entry& entry : fs::directory_iterator(project / "config/scenarios")) {
    if (entry.path().filename() != "squat.json") fs::remove_all(entry.path());
  }
  const std::string tested = std::string(push) + " --tested";
  CHECK(shell(project, tested).exit_code == 2);
  CHECK(shell(project, "kadans test squat").exit_code == 0);  // not the whole suite
  CHECK(shell(project, tested).exit_code == 2);
  CHECK(shell(project, "kadans test").exit_code == 0);
  const Outcome passed = shell(project, tested);
  CHECK_MESSAGE(passed.exit_code == 0, passed.err);
  edit(project / squat, "local k", "-- another\nlocal k");
  const Outcome refused = shell(project, tested);
  CHECK(refused.exit_code == 2);
  CHECK(has(refused.err, "the suite has not passed with these files"));
}

TEST_CASE("ctl --host reaches a run on another computer with the words as they were typed") {
  const fs::path project = project_with_ssh("push_ctl");
  REQUIRE(shell(project, push).exit_code == 0);
  const Outcome outcome = beside_run(project, "",
                                     "kadans ctl --host me@robot --socket c status &&"
                                     "kadans ctl get --host=me@robot --socket c --json posture.l_knee.kp_Nm_per_rad &&"
                                     "kadans ctl --host me@robot --socket c play 'squat { repeats = 1 }' --replace");
  CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
  CHECK(has(outcome.out, "tulip (run on virtual time"));
  CHECK(has(outcome.out, "\"unit\":\"Nm/rad\""));
  CHECK(has(read(project / "ssh.log"), "-- me@robot kadans ctl --socket c status"));
  const Outcome none = shell(project, "KADANS_TEST_NO_NETWORK=1 kadans ctl --host robot status");
  CHECK(none.exit_code == 2);
  CHECK(has(none.err, "no route to host"));
  for (const char* name : {"-oProxyCommand=x", "\"\"", "'a b'"}) {
    const Outcome refused = shell(project, std::string("kadans ctl --host=") + name + " status");
    CHECK(refused.exit_code == 2);
  }
  CHECK_FALSE(has(read(project / "ssh.log"), "Proxy"));
}

}  // namespace push_test
