// `kadans new behavior`: a behavior of one joint with its test.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "app/terminal.h"
#include "kadans/signal/shell_word.h"
#include "new_files.h"
#include "new_subject.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view behavior_template =
    R"(-- Moves one joint aside and back, as often as it is told, and gives up when the joint does not get there. A first
-- version: states, motions and numbers are yours to change. docs/behaviors.md has the language.
local k = require "kadans"

local joint = @joint@
local home_@unit@ = @home@  -- where it starts

local P = k.params {
  aside_@unit@ = { @aside@, min = @least@, max = @most@, unit = "@unit@", doc = "how far it moves" },
  move_s  = { @move_s@, min = 0.2, max = 20, unit = "s", doc = "time to get there" },
  rest_s  = { 0.5, min = 0.1, max = 20, unit = "s", doc = "time to stay there" },
  times   = { 2, min = 1, max = 1000, doc = "how often" },
  missing = { 0.5, min = 0.01, max = 1, doc = "share of the way that may be missing" },
}

local function way() return @sign@P.aside_@unit@ end

-- Whether the joint has not moved as far as it was told, from where it began.
local function missed(s, m)
  local went = s.joints[joint].position_rad - m.vars.began
  return math.abs(went - way()) > P.missing * P.aside_@unit@
end

return k.behavior "@name@" {
  controls = "@set@",
  vars     = { done = 0, began = 0 },  -- kept over a reload
  initial  = "ready",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" and s.safety.level ~= "limited" end, to = "failed", why = "safety" },
  },

  k.state "ready" {
    run = function(m)
      m.@object@:move({ [joint] = home_@unit@ }, { time_s = P.move_s }):wait()
      m:wait(P.rest_s)
    end,
    { on = "run.done", to = "aside" },
  },
  k.state "aside" {
    enter = function(m, s) m.vars.began = s.joints[joint].position_rad end,
    run = function(m)
      m.@object@:move({ [joint] = home_@unit@ + way() }, { time_s = P.move_s }):wait()
      m:wait(P.rest_s)
    end,
    { on = "run.done", when = missed, to = "failed", why = "did not get there" },
    { on = "run.done", to = "back" },
  },
  k.state "back" {
    run = function(m)
      m.@object@:move({ [joint] = home_@unit@ }, { time_s = P.move_s }):wait()
      m:wait(P.rest_s)
      m.vars.done = m.vars.done + 1
    end,
    { on = "run.done", when = function(_, m) return m.vars.done >= P.times end, to = "done" },
    { on = "run.done", to = "aside" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}
)";

constexpr std::string_view behavior_test_template = R"(-- kadans behavior test @file@
local k = require "kadans"

describe("@name@", function()
  local joint, path, run = @joint@, @path@, nil
  before_each(function() run = k.play("@name@.lua", { robot = @robot@, plant = "bullet" }) end)

  it("moves the joint aside and comes back, as often as it is told", function()
    run:set_parameter("times", 1)
    run:advance_to("aside")
    local began = run.joints[joint].position_rad
    run:advance(@there_s@)
    expect(run.joints[joint].position_rad - began).to_be_near(@way@, @near@)
    expect(run:finish(30)).to_equal "done"
    expect(run.states).to_equal "ready aside back done"
    expect(run.joints[joint].position_rad).to_be_near(began, @near@)
  end)

  it("fails when the joint stays where it is", function()
    run:set_sensor(path, @home@)
    expect(run:finish(30)).to_equal "failed"
    expect(run.states).to_equal "ready aside failed"
  end)

  it("fails when the safety layer has to act", function()
    run:advance_to("aside")
    run:set_sensor("safety.level", "damp")
    run:advance(0.1)
    expect(run.outcome).to_equal "failed"
  end)
end)
)";

std::string lua_number(double value) { return printed("%.6g", value); }

int run_new_behavior(const NewPartOptions& options) {
  refuse_bad_name(options.name, "a behavior", "nod");
  const NewSubject subject = read_subject(options);
  const AsideJoint chosen = joint_aside(subject);
  const std::string folder = "behaviors/" + subject.behaviors_folder();
  const std::string file = folder + "/" + options.name + ".lua", test = folder + "/" + options.name + "_test.lua";
  const double far = std::abs(chosen.aside), home = std::round(chosen.home * 1e6) / 1e6;
  // Half of its greatest speed at most, which is 1.9 times the mean of the motion.
  const double move_s = std::max(1.0, std::ceil(10 * 1.9 * far / (0.5 * chosen.joint->velocity_max_rad_s)) / 10);
  const std::vector<std::pair<std::string, std::string>> values{
      {"@name@", options.name},
      {"@file@", test},
      {"@robot@", source_text(subject.robot_file)},
      {"@joint@", source_text(chosen.joint->name)},
      {"@path@", source_text("joints." + chosen.joint->name + ".position_rad")},
      {"@set@", chosen.set->name},
      {"@object@", chosen.object->name},
      {"@unit@", chosen.joint->type == JointType::prismatic ? "m" : "rad"},
      {"@home@", lua_number(home)},
      {"@way@", lua_number(chosen.aside)},
      {"@near@", lua_number(0.4 * far)},
      {"@sign@", chosen.aside < 0 ? "-" : ""},
      {"@aside@", lua_number(far)},
      {"@least@", lua_number(0.001)},
      {"@most@", lua_number(chosen.most)},
      {"@move_s@", lua_number(move_s)},
      {"@there_s@", lua_number(move_s + 0.3)}};
  write_new_files({subject.project / file, subject.project / test},
                  {{fs::proximate(subject.project / file), filled_template(behavior_template, values)},
                   {fs::proximate(subject.project / test), filled_template(behavior_test_template, values)}});
  tell_command("Test it", subject.project, "behavior test " + shell_word(test));
  tell_command("Run it ", subject.project,
               "run " + shell_word(subject.robot_file) + " --play " + options.name +
                   " --live    or let `kadans new scenario NAME --play " + options.name + "` write what it must do");
  if (options.no_run) return exit_passed;
  return run_kadans({"behavior", "test", fs::absolute(subject.project / test).string()});
}

}  // namespace

void add_new_behavior(CLI::App& made, CommandLine& line) {
  const auto [behavior, options] =
      line.add<NewPartOptions>(made, "behavior", "Write a behavior with its test, and run the test", run_new_behavior);
  add_part_options(*behavior, options, "Its name, for example nod", "Do not run its test");
}

}  // namespace kadans
