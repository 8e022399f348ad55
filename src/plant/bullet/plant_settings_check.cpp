#include "plant_settings_check.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "signal/number_text.h"

namespace kadans::bullet {
namespace {

[[noreturn]] void reject(const std::string& name, double value, const std::string& must) {
  throw std::invalid_argument(name + " = " + printed("%g", value) + " must be " + must);
}

void require_at_least_zero(const std::string& name, double value) {
  if (!(value >= 0 && std::isfinite(value))) reject(name, value, "at least 0");
}

void require_count(const std::string& name, std::size_t count, std::size_t joints) {
  if (count != joints) reject(name + " entries", static_cast<double>(count), "one a joint, " + std::to_string(joints));
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
  require_at_least_zero(name + "enable_s", drive.enable_s);
  require_at_least_zero(name + "brake_Nm", drive.brake_Nm);
  if (drive.spring_Nm_per_rad > 0 && !(drive.rotor_inertia_kg_m2 > 0)) {
    reject(name + "rotor_inertia_kg_m2", drive.rotor_inertia_kg_m2, "above 0 with a series spring");
  }
}

void check_coupling(const std::vector<DriveSettings>& drives, const Transmission& transmission) {
  for (const std::size_t i : transmission.joints()) {
    if (i >= drives.size()) reject("transmission of joint number", static_cast<double>(i), "one of the robot's");
  }
}

void require_link(const RobotModel& model, const std::string& what, const std::string& link) {
  if (!model.find_link(link)) throw std::invalid_argument(what + ": the robot has no link '" + link + "'");
}

constexpr double slope_max_rad = 1.2;

void require_above_zero(const std::string& name, double value) {
  if (!(value > 0 && std::isfinite(value))) reject(name, value, "above 0");
}

void require_finite(const std::string& name, std::span<const double> values) {
  for (const double value : values) {
    if (!std::isfinite(value)) reject(name, value, "finite");
  }
}

void require_slope(const std::string& name, double value) {
  if (!(std::abs(value) <= slope_max_rad)) reject(name, value, "at most 1.2 rad either way");
}

struct ShapeCheck {
  std::string of;  // "object 'table': "

  void operator()(const WorldBox& box) const {
    for (const double size : box.size_m) require_above_zero(of + "size_m", size);
    require_at_least_zero(of + "mass_kg", box.mass_kg);
    require_finite(of + "velocity_m_s", box.velocity_m_s);
  }
  void operator()(const WorldRamp& ramp) const {
    require_above_zero(of + "length_m", ramp.length_m);
    require_above_zero(of + "width_m", ramp.width_m);
    require_slope(of + "incline_rad", ramp.incline_rad);
  }
  void operator()(const WorldStairs& stairs) const {
    if (!(stairs.count >= 1 && stairs.count <= max_stairs))
      reject(of + "count", stairs.count, "1.." + std::to_string(max_stairs));
    require_above_zero(of + "rise_m", stairs.rise_m);
    require_above_zero(of + "run_m", stairs.run_m);
    require_above_zero(of + "width_m", stairs.width_m);
  }
  void operator()(const WorldWall& wall) const {
    require_above_zero(of + "width_m", wall.width_m);
    require_above_zero(of + "height_m", wall.height_m);
    require_above_zero(of + "thickness_m", wall.thickness_m);
  }
  void operator()(const WorldBall& ball) const {
    require_above_zero(of + "radius_m", ball.radius_m);
    require_above_zero(of + "mass_kg", ball.mass_kg);
    require_at_least_zero(of + "rolling_friction_m", ball.rolling_friction_m);
    if (!(ball.restitution >= 0 && ball.restitution <= 1)) reject(of + "restitution", ball.restitution, "0..1");
    require_finite(of + "velocity_m_s", ball.velocity_m_s);
  }
  void operator()(const WorldPendulum& pendulum) const {
    require_above_zero(of + "length_m", pendulum.length_m);
    require_above_zero(of + "radius_m", pendulum.radius_m);
    require_above_zero(of + "mass_kg", pendulum.mass_kg);
    require_at_least_zero(of + "release_s", pendulum.release_s);
    if (!(pendulum.distance_m >= 0 && pendulum.distance_m < pendulum.length_m))
      reject(of + "distance_m", pendulum.distance_m, "at least 0 and less than length_m");
  }
};

void check_motion(const std::string& of, const MotionSettings& motion) {
  double last_s = -1;
  for (const MotionSettings::Knot& knot : motion.knots) {
    if (!(knot.time_s > last_s && knot.time_s >= 0 && std::isfinite(knot.time_s)))
      reject(of + "motion: time_s", knot.time_s, "at least 0 and later than the one before");
    require_finite(of + "motion: velocity_m_s", knot.velocity_m_s);
    last_s = knot.time_s;
  }
}

void check_object(const WorldObject& object) {
  const std::string of = "object '" + object.name + "': ";
  require_finite(of + "position_m", object.pose.position_m);
  double norm2 = 0;
  for (const double part : object.pose.orientation) norm2 += part * part;
  if (!(std::abs(norm2 - 1) < 1e-6)) throw std::invalid_argument(of + "orientation must be a unit quaternion");
  require_at_least_zero(of + "friction", object.friction);
  std::visit(ShapeCheck{of}, object.shape);
  check_motion(of, object.motion);
  if (object.free() && object.motion.moves()) {
    throw std::invalid_argument(of + "what moves freely cannot be driven: it has a mass and a motion");
  }
}

void check_payload(const RobotModel& model, const PayloadSettings& payload) {
  const std::string of = "payload '" + payload.name + "': ";
  if (!model.find_link(payload.link)) throw std::invalid_argument(of + "the robot has no link '" + payload.link + "'");
  require_finite(of + "point_m", payload.point_m);
  require_above_zero(of + "mass_kg", payload.mass_kg);
  if (!(payload.from_s >= 0 && std::isfinite(payload.from_s))) reject(of + "from_s", payload.from_s, "at least 0");
  if (!(payload.until_s > payload.from_s)) reject(of + "until_s", payload.until_s, "later than from_s");
}

template <typename Named>
void require_names(const std::string& what, const std::vector<Named>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name.empty()) throw std::invalid_argument(what + " number " + std::to_string(i) + " has no name");
    for (std::size_t j = 0; j < i; ++j) {
      if (all[i].name == all[j].name) throw std::invalid_argument("two " + what + "s are named '" + all[i].name + "'");
    }
  }
}

void check_world(const RobotModel& model, const WorldSettings& world) {
  if (world.objects.size() > max_world_objects) {
    reject("objects", static_cast<double>(world.objects.size()), "at most " + std::to_string(max_world_objects));
  }
  require_names("object", world.objects);
  require_names("payload", world.payloads);
  require_slope("slope_rad", world.slope_rad);
  require_finite("slope_heading_rad", {&world.slope_heading_rad, 1});
  check_motion("ground: ", world.ground_motion);
  for (const WorldObject& object : world.objects) check_object(object);
  for (const PayloadSettings& payload : world.payloads) check_payload(model, payload);
}

}  // namespace

void check_settings(const RobotModel& model, const PlantSettings& settings) {
  const std::size_t joints = model.joints.size();
  if (joints > max_joints) reject("joints", static_cast<double>(joints), "at most " + std::to_string(max_joints));
  require_count("drives", settings.drives.size(), joints);
  require_count("encoders", settings.encoders.size(), joints);
  require_count("position_rad", settings.position_rad.size(), joints);
  if (settings.feet.size() > max_feet)
    reject("feet", static_cast<double>(settings.feet.size()), "at most " + std::to_string(max_feet));
  if (settings.solver_iterations < 1) reject("solver_iterations", settings.solver_iterations, "at least 1");
  require_at_least_zero("ground_friction", settings.ground_friction);
  require_at_least_zero("ground_stiffness_N_per_m", settings.ground_stiffness_N_per_m);
  require_at_least_zero("ground_damping_Ns_per_m", settings.ground_damping_Ns_per_m);
  if (!(settings.ground_restitution >= 0 && settings.ground_restitution <= 1))
    reject("ground_restitution", settings.ground_restitution, "0..1");
  for (const double g : settings.gravity_m_s2) {
    if (!std::isfinite(g)) throw std::invalid_argument("gravity_m_s2 must be finite");
  }
  for (std::size_t i = 0; i < joints; ++i) {
    const std::string& name = model.joints[i].name;
    check_drive(name, settings.drives[i]);
    require_at_least_zero("encoder of joint '" + name + "': resolution_rad", settings.encoders[i].resolution_rad);
    require_at_least_zero("encoder of joint '" + name + "': noise_rad", settings.encoders[i].noise_rad);
    if (!std::isfinite(settings.position_rad[i]))
      reject("position_rad of '" + name + "'", settings.position_rad[i], "finite");
  }
  for (const Transmission& transmission : model.transmissions) check_coupling(settings.drives, transmission);
  for (const FootSettings& foot : settings.feet) require_link(model, "foot", foot.link);
  for (const SurfaceSettings& surface : settings.surfaces) {
    require_link(model, "surface", surface.link);
    require_at_least_zero("friction of '" + surface.link + "'", surface.friction);
  }
  check_world(model, settings.world);
}

}  // namespace kadans::bullet
