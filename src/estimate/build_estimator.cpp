// The constructor of the estimator: checks every setting, and says which joint or foot is wrong.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "estimator.h"

namespace kadans {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("estimate: " + what); }

// The vector's value for a joint; `otherwise` when the vector is empty.
template <typename T>
T of_joint(const std::vector<T>& values, std::size_t joint, T otherwise) {
  return values.empty() ? otherwise : values[joint];
}

template <typename T>
void check_size(const std::vector<T>& values, const char* key, const RobotModel& model) {
  if (!values.empty() && values.size() != model.joints.size())
    refuse(std::string(key) + " has " + std::to_string(values.size()) + " values, the robot " +
           std::to_string(model.joints.size()) + " joints");
}

OrientationFilter::Config orientation_config(const EstimateSettings& settings) {
  return {.accelerometer_gain_per_s = settings.accelerometer_gain_per_s,
          .gyro_bias_gain_per_s2 = settings.gyro_bias_gain_per_s2,
          .gravity_tolerance = settings.gravity_tolerance,
          .gyro_bias_max_rad_s = settings.gyro_bias_max_rad_s};
}

// Built with the name of the setting's owner before what the part itself says.
template <typename Part>
Part make(const typename Part::Config& config, const std::string& owner) {
  try {
    return Part(config);
  } catch (const std::invalid_argument& error) {
    refuse(owner + ": " + error.what());
  }
}

}  // namespace

Estimator::Estimator(const RobotModel& model, const EstimateSettings& settings, double dt_s)
    : settings_(settings),
      orientation_(make<OrientationFilter>(orientation_config(settings), "base orientation")),
      dt_s_(dt_s) {
  if (!(dt_s > 0 && std::isfinite(dt_s))) refuse("dt_s = " + std::to_string(dt_s) + " must be > 0");
  add_joints(model, settings, dt_s);
  add_feet(model, settings);
  if (settings.channels.size() > max_channels)
    refuse(std::to_string(settings.channels.size()) + " sensors, at most " + std::to_string(max_channels));
  health_.channel_count = static_cast<std::uint32_t>(settings.channels.size());
  channels_.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < settings.channels.size(); ++i)
    health_.channels[i].period_ticks =
        static_cast<std::uint32_t>(std::max(1.0, std::ceil(settings.channels[i].period_s / dt_s - 1e-9)));
}

void Estimator::add_joints(const RobotModel& model, const EstimateSettings& settings, double dt_s) {
  if (model.joints.size() > max_joints)
    refuse("the robot has " + std::to_string(model.joints.size()) + " joints, at most " + std::to_string(max_joints));
  check_size(settings.joint_velocity_cutoff_Hz, "joint_velocity_cutoff_Hz", model);
  check_size(settings.spring_Nm_per_rad, "spring_Nm_per_rad", model);
  check_size(settings.sample_divisor, "sample_divisor", model);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const std::string owner = "joint '" + model.joints[i].name + "'";
    const double own_cutoff_Hz = of_joint(settings.joint_velocity_cutoff_Hz, i, 0.0);
    const double spring_Nm_per_rad = of_joint(settings.spring_Nm_per_rad, i, 0.0);
    const std::uint32_t divisor = of_joint(settings.sample_divisor, i, std::uint32_t{1});
    if (!(spring_Nm_per_rad >= 0 && std::isfinite(spring_Nm_per_rad)))
      refuse(owner + ": spring_Nm_per_rad = " + std::to_string(spring_Nm_per_rad) + " must be >= 0");
    if (divisor == 0) refuse(owner + ": sample_divisor = 0 must be >= 1");
    const VelocityFilter::Config velocity{.cutoff_Hz = own_cutoff_Hz == 0 ? settings.velocity_cutoff_Hz : own_cutoff_Hz,
                                          .dt_s = divisor * dt_s};
    joints_.push_back({.velocity = make<VelocityFilter>(velocity, owner + ": velocity"),
                       .spring_Nm_per_rad = spring_Nm_per_rad,
                       .last_sequence = 0,
                       .elapsed_s = 0,
                       .state = {}});
    health_.joints[i].period_ticks = divisor;
  }
  health_.joint_count = static_cast<std::uint32_t>(model.joints.size());
}

void Estimator::add_feet(const RobotModel& model, const EstimateSettings& settings) {
  if (settings.feet.size() > max_feet)
    refuse(std::to_string(settings.feet.size()) + " feet, at most " + std::to_string(max_feet));
  for (const EstimateFoot& foot : settings.feet) {
    const auto link = model.find_link(foot.link);
    if (!link) refuse("foot: the robot has no link '" + foot.link + "'");
    const ContactDetector::Config contact{
        .on_N = settings.contact_on_N, .off_N = settings.contact_off_N, .sensors_m = foot.sensors_m};
    feet_.push_back({.detector = make<ContactDetector>(contact, "foot '" + foot.link + "'"),
                     .leg = LegChain(model, *link),
                     .last_sequence = 0,
                     .force_N = {}});
  }
  health_.foot_count = static_cast<std::uint32_t>(feet_.size());
}

}  // namespace kadans
