// The parts of a robot's configuration that stand on plant, start and estimator.
#include <algorithm>
#include <array>

#include "config/json/name_pattern.h"
#include "kadans/model/kinematics.h"
#include "robot_reader.h"
#include "signal/nearest_name.h"

namespace kadans {
namespace {

void drive_fields(Fields& f, DriveSettings& d) {
  f.number("torque_max_Nm", d.torque_max_Nm, {0, 1e4, "Nm"},
           "torque limit of the motor at the joint (default: the URDF's)");
  f.number("velocity_max_rad_s", d.velocity_max_rad_s, {0, 1e3, "rad/s"},
           "no-load speed at the joint (default: the URDF's)");
  f.number("knee_velocity_rad_s", d.knee_velocity_rad_s, {0, 1e3, "rad/s"},
           "speed up to which the motor gives its full torque; above it the torque falls to 0 at velocity_max_rad_s");
  f.number("rotor_inertia_kg_m2", d.rotor_inertia_kg_m2, {0, 10, "kg m2"}, "rotor inertia reflected to the joint");
  f.number("viscous_Nms_per_rad", d.viscous_Nms_per_rad, {0, 100, "Nms/rad"}, "viscous friction on the motor's side");
  f.number("coulomb_Nm", d.coulomb_Nm, {0, 100, "Nm"}, "dry friction on the motor's side");
  f.number("spring_Nm_per_rad", d.spring_Nm_per_rad, {0, 1e5, "Nm/rad"},
           "spring between motor and joint (series elastic actuator); 0: rigid");
  f.number("spring_damping_Nms_per_rad", d.spring_damping_Nms_per_rad, {0, 100, "Nms/rad"}, "damping of that spring");
  f.number("position_gain_Nm_per_rad", d.position_gain_Nm_per_rad, {0, 1e5, "Nm/rad"},
           "gain of the drive's position mode");
  f.number("velocity_gain_Nms_per_rad", d.velocity_gain_Nms_per_rad, {0, 1e4, "Nms/rad"},
           "velocity gain of the drive's position and velocity modes");
  f.number("parallel_spring_Nm_per_rad", d.parallel_spring_Nm_per_rad, {0, 1e5, "Nm/rad"},
           "passive spring parallel to the joint");
  f.number("parallel_rest_rad", d.parallel_rest_rad, {-10, 10, "rad"},
           "position at which the parallel spring gives no torque");
  f.number("parallel_damping_Nms_per_rad", d.parallel_damping_Nms_per_rad, {0, 1e3, "Nms/rad"},
           "passive damper parallel to the joint");
  f.boolean("enabled", d.enabled, "a modelled drive is enabled from the start; otherwise an order must enable it");
  f.number("enable_s", d.enable_s, {0, 60, "s"}, "time that a modelled drive takes from the order until it is enabled");
  f.number("brake_Nm", d.brake_Nm, {0, 1e4, "Nm"},
           "dry friction of the brake that holds the joint while its drive is not enabled; 0: none");
}

constexpr NumberRange anywhere_m{-10, 10, "m"};

// A plant type's list of fields, as one of the file's.
class TypeFields final : public PlantFields {
 public:
  explicit TypeFields(Fields& fields) : fields_(fields) {}
  void number(std::string_view name, double& value, Range range, std::string_view doc) override {
    fields_.number(name, value, {range.min, range.max, range.unit}, doc);
  }
  void integer(std::string_view name, std::uint32_t& value, Range range, std::string_view doc) override {
    fields_.integer(name, value,
                    {static_cast<std::uint64_t>(range.min), static_cast<std::uint64_t>(range.max), range.unit}, doc);
  }
  void boolean(std::string_view name, bool& value, std::string_view doc) override { fields_.boolean(name, value, doc); }
  void string(std::string_view name, std::string& value, std::string_view doc) override {
    fields_.string(name, value, doc);
  }

 private:
  Fields& fields_;
};

}  // namespace

void RobotReader::drive(Fields& entry) {
  each_joint(entry, config_.plant.drives, [&](DriveSettings& d) { drive_fields(entry, d); });
  if (!have_model_) return;
  for (const std::size_t i : matching(entry.key(), joint_names_)) {
    const DriveSettings& d = config_.plant.drives[i];
    if (config_.model.joints[i].passive() && d.torque_max_Nm > 0 && entry.has("torque_max_Nm")) {
      return problems_.add(entry.place("torque_max_Nm"), entry.path("torque_max_Nm") + " gives a motor to joint '" +
                                                             joint_names_[i] +
                                                             "', which is passive (effort 0 in the URDF)");
    }
    if (!(d.knee_velocity_rad_s <= d.velocity_max_rad_s)) {
      return problems_.add(entry.place("knee_velocity_rad_s"), entry.path("knee_velocity_rad_s") + " is " +
                                                                   number_text(d.knee_velocity_rad_s) + ", joint '" +
                                                                   joint_names_[i] + "' has velocity_max_rad_s " +
                                                                   number_text(d.velocity_max_rad_s));
    }
  }
}

void RobotReader::surface(Fields& entry) {
  SurfaceSettings surface;
  entry.number("friction", surface.friction, {0, 10}, "coefficient of friction", Need::required);
  if (!have_model_) return;
  const std::vector<std::string> links = config_.model.link_names();
  const std::vector<std::size_t> chosen = matching(entry.key(), links);
  if (chosen.empty()) problems_.add_unknown(entry.key_place(), "link", entry.key(), links);
  std::vector<SurfaceSettings>& all = config_.plant.surfaces;
  for (const std::size_t i : chosen) {
    std::erase_if(all, [&](const SurfaceSettings& s) { return s.link == links[i]; });
    all.push_back({links[i], surface.friction});
  }
}

void RobotReader::imu(Fields& f) {
  ImuSettings& imu = config_.plant.imu;
  Vec3 angles_rad{};
  f.numbers("position_m", imu.pose.position_m, anywhere_m, "position of the IMU in the base frame");
  if (f.numbers("roll_pitch_yaw_rad", angles_rad, {-7, 7, "rad"}, "orientation of the IMU in the base frame")) {
    imu.pose.orientation = from_roll_pitch_yaw(angles_rad[0], angles_rad[1], angles_rad[2]);
  }
  f.number("gyro_noise_rad_s", imu.gyro_noise_rad_s, {0, 10, "rad/s"}, "standard deviation of the noise");
  f.number("gyro_bias_rad_s", imu.gyro_bias_rad_s, {0, 10, "rad/s"}, "standard deviation of the bias drawn once a run");
  f.number("accelerometer_noise_m_s2", imu.accelerometer_noise_m_s2, {0, 100, "m/s2"},
           "standard deviation of the noise");
  f.number("accelerometer_bias_m_s2", imu.accelerometer_bias_m_s2, {0, 100, "m/s2"},
           "standard deviation of the bias drawn once a run");
}

void RobotReader::foot(Fields& f) {
  FootSettings foot;
  f.string("link", foot.link, "the link that carries the sole", Need::required);
  f.numbers("heel_inner_m", foot.sensors_m[0], anywhere_m, "pressure sensor, in the link's frame", Need::required);
  f.numbers("heel_outer_m", foot.sensors_m[1], anywhere_m, "pressure sensor, in the link's frame", Need::required);
  f.numbers("toe_inner_m", foot.sensors_m[2], anywhere_m, "pressure sensor, in the link's frame", Need::required);
  f.numbers("toe_outer_m", foot.sensors_m[3], anywhere_m, "pressure sensor, in the link's frame", Need::required);
  f.number("noise_N", foot.noise_N, {0, 1e3, "N"}, "standard deviation of the noise of each sensor");
  if (!have_model_) return;
  if (!foot.link.empty() && !config_.model.find_link(foot.link)) {
    problems_.add_unknown(f.place("link"), "link", foot.link, config_.model.link_names());
  }
  config_.estimate.feet.push_back({foot.link, foot.sensors_m});
  config_.plant.feet.push_back(std::move(foot));
}

void RobotReader::plant(Fields& f) {
  PlantSettings& plant = config_.plant;
  f.map("drives", "drives by joint pattern", [&](Fields& entry) { drive(entry); });
  f.map("encoders", "joint encoders by joint pattern", [&](Fields& entry) {
    each_joint(entry, plant.encoders, [&](EncoderSettings& encoder) {
      entry.number("resolution_rad", encoder.resolution_rad, {0, 1, "rad"}, "step of the reading; 0: continuous");
      entry.number("noise_rad", encoder.noise_rad, {0, 1, "rad"}, "standard deviation of the noise");
    });
  });
  f.object("imu", "inertial measurement unit on the base link", [&](Fields& e) { imu(e); });
  f.list("feet", {0, max_feet}, "soles with four pressure sensors", [&](Fields& e) { foot(e); });
  f.map("surfaces", "friction of the links' surfaces by link pattern", [&](Fields& entry) { surface(entry); });
  f.number("ground_friction", plant.ground_friction, {0, 10},
           "coefficient of friction of the ground; a contact's coefficient is the product of those of both surfaces");
  f.numbers("gravity_m_s2", plant.gravity_m_s2, {-100, 100, "m/s2"}, "gravity in world axes");
  static const std::vector<std::string> solvers{"tree", "stock"};
  f.choice("solver", plant.solver, solvers, "solver of contacts and joint laws: the one of this project, or Bullet's");
  f.integer("solver_iterations", plant.solver_iterations, {1, 1000}, "iterations of the contact solver in a step");
  f.boolean("fixed_base", plant.fixed_base, "the base link is bolted to the world");
  f.boolean("self_collision", plant.self_collision, "the robot's links collide with each other");
  for (const auto& type : config_.plant_types) {
    if (!type->has_fields()) continue;
    f.object(type->name(), type->doc(), [&](Fields& e) {
      TypeFields fields(e);
      type->fields(fields);
    });
  }
  if (object_types_.empty() && !config_.plugins.empty()) f.leave_others();  // a plug-in's type would ask for them
  for (std::size_t i = 0; i < plant.drives.size(); ++i) {
    config_.estimate.spring_Nm_per_rad[i] = config_.safety.joints[i].spring_Nm_per_rad =
        plant.drives[i].spring_Nm_per_rad;
  }
}

// By its name, which is a field in Lua and a part of a signal's name.
void RobotReader::sensor(Fields& entry) {
  constexpr double most = 1e12;
  SensorChannel channel{.name = std::string(entry.key()), .unit = {}, .doc = {}, .min = -most, .max = most};
  entry.string("unit", channel.unit, "unit of its readings, such as m, V or C; none for a switch or a count");
  entry.string("doc", channel.doc, "a sentence that says what it measures");
  entry.number("min", channel.min, {-most, most, ""}, "a reading below it is a fault");
  entry.number("max", channel.max, {-most, most, ""}, "a reading above it is a fault");
  entry.number("period_s", channel.period_s, {0, 60, "s"}, "time between two readings; 0: one reading in each tick");
  entry.number("value", channel.value, {-most, most, ""},
               "reading in a model; scenarios change it as sensor.NAME.value");
  entry.number("noise", channel.noise, {0, most, ""}, "standard deviation of the noise in a model");
  if (!entry.reading()) return;
  constexpr std::size_t longest = 32;
  const bool begins_well = !channel.name.empty() && (channel.name[0] < '0' || channel.name[0] > '9');
  if (!begins_well || channel.name.size() > longest || !is_word(channel.name))
    problems_.add(entry.key_place(), "'" + channel.name +
                                         "' is no name of a sensor: letters, digits and '_', at most " +
                                         std::to_string(longest) + ", no digit first");
  if (!(channel.min <= channel.max))
    problems_.add(entry.place("max"), entry.path("max") + " is " + number_text(channel.max) +
                                          ", must be at least min, " + number_text(channel.min));
  if (config_.plant.channels.size() == max_channels)
    return problems_.add(entry.key_place(), "a robot has at most " + std::to_string(max_channels) + " sensors");
  if (channel.doc.empty()) channel.doc = "Sensor " + channel.name + ".";
  config_.plant.channels.push_back(std::move(channel));
}

void RobotReader::start(Fields& f) {
  PlantSettings& plant = config_.plant;
  Vec3 angles_rad{};
  const bool posed = f.string("pose", config_.start_pose, "pose in which the joints start (default: all at 0)");
  f.numbers("position_m", plant.base.position_m, {-1000, 1000, "m"}, "position of the base frame in the world");
  if (f.numbers("roll_pitch_yaw_rad", angles_rad, {-7, 7, "rad"}, "orientation of the base frame in the world")) {
    plant.base.orientation = from_roll_pitch_yaw(angles_rad[0], angles_rad[1], angles_rad[2]);
  }
  f.boolean("stand_on_ground", plant.stand_on_ground,
            "the height is chosen so that the robot's lowest point touches the ground");
  if (!posed || !have_model_) return;
  const auto named = [&](const PoseInfo& pose) { return pose.name == config_.start_pose; };
  const auto found = std::find_if(config_.poses.begin(), config_.poses.end(), named);
  if (found == config_.poses.end()) {
    problems_.add_unknown(f.place("pose"), "pose", config_.start_pose, names_of(config_.poses));
    return;
  }
  for (const auto& [joint, position_rad] : found->position_rad) plant.position_rad[joint] = position_rad;
}

void RobotReader::estimate(Fields& f) {
  EstimateSettings& estimate = config_.estimate;
  f.number("velocity_cutoff_Hz", estimate.velocity_cutoff_Hz, {0.1, 1e4, "Hz"},
           "cut-off frequency of the filter of joint velocities");
  f.number("accelerometer_gain_per_s", estimate.accelerometer_gain_per_s, {0, 100, "1/s"},
           "how fast gravity corrects roll and pitch");
  f.number("gyro_bias_gain_per_s2", estimate.gyro_bias_gain_per_s2, {0, 100, "1/s2"},
           "how fast the gyro's bias is learnt");
  f.number("gyro_bias_max_rad_s", estimate.gyro_bias_max_rad_s, {0, 10, "rad/s"}, "limit of the learnt bias");
  f.number("gravity_tolerance", estimate.gravity_tolerance, {1e-3, 10},
           "| |a| / g - 1 | from which the accelerometer no longer corrects the orientation");
  f.number("contact_on_N", estimate.contact_on_N, {1e-3, 1e4, "N"}, "a foot that bears more force comes into contact");
  f.number("contact_off_N", estimate.contact_off_N, {1e-3, 1e4, "N"},
           "a foot that bears less force is no longer in contact");
  if (f.reading() && !(estimate.contact_off_N <= estimate.contact_on_N)) {
    problems_.add(f.place("contact_off_N"), f.path("contact_off_N") + " is " + number_text(estimate.contact_off_N) +
                                                ", must be at most contact_on_N, " +
                                                number_text(estimate.contact_on_N));
  }
  f.map("joints", "settings that differ for some joints, by joint pattern", [&](Fields& entry) {
    each_joint(entry, estimate.joint_velocity_cutoff_Hz, [&](double& cutoff_Hz) {
      entry.number("velocity_cutoff_Hz", cutoff_Hz, {0, 1e4, "Hz"},
                   "cut-off frequency of the filter of its velocity; 0: the same as of all joints");
    });
    each_joint(entry, estimate.sample_divisor, [&](std::uint32_t& divisor) {
      entry.integer("sample_divisor", divisor, {1, 1000}, "the joint is sampled every n-th control tick");
    });
  });
}

}  // namespace kadans
