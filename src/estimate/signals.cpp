#include "kadans/estimate/signals.h"

#include <string>

namespace kadans {
namespace {

void declare_joints(SignalTable& table, const RobotModel& model, const JointStates& joints) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const std::string topic = "joint." + model.joints[i].name;
    const JointState& joint = joints.joints[i];
    table.add({topic + ".position_rad", "rad", "Position of the joint, as measured."}, &joint.position_rad);
    table.add({topic + ".velocity_rad_s", "rad/s", "Velocity of the joint, filtered."}, &joint.velocity_rad_s);
    table.add({topic + ".effort_Nm", "Nm", "Torque at the joint, from its spring or its motor."}, &joint.effort_Nm);
  }
}

void declare_base(SignalTable& table, const BaseStatus& base) {
  table.add({"base.roll_rad", "rad", "Roll of the base."}, &base.roll_rad);
  table.add({"base.pitch_rad", "rad", "Pitch of the base; positive leans forward."}, &base.pitch_rad);
  table.add({"base.yaw_rad", "rad", "Yaw of the base since the start; it drifts."}, &base.yaw_rad);
  table.add({"base.tilt_rad", "rad", "Angle between the base's z axis and up."}, &base.tilt_rad);
  table.add({"base.height_m", "m", "Height of the base over the lowest sole that bears."}, &base.height_m);
  constexpr const char* axis_names[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis = axis_names[i];
    table.add({"base.rate_" + axis + "_rad_s", "rad/s", "Angular velocity about the base's " + axis + " axis."},
              &base.angular_velocity_rad_s[i]);
  }
}

void declare_foot(SignalTable& table, const std::string& link, const FootStatus& foot) {
  const std::string topic = "foot." + link;
  table.add({topic + ".force_N", "N", "Sum of the foot's pressure sensors."}, &foot.force_N);
  table.add({topic + ".contact", "", "1 while the foot bears."}, &foot.contact);
  table.add({topic + ".cop_x_m", "m", "Centre of pressure, forward in the foot's frame."}, &foot.cop_x_m);
  table.add({topic + ".cop_y_m", "m", "Centre of pressure, to the left in the foot's frame."}, &foot.cop_y_m);
}

}  // namespace

void declare_signals(SignalTable& table, const RobotModel& model, const EstimateSettings& settings,
                     const JointStates& joints, const RobotStatus& status) {
  declare_joints(table, model, joints);
  declare_base(table, status.base);
  for (std::size_t i = 0; i < settings.feet.size(); ++i) declare_foot(table, settings.feet[i].link, status.feet[i]);
  const SupportStatus& support = status.support;
  table.add({"support.force_N", "N", "Sum of the forces under the feet that bear."}, &support.force_N);
  table.add({"support.cop_x_m", "m", "Centre of pressure of all feet, ahead of the base."}, &support.cop_x_m);
  table.add({"support.cop_y_m", "m", "Centre of pressure of all feet, to the left of the base."}, &support.cop_y_m);
}

}  // namespace kadans
