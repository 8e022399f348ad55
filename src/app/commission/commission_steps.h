// The steps of `kadans commission`. Each is a function over what all of them have: the session, the configuration's
// wiring, and what was done before.
#pragma once

#include <string>
#include <vector>

#include "app/assembly/robot.h"
#include "bench_session.h"
#include "progress.h"
#include "wiring.h"

namespace kadans {

struct CommissionStep {
  BenchSession& session;
  const Robot& files;
  const RobotConfig& robot;  // of these files
  Wiring& wiring;
  Progress& progress;
  std::string_view name;            // of the step
  std::vector<std::size_t> joints;  // for which it is not done yet, and shall be
  std::vector<std::string>& problems;

  const std::string& joint_name(std::size_t joint) const { return robot.model.joints[joint].name; }
  // What is pushed in this joint's place when drives are: named by the joint where that has a drive of its own.
  const std::string& drive_name(std::size_t joint) const {
    return robot.model.coupling_of(joint) != nullptr ? wiring.drive_name(joint_name(joint)) : joint_name(joint);
  }
  double number_at(std::size_t joint, std::string_view field, double otherwise) const {
    return wiring.number(joint_name(joint), field, otherwise);
  }
  void done(std::size_t joint, const std::string& found) { progress.set(name, joint_name(joint), found); }
  // A sentence about what is wrong; the joint's step is not done.
  void problem(const std::string& sentence) {
    session.tell(sentence);
    problems.push_back(sentence);
  }
};

// Which drive is which joint: wiggles one drive after the other; the person says which joint moved.
void find_names(CommissionStep& step);
// In which direction motor and encoder turn: moves each joint by some degrees.
void find_directions(CommissionStep& step);
// Where a joint's zero is: by a jig, a hard stop, or the switch or index that its drive looks for.
void find_zeros(CommissionStep& step);
// How far a joint may go: it is moved by hand.
void find_limits(CommissionStep& step);
// How strong its drive is: by the command that carries a known load, up and down.
void find_scales(CommissionStep& step);
// Its inertia, friction and delay by a swing, the gains that follow, and whether a small step with them goes well.
void find_gains(CommissionStep& step);

// The least inertia that each joint's drive may feel: the others move as they like. With the rotors, at the pose 0.
// `by_drives`: that of the drives, where two move two joints.
std::vector<double> inertias_kg_m2(const RobotConfig& robot, bool by_drives = false);
// "counter-clockwise, seen from above": how a joint's drive turns it in its positive direction, at the pose 0. Of one
// that moves two joints what each of them does.
std::string positive_turn_of_drive(const RobotModel& model, std::size_t joint);
std::string degrees_text(double rad);  // "1.2 degrees"

}  // namespace kadans
