// `kadans ctl` and its completion as a person uses them, beside a run on virtual time and a simulation.
#include <cstdlib>
#include <filesystem>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

using namespace kadans::program;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string kadans_program = (fs::path(KADANS_BINARY_DIR) / "kadans").string();
const char* const kp = "posture.l_knee.kp_Nm_per_rad";

// Runs `commands` while `started` goes on in the background, found in the folder c; `ctl` stands for the program's.
int beside(const fs::path& project, const std::string& started, const std::string& commands) {
  write(project / "beside.sh",
        "export XDG_STATE_HOME=\"$PWD/state\" XDG_RUNTIME_DIR=\"$PWD/none\"\n"
        "kadans() { '" +
            kadans_program +
            "' \"$@\"; }\n"
            "ctl() { kadans ctl --socket c \"$@\"; }\n"
            "'" +
            kadans_program + "' " + started +
            " --ctl c >out 2>err &\n"
            "run=$!\n"
            "until ctl status >/dev/null 2>&1; do kill -0 $run || exit 9; done\n" +
            commands + "\nkill -TERM $run; wait $run; echo $? >code; wait\n");
  return std::system(("cd '" + project.string() + "' && bash beside.sh >said 2>wrong").c_str());  // NOLINT: the point
}

// Moves an arm by the events that it gets.
const char* const listener = R"(local k = require "kadans"
k.events { swing = { "swing the arm", to_rad = { "rad", min = -1, max = 1 } }, ["arm.rest"] = {} }
return k.behavior "listen" {
  controls = "posture",
  k.state "wait" {
    endless = true,
    { on = "swing", to = "wait", action = function(m, s)
      m.posture:move({ l_shoulder_pitch = s.event.data.to_rad }, { time_s = 0.2 })
    end },
    { on = "arm.rest", to = "wait", action = function(m) m.posture:move("stand", { time_s = 0.2 }) end },
  },
})";

const std::string live = "run config/tulip/robot.json --plant ideal --play squat --threads-on-virtual-time -v";

}  // namespace

TEST_CASE("ctl looks into a run, commands it and tunes it, and the run ends as if nothing had been") {
  const auto project = project_copy("ctl_run");
  const std::string robot = read(project / "config/tulip/robot.json");
  REQUIRE(beside(project, live,
                 "ctl status && ctl status --json >status.json\n"
                 "ctl list parameters | grep l_knee.kp\n"
                 "ctl get posture.l_knee.kp_Nm_per_rad >before\n"
                 "ctl set posture.l_knee.kp_Nm_per_rad 123\n"
                 "ctl get posture.l_knee.kp_Nm_per_rad\n"
                 "ctl save\n"
                 "ctl undo\n"
                 "ctl watch joint.l_knee.position_rad --rate 1000 --count 3\n"
                 "printf '1 + 1\\n:status\\n' | ctl repl\n"
                 "ctl record start seen.mcap; ctl record stop\n"
                 "ctl fault list\n"
                 "ctl stop\n") == 0);
  const std::string said = read(project / "said"), wrong = read(project / "wrong");
  CHECK_MESSAGE(read(project / "code") == "0\n", wrong);
  CHECK_MESSAGE(wrong.empty(), wrong);
  CHECK(has(said, "tulip (run on virtual time, process "));
  CHECK(has(said, "safety   normal"));
  CHECK(has(said, "squat in "));
  CHECK(has(said, "\n123 Nm/rad\n"));
  CHECK(has(said, std::string(kp) + ": 123 -> "));
  CHECK(has(said, "time_s\tjoint.l_knee.position_rad\n"));
  CHECK(has(said, "\n2\n"));
  CHECK(has(said, "seen.mcap"));
  CHECK(has(said, "safety level normal, 0 faults"));
  CHECK(Json::parse(read(project / "status.json"))["safety"]["level"] == "normal");
  const std::string saved = read(project / "config/tulip/robot.json");
  CHECK(saved != robot);
  CHECK(has(saved, "l_knee.kp_Nm_per_rad\": 123"));
  CHECK(run("check config/tulip/robot.json", project).exit_code == 0);
  CHECK(has(read(project / "err"), "ctl: uid "));  // every change is told
}

// A pause would not be repeated, so there is none.
TEST_CASE("ctl emits events into a simulation, and its replay and its checkpoint repeat them bit for bit") {
  const auto project = project_copy("ctl_emit");
  write(project / "behaviors/tulip/listen.lua", listener);
  write(project / "config/scenarios/listen.json",
        R"({ "name": "listen", "robot": "config/tulip/robot.json", "plant": "ideal", "duration_s": 1000,
             "behaviors": ["listen"] })");
  REQUIRE(beside(project, "sim config/scenarios/listen.json --realtime --record run.mcap --checkpoint 3=here.mcap",
                 "ctl list events; ctl list events --names\n"
                 "ctl emit swing to_rad=0.3\n"
                 "ctl emit arm.rest --json\n"
                 "ctl emit swing '{\"to_rad\": 0.123456789}'\n"
                 "ctl emit swing to_rad=3; echo $?\n"
                 "ctl emit swng; echo $?\n"
                 "ctl emit 'a b' x=1; echo $?\n"
                 "until [ -e here.mcap ]; do ctl status >/dev/null; done\n") == 0);
  const std::string said = read(project / "said"), wrong = read(project / "wrong");
  CAPTURE(said);
  CAPTURE(wrong);
  CHECK(has(said, "swing     swing the arm; to_rad: a number in rad, -1..1"));
  CHECK(has(said, "\narm.rest\nswing\n"));
  CHECK(has(said, "event swing {\"to_rad\":0.3} from uid "));
  CHECK(has(said, "\"ok\":true"));
  CHECK(has(said, "\n1\n1\n1\n"));
  CHECK(has(wrong, "event 'swing': field 'to_rad' = 3 is outside its range -1..1 rad"));
  CHECK(has(wrong, "unknown event 'swng' for what plays, did you mean 'swing'?"));
  const std::string events = run("log cat run.mcap --topic /events", project).out;
  CAPTURE(events);
  CHECK(has(events, "\"data\":{\"to_rad\":0.123456789},\"event\":\"swing\",\"ordered\":true,\"tick\":"));
  CHECK(has(events, "\"who\":\"uid "));
  const Outcome replayed = run("replay run.mcap --from-record", project);
  CHECK_MESSAGE(replayed.exit_code == 0, replayed.out);
  CHECK(has(replayed.out, "run.mcap: the same, "));
  const Outcome on = run("sim --from here.mcap --duration 3.2 --record on.mcap", project);
  CHECK_MESSAGE(on.exit_code == 0, on.err);
  CHECK(run("replay on.mcap --from-record", project).exit_code == 0);
}

TEST_CASE("events reach behaviors in a process of their own, and it tells why it refuses one") {
  const auto project = project_copy("ctl_emit_process");
  write(project / "behaviors/tulip/listen.lua", listener);
  REQUIRE(beside(project,
                 "run config/tulip/robot.json --plant ideal --play listen --behaviors process "
                 "--threads-on-virtual-time -v --record run.mcap",
                 "ctl emit swing to_rad=0.3; echo $?\n"
                 "ctl emit swing to_rad=3; echo $?\n"
                 "ctl emit swng; echo $?\n"
                 "ctl pause; ctl emit arm.rest; echo $?; ctl resume\n"
                 "ctl emit arm.rest; echo $?\n") == 0);
  const std::string said = read(project / "said"), wrong = read(project / "wrong");
  CAPTURE(said);
  CAPTURE(wrong);
  CHECK(has(said, "event swing {\"to_rad\":0.3} from uid "));
  CHECK(has(said, " to listen\n0\n1\n1\n"));
  CHECK(has(said, "event arm.rest from uid "));
  CHECK(has(wrong, "event 'swing': field 'to_rad' = 3 is outside its range -1..1 rad"));
  CHECK(has(wrong, "did you mean 'swing'?"));
  CHECK(has(wrong, "the behaviors are paused"));
  CHECK(has(run("log cat run.mcap --topic /events", project).out, "\"data\":{\"to_rad\":0.3},\"event\":\"swing\""));
}

TEST_CASE("what ctl save wrote counts in the next run, and what a preset makes otherwise is said") {
  const auto project = project_copy("ctl_save");
  REQUIRE(beside(project, live,
                 "ctl set posture.l_knee.kp_Nm_per_rad 250\n"
                 "ctl set squat.depth_m 0.05\n"
                 "ctl save\n"
                 "ctl save --preset stif; echo $?\n"
                 "ctl save --preset stiff --json >stiff.json\n"
                 "ctl stop\n") == 0);
  const std::string said = read(project / "said"), wrong = read(project / "wrong");
  CAPTURE(said);
  CAPTURE(wrong);
  CHECK(has(said, "squat.depth_m: 0.1 -> 0.05"));
  CHECK(has(said, "where a behavior chooses a preset, that counts, in the next run too:\n"));
  CHECK(has(said, "posture.l_knee.kp_Nm_per_rad: stiff sets 300"));
  CHECK(has(said, "'kadans ctl save --preset NAME' writes what was set into one of them, too"));
  CHECK(has(wrong, "preset 'stif' sets none of what was changed"));
  for (const auto& one : Json::parse(read(project / "stiff.json"))["overridden"]) CHECK(one["preset"] != "stiff");
  const std::string saved = read(project / "config/tulip/robot.json");
  CHECK(has(saved, "\"behaviors\": { \"squat\": { \"depth_m\": 0.05 } }"));
  CHECK(run("check config/tulip/robot.json", project).exit_code == 0);
  const auto json = Json::parse(run("sim config/scenarios/squat.json --duration 3.2 --json --no-record", project).out);
  const auto deep = Json::parse(run("sim config/scenarios/squat.json --play 'squat{depth_m=0.1}' --duration 3.2 --json "
                                    "--no-record",
                                    project)
                                    .out);
  CHECK(json["checks"][0]["value"].get<double>() > deep["checks"][0]["value"].get<double>() + 0.04);
  write(project / "look.txt", ":run 3\nparameters.posture.l_knee.kp_Nm_per_rad\n");
  CHECK(has(run("repl config/scenarios/squat.json <look.txt", project).out, "250"));  // `squat` chooses stiff
}

TEST_CASE("ctl reload beside a simulation tells of every new version, whenever in the behaviors' period it comes") {
  const auto project = project_copy("ctl_reload_sim");
  std::string commands;
  for (int i = 1; i <= 8; ++i)
    commands += "sed -i 's/hold_s *= { *[0-9.]*/hold_s = { 0." + std::to_string(i) +
                "/' behaviors/tulip/squat.lua; ctl reload; ctl get squat.hold_s\n";
  REQUIRE(beside(project, "sim config/scenarios/squat.json --play 'squat{repeats=20}' --duration 1000 --no-record",
                 commands + "ctl reload\n") == 0);
  const std::string said = read(project / "said");
  CAPTURE(read(project / "wrong"));
  std::string wanted;
  for (int i = 1; i <= 8; ++i) wanted += "squat: reloaded behaviors/tulip/squat.lua\n0." + std::to_string(i) + " s\n";
  CHECK(said == wanted + "no new version: the files are as they were loaded\n");
}

TEST_CASE("ctl says what it could not do, with the reason, by its exit code") {
  const auto project = project_copy("ctl_refused");
  REQUIRE(beside(project, live,
                 "ctl set posture.l_knee.kp 1; echo $?\n"
                 "ctl set posture.l_knee.kp_Nm_per_rad -1; echo $?\n"
                 "ctl undo; echo $?\n"
                 "ctl switch postur; echo $?\n"
                 "ctl stauts; echo $?\n"
                 "printf 'nonsense(\\n)\\nx.y.z\\n' | ctl repl; echo $?\n"
                 "kadans ctl --socket c/develop estop; echo $?\n") == 0);
  CHECK(read(project / "said") == "1\n1\n1\n1\n2\n1\n0\n");
  const std::string wrong = read(project / "wrong");
  CHECK(has(wrong, "unknown parameter 'posture.l_knee.kp', did you mean"));
  CHECK(has(wrong, "is outside its range 0.."));
  CHECK(has(wrong, "there is nothing to undo"));
  CHECK(has(wrong, "unknown control set 'postur', did you mean 'posture'?"));
  CHECK(has(wrong, "unknown command 'ctl stauts', did you mean 'status'?"));
  CHECK(read(project / "code") == "1\n");  // the robot was held
}

TEST_CASE("ctl commands a run whose behaviors play in a process of their own, and says what it cannot do there") {
  const auto project = project_copy("ctl_process");
  REQUIRE(beside(project, live + " --behaviors process",
                 "ctl status && ctl set posture.l_knee.kp_Nm_per_rad 123 && ctl pause && ctl status && ctl resume\n"
                 "echo '1 + 1' | ctl repl; echo $?\n"
                 "ctl reload squat && ctl stop\n") == 0);
  const std::string said = read(project / "said"), wrong = read(project / "wrong");
  CHECK_MESSAGE(read(project / "code") == "0\n", wrong);
  CHECK(has(said, "squat in "));
  CHECK_FALSE(has(said, "squat in state "));
  CHECK(has(said, "paused; squat"));
  CHECK(has(said, std::string(kp) + ": "));
  CHECK(has(wrong, "there is no console while behaviors play in a process of their own"));
}

TEST_CASE("ctl asks decisions why, and lets them read their files again, in a thread and in a process of their own") {
  const auto project = project_copy("ctl_decisions");
  const std::string decides = R"(local k = require "kadans"
return k.decisions "decide" {
  initial = "a",
  k.state "a" {
    enter = function(m) m:replace("squat{repeats=100}") end,
    { when = function(s) return s.time_s < 0 end, to = "b" },
  },
  k.final "b" {},
})";
  write(project / "config/tulip/decides.json",
        R"({ "based_on": "config/tulip/robot.json", "supervisor": { "decisions": "decide" } })");
  for (const char* where : {"thread", "process"}) {
    CAPTURE(where);
    write(project / "behaviors/tulip/decide.lua", decides);
    REQUIRE(beside(project,
                   "run config/tulip/decides.json --plant ideal --threads-on-virtual-time -v --decisions " +
                       std::string(where),
                   "until ctl why | grep -q squat; do kill -0 $run || exit 8; done\n"
                   "ctl why decide; echo $?; ctl why >both; ctl why nobody; echo $?\n"
                   "ctl reload decide; echo $?\n"
                   "sed -i 's/s.time_s < 0/s.time_s < -1/' behaviors/tulip/decide.lua; ctl reload decide; echo $?\n"
                   "ctl reload; echo $?\n"
                   "sed -i 's/to = \"b\"/to = \"c\"/' behaviors/tulip/decide.lua; ctl reload decide; echo $?\n"
                   "ctl why decide | grep -c 'loaded'; echo over\n") == 0);
    const std::string said = read(project / "said"), wrong = read(project / "wrong"), both = read(project / "both");
    CAPTURE(said);
    CAPTURE(wrong);
    CHECK(has(said, "the guard gives false"));
    CHECK(has(said, "s.time_s < 0"));
    CHECK(has(both, "decide"));
    CHECK(has(both, "squat"));
    CHECK(has(wrong, "unknown behavior 'nobody'"));
    CHECK(has(said, "decide: no new version: the files are as they were loaded\n0\n"));
    CHECK(has(said, "decide: reloaded behaviors/tulip/decide.lua\n0\n"));
    CHECK(has(said, "no new version: the files are as they were loaded\ndecide: no new version"));
    CHECK(has(wrong, "decide: reload refused, the old version goes on: behaviors/tulip/decide.lua:6:"));
    CHECK(has(read(project / "err"), "decide: reloaded behaviors/tulip/decide.lua"));  // the log has it, too
    CHECK(read(project / "code") == "0\n");
  }
}

TEST_CASE("ctl tells of behaviors in a process of their own what it tells of those in a thread") {
  const auto project = project_copy("ctl_tables");
  write(project / "behaviors/tulip/listen.lua", listener);
  write(project / "behaviors/tulip/count.lua", R"(local k = require "kadans"
k.params { steps = { 3, "", min = 1, max = 9, doc = "how many" } }
return k.behavior "count" { k.final "over" { outcome = "done", result = function() return { steps = 3 } end } })");
  write(project / "behaviors/tulip/broken.lua", R"(local k = require "kadans"
return k.behavior "broken" { k.state "x" { endless = true, run = function(m) m:wait(0.01) error "it broke" end } })");
  const std::string commands =
      "until ctl list behaviors --json | grep -q 'it broke'; do kill -0 $run || exit 8; done\n"
      "ctl list behaviors --json | sed 's/behaviors.tulip.broken.lua:2: //'; ctl list events --json\n"
      "ctl list behaviors | grep listen; ctl list parameters | grep -v '[.].*[.]'\n"
      "ctl why listen | grep -v ' s left'; ctl why nobody; echo $?\n"
      "ctl set count.steps 5 && ctl get count.steps && ctl undo && ctl get count.steps\n"
      "ctl set count.steps 50; ctl set count.stepz 5; ctl undo; echo $?\n"
      "ctl reload; ctl reload nobody; echo $?\n"
      "sed -i 's/min = -1/min = -0.5/' behaviors/tulip/listen.lua; ctl reload; ctl list events\n"
      "sed -i 's/endless/endles/' behaviors/tulip/listen.lua; ctl reload listen; echo $?\n"
      "sed -i 's/min = -0.5/min = -1/; s/endles /endless /' behaviors/tulip/listen.lua; ctl reload listen\n"
      "ctl play wavee; ctl play 'count{steps=7}'; echo $?; ctl emit swing to_rad=9; ctl emit swng; ctl emit swing\n";
  const auto told = [&](const std::string& where) {
    REQUIRE(beside(project,
                   "run config/tulip/robot.json --plant ideal --play 'listen | count | broken' "
                   "--threads-on-virtual-time --behaviors " +
                       where,
                   commands) == 0);
    return read(project / "said") + "--\n" + read(project / "wrong");
  };
  const std::string thread = told("thread");
  CHECK(told("process") == thread);
  CAPTURE(thread);
  CHECK(has(thread, "\"result\":\"{ steps = 3 }\""));
  CHECK(has(thread, "listen  in "));
  CHECK(has(thread, "to_rad: a number in rad, -1..1"));
  CHECK(has(thread, "to_rad: a number in rad, -0.5..1"));
  CHECK(has(thread, "count.steps: 3 -> 5"));
  CHECK(has(thread, "count.steps: 5 -> 3"));
  CHECK(has(thread, "listen: reloaded behaviors/tulip/listen.lua"));
  CHECK(has(thread, "count.steps = 50 is outside its range 1..9"));
  CHECK(has(thread, "did you mean 'count.steps'?"));
  CHECK(has(thread, "unknown behavior 'nobody'"));
}

TEST_CASE("ctl finds a simulation too, and says where it looked when there is none") {
  const auto project = project_copy("ctl_sim");
  REQUIRE(
      beside(
          project, "sim config/scenarios/squat.json --realtime --duration 1000 --watch",
          "ctl status; ctl pause; ctl set posture.l_knee.kp_Nm_per_rad 80; ctl status; ctl record stop; ctl estop\n") ==
      0);
  const std::string said = read(project / "said");
  CHECK(has(said, "simulation of squat"));
  CHECK(has(said, "paused; squat"));
  CHECK(has(said, " -> 80\n"));
  CHECK(has(said, "record   squat.mcap"));
  CHECK(has(read(project / "wrong"), "was begun with this run and ends with it"));
  CHECK(read(project / "code") == "130\n");
  const Outcome none = run("ctl --socket c status", project);
  CHECK(none.exit_code == 2);
  CHECK(has(none.err, "no running instance found; looked in c"));
}

TEST_CASE("a second run at the same place is refused before anything moves") {
  const auto project = project_copy("ctl_second");
  REQUIRE(
      beside(
          project, live,
          "kadans run config/tulip/robot.json --threads-on-virtual-time --duration 1 --ctl c; echo $?; ctl status") ==
      0);
  CHECK(has(read(project / "said"), "2\ntulip"));
  CHECK(has(read(project / "wrong"), "another instance is reached here already"));
}

TEST_CASE("bash completes verbs, options, and names from the run") {
  const auto project = project_copy("ctl_bash");
  write(
      project / "complete.bash",
      "kadans() { '" + kadans_program +
          "' \"$@\"; }\neval \"$(kadans completion bash)\"\n"
          "try() { COMP_WORDS=(kadans \"$@\"); COMP_CWORD=$#; COMPREPLY=(); _kadans; echo \"$*: ${COMPREPLY[*]}\"; }\n"
          "try ctl st; try ct; try ctl fault ''; try ctl list s; try ctl play --re\n"
          "try ctl --socket c set posture.l_knee.kp_; try ctl --socket c watch safety.lev\n"
          "try ctl --socket c switch post; try ctl --socket c play squ; try ctl --socket gone set posture.\n"
          "try completion ''\n");
  REQUIRE(beside(project, live, "bash complete.bash") == 0);
  const std::string said = read(project / "said");
  CHECK_MESSAGE(has(said, "ctl st: status stop\n"), said);
  CHECK(has(said, "ct: ctl\n"));
  CHECK(has(said, "ctl fault : list clear\n"));
  CHECK(has(said, "ctl list s: sets signals\n"));
  CHECK(has(said, "ctl play --re: --replace\n"));
  CHECK(has(said, std::string("set posture.l_knee.kp_: ") + kp + "\n"));
  CHECK(has(said, "watch safety.lev: safety.level\n"));
  CHECK(has(said, "switch post: posture\n"));
  CHECK(has(said, "play squ: squat"));
  CHECK(has(said, "gone set posture.: \n"));
  CHECK(has(said, "completion : bash zsh\n"));
  CHECK(read(project / "wrong").empty());
}

TEST_CASE("zsh completes verbs, and names from the run" *
          doctest::skip(std::system("command -v zsh >/dev/null") != 0)) {
  const auto project = project_copy("ctl_zsh");
  write(project / "complete.zsh",
        "kadans() { '" + kadans_program +
            "' \"$@\" }\neval \"$(kadans completion zsh)\"\n"
            "compadd() { shift; echo \"${(@)argv[(R)${words[CURRENT]}*]}\" }\n"
            "_files() { echo files }\n"
            "try() { local -a words=(kadans \"$@\"); local CURRENT=$(( $# + 1 )); echo -n \"$*: \"; _kadans }\n"
            "try ctl st; try ctl --socket c set posture.l_knee.kp_; try check ''\n");
  REQUIRE(beside(project, live, "zsh -f complete.zsh") == 0);
  const std::string said = read(project / "said");
  CHECK_MESSAGE(has(said, std::string("set posture.l_knee.kp_: ") + kp + "\n"), said);
  CHECK(has(said, "ctl st: "));
  CHECK(has(said, "check : files\n"));
  CHECK_MESSAGE(read(project / "wrong").empty(), read(project / "wrong"));
}
