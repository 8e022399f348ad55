// Tests of behaviors, written in Lua beside them: `describe`, `it`, `before_each`, `expect`, and k.play, which plays a
// behavior on a robot from TestStages. Each file has a sandbox of its own. Its tests run after the file was loaded,
// each with a budget of its own, so a test that fails, raises or never ends does not stop the others.
//
//   local run = k.play "squat.lua"        a behavior beside this file, or a path from the project's root
//   run:advance(2.0)                       virtual seconds
//   expect(run.state).to_equal "squat"
//   expect(run.active).to_equal { "squat" }    all innermost active states
//
// A k.decisions is played likewise, but nothing plays what it asks for: the test says how that ends.
//
//   expect(run.orders[1].list).to_equal "walk_to"
//   run:play_ends "failed"
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/scenario/play_item.h"
#include "kadans/control/catalog.h"
#include "kadans/signal/status.h"

namespace kadans {

class Behavior;

// A robot with one behavior that plays on it.
class TestStage {
 public:
  virtual ~TestStage() = default;
  virtual void advance(double seconds) = 0;  // throws std::runtime_error when the plant fails
  virtual const Snapshot& snapshot() const = 0;
  virtual const Catalog& catalog() const = 0;
  virtual Behavior& behavior() = 0;                        // that is tested
  virtual std::string control_sets() const { return ""; }  // names of the active ones
  virtual std::string said() const = 0;                    // the lines that the behavior logged
  virtual std::string went() = 0;                          // the states that it went through, "settle squat rest"
  // Returns "", or why the behavior cannot take it.
  virtual std::string emit(const PlayedEvent& event) = 0;
  // Sets a value that the behavior sees from now on: "base.pitch_rad", "joints.l_knee.position_rad",
  // "feet.left.contact", "sensors.front_m", "safety.level" (its number). False, and nothing changes, when the name is
  // unknown or the value is out of range.
  virtual bool set_sensor(const std::string& name, double value) = 0;
  // Of decisions: what they asked for, and the messages that they sent, as lists that Lua can read; "": it is none.
  virtual std::string orders() const { return ""; }
  virtual std::string messages() const { return ""; }
  // Of decisions: what plays has ended, or is in that state. These return "", or why not.
  virtual std::string end_play(const std::string& /*outcome*/) { return "play_ends: nothing decides here"; }
  virtual std::string set_playing(const std::string& /*behavior*/, const std::string& /*state*/) {
    return "plays: nothing decides here";
  }
};

class TestStages {
 public:
  virtual ~TestStages() = default;
  struct Options {
    std::string robot;     // the file of a configuration; "": the one of the scenario, else of the behavior's folder
    std::string plant;     // a plant type; "": joints that nothing loads
    std::string scenario;  // a scenario's file, for its robot and its world model; "": none
  };
  // Throws InputError.
  virtual std::unique_ptr<TestStage> make(const std::filesystem::path& behavior, const Options& options) = 0;
};

struct TestOutcome {
  std::string name;     // "squat goes down three times"
  std::string problem;  // "file:line: expected ..."; "" when it passed
  double wall_s = 0;    // time that it took
};

// Runs the tests whose names contain `only`, in the order of the file. Throws InputError when the file does not load.
std::vector<TestOutcome> run_behavior_tests(const std::filesystem::path& root, const std::filesystem::path& file,
                                            TestStages& stages, const std::string& only = "");

}  // namespace kadans
