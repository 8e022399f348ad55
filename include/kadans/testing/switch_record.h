// What a switch from one control object to another does to the drive's torque, whatever the modes of the two.
//
//   JointBench bench(config, {{"soft", make_joint_impedance}, {"stiff", make_joint_pid}});
//   ... bring it into the situation to be tested ...
//   CHECK(record_switch(bench, "stiff") <= SwitchLimits{});
#pragma once

#include <iosfwd>
#include <string_view>
#include <vector>

#include "kadans/control/switchover.h"

namespace kadans::testing {

class JointBench;

struct SwitchRecord {
  double dt_s = 0;
  std::vector<double> torque_Nm;  // of the drive, per tick; [0] is the last one of the old object
  double first_step_share = 0;    // between the two objects' torques, as a share of the joint's limit
  double largest_step_share = 0;  // from tick to tick, in all of the record
  double converged_s = 0;  // after which the torque stays within 2 % of the limit around where it ends; NaN: never
};

struct SwitchLimits {
  double first_step_share = SwitchSettings{}.step_max;
  double converged_s = SwitchSettings{}.fade_s;
};

// Switches to the object of this name and records for duration_s. Torques are compared where one tick meets the next:
// at the end of the old actuation's last tick and at the beginning of the new one's first. converged_s is meaningful
// only in a situation that comes to rest.
SwitchRecord record_switch(JointBench& bench, std::string_view object, double duration_s = 0.5);

bool operator<=(const SwitchRecord& record, const SwitchLimits& limits) noexcept;
std::ostream& operator<<(std::ostream& out, const SwitchRecord& record);
std::ostream& operator<<(std::ostream& out, const SwitchLimits& limits);

}  // namespace kadans::testing
