// Tests of behaviors, written in Lua beside them: `describe`, `it`, `before_each`, `expect`, and k.play, which plays a
// behavior on a robot that whoever runs the tests provides. Each file has a sandbox of its own; its tests run when it
// is loaded, each on a budget of its own, so that one that fails, errors or never ends ends itself, not the others.
//
//   local run = k.play "squat.lua"        a behavior beside this file, or a path from the project's root
//   run:advance(2.0)                       virtual seconds
//   expect(run.state).to_equal "squat"
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/signal/status.h"

namespace kadans {

// A robot with one behavior that plays on it.
class TestStage {
 public:
  virtual ~TestStage() = default;
  virtual void advance(double seconds) = 0;  // throws std::runtime_error when the plant fails
  virtual const Snapshot& snapshot() const = 0;
  virtual const Catalog& catalog() const = 0;
  virtual std::string state() const = 0;
  virtual std::string outcome() const = 0;
  virtual std::string error() const = 0;
  virtual std::string control_sets() const = 0;  // names of the active ones
  virtual std::string said() const = 0;          // what the behavior logged, line by line
  virtual std::string went() const = 0;          // its states in order, "settle squat rest"
  // Each false, and nothing changes, when the name is unknown or the value out of range.
  virtual bool emit(const std::string& event) = 0;
  virtual bool set_parameter(const std::string& name, double value) = 0;
  // What the behavior sees from now on: "base.pitch_rad", "joints.l_knee.position_rad", "feet.left.contact",
  // "sensors.front_m", "safety.level" (its number).
  virtual bool set_sensor(const std::string& name, double value) = 0;
};

class TestStages {
 public:
  virtual ~TestStages() = default;
  // `robot` is a configuration or "" for the one of the behavior's folder. Throws InputError.
  virtual std::unique_ptr<TestStage> make(const std::filesystem::path& behavior, const std::string& robot) = 0;
};

struct TestOutcome {
  std::string name;     // "squat goes down three times"
  std::string problem;  // "file:line: expected ..."; "" when it passed
  double wall_s = 0;    // that it took
};

// In the order of the file those whose name holds `only`. Throws InputError when the file does not load.
std::vector<TestOutcome> run_behavior_tests(const std::filesystem::path& root, const std::filesystem::path& file,
                                            TestStages& stages, const std::string& only = "");

}  // namespace kadans
