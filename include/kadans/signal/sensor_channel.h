// A sensor of a robot other than its joints, its IMU and its feet: a distance, a voltage, a switch, a force. A channel
// is an entry of the robot's configuration. The plant fills it; records, checks, faults and behaviors know it by its
// name.
#pragma once

#include <limits>
#include <string>

namespace kadans {

struct SensorChannel {
  std::string name;
  std::string unit;
  std::string doc;                                                                               // a sentence
  double min = std::numeric_limits<double>::lowest(), max = std::numeric_limits<double>::max();  // beyond: a fault
  double period_s = 0;  // between two readings; 0: one in each tick
  // Of a model: what it reads, and the standard deviation of its noise.
  double value = 0, noise = 0;
};

}  // namespace kadans
