#include "quantities.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "kadans/model/inertia.h"
#include "kadans/model/kinematics.h"
#include "kadans/signal/nearest_name.h"
#include "kadans/signal/random.h"

namespace kadans {
namespace {

constexpr NumberRange scale_range{0, 1000, ""};

Quat about(std::size_t axis, double angle_rad) {
  Quat q{std::cos(angle_rad / 2), 0, 0, 0};
  q[axis + 1] = std::sin(angle_rad / 2);
  return q;
}

double& friction_of(PlantSettings& plant, const std::string& link) {
  const auto found = std::ranges::find(plant.surfaces, link, &SurfaceSettings::link);
  if (found != plant.surfaces.end()) return found->friction;
  plant.surfaces.push_back({.link = link});
  return plant.surfaces.back().friction;
}

// Where the presets of the control objects keep a parameter, and what they have there.
std::vector<std::pair<double*, double>> values_in_presets(Catalog& catalog, ParameterId id) {
  std::vector<std::pair<double*, double>> found;
  for (ObjectInfo& object : catalog.objects) {
    for (Preset& preset : object.presets) {
      for (auto& [parameter, value] : preset.values) {
        if (parameter == id) found.emplace_back(&value, value);
      }
    }
  }
  return found;
}

}  // namespace

void put_value(std::vector<QuantityValue>& values, const std::string& name, double value) {
  const auto known = std::ranges::find(values, name, &QuantityValue::name);
  if (known == values.end()) return values.push_back({name, value});
  known->value = value;
}

Quantities::Quantities(PlantVariant& variant, Catalog& catalog, bool further_robot) {
  PlantSettings& plant = variant.plant;
  if (!further_robot) add_world(plant);
  add_value("actuation.delay_s", {0, 0.1, "s"}, variant.actuation_delay_s);
  if (variant.sees) {
    for (const SightRange& range : sight_ranges)
      add_value(std::string("sight.") + range.name, {range.min, range.max, range.unit}, variant.sight.*range.value);
  }
  for (ScenarioPerception& one : variant.perception) {
    if (!one.record.name.empty()) continue;
    for (const SightRange& range : sight_ranges)
      add_value("perception." + one.entry.name + "." + range.name, {range.min, range.max, range.unit},
                one.settings.*range.value);
    add_value("perception." + one.entry.name + ".imagined", {0, 1}, one.imagined);
  }
  add_start(plant);
  add_sensors(plant);
  add_joints(variant.model, plant);
  add_links(variant.model, plant);
  add_parameters(catalog);
}

void Quantities::add(std::string name, NumberRange range, double value, std::function<void(double)> set) {
  names_.push_back(std::move(name));
  quantities_.push_back({range, value, std::move(set)});
}

void Quantities::add_value(std::string name, NumberRange range, double& value) {
  add(std::move(name), range, value, [&value](double given) { value = given; });
}

void Quantities::add_scale(std::string name, double& value) {
  add(std::move(name), scale_range, 1, [&value, whole = value](double factor) { value = whole * factor; });
}

void Quantities::add_world(PlantSettings& plant) {
  add_value("ground.friction", {0, 10, ""}, plant.ground_friction);
  add_value("ground.restitution", {0, 1, ""}, plant.ground_restitution);
  add_value("ground.stiffness_N_per_m", {0, 1e7, "N/m"}, plant.ground_stiffness_N_per_m);
  add_value("ground.damping_Ns_per_m", {0, 1e5, "N s/m"}, plant.ground_damping_Ns_per_m);
  for (WorldObject& object : plant.world.objects) {
    const std::string name = "world." + object.name + ".";
    add_value(name + "x_m", {-1000, 1000, "m"}, object.pose.position_m[0]);
    add_value(name + "y_m", {-1000, 1000, "m"}, object.pose.position_m[1]);
    add_value(name + "friction", {0, 10, ""}, object.friction);
    auto* ball = std::get_if<WorldBall>(&object.shape);
    if (ball == nullptr) continue;
    add_value(name + "mass_kg", {1e-4, 1e4, "kg"}, ball->mass_kg);
    add_value(name + "rolling_friction_m", {0, 1, "m"}, ball->rolling_friction_m);
    add_value(name + "restitution", {0, 1, ""}, ball->restitution);
  }
}

void Quantities::add_start(PlantSettings& plant) {
  add_value("start.x_m", {-100, 100, "m"}, plant.base.position_m[0]);
  add_value("start.y_m", {-100, 100, "m"}, plant.base.position_m[1]);
  // About axes that are fixed in the world, applied in this order, as in URDF.
  constexpr std::array<const char*, 3> names{"start.roll_rad", "start.pitch_rad", "start.yaw_rad"};
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    add(names[axis], {-4, 4, "rad"}, 0, [this, &plant, axis, start = plant.base.orientation](double angle_rad) {
      turn_rad_[axis] = angle_rad;
      plant.base.orientation = start;
      for (std::size_t i = 0; i < turn_rad_.size(); ++i) {
        if (turn_rad_[i] != 0) plant.base.orientation = multiply(about(i, turn_rad_[i]), plant.base.orientation);
      }
    });
  }
}

void Quantities::add_sensors(PlantSettings& plant) {
  const NumberRange noise{0, 1000, ""};
  add_value("imu.gyro_noise_rad_s", noise, plant.imu.gyro_noise_rad_s);
  add_value("imu.gyro_bias_rad_s", noise, plant.imu.gyro_bias_rad_s);
  add_value("imu.accelerometer_noise_m_s2", noise, plant.imu.accelerometer_noise_m_s2);
  add_value("imu.accelerometer_bias_m_s2", noise, plant.imu.accelerometer_bias_m_s2);
  for (FootSettings& foot : plant.feet) add_value("foot." + foot.link + ".noise_N", noise, foot.noise_N);
  for (SensorChannel& sensor : plant.channels) {
    add_value("sensor." + sensor.name + ".value", {-1e12, 1e12, sensor.unit}, sensor.value);
    add_value("sensor." + sensor.name + ".noise", {0, 1e12, sensor.unit}, sensor.noise);
  }
}

void Quantities::add_joints(const RobotModel& model, PlantSettings& plant) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const std::string joint = "joint." + model.joints[i].name + ".";
    DriveSettings& drive = plant.drives[i];
    add_scale(joint + "torque_scale", drive.torque_max_Nm);
    add_scale(joint + "damping_scale", drive.viscous_Nms_per_rad);
    add_scale(joint + "coulomb_scale", drive.coulomb_Nm);
    if (drive.torque_max_Nm > 0) add_value(joint + "coulomb_Nm", {0, 100, "Nm"}, drive.coulomb_Nm);
    add_scale(joint + "spring_scale", drive.spring_Nm_per_rad);
    add_value(joint + "encoder_noise_rad", {0, 1, "rad"}, plant.encoders[i].noise_rad);
    const std::size_t joints = model.joints.size();
    const double start_rad = i < plant.position_rad.size() ? plant.position_rad[i] : 0;
    add(joint + "start_rad", {-7, 7, "rad"}, 0, [&plant, i, joints, start_rad](double offset_rad) {
      plant.position_rad.resize(joints);
      plant.position_rad[i] = start_rad + offset_rad;
    });
  }
}

void Quantities::add_links(RobotModel& model, PlantSettings& plant) {
  for (Link& link : model.links) {
    add("link." + link.name + ".mass_scale", {0.01, 100, ""}, 1,
        [&link, whole = link.inertia](double factor) { link.inertia = scaled(whole, factor); });
    const auto surface = std::ranges::find(plant.surfaces, link.name, &SurfaceSettings::link);
    const double friction = surface != plant.surfaces.end() ? surface->friction : SurfaceSettings{}.friction;
    add("link." + link.name + ".friction", {0, 10, ""}, friction,
        [&plant, name = link.name](double given) { friction_of(plant, name) = given; });
  }
}

void Quantities::add_parameters(Catalog& catalog) {
  for (ParameterId id = 0; id < catalog.parameters.size(); ++id) {
    const Parameter& info = catalog.parameters.info(id);
    struct Scaled {
      double value, factor;
    };
    const auto scaled = std::make_shared<Scaled>(Scaled{catalog.parameters.get(id), 1});
    // The range was looked at: the table takes it.
    const auto store = [&catalog, id, scaled] {
      const Parameter& range = catalog.parameters.info(id);
      (void)catalog.parameters.set(id, std::clamp(scaled->value * scaled->factor, range.min, range.max));
    };
    add("control." + info.name, {info.min, info.max, info.unit}, scaled->value, [scaled, store](double value) {
      scaled->value = value;
      store();
    });
    // A gain that is off by a factor is so whatever preset a behavior chooses.
    const std::vector<std::pair<double*, double>> presets = values_in_presets(catalog, id);
    add("control." + info.name + "_scale", scale_range, 1, [scaled, store, presets, &catalog, id](double factor) {
      scaled->factor = factor;
      store();
      const Parameter& range = catalog.parameters.info(id);
      for (const auto& [value, whole] : presets) *value = std::clamp(whole * factor, range.min, range.max);
    });
  }
}

std::vector<std::size_t> Quantities::chosen(const std::string& pattern, TextPlace place, Problems& problems) const {
  std::vector<std::size_t> fitting = matching(pattern, names_);
  if (fitting.empty()) problems.add_unknown(place, "quantity", pattern, names_);
  return fitting;
}

bool Quantities::apply(std::size_t index, double value, TextPlace place, std::vector<QuantityValue>& done,
                       Problems& problems) {
  const NumberRange& range = quantities_[index].range;
  if (!(value >= range.min && value <= range.max)) {
    problems.add(place, names_[index] + " is " + number_text(value) + ", must be " + number_text(range.min) + ".." +
                            number_text(range.max) + (range.unit.empty() ? "" : " " + std::string(range.unit)));
    return false;
  }
  quantities_[index].set(value);
  quantities_[index].value = value;
  put_value(done, names_[index], value);
  return true;
}

void Quantities::set(const NumberEntry& entry, std::vector<QuantityValue>& done, Problems& problems) {
  for (const std::size_t index : chosen(entry.key, entry.place, problems)) {
    if (!apply(index, entry.value, entry.value_place, done, problems)) return;
  }
}

void Quantities::draw(const Variation& variation, std::uint64_t seed, std::vector<QuantityValue>& done,
                      Problems& problems) {
  const std::string& pattern = variation.pattern.name;
  for (const std::size_t index : chosen(pattern, variation.pattern.place, problems)) {
    const std::string& stream = variation.distribution.together ? pattern : names_[index];
    const double u = RandomStream(seed, "quantity." + stream).uniform();
    if (!apply(index, variation.distribution.at(u), variation.pattern.place, done, problems)) return;
  }
}

}  // namespace kadans
