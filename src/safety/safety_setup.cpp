// What happens to the safety layer before the loop: its limits are checked, its signals declared.
#include <stdexcept>
#include <string>

#include "safety.h"

namespace kadans {
namespace {

void require(bool sane, const std::string& what) {
  if (!sane) throw std::invalid_argument("safety: " + what);
}

void check_limits(const JointLimits& l, const Joint& joint) {
  const bool sane = l.lower_rad <= l.upper_rad && l.velocity_max_rad_s >= 0 && l.effort_max_Nm >= 0 &&
                    l.effort_rate_max_Nm_s >= 0 && l.power_max_W >= 0 && l.continuous_Nm >= 0 &&
                    l.thermal_time_constant_s > 0;
  require(sane, "the limits of joint " + joint.name + " make no sense");
}

void check_settings(const SafetySettings& s) {
  require(s.position_margin_rad >= 0 && s.velocity_margin >= 1, "margins must be at least 0 rad and 1 times the speed");
  require(s.damping_Nms_per_rad >= 0 && s.recover_s > 0, "damping must be at least 0, recover_s above 0");
  require(s.soft_stop.zone_rad >= 0 && s.soft_stop.stiffness_Nm_per_rad >= 0, "a soft stop must not be negative");
  require(s.thermal.ambient_C < s.thermal.warm_C && s.thermal.warm_C <= s.thermal.hot_C,
          "thermal: ambient_C < warm_C <= hot_C must hold");
  require(s.drives.enable_s >= 0 && s.drives.hot_C > 0 && s.drives.sample_age_max_s > 0,
          "drives: enable_s must be at least 0, hot_C and sample_age_max_s above 0");
  require(s.supply.highest_V == 0 || s.supply.lowest_V < s.supply.highest_V, "supply: lowest_V < highest_V must hold");
  require(s.fall.soft_share >= 0 && s.fall.soft_share <= 1, "fall.soft_share must be 0..1");
}

}  // namespace

Safety::Safety(const SafetySettings& settings, const RobotModel& model)
    : settings_(settings),
      joint_count_(model.joints.size()),
      imu_(settings),
      fall_(settings),
      engine_(settings),
      supply_(settings) {
  if (settings_.joints.size() != joint_count_) {
    throw std::invalid_argument("safety limits for " + std::to_string(settings_.joints.size()) +
                                " joints, the robot has " + std::to_string(joint_count_));
  }
  require(joint_count_ <= max_joints, "at most " + std::to_string(max_joints) + " joints");
  check_settings(settings_);
  for (std::size_t i = 0; i < joint_count_; ++i) {
    check_limits(settings_.joints[i], model.joints[i]);
    joints_[i].watch = JointWatch(settings_, settings_.joints[i]);
    joints_[i].limiter = JointLimiter(settings_, settings_.joints[i]);
  }
  feet_.fill(FootWatch(settings_));
  require(settings_.channels.size() <= max_channels, "at most " + std::to_string(max_channels) + " sensors");
  for (std::size_t i = 0; i < settings_.channels.size(); ++i)
    channels_[i] = ChannelWatch(settings_, settings_.channels[i]);
  for (std::size_t code = 0; code < fault_codes; ++code) {
    if (settings_.reactions[code].escalate) escalating_ |= bit(static_cast<FaultCode>(code));
  }
}

void Safety::declare_signals(SignalTable& table, const RobotModel& model) const {
  table.add({"safety.faults", "", "Faults since the start or the last clearing."}, &fault_count_);
  table.add({"safety.level", "", "Worst rung of robot and joints: 0 normal, 1 limited, 2 hold, 3 damp, 4 off."},
            &level_number_);
  table.add({"safety.robot_level", "", "Rung of the robot as a whole."}, &robot_level_number_);
  table.add({"safety.fall", "", "0 upright, 1 falling, 2 fallen."}, &fall_.phase_number());
  table.add({"safety.impact_m_s2", "m/s2", "Largest specific force of the last fall."}, &fall_.impact_m_s2());
  table.add({"safety.missed_ticks", "", "Ticks of the control engine missed since the start."},
            &engine_.missed_ticks());
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const std::string prefix = "safety." + model.joints[i].name;
    table.add({prefix + ".level", "", "Rung of the joint, the robot's included."}, &joints_[i].level_number);
    if (joints_[i].limiter.passive()) continue;
    table.add({prefix + ".temperature_C", "C", "Of the motor's winding, by the thermal model."},
              &joints_[i].watch.thermal().temperature_C());
  }
}

}  // namespace kadans
