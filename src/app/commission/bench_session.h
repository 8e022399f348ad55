// A person and a robot on its bench, tick by tick: questions and answers while all drives are off, and motions of one
// joint while a key is held.
//
// Every tick is bounded here, whatever a motion asks for: no joint gets more than its share of torque, and a motion
// ends when any joint went further than away_rad from where it stood when the key was pressed, when a drive reports a
// fault, or falls silent, or when the motion itself gives it up.
//
// Where two drives move two joints together (transmissions), it pushes and sees joints, or after by_drives() drives:
// then all numbers are of drives, each in its joint's place.
//
// One owner, one thread, no tick of an engine: it may throw.
#pragma once

#include <string>
#include <vector>

#include "app/bench/bench.h"
#include "app/bench/push.h"
#include "app/bench/pushed_joint.h"
#include "kadans/model/robot_model.h"
#include "kadans/plant/plant_type.h"
#include "person.h"

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
    std::vector<double> drive_effort_max_Nm{};  // greatest torque of each drive; none: those of the joints
  };

  BenchSession(Bench& bench, Person& person, const RobotModel& model, const Settings& settings);

  const RobotModel& model() const noexcept { return model_; }
  // A drive rounds what it is asked for.
  double effort_max_Nm(std::size_t joint) const {
    const double most_Nm =
        pair_of(joint) != nullptr ? settings_.drive_effort_max_Nm[joint] : model_.joints[joint].effort_max_Nm;
    return 0.98 * settings_.share * most_Nm;
  }
  void by_drives() noexcept {
    by_drives_ = true;
    see();
  }
  void tell(const std::string& sentence) { person_.hear(sentence); }
  // All drives are off meanwhile. Throws PersonGone.
  std::string ask(const Question& question);
  double ask_number(Question question, double min, double max);
  // Pushes a joint while the key is held, until the person has seen enough. Returns a sentence about what stopped it
  // before; "" when nothing did. `far`: this joint may go on as far as it is pushed. Throws PersonGone.
  std::string hold(const Question& question, std::size_t joint, Push& push, bool far = false);
  const BenchSight& sight() const noexcept { return sight_; }
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
  void see();
  // The transmission by which this drive is coupled, while drives are pushed; else nullptr.
  const Transmission* pair_of(std::size_t joint) const noexcept {
    return by_drives_ ? model_.coupling_of(joint) : nullptr;
  }
  std::string look_for_stop(std::size_t joint, bool far) const;
  bool still();

  void order(std::size_t joint, DriveOrder order);

  Bench& bench_;
  Person& person_;
  const RobotModel& model_;
  Settings settings_;
  std::vector<PushedJoint> watches_;
  SensorFrame sensors_;
  ActuationFrame actuation_;
  std::int64_t first_ns_;
  BenchSight sight_;
  std::array<double, max_joints> held_from_rad_{}, joints_held_from_rad_{};
  std::array<double, max_joints> still_at_rad_{};
  double still_s_ = 0;
  std::array<Range, max_joints> ranges_{};
  std::size_t homing_joint_ = 0;
  bool* homed_ = nullptr;
  int homing_ticks_ = 0;
  bool by_drives_ = false;
};

}  // namespace kadans
