#include "divergence.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "convert.h"
#include "kadans/model/dynamics.h"
#include "signal/number_text.h"

namespace kadans::bullet {
namespace {

constexpr double speed_max_rad_s = 1000, slide_max_m_s = 100, base_max_m_s = 100, over_own = 10;
constexpr double memory_steps = 20;        // over which changes of a torque's sign are smoothed
constexpr double often = 0.3;              // a torque that changes its sign in so many of the steps
constexpr double fastest_per_step = 1000;  // rad/s: what a joint's torque does to it in a step, if its inertia is small

}  // namespace

Divergence::Divergence(const RobotModel& model, const PlantSettings& settings) {
  Dynamics dynamics(model);
  dynamics.update(settings.position_rad, std::vector<double>(model.joints.size()), {});
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    const auto at = static_cast<Eigen::Index>(i);
    const double own = joint.velocity_max_rad_s < 1e5 ? over_own * joint.velocity_max_rad_s : 0;
    joints_.push_back({.name = joint.name,
                       .slides = joint.type == JointType::prismatic,
                       .speed_max = std::max(joint.type == JointType::prismatic ? slide_max_m_s : speed_max_rad_s, own),
                       .inertia = dynamics.mass_matrix()(at, at) + settings.drives[i].rotor_inertia_kg_m2});
  }
}

void Divergence::look(const btMultiBody& body, const Drives& drives, double dt_s, std::int64_t time_ns) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Watched& joint = joints_[i];
    const double torque_Nm = drives.joint_torque_Nm(i);
    const bool pushes = torque_Nm == 0 ? joint.pushes : torque_Nm > 0;
    joint.turned_over += ((pushes != joint.pushes ? 1 : 0) - joint.turned_over) / memory_steps;
    joint.pushes = pushes;
    const int link = static_cast<int>(i);
    const double velocity = body.getJointVel(link);
    if (std::abs(velocity) <= joint.speed_max && std::isfinite(body.getJointPos(link))) continue;
    tell(drives,
         "joint '" + joint.name + "' moves at " + printed("%.3g", std::abs(velocity)) +
             (joint.slides ? " m/s" : " rad/s"),
         dt_s, time_ns, link);
  }
  const btVector3 velocity = body.getBaseVel(), turning = body.getBaseOmega();
  const bool calm =
      finite(body.getBasePos()) && velocity.length() <= base_max_m_s && turning.length() <= speed_max_rad_s;
  if (calm) return;
  const auto shaken = std::ranges::max_element(joints_, {}, &Watched::turned_over);
  tell(drives,
       "the base moves at " + printed("%.3g", velocity.length()) + " m/s and turns at " +
           printed("%.3g", turning.length()) + " rad/s",
       dt_s, time_ns, shaken == joints_.end() ? -1 : static_cast<int>(shaken - joints_.begin()));
}

void Divergence::tell(const Drives& drives, const std::string& what, double dt_s, std::int64_t time_ns,
                      int joint) const {
  std::string text = "the model diverges at " + printed("%.3f", 1e-9 * static_cast<double>(time_ns)) + " s: " + what;
  if (joint >= 0) {
    const Watched& most = joints_[static_cast<std::size_t>(joint)];
    const double torque = std::abs(drives.joint_torque_Nm(static_cast<std::size_t>(joint)));
    const std::string unit = most.slides ? " kg" : " kg m2";
    if (most.turned_over > often) {
      text += "; the torque of '" + most.name + "' changed its sign in " + printed("%.0f", 100 * most.turned_over) +
              " % of the last steps: its gain is too high for its delay and for its inertia of " +
              printed("%.2g", most.inertia) + unit;
    } else if (torque * dt_s > fastest_per_step * most.inertia || !(most.inertia > 1e-7)) {
      text += "; the inertia of '" + most.name + "' with what it carries is " + printed("%.2g", most.inertia) + unit +
              ", too small for its torque and a step of " + printed("%.3g", 1000 * dt_s) + " ms: is it in other units?";
    } else {
      text += "; no drive shakes it: it was pushed by more than it can bear, or the world holds it where it cannot be";
    }
  }
  throw std::runtime_error(text);
}

}  // namespace kadans::bullet
