// The parts of a robot's configuration that stand on plant, start, estimator and safety.
#include <algorithm>
#include <cmath>

#include "kadans/model/kinematics.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/nearest_name.h"
#include "mesh_hull.h"
#include "project_root.h"
#include "robot_reader.h"

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

constexpr NumberRange sensor_position_m{-10, 10, "m"};

// A plant type's list of fields, as one of the file's.
class TypeFields final : public PlantFields {
 public:
  TypeFields(Fields& fields, std::span<const std::string> drives) : fields_(fields), drives_(drives) {}
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
  void map(std::string_view name, const ReadEntry& read, std::string_view doc) override {
    fields_.map(name, doc, [&](Fields& entry) {
      TypeFields fields(entry, drives_);
      read(fields, entry.key());
    });
  }
  bool reading() const noexcept override { return fields_.reading(); }
  std::span<const std::string> drives() const noexcept override { return drives_; }
  void refuse(std::string_view name, const std::string& why) override {
    fields_.refuse(where(name), (given(name) ? fields_.path(name) : fields_.path()) + ": " + why);
  }
  InputProblem place(std::string_view name) const override {
    if (!fields_.reading()) return {};
    const TextPlace at = where(name);
    return {.file = fields_.problems().file(), .line = at.line, .column = at.column, .message = {}};
  }

 private:
  bool given(std::string_view name) const { return !name.empty() && fields_.has(name); }
  TextPlace where(std::string_view name) const {
    if (given(name)) return fields_.place(name);
    return fields_.key().empty() ? fields_.place() : fields_.key_place();
  }

  Fields& fields_;
  std::span<const std::string> drives_;
};

}  // namespace

void RobotReader::transmission(Fields& f) {
  static const std::vector<std::string> kinds{"simple", "differential", "four_bar_linkage"};
  constexpr NumberRange ratio{-1e6, 1e6};
  Transmission::Settings settings;
  std::vector<PlacedName> joints, drives;
  const bool known = f.choice("type", settings.kind, kinds,
                              "simple: one joint; the others couple two joints and two drives", Need::required);
  f.strings("joints", joints, {1, 2}, "the joints, in the order of the type's equations", Need::required);
  f.strings("drives", drives, {1, 2}, "names of the drives, for plant.drives and messages; else the joints'");
  f.number_list("actuator_reduction", settings.actuator_reduction, {1, 2}, ratio, "of each drive; negative: reversed");
  f.number_list("joint_reduction", settings.joint_reduction, {1, 2}, ratio, "of each joint; negative: reversed");
  f.number_list("joint_offset_rad", settings.joint_offset_rad, {1, 2}, {-100, 100, "rad"},
                "of each joint: its position when its drives are at 0");
  if (!have_model_ || !known) return;
  RobotModel& model = config_.model;
  for (const PlacedName& joint : joints) {
    const std::optional<std::size_t> found = model.find_joint(joint.name);
    if (!found) return problems_.add_unknown(joint.place, "joint", joint.name, joint_names_);
    if (model.joints[*found].passive())
      return problems_.add(joint.place,
                           "joint '" + joint.name + "' is passive (effort 0 in the URDF): no drive moves it");
    const auto has_it = [&](const Transmission& other) {
      return std::ranges::find(other.joints(), *found) != other.joints().end();
    };
    const auto own = model.transmissions.begin() + static_cast<std::ptrdiff_t>(of_urdf_);
    if (std::any_of(own, model.transmissions.end(), has_it))
      return problems_.add(joint.place, "joint '" + joint.name + "' is in two transmissions");
    if (const auto urdf = std::find_if(model.transmissions.begin(), own, has_it); urdf != own) {
      leave_to_joints(*urdf);
      model.transmissions.erase(urdf), --of_urdf_;  // what is said here goes before the URDF's
    }
    settings.joints.push_back(*found);
  }
  drive_names_ = model.drive_names();
  for (const PlacedName& drive : drives) {
    if (std::ranges::find(drive_names_, drive.name) != drive_names_.end() || !is_word(drive.name) || drive.name.empty())
      return problems_.add(drive.place, "'" + drive.name +
                                            "' is no name for a drive: letters, digits and '_', and no joint or other "
                                            "drive may have it");
    settings.drives.push_back(drive.name);
  }
  try {
    const Transmission made(settings);
    if (made.coupled() && !model.on_one_path(made.joints()[0], made.joints()[1]))
      return f.refuse("joints", ": one of two coupled joints must carry the other");
    model.transmissions.push_back(made);
  } catch (const std::invalid_argument& error) {
    return f.refuse(std::string(": ") + error.what());
  }
  drive_names_ = model.drive_names();
  default_drives(model.transmissions.back());
}

// Drives of a coupling that can give both joints all that the URDF allows them at once.
void RobotReader::default_drives(const Transmission& transmission) {
  if (!transmission.coupled()) return;
  const std::vector<std::size_t>& joints = transmission.joints();
  for (std::size_t i = 0; i < 2; ++i) {
    DriveSettings& drive = config_.plant.drives[joints[i]];
    drive.torque_max_Nm = drive.velocity_max_rad_s = 0;
    for (std::size_t j = 0; j < 2; ++j) {
      const Joint& joint = config_.model.joints[joints[j]];
      drive.torque_max_Nm += std::abs(transmission.joint_per_drive(j, i)) * joint.effort_max_Nm;
      drive.velocity_max_rad_s += std::abs(transmission.drive_per_joint(i, j)) * joint.velocity_max_rad_s;
    }
  }
}

// Drives in the joints' own coordinates again.
void RobotReader::leave_to_joints(const Transmission& transmission) {
  for (const std::size_t i : transmission.joints()) {
    config_.plant.drives[i].torque_max_Nm = config_.model.joints[i].effort_max_Nm;
    config_.plant.drives[i].velocity_max_rad_s = config_.model.joints[i].velocity_max_rad_s;
  }
}

void RobotReader::drive(Fields& entry) {
  const std::vector<std::size_t> meant =
      have_model_ ? chosen(entry.key(), entry.key_place(), "joint", drive_names_) : std::vector<std::size_t>();
  each(meant, config_.plant.drives, [&](DriveSettings& d) { drive_fields(entry, d); });
  for (const std::size_t i : meant) {
    const DriveSettings& d = config_.plant.drives[i];
    if (config_.model.joints[i].passive() && d.torque_max_Nm > 0 && entry.has("torque_max_Nm")) {
      return entry.refuse("torque_max_Nm",
                          " gives a motor to joint '" + drive_names_[i] + "', which is passive (effort 0 in the URDF)");
    }
    if (!(d.knee_velocity_rad_s <= d.velocity_max_rad_s)) {
      return entry.refuse("knee_velocity_rad_s", " is " + number_text(d.knee_velocity_rad_s) + ", joint '" +
                                                     drive_names_[i] + "' has velocity_max_rad_s " +
                                                     number_text(d.velocity_max_rad_s));
    }
  }
}

void RobotReader::surface(Fields& entry) {
  SurfaceSettings surface;
  entry.number("friction", surface.friction, {0, 10}, "coefficient of friction", Need::required);
  if (!have_model_) return;
  const std::vector<std::string> links = config_.model.link_names();
  std::vector<SurfaceSettings>& all = config_.plant.surfaces;
  for (const std::size_t i : chosen(entry.key(), entry.key_place(), "link", links)) {
    std::erase_if(all, [&](const SurfaceSettings& s) { return s.link == links[i]; });
    all.push_back({links[i], surface.friction});
  }
}

void RobotReader::collision(Fields& entry) {
  enum class As : std::uint8_t { described, box, nothing } as = As::described;
  static const std::vector<std::string> names{"described", "box", "nothing"};
  std::vector<PlacedName> meshes;
  entry.choice(
      "as", as, names,
      "as the URDF describes the link, meshes as their convex hulls; with boxes in the place of meshes; or not "
      "at all");
  entry.strings("meshes", meshes, {1, 64},
                "files of meshes, in the frame of the link that moves, whose convex hulls take the place of what the "
                "URDF describes");
  if (!have_model_) return;
  std::vector<Geometry> given;
  for (const PlacedName& mesh : meshes) {
    const std::filesystem::path file = resolve_file(mesh.name, mesh.place, "mesh", problems_);
    if (file.empty()) return;
    try {
      given.push_back({.shape = Mesh{.file = file.string(), .corners_m = mesh_hull(file.string())}});
    } catch (const InputError& error) {
      return problems_.add(mesh.place, error.what());
    }
  }
  const std::vector<std::string> links = config_.model.link_names();
  for (const std::size_t i : chosen(entry.key(), entry.key_place(), "link", links)) {
    std::vector<Geometry>& all = config_.model.links[*config_.model.find_link(links[i])].collisions;
    if (as == As::nothing || !given.empty()) std::erase_if(all, [&](const Geometry& g) { return g.link == links[i]; });
    for (Geometry geometry : given) {
      geometry.link = links[i];
      all.push_back(geometry);
    }
    if (as != As::box) continue;
    for (Geometry& geometry : all) {
      const auto* const mesh = std::get_if<Mesh>(&geometry.shape);
      if (mesh == nullptr || geometry.link != links[i] || mesh->corners_m.empty()) continue;
      const Around around = box_around(*mesh);
      geometry.pose = compose(geometry.pose, {.position_m = around.center_m});
      geometry.shape = Box{around.size_m};
    }
  }
}

void RobotReader::imu(Fields& f) {
  ImuSettings& imu = config_.plant.imu;
  Vec3 angles_rad{};
  f.numbers("position_m", imu.pose.position_m, sensor_position_m, "position of the IMU in the base frame");
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
  std::size_t sensor = 0;
  for (const char* const name : {"heel_inner_m", "heel_outer_m", "toe_inner_m", "toe_outer_m"})
    f.numbers(name, foot.sensors_m[sensor++], sensor_position_m, "pressure sensor, in the link's frame",
              Need::required);
  f.number("noise_N", foot.noise_N, {0, 1e3, "N"}, "standard deviation of the noise of each sensor");
  std::string name;
  f.string("name", name,
           "its name in behaviors, s.feet.NAME (default: of two without names left and right, else the link's)");
  if (name.find('.') != std::string::npos) f.refuse("name", ": a foot's name has no dot");
  if (!have_model_) return;
  if (!foot.link.empty()) (void)problems_.known({foot.link, f.place("link")}, "link", config_.model.link_names());
  config_.estimate.feet.push_back({foot.link, foot.sensors_m, name});
  config_.plant.feet.push_back(std::move(foot));
}

void RobotReader::name_feet(Fields& f) {
  std::vector<EstimateFoot>& feet = config_.estimate.feet;
  const bool pair = feet.size() == 2 && feet[0].name.empty() && feet[1].name.empty();
  for (std::size_t i = 0; i < feet.size(); ++i) {
    EstimateFoot& foot = feet[i];
    if (foot.name.empty()) foot.name = !pair ? foot.link : i == 0 ? "left" : "right";
    for (std::size_t other = 0; other < i; ++other) {
      if (feet[other].name == foot.name || feet[other].link == foot.link)
        f.refuse("feet", ": two feet are '" + foot.name + "'");
    }
  }
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
  f.object("serial_imu", "an IMU on a serial line of its own, beside a bus with drives", [&](Fields& e) {
    TypeFields fields(e, drive_names_);
    config_.serial_imu.fields(fields);
  });
  if (config_.serial_imu.given()) {
    const double readings = 1e-9 * static_cast<double>(config_.engine.control_period_ns()) * config_.serial_imu.rate_Hz;
    config_.estimate.imu_divisor = static_cast<std::uint32_t>(std::max(1.0, std::ceil(1 / readings - 1e-9)));
  }
  f.list("feet", {0, max_feet}, "soles with four pressure sensors", [&](Fields& e) { foot(e); });
  name_feet(f);
  f.map("surfaces", "friction of the links' surfaces by link pattern", [&](Fields& entry) { surface(entry); });
  f.map("collisions", "how links collide, by link pattern", [&](Fields& entry) { collision(entry); });
  f.number("ground_friction", plant.ground_friction, {0, 10},
           "coefficient of friction of the ground; a contact's coefficient is the product of those of both surfaces");
  f.number("ground_restitution", plant.ground_restitution, {0, 1}, "share of the speed that the ground gives back");
  f.number("ground_stiffness_N_per_m", plant.ground_stiffness_N_per_m, {0, 1e7, "N/m"},
           "of soft ground, under each point of contact (a sole has four); 0: hard");
  f.number("ground_damping_Ns_per_m", plant.ground_damping_Ns_per_m, {0, 1e5, "N s/m"},
           "damping of soft ground, under each point of contact");
  f.numbers("gravity_m_s2", plant.gravity_m_s2, {-100, 100, "m/s2"}, "gravity in world axes");
  static const std::vector<std::string> solvers{"tree", "stock"};
  f.choice("solver", plant.solver, solvers, "solver of contacts and joint laws: the one of this project, or Bullet's");
  f.integer("solver_iterations", plant.solver_iterations, {1, 1000}, "iterations of the contact solver in a step");
  f.boolean("fixed_base", plant.fixed_base, "the base link is bolted to the world");
  f.boolean("self_collision", plant.self_collision, "the robot's links collide with each other");
  std::string srdf;
  if (f.string("srdf", srdf, "an SRDF of the robot: the pairs of its <disable_collisions> pass through each other") &&
      have_model_) {
    const std::filesystem::path file = resolve_file(srdf, f.place("srdf"), "srdf", problems_);
    try {
      std::vector<InputProblem> warnings;
      if (!file.empty()) plant.passing = read_srdf(file.string(), config_.model, &warnings);
      config_.urdf_warnings.insert(config_.urdf_warnings.end(), warnings.begin(), warnings.end());
    } catch (const InputError& error) {
      problems_.add(error);
    }
  }
  for (const auto& type : config_.plant_types) {
    if (!type->has_fields()) continue;
    f.object(type->name(), type->doc(), [&](Fields& e) {
      TypeFields fields(e, drive_names_);
      type->fields(fields);
    });
  }
  if (object_types_.empty() && !config_.plugins.empty()) f.leave_others();  // a plug-in's type would ask for them
  for (std::size_t i = 0; i < plant.drives.size(); ++i) {
    config_.estimate.spring_Nm_per_rad[i] = config_.safety.joints[i].spring_Nm_per_rad =
        plant.drives[i].spring_Nm_per_rad;
  }
  for (const Transmission& transmission : config_.model.transmissions) {
    if (!transmission.coupled()) continue;
    for (const std::size_t i : transmission.joints()) {
      config_.safety.joints[i].drive_effort_max_Nm = plant.drives[i].torque_max_Nm;
      config_.safety.joints[i].drive_velocity_max_rad_s = plant.drives[i].velocity_max_rad_s;
    }
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
  entry.object("events", "events that it sends to behaviors when it passes 0.5, for a switch", [&](Fields& f) {
    input_event_fields(f,
                       {.of = InputEvent::Of::sensor,
                        .index = static_cast<std::uint32_t>(config_.plant.channels.size()),
                        .input = "sensors." + channel.name},
                       "rise", "fall", config_.input_events);
  });
  if (!entry.reading()) return;
  constexpr std::size_t longest = 32;
  const bool begins_well = !channel.name.empty() && (channel.name[0] < '0' || channel.name[0] > '9');
  if (!begins_well || channel.name.size() > longest || !is_word(channel.name))
    problems_.add(entry.key_place(), "'" + channel.name +
                                         "' is no name of a sensor: letters, digits and '_', at most " +
                                         std::to_string(longest) + ", no digit first");
  if (!(channel.min <= channel.max)) entry.refuse("max", channel.max, "at least min, " + number_text(channel.min));
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
  const auto found = problems_.known({config_.start_pose, f.place("pose")}, "pose", names_of(config_.poses));
  if (!found) return;
  for (const auto& [joint, position_rad] : config_.poses[*found].position_rad) plant.position_rad[joint] = position_rad;
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
    f.refuse("contact_off_N", estimate.contact_off_N, "at most contact_on_N, " + number_text(estimate.contact_on_N));
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

// The part of a robot's configuration that stands on safety: limits by joint, what the watches look for, reactions.

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
    entry.refuse(field, " goes beyond the URDF's " + number_text(urdf) + " of joint '" + joint.name +
                            "'; limits may only be narrowed");
    return false;
  };
  if (!(l.lower_rad >= joint.lower_rad)) return refuse_field("lower_rad", joint.lower_rad);
  if (!(l.upper_rad <= joint.upper_rad)) return refuse_field("upper_rad", joint.upper_rad);
  if (!(l.velocity_max_rad_s <= joint.velocity_max_rad_s)) {
    return refuse_field("velocity_max_rad_s", joint.velocity_max_rad_s);
  }
  if (!(l.effort_max_Nm <= joint.effort_max_Nm)) return refuse_field("effort_max_Nm", joint.effort_max_Nm);
  if (l.lower_rad <= l.upper_rad) return true;
  entry.refuse(entry.place("upper_rad"), entry.path() + ": lower_rad " + number_text(l.lower_rad) +
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
    f.refuse("thermal", ": ambient_C < warm_C <= hot_C must hold");
  }
  s.foot_joints.clear();
  for (const EstimateFoot& foot : config_.estimate.feet) {
    const std::optional<std::size_t> link = have_model_ ? config_.model.find_link(foot.link) : std::nullopt;
    s.foot_joints.push_back(link && *link > 0 ? static_cast<std::uint16_t>(*link - 1) : no_joint);
  }
}

}  // namespace kadans
