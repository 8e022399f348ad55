// A robot made of tables, a queue and a log: what a behavior needs to be played in a test. The control engine is
// replaced by a few lines that apply transactions and let motions take their time.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "engine/transaction.h"
#include "script/behavior/behavior.h"
#include "script/host/script_host.h"
#include "signal/number_text.h"

namespace kadans::script_test {

inline const std::vector<std::string>& joint_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const std::string side : {"l_", "r_"}) {
      for (const char* joint :
           {"hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll", "shoulder_pitch"}) {
        all.push_back(side + joint);
      }
    }
    return all;
  }();
  return names;
}

// 14 joints, object "posture" on the driven ones in set "posture", object "arms" in set "gesture".
class Robot {
 public:
  Robot() {
    catalog.model = &model;
    catalog.feet = {{"left", "l_sole"}, {"right", "r_sole"}};
    model.name = "tulip";
    model.links.resize(joint_names().size() + 1);
    for (const std::string& name : joint_names()) {
      Joint joint{.name = name, .lower_rad = -2.0, .upper_rad = 2.0};
      if (name.ends_with("knee")) joint.lower_rad = 0, joint.upper_rad = 2.35;
      model.joints.push_back(joint);
    }
    values.resize(64);
    add_object("posture", [](const std::string& name) { return !name.ends_with("ankle_roll"); });
    add_object("arms", [](const std::string& name) { return name.ends_with("shoulder_pitch"); });
    catalog.sets = {{"posture", {0}}, {"gesture", {1}}};
    PoseInfo stand{"stand", {}}, lean{"lean", {}};
    for (std::size_t i = 0; i < model.joints.size(); ++i) stand.position_rad.emplace_back(i, 0.0);
    for (std::size_t i = 0; i < model.joints.size(); ++i) lean.position_rad.emplace_back(i, 0.1);
    catalog.poses = {stand, lean};
  }

  // Object "legs" in set "legs": all driven joints but those of "arms".
  void add_legs() {
    add_object("legs", [](const std::string& name) {
      return !name.ends_with("ankle_roll") && !name.ends_with("shoulder_pitch");
    });
    catalog.sets.push_back({"legs", {2}});
  }

  RobotModel model;
  Catalog catalog;
  std::vector<double> values;

 private:
  template <typename Takes>
  void add_object(const std::string& name, Takes takes) {
    ObjectInfo object{.name = name, .type = "joint_pid"};
    const auto owner = static_cast<std::uint32_t>(catalog.objects.size());
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      if (!takes(model.joints[i].name)) continue;
      object.joints.push_back(i);
      const std::string prefix = name + "." + model.joints[i].name + ".";
      object.parameters.push_back(catalog.parameters.add(
          {.name = prefix + "kp_Nm_per_rad", .unit = "Nm/rad", .min = 0, .max = 500, .initial = 100}, &values[used_++],
          owner));
      object.setpoints.push_back(catalog.setpoints.add({.name = prefix + "position_rad",
                                                        .unit = "rad",
                                                        .min = model.joints[i].lower_rad,
                                                        .max = model.joints[i].upper_rad,
                                                        .owner = owner,
                                                        .channel = static_cast<std::uint32_t>(object.setpoints.size()),
                                                        .joint = static_cast<std::uint32_t>(i)}));
    }
    for (const auto& [preset, value] : {std::pair{"stiff", 200.0}, std::pair{"soft", 20.0}}) {
      Preset made{preset, {}};
      for (const ParameterId id : object.parameters) made.values.emplace_back(id, value);
      object.presets.push_back(made);
    }
    catalog.objects.push_back(object);
  }
  std::size_t used_ = 0;
};

class Log final : public BehaviorLog, private LineSink {
 public:
  Log() { add(*this); }
  void tell(const Line& line) override {
    if (const Transition* made = line.transition; made != nullptr) {
      transitions.push_back(made->from + ">" + made->to + ":" + made->why);
    } else {
      messages.push_back(std::string(line.behavior) + ": " + std::string(line.text));
      errors += line.severity == Severity::error ? 1 : 0;
    }
  }
  void tell_active(const ActiveStates& told) override {
    active.push_back(std::string(told.behavior) + ": " + listed(told.copies()));
  }
  std::string joined() const {
    std::string all;
    for (const std::string& text : messages) all += text.substr(text.find(": ") + 2) + "\n";
    return all;
  }
  std::vector<std::string> transitions, messages, active;
  int errors = 0;
};

// A folder of scripts that is gone after the test.
class Scripts {
 public:
  Scripts();
  ~Scripts();
  Scripts(const Scripts&) = delete;
  Scripts& operator=(const Scripts&) = delete;
  std::filesystem::path write(const std::string& name, const std::string& text) const;
  std::filesystem::path root;
};

// The control engine's place: applies what waits in the queue, lets motions take their time, and makes the snapshot of
// the next behavior tick, 10 ms later.
class Engine {
 public:
  Engine() { snapshot.control_sets = robot.catalog.initial_sets; }
  void step();
  // How many of the commands applied so far were of that kind.
  std::size_t commands(CommandKind kind) const;

  Robot robot;
  CommandQueue queue;
  CommandSender sender{queue};
  Snapshot snapshot;
  std::vector<Command> applied;  // all so far, headers too
  bool applying = true;          // whether the control engine takes transactions

 private:
  void apply();
  double moving_until_s_[max_objects]{};
};

// Plays one behavior, tick by tick of 10 ms.
class Stage : public Engine {
 public:
  explicit Stage(const std::string& text, ScriptLimits limits = {}, std::uint64_t seed = 1);  // throws InputError
  Stage(const std::filesystem::path& root, const std::filesystem::path& file);
  bool tick(int times = 1);
  // Ticks until the behavior is over, at most so often.
  void play(int ticks_max = 1000) {
    while (ticks_max-- > 0 && tick()) {
    }
  }
  std::string said() const { return log.joined(); }

  Scripts scripts;
  Log log;
  std::unique_ptr<Behavior> behavior;
};

// Plays lists of behaviors, whose files are in `scripts`, tick by tick of 10 ms.
class Theatre : public Engine {
 public:
  // Opens with behaviors/b0.lua, b1.lua ... of these texts; all in lane 0 when no lanes are given.
  explicit Theatre(const std::vector<std::string>& texts, const std::vector<std::uint32_t>& lanes = {});
  Theatre() = default;
  void open(ScriptHost::Settings settings);  // throws InputError
  void tick(int times = 1);
  // What is in behaviors/<name>.lua, as an order's list.
  std::vector<PlayItem> list(const std::vector<std::string>& names) const;

  Scripts scripts;
  Log log;
  std::unique_ptr<ScriptHost> host;
};

// A behavior that runs `code`, with m and s, on entering its only state.
inline std::string on_enter(const std::string& code) {
  return "local k = require 'kadans'\nreturn k.behavior 'test' { k.state 'a' { enter = function(m, s)\n" + code +
         "\nend } }\n";
}
// What the code prints, or its error.
std::string output_of(const std::string& code);

// The message that loading this text gives; "" when it loads.
std::string load_error(const std::string& text);

}  // namespace kadans::script_test
