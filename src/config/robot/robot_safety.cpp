// The part of a robot's configuration that stands on safety: limits by joint, what the watches look for, reactions.
#include <algorithm>
#include <array>

#include "config/json/name_pattern.h"
#include "robot_reader.h"

namespace kadans {
namespace {

std::vector<std::string> level_names() {
  std::vector<std::string> names;
  for (const SafetyLevel level :
       {SafetyLevel::normal, SafetyLevel::limited, SafetyLevel::hold, SafetyLevel::damp, SafetyLevel::off}) {
    names.emplace_back(name(level));
  }
  return names;
}

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (std::size_t code = 1; code < fault_codes; ++code) {
    const auto fault = static_cast<FaultCode>(code);
    if (fault != FaultCode::emergency_stop &&
        fault != FaultCode::emergency_input)  // what follows is no matter of taste
      names.emplace_back(name(static_cast<FaultCode>(code)));
  }
  return names;
}

void soft_stop_fields(Fields& f, SoftStopSettings& s) {
  f.number("zone_rad", s.zone_rad, {0, 1, "rad"},
           "range before a position limit in which torque towards the limit fades to 0");
  f.number("stiffness_Nm_per_rad", s.stiffness_Nm_per_rad, {0, 1e4, "Nm/rad"},
           "stiffness of the spring that pulls a joint back beyond its position limit");
}

void thermal_fields(Fields& f, ThermalSettings& s) {
  f.number("ambient_C", s.ambient_C, {-50, 80, "C"}, "temperature at which a motor starts and to which it cools down");
  f.number("warm_C", s.warm_C, {0, 300, "C"},
           "temperature of a winding from which its torque is limited, down to the continuous torque at hot_C");
  f.number("hot_C", s.hot_C, {0, 300, "C"}, "temperature of a winding from which it is a fault");
}

void sensor_fields(Fields& f, SensorWatchSettings& s) {
  f.number("jump_rad", s.jump_rad, {0, 10, "rad"},
           "step between two readings of a joint, in addition to the step at twice its speed limit, above which it is "
           "a fault");
  f.integer("stuck_ticks", s.stuck_ticks, {2, 100000},
            "identical readings in a row, while the joint's motor works, from which it is a fault");
  f.number("stuck_motion_rad", s.stuck_motion_rad, {1e-6, 10, "rad"},
           "motion of the motor, or of its set-point, from which the motor counts as working");
  f.number(
      "stuck_effort_share", s.stuck_effort_share, {1e-3, 10},
      "change of the demanded torque, as a share of its limit, from which a motor without a spring counts as working");
  f.boolean("imu", s.imu, "the inertial measurement unit is watched");
  f.integer("imu_stuck_ticks", s.imu_stuck_ticks, {2, 100000},
            "identical readings in a row of an IMU that had noise, from which it is a fault");
  f.number("gyro_step_rad_s", s.gyro_step_rad_s, {0, 1e4, "rad/s"},
           "step between two readings of the gyro above which it is a fault");
  f.number("gyro_max_rad_s", s.gyro_max_rad_s, {0, 1e4, "rad/s"}, "largest rate that the gyro can measure");
  f.number("acceleration_max_m_s2", s.acceleration_max_m_s2, {0, 1e5, "m/s2"},
           "largest acceleration that the accelerometer can measure");
  f.integer("foot_stuck_ticks", s.foot_stuck_ticks, {2, 100000},
            "identical readings in a row of a foot that had noise, from which it is a fault");
  f.number("foot_force_max_N", s.foot_force_max_N, {0, 1e6, "N"}, "largest force that one pressure sensor can measure");
}

void drive_fields(Fields& f, DriveWatchSettings& s) {
  f.number("enable_s", s.enable_s, {0, 60, "s"},
           "time that a drive may take until it is enabled, after the first order for torque");
  f.number("hot_C", s.hot_C, {1, 300, "C"}, "temperature reported by a drive from which it is a fault");
  f.number("sample_age_max_s", s.sample_age_max_s, {1e-4, 10, "s"},
           "largest age of a joint's reading when the sensor frame is made");
}

void supply_fields(Fields& f, SupplySettings& s) {
  f.number("lowest_V", s.lowest_V, {0, 1000, "V"}, "lowest supply voltage of the drives; 0: not watched");
  f.number("highest_V", s.highest_V, {0, 1000, "V"}, "highest supply voltage of the drives; 0: not watched");
  f.number("time_s", s.time_s, {0, 10, "s"}, "time outside of these limits after which it is a fault");
}

void fall_fields(Fields& f, FallSettings& s) {
  f.number("roll_max_rad", s.roll_max_rad, {0.01, 7, "rad"}, "roll beyond which the robot counts as falling");
  f.number("pitch_max_rad", s.pitch_max_rad, {0.01, 7, "rad"}, "pitch beyond which the robot counts as falling");
  f.number("rate_max_rad_s", s.rate_max_rad_s, {0.01, 1e3, "rad/s"},
           "rate of rotation beyond which the robot counts as falling");
  f.number("time_s", s.time_s, {0, 10, "s"}, "time for which a limit of fall must be exceeded");
  f.number("soft_share", s.soft_share, {0, 1},
           "share of every torque that remains while the robot falls; 1: all of it");
  f.number("rest_rate_rad_s", s.rest_rate_rad_s, {1e-3, 100, "rad/s"},
           "rate of rotation below which a fallen robot is at rest");
  f.number("rest_s", s.rest_s, {0, 60, "s"}, "time at rest after which the full torque is back");
  f.number("impact_max_m_s2", s.impact_max_m_s2, {0, 1e5, "m/s2"},
           "specific force in a fall above which an impact is recorded");
}

}  // namespace

void RobotReader::limits(Fields& entry) {
  each_joint(entry, config_.safety.joints, [&](JointLimits& limits) {
    entry.number("lower_rad", limits.lower_rad, {-1e3, 1e3, "rad"}, "lower position limit (default: the URDF's)");
    entry.number("upper_rad", limits.upper_rad, {-1e3, 1e3, "rad"}, "upper position limit (default: the URDF's)");
    entry.number("velocity_max_rad_s", limits.velocity_max_rad_s, {0, 1e3, "rad/s"},
                 "speed limit (default: the URDF's)");
    entry.number("effort_max_Nm", limits.effort_max_Nm, {0, 1e4, "Nm"}, "torque limit (default: the URDF's)");
    entry.number("effort_rate_max_Nm_s", limits.effort_rate_max_Nm_s, {0, 1e8, "Nm/s"},
                 "largest rate of change of the demanded torque; 0: effort_max_Nm in a millisecond");
    entry.number("power_max_W", limits.power_max_W, {0, 1e6, "W"},
                 "limit of torque times speed; 0: effort_max_Nm times velocity_max_rad_s");
    entry.number("continuous_Nm", limits.continuous_Nm, {0, 1e4, "Nm"},
                 "constant torque that heats the winding to thermal.hot_C in the end; 0: 0.6 of effort_max_Nm");
    entry.number("thermal_time_constant_s", limits.thermal_time_constant_s, {1, 1e5, "s"},
                 "time constant of the winding's temperature");
  });
  if (!have_model_) return;
  for (const std::size_t i : matching(entry.key(), joint_names_)) {
    if (!within_urdf(entry, config_.safety.joints[i], config_.model.joints[i])) return;
  }
}

// Limits may only be narrower than the URDF's.
bool RobotReader::within_urdf(const Fields& entry, const JointLimits& l, const Joint& joint) {
  const auto refuse_field = [&](const char* field, double urdf) {
    problems_.add(entry.place(field), entry.path(field) + " goes beyond the URDF's " + number_text(urdf) +
                                          " of joint '" + joint.name + "'; limits may only be narrowed");
    return false;
  };
  if (!(l.lower_rad >= joint.lower_rad)) return refuse_field("lower_rad", joint.lower_rad);
  if (!(l.upper_rad <= joint.upper_rad)) return refuse_field("upper_rad", joint.upper_rad);
  if (!(l.velocity_max_rad_s <= joint.velocity_max_rad_s)) {
    return refuse_field("velocity_max_rad_s", joint.velocity_max_rad_s);
  }
  if (!(l.effort_max_Nm <= joint.effort_max_Nm)) return refuse_field("effort_max_Nm", joint.effort_max_Nm);
  if (l.lower_rad <= l.upper_rad) return true;
  problems_.add(entry.place("upper_rad"), entry.path() + ": lower_rad " + number_text(l.lower_rad) +
                                              " is above upper_rad " + number_text(l.upper_rad) + " for joint '" +
                                              joint.name + "'");
  return false;
}

// By the fault's name.
void RobotReader::reaction(Fields& entry) {
  static const std::vector<std::string> levels = level_names(), faults = fault_names();
  Reaction scratch;
  Reaction* reaction = &scratch;
  for (std::size_t code = 1; code < fault_codes; ++code) {
    const bool theirs = std::ranges::find(faults, entry.key()) != faults.end();
    if (theirs && entry.key() == name(static_cast<FaultCode>(code))) reaction = &config_.safety.reactions[code];
  }
  if (entry.reading() && reaction == &scratch) problems_.add_unknown(entry.key_place(), "fault", entry.key(), faults);
  entry.choice("joint", reaction->joint, levels, "rung of the ladder for the joint concerned");
  entry.choice("robot", reaction->robot, levels, "rung of the ladder for the whole robot");
  entry.boolean("latch", reaction->latch, "the rung stays until faults are cleared");
  entry.boolean("escalate", reaction->escalate,
                "while the fault lasts, the rung becomes damp after hold_s, and off after another damp_s");
  entry.number("exit_s", reaction->exit_s, {0, 60, "s"},
               "time that must pass after the end of the fault before its rung is left");
}

void RobotReader::safety(Fields& f) {
  SafetySettings& s = config_.safety;
  f.map("limits", "limits by joint pattern, narrower than the URDF's", [&](Fields& entry) { limits(entry); });
  f.number("position_margin_rad", s.position_margin_rad, {0, 1, "rad"},
           "distance beyond a position limit above which it is a fault");
  f.number("velocity_margin", s.velocity_margin, {1, 10}, "multiple of the speed limit above which it is a fault");
  f.object("soft_stop", "the range before a position limit", [&](Fields& e) { soft_stop_fields(e, s.soft_stop); });
  f.object("thermal", "the model of the motors' windings", [&](Fields& e) { thermal_fields(e, s.thermal); });
  f.number("damping_Nms_per_rad", s.damping_Nms_per_rad, {0, 100, "Nms/rad"}, "damping of a joint that damps");
  f.number("recover_s", s.recover_s, {1e-3, 60, "s"},
           "time in which the torque of a joint that recovers grows to its full value");
  f.number("heartbeat_timeout_s", s.heartbeat_timeout_s, {0.01, 60, "s"},
           "time without a heartbeat of the behavior engine after which it is a fault");
  f.integer("silent_ticks_max", s.silent_ticks_max, {1, 10000},
            "largest number of missing readings in a row that is not yet a fault");
  f.object("sensors", "when a sensor's readings are a fault", [&](Fields& e) { sensor_fields(e, s.sensors); });
  f.object("drives", "when what a drive reports of itself is a fault", [&](Fields& e) { drive_fields(e, s.drives); });
  f.object("supply", "when the drives' supply voltage is a fault", [&](Fields& e) { supply_fields(e, s.supply); });
  f.integer("overruns_in_a_row_max", s.overruns_in_a_row_max, {1, 10000}, "overruns in a row from which it is a fault");
  f.integer("joints_lost_max", s.joints_lost_max, {0, max_joints},
            "largest number of joints that may damp or be off; with more, the whole robot damps");
  f.number("tilt_max_rad", s.tilt_max_rad, {0, 7, "rad"},
           "largest angle between the base's z axis and the vertical while the robot stands");
  f.object("fall", "when the robot counts as falling, and what it does then",
           [&](Fields& e) { fall_fields(e, s.fall); });
  f.number("hold_s", s.hold_s, {0, 60, "s"}, "time for which the robot holds before it damps, when a fault escalates");
  f.number("damp_s", s.damp_s, {0, 60, "s"}, "time for which it damps before it is off");
  f.map("reactions", "what follows from a fault, by the fault's name", [&](Fields& entry) { reaction(entry); });
  if (f.reading() && !(s.thermal.ambient_C < s.thermal.warm_C && s.thermal.warm_C <= s.thermal.hot_C)) {
    problems_.add(f.place("thermal"), f.path("thermal") + ": ambient_C < warm_C <= hot_C must hold");
  }
  s.foot_joints.clear();
  for (const EstimateFoot& foot : config_.estimate.feet) {
    const std::optional<std::size_t> link = have_model_ ? config_.model.find_link(foot.link) : std::nullopt;
    s.foot_joints.push_back(link && *link > 0 ? static_cast<std::uint16_t>(*link - 1) : no_joint);
  }
}

}  // namespace kadans
