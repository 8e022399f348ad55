// A person and a robot on its bench, tick by tick: questions and answers while all drives are off, and motions of one
// joint while a key is held.
//
// Every tick is bounded here, whatever a motion asks for: no joint gets more than its share of torque, and a motion
// ends when any joint went further than away_rad from where it stood when the key was pressed, when a drive reports a
// fault, or falls silent.
//
// One owner, one thread, no tick of an engine: it may throw.
#pragma once

#include <string>
#include <vector>

#include "app/bench/bench.h"
#include "app/bench/pushed_joint.h"
#include "kadans/model/robot_model.h"
#include "kadans/plant/plant_type.h"
#include "person.h"
#include "push.h"

namespace kadans {

// The person has gone, or wants to end; what was found is written.
struct PersonGone {};

class BenchSession {
 public:
  struct Settings {
    double share = 0.1;      // of each joint's greatest torque
    double period_s = 1e-3;  // of a tick
    double away_rad = 0.07;  // 4 degrees
    DriveWords words = nullptr;
  };
  enum class Stop : std::uint8_t { none, fault, silent, too_far };

  BenchSession(Bench& bench, Person& person, const RobotModel& model, const Settings& settings);

  const RobotModel& model() const noexcept { return model_; }
  // A drive rounds what it is asked for.
  double effort_max_Nm(std::size_t joint) const { return 0.98 * settings_.share * model_.joints[joint].effort_max_Nm; }
  double share() const noexcept { return settings_.share; }
  void tell(const std::string& sentence) { person_.hear(sentence); }
  // All drives are off meanwhile. Throws PersonGone.
  std::string ask(const Question& question);
  double ask_number(Question question, double min, double max);
  // Pushes a joint while the key is held, until the person has seen enough. `far`: this joint may go on as far as it is
  // pushed. Throws PersonGone.
  Stop hold(const Question& question, std::size_t joint, Push& push, bool far = false);
  // Why a hold() stopped, as a sentence.
  std::string why(Stop stop) const;
  const BenchSight& sight() const noexcept { return sight_; }
  const SensorFrame& sensors() const noexcept { return sensors_; }
  struct Range {
    double least_rad = 0, most_rad = 0;
  };
  const Range& range(std::size_t joint) const { return ranges_[joint]; }  // since the last question was asked
  void wait(double seconds);                                              // all drives are off
  void settle(double seconds);  // the same, until all joints are at rest, for so long at most
  // While a key is held, the drive is told to look for its zero, and off again when it is not; `homed` is whether it
  // has found it. nullptr: no longer.
  void watch_homing(std::size_t joint, bool* homed);

 private:
  void tick(std::size_t joint, double effort_Nm, bool acts);
  Stop look_for_stop(std::size_t joint, bool far);
  bool still();

  void order(std::size_t joint, DriveOrder order);

  Bench& bench_;
  Person& person_;
  const RobotModel& model_;
  Settings settings_;
  std::vector<PushedJoint> watches_;
  SensorFrame sensors_;
  ActuationFrame actuation_;
  BenchSight sight_;
  std::array<double, max_joints> held_from_rad_{};
  std::array<double, max_joints> still_at_rad_{};
  double still_s_ = 0;
  std::array<Range, max_joints> ranges_{};
  std::size_t stopped_joint_ = 0, homing_joint_ = 0;
  bool* homed_ = nullptr;
  int homing_ticks_ = 0;
};

}  // namespace kadans
