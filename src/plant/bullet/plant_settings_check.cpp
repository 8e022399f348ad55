#include "plant_settings_check.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "world_settings_check.h"

namespace kadans::bullet {
namespace {

[[noreturn]] void refuse(const std::string& name, double value, const std::string& must) {
  std::ostringstream text;
  text << name << " = " << value << " must be " << must;
  throw std::invalid_argument(text.str());
}

void require_at_least_zero(const std::string& name, double value) {
  if (!(value >= 0 && std::isfinite(value))) refuse(name, value, "at least 0");
}

void require_count(const std::string& name, std::size_t count, std::size_t joints) {
  if (count != joints) refuse(name + " entries", static_cast<double>(count), "one a joint, " + std::to_string(joints));
}

void check_drive(const std::string& joint, const DriveSettings& drive) {
  const std::string name = "drive of joint '" + joint + "': ";
  require_at_least_zero(name + "torque_max_Nm", drive.torque_max_Nm);
  require_at_least_zero(name + "velocity_max_rad_s", drive.velocity_max_rad_s);
  require_at_least_zero(name + "knee_velocity_rad_s", drive.knee_velocity_rad_s);
  require_at_least_zero(name + "rotor_inertia_kg_m2", drive.rotor_inertia_kg_m2);
  require_at_least_zero(name + "viscous_Nms_per_rad", drive.viscous_Nms_per_rad);
  require_at_least_zero(name + "coulomb_Nm", drive.coulomb_Nm);
  require_at_least_zero(name + "spring_Nm_per_rad", drive.spring_Nm_per_rad);
  require_at_least_zero(name + "spring_damping_Nms_per_rad", drive.spring_damping_Nms_per_rad);
  require_at_least_zero(name + "position_gain_Nm_per_rad", drive.position_gain_Nm_per_rad);
  require_at_least_zero(name + "velocity_gain_Nms_per_rad", drive.velocity_gain_Nms_per_rad);
  require_at_least_zero(name + "parallel_spring_Nm_per_rad", drive.parallel_spring_Nm_per_rad);
  require_at_least_zero(name + "parallel_damping_Nms_per_rad", drive.parallel_damping_Nms_per_rad);
  if (drive.spring_Nm_per_rad > 0 && !(drive.rotor_inertia_kg_m2 > 0)) {
    refuse(name + "rotor_inertia_kg_m2", drive.rotor_inertia_kg_m2, "above 0 with a series spring");
  }
}

void require_link(const RobotModel& model, const std::string& what, const std::string& link) {
  if (!model.find_link(link)) throw std::invalid_argument(what + ": the robot has no link '" + link + "'");
}

}  // namespace

void check_settings(const RobotModel& model, const PlantSettings& settings) {
  const std::size_t joints = model.joints.size();
  if (joints > max_joints) refuse("joints", static_cast<double>(joints), "at most " + std::to_string(max_joints));
  require_count("drives", settings.drives.size(), joints);
  require_count("encoders", settings.encoders.size(), joints);
  require_count("position_rad", settings.position_rad.size(), joints);
  if (settings.feet.size() > max_feet) refuse("feet", static_cast<double>(settings.feet.size()), "at most 4");
  if (settings.solver_iterations < 1) refuse("solver_iterations", settings.solver_iterations, "at least 1");
  require_at_least_zero("ground_friction", settings.ground_friction);
  for (const double g : settings.gravity_m_s2) {
    if (!std::isfinite(g)) throw std::invalid_argument("gravity_m_s2 must be finite");
  }
  for (std::size_t i = 0; i < joints; ++i) {
    const std::string& name = model.joints[i].name;
    check_drive(name, settings.drives[i]);
    require_at_least_zero("encoder of joint '" + name + "': resolution_rad", settings.encoders[i].resolution_rad);
    require_at_least_zero("encoder of joint '" + name + "': noise_rad", settings.encoders[i].noise_rad);
    if (!std::isfinite(settings.position_rad[i]))
      refuse("position_rad of '" + name + "'", settings.position_rad[i], "finite");
    if (model.joints[i].mimic) throw std::invalid_argument("joint '" + name + "': mimic joints cannot be simulated");
  }
  for (const FootSettings& foot : settings.feet) require_link(model, "foot", foot.link);
  for (const SurfaceSettings& surface : settings.surfaces) {
    require_link(model, "surface", surface.link);
    require_at_least_zero("friction of '" + surface.link + "'", surface.friction);
  }
  check_world(model, settings.world);
}

}  // namespace kadans::bullet
