// `kadans commission`: finds out with a person what stands between a robot's configuration and its wiring, step by step
// and joint by joint, and writes it into the configuration.
//
// Each step opens the drives anew with the configuration as it is then. What a joint's step found is written at once,
// and kept in ROBOT.commission (progress.h). So a run that is cut off goes on where it was. What is wrong is told in a
// sentence; that joint's step is not done, the other joints go on.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/assembly/robot.h"
#include "app/bench/bench.h"
#include "person.h"

namespace kadans {

struct CommissionSettings {
  std::string robot;                // its configuration
  std::string plant;                // type of plant: hm2-eth, dynamixel
  double share = 0.1;               // of each joint's greatest torque, at any moment
  std::vector<std::string> steps;   // none: all
  std::vector<std::string> joints;  // none: all that have a motor
  bool again = false;               // forgets what was done
};

// The names of the steps, in their order.
const std::vector<std::string>& commission_steps();

// Opens the drives of a robot that has just been read. nullptr: somebody wants the program to end.
using OpenDrives = std::function<std::unique_ptr<Bench>(const Robot& robot)>;

struct CommissionReport {
  std::vector<std::string> problems;  // sentences
  bool ended_early = false;           // the person has gone
};

// Throws InputError for a robot that cannot be commissioned, and for drives that cannot be opened.
CommissionReport commission(const CommissionSettings& settings, Person& person, const OpenDrives& open);

}  // namespace kadans
