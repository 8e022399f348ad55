// Projects of a few files for tests of what behavior check finds in them.
#pragma once

#include "app/assembly/robot.h"
#include "app/program.h"
#include "estimate/estimator.h"
#include "script/check/check_behavior.h"

namespace kadans::check_tests {

namespace fs = std::filesystem;

struct Case {
  const char* name;
  const char* chart;    // behind `local k = require "kadans"`, in line 1
  const char* message;  // behind the file's name; "" for none
};

class Project {
 public:
  Project()
      : robot_(read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json")),
        system_(make_control_system(robot_)),
        folder_(program::fresh_folder("check_findings")) {
    declare_signals(system_->catalog.signals, robot_.config.model, robot_.config.estimate, *measured_);
    fs::create_directories(folder_ / "behaviors/lib");
    lib("arms",
        "local arms = { count = 0 }\n"
        "function arms.raise(m) m.posture:move('stand', { time_s = 1 }) end\n"
        "arms.lower = function(m) m.posture:move('squat', { time_s = 1 }) end\n"
        "function arms.learn() arms.learnt = true end\n"
        "function arms.up(s) return s.time_s > 1 end\n"
        "function arms.forgets(s) local x = s.time_s > 1 end\n"
        "return arms\n");
    lib("grows", "local grows = {}\nfunction grows.put(key, value) grows[key] = value end\nreturn grows\n");
    lib("falls_back", "return setmetatable({}, { __index = function(_, key) return key end })\n");
    lib("nothing", "local nothing = {}\nfunction nothing.f() end\n");
    lib("says", "require 'kadans'.log.info('loaded')\n");
    lib("number", "return 7\n");
    lib("call", "return function(m) m.posture:set_gains 'soft' end\n");
    lib("takes",
        "local k = require 'kadans' return k.behavior 'takes' { args = { how_m = { 1, min = 0, max = 3 }, far_m = 0 "
        "},\n"
        "k.final 'a' { outcome = 'done', result = function(m) return { x = m.args.how_m } end } }\n");
    lib("over", "local k = require 'kadans' return k.behavior 'over' { k.final 'a' { outcome = 'tired' } }\n");
  }

  void lib(const std::string& name, const std::string& text) const {
    program::write(folder_ / ("behaviors/lib/" + name + ".lua"), text);
  }
  std::string problems(const std::string& chart) const {
    program::write(folder_ / "behaviors/t.lua", "local k = require \"kadans\"\n" + chart);
    return told(check_behavior(folder_, "behaviors/t.lua", system_->catalog));
  }
  CheckedScript script(const std::string& name, const std::string& text) const {
    program::write(folder_ / name, text);
    return check_script(folder_, name, &system_->catalog);
  }
  static std::string told(const std::vector<InputProblem>& problems) {
    std::string all;
    for (const InputProblem& problem : problems) all += problem.text() + "\n";
    return all;
  }

 private:
  Robot robot_;
  std::unique_ptr<ControlSystem> system_;
  std::unique_ptr<Snapshot> measured_ = std::make_unique<Snapshot>();  // for the names of what is measured
  fs::path folder_;
};

}  // namespace kadans::check_tests
