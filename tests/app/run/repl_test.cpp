// `kadans repl` from a pipe: what a person types, in a file.
#include <doctest/doctest.h>

#include "app/program.h"

using namespace kadans::program;

namespace {

Outcome type(const std::filesystem::path& project, const std::string& lines, const std::string& arguments = "") {
  write(project / "lines.txt", lines);
  return run("repl config/scenarios/squat.json " + arguments + " <lines.txt", project);
}

}  // namespace

TEST_CASE("repl prints what lines give, time passes by :run only") {
  const auto project = project_copy("repl_values");
  const Outcome outcome = type(project,
                               "s.time_s\nbehaviors.squat.state\nsignals.plant.base.height_m > 0.8\n"
                               ":run 1.6\nstring.format('%.2f', s.time_s)\nbehaviors.squat.state\n");
  CHECK(outcome.out == "0\nsettle\ntrue\n1.60\nsquat\n");
  CHECK(outcome.err.empty());
  CHECK(outcome.exit_code == 0);
}

TEST_CASE("repl tells a mistake with its line, stops an endless line, goes on, and exits 1") {
  const auto project = project_copy("repl_mistakes");
  const Outcome outcome = type(project, "signals.plant.base.hight_m\nwhile true do end\n:stpo\n1 + 1\n");
  CHECK(has(outcome.err, "console:1: "));
  CHECK(has(outcome.err, "did you mean 'height_m'?"));
  CHECK(has(outcome.err, "console:2: instruction budget exceeded"));
  CHECK(has(outcome.err, "did you mean ':stop'?"));
  CHECK(outcome.out == "2\n");
  CHECK(outcome.exit_code == 1);
  CHECK(type(project, "function f()\n").exit_code == 1);
}

TEST_CASE("repl refuses to move the robot before :write and moves it after") {
  const auto project = project_copy("repl_write");
  const std::string move = "m.posture:move({ l_shoulder_pitch = 0.5 }, { time_s = 0.5 })\n";
  const std::string look = ":run 1\ns.joints.l_shoulder_pitch.position_rad > 0.4\n";
  const Outcome refused = type(project, ":stop\n" + move + look);
  CHECK(has(refused.err, "console:2: this console only reads"));
  CHECK(has(refused.out, "false\n"));
  const Outcome moved = type(project, ":stop\n:run 0.1\n:write\n" + move + look);
  CHECK(moved.err.empty());
  CHECK(has(moved.out, "true\n"));
}

TEST_CASE("repl plays lists, pauses and resumes, a wrong list changes nothing") {
  const auto project = project_copy("repl_play");
  const Outcome outcome =
      type(project,
           ":replace squat{repeats=1}, wave\n:run 2\n:play squta\n:pause\n:run 1\nbehaviors.squat.state\n:status\n"
           ":resume\n:run 6\n:status\n:stop\n:run 0.1\n:status\n",
           "--play wave");
  CHECK(has(outcome.err, "console:3:7: unknown behavior 'squta' in behaviors/tulip, did you mean 'squat'?"));
  CHECK(has(outcome.out, "supervisor: replace squat wave"));
  CHECK(has(outcome.out, "squat\npaused\n"));
  CHECK(has(outcome.out, "plays\n"));
  CHECK(has(outcome.out, "squat: done\n  wave: in wave\n"));
  CHECK(has(outcome.out, "nothing plays\n"));
}

TEST_CASE("repl without a scenario takes the project's only robot") {
  const auto project = project_copy("repl_robot");
  for (const char* other : {"head", "jiwiy", "hanging", "reaching", "looking"})
    std::filesystem::remove_all(project / "config" / other);
  write(project / "lines.txt", "s.joints.l_knee ~= nil\n:status\n");
  const Outcome outcome = run("repl <lines.txt", project);
  CHECK(outcome.out == "true\nnothing plays\n");
}
