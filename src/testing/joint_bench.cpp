#include "kadans/testing/joint_bench.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/motion/setpoint_motions.h"
#include "kadans/signal/nearest_name.h"

namespace kadans::testing {
namespace {

// The number of the one name that is `wanted` or ends in "." + wanted, and begins with `prefix`. Throws
// std::invalid_argument when there is none, with the nearest, or more than one.
std::size_t find_by_ending(std::string_view what, std::string_view wanted, const std::vector<std::string>& names,
                           std::string_view prefix = "") {
  const std::string ending = "." + std::string(wanted);
  std::vector<std::size_t> found;
  std::vector<std::string> short_names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == wanted) return i;
    if (!names[i].starts_with(prefix)) continue;
    if (names[i].ends_with(ending)) found.push_back(i);
    short_names.push_back(names[i].substr(names[i].rfind('.') + 1));
    short_names.push_back(names[i]);
  }
  if (found.size() == 1) return found[0];
  const std::string quoted = std::string(what) + " '" + std::string(wanted) + "'";
  if (found.empty()) throw std::invalid_argument("unknown " + quoted + did_you_mean(wanted, short_names));
  throw std::invalid_argument(quoted + " is not clear: " + names[found[0]] + " or " + names[found[1]]);
}

constexpr double gravity_m_s2 = 9.81;
constexpr double unfiltered_Hz = 100;  // of a filter that is not used
constexpr std::uint64_t behavior_divisor = 10;

// A link whose inertia about the joint and whose weight are the plant's: a ball at the end of a lever.
Inertia link_inertia(const OneJointPlant::Config& plant) {
  Inertia inertia;
  const double lever_kg_m = plant.gravity_Nm / gravity_m_s2;
  inertia.mass_kg = std::max(1.0, 2 * lever_kg_m * lever_kg_m / plant.inertia_kg_m2);
  const double lever_m = lever_kg_m / inertia.mass_kg;
  inertia.com_m = {0, 0, -lever_m};
  inertia.xx = inertia.yy = inertia.zz = plant.inertia_kg_m2 - inertia.mass_kg * lever_m * lever_m;
  return inertia;
}

RobotModel model_of(const JointBenchConfig& config) {
  RobotModel model;
  model.name = "one_joint";
  model.links.resize(2);
  model.links[0].name = "base";
  model.links[0].inertia = {.mass_kg = 100, .xx = 10, .yy = 10, .zz = 10};
  model.links[1].name = "link";
  model.links[1].inertia = link_inertia(config.plant);
  Joint& joint = model.joints.emplace_back();
  joint.name = "joint";
  joint.axis = {0, -1, 0};  // so that gravity's torque is -gravity_Nm sin(position)
  joint.lower_rad = config.lower_rad;
  joint.upper_rad = config.upper_rad;
  joint.effort_max_Nm = config.effort_max_Nm > 0 ? config.effort_max_Nm : config.plant.torque_max_Nm;
  joint.velocity_max_rad_s = 20;
  joint.damping_Nms_per_rad = config.plant.viscous_Nms_per_rad;
  joint.friction_Nm = config.plant.coulomb_Nm;
  return model;
}

double velocity_delay_s(const JointBenchConfig& config) {
  return config.velocity_cutoff_Hz > 0
             ? VelocityFilter::delay_s({.cutoff_Hz = config.velocity_cutoff_Hz, .dt_s = config.dt_s})
             : 0;
}

}  // namespace

JointBench::JointBench(const JointBenchConfig& config, MakeControlObject make)
    : JointBench(config, {BenchObject{"object", std::move(make)}}) {}

JointBench::JointBench(const JointBenchConfig& config, const std::vector<BenchObject>& objects)
    : config_(config),
      model_(model_of(config)),
      plant_(config.plant),
      filter_({.cutoff_Hz = config.velocity_cutoff_Hz > 0 ? config.velocity_cutoff_Hz : unfiltered_Hz,
               .dt_s = config.dt_s}) {
  joints_.count = written_.joint_count = computed_.joint_count = 1;
  add_objects(objects);
}

JointBench::~JointBench() = default;

double JointBench::motion_remaining_s() const noexcept { return motions_->remaining_s(active_object()); }

void JointBench::add_objects(const std::vector<BenchObject>& objects) {
  catalog_.model = &model_;
  catalog_.drives = {{.effort_max_Nm = effort_max_Nm(),
                      .position_gain_Nm_per_rad = config_.plant.position_gain_Nm_per_rad,
                      .velocity_gain_Nms_per_rad = config_.plant.velocity_gain_Nms_per_rad,
                      .velocity_delay_s = velocity_delay_s(config_)}};
  std::vector<std::unique_ptr<ControlObject>> made;
  for (const BenchObject& object : objects) {
    const auto index = static_cast<std::uint32_t>(made.size());
    made.push_back(object.make({model_, {0}}));
    Declaration declaration(object.name, index, catalog_.parameters, catalog_.setpoints, catalog_.signals);
    made.back()->declare(declaration);
    made.back()->parameters_changed();
    catalog_.objects.push_back(
        {.name = object.name, .type = object.name, .joints = {0}, .parameters = {}, .setpoints = {}, .presets = {}});
    catalog_.sets.push_back({.name = object.name, .objects = {index}});
  }
  sets_ = std::make_unique<ControlSets>(catalog_, std::move(made));
  motions_ = std::make_unique<SetpointMotions>(catalog_, *sets_);
  row_.assign(catalog_.signals.size(), 0.0);
}

void JointBench::set(std::string_view parameter, double value) {
  const auto id = static_cast<ParameterId>(find_by_ending("parameter", parameter, catalog_.parameters.names()));
  const Parameter& info = catalog_.parameters.info(id);
  if (!catalog_.parameters.set(id, value)) {
    throw std::invalid_argument("parameter " + info.name + " cannot be " + std::to_string(value) + ", its range is " +
                                std::to_string(info.min) + ".." + std::to_string(info.max) + " " + info.unit);
  }
  const std::uint32_t owner = catalog_.parameters.owner(id);
  if (owner < sets_->size()) sets_->object(owner).parameters_changed();
}

double JointBench::get(std::string_view parameter) const {
  const auto id = find_by_ending("parameter", parameter, catalog_.parameters.names());
  return catalog_.parameters.get(static_cast<ParameterId>(id));
}

SetpointId JointBench::find_setpoint(std::string_view name) const {
  const std::string active = catalog_.objects[active_object()].name + ".";
  return static_cast<SetpointId>(find_by_ending("set-point", name, catalog_.setpoints.names(), active));
}

void JointBench::set_point(double value, double duration_s) {
  for (SetpointId id = 0; id < catalog_.setpoints.size(); ++id) {
    if (catalog_.setpoints[id].owner == active_object())
      return set_point(catalog_.setpoints[id].name, value, duration_s);
  }
  throw std::invalid_argument("control object " + catalog_.objects[active_object()].name + " has no set-point");
}

void JointBench::set_point(std::string_view setpoint, double value, double duration_s) {
  const SetpointId id = find_setpoint(setpoint);
  const Setpoint& info = catalog_.setpoints[id];
  if (!catalog_.setpoints.accepts(id, value) || !(duration_s >= 0)) {
    throw std::invalid_argument("set-point " + info.name + " cannot be " + std::to_string(value) + " in " +
                                std::to_string(duration_s) + " s, its range is " + std::to_string(info.min) + ".." +
                                std::to_string(info.max) + " " + info.unit);
  }
  if (tick_ == 0) tick();  // the object starts in its first tick
  motions_->move(id, value, duration_s);
}

void JointBench::cancel_motion(std::string_view setpoint) { motions_->cancel(find_setpoint(setpoint)); }

void JointBench::lead(const SetpointState& position) noexcept { led_ = position; }

void JointBench::lead_active(const ControlInput& input) {
  sets_->start_newcomers(input);
  const std::uint32_t object = active_object();
  for (SetpointId id = 0; id < catalog_.setpoints.size(); ++id) {
    const Setpoint& setpoint = catalog_.setpoints[id];
    if (setpoint.owner != object) continue;
    const bool velocity = setpoint.unit == "rad/s";
    if (!velocity && setpoint.unit != "rad") continue;
    const SetpointState state = velocity ? SetpointState{led_->velocity, led_->acceleration, 0} : *led_;
    if (setpoint.follows && !setpoint.own_motion) {
      sets_->object(object).follow(setpoint.channel, state);
    } else {
      motions_->move(id, std::clamp(state.value, setpoint.min, setpoint.max), 0);
    }
  }
}

void JointBench::switch_to(std::string_view object) {
  sets_->switch_to(static_cast<std::uint32_t>(find_by_ending("object", object, names_of(catalog_.sets))));
}

JointBench::Led JointBench::led(std::string_view object) const {
  const std::size_t owner = find_by_ending("object", object, names_of(catalog_.sets));
  Led by = Led::nothing;
  for (SetpointId id = 0; id < catalog_.setpoints.size(); ++id) {
    const Setpoint& setpoint = catalog_.setpoints[id];
    if (setpoint.owner != owner) continue;
    if (setpoint.unit == "rad") return Led::position;
    if (setpoint.unit == "rad/s") by = Led::velocity;
  }
  return by;
}

double JointBench::signal(std::string_view name) const {
  return row_[find_by_ending("signal", name, catalog_.signals.names())];
}

void JointBench::estimate(const SensorFrame& sensors) noexcept {
  const OneJointPlant::State& truth = plant_.state();
  const bool tachometer = config_.velocity_source == VelocitySource::tachometer;
  filter_position_rad_ =
      tachometer ? filter_position_rad_ + config_.dt_s * truth.velocity_rad_s : sensors.joints[0].position_rad;
  const double filtered_rad_s = filter_.update(filter_position_rad_, config_.dt_s);
  const double spring = config_.plant.spring_Nm_per_rad;
  JointState& joint = joints_.joints[0];
  joint.position_rad = sensors.joints[0].position_rad;
  joint.velocity_rad_s = config_.velocity_cutoff_Hz > 0 ? filtered_rad_s : truth.velocity_rad_s;
  joint.effort_Nm = spring > 0 ? spring * (sensors.joints[0].motor_position_rad - sensors.joints[0].position_rad)
                               : sensors.joints[0].motor_effort_Nm;
}

void JointBench::update_high_level() {
  snapshot_.tick = tick_;
  snapshot_.time_ns = sensors_.time_ns;
  snapshot_.joints = joints_;
  snapshot_.status = status_;
  sets_->fill(snapshot_);
  sets_->update(tick_ / behavior_divisor, snapshot_);
}

void JointBench::tick() {
  plant_.read(sensors_);
  estimate(sensors_);
  JointActuation& asked = computed_.joints[0];
  if (!is_finite(asked)) {
    ++not_finite_ticks_;
    asked = {};
  }
  const double limit_Nm = effort_max_Nm();
  if (std::abs(asked.effort_Nm) > limit_Nm) ++limited_ticks_;
  asked.effort_Nm = std::clamp(asked.effort_Nm, -limit_Nm, limit_Nm);
  written_ = computed_;
  plant_.write(written_);
  const ControlInput input{joints_, status_, written_, sensors_.time_ns, config_.dt_s};
  if (led_) lead_active(input);
  led_.reset();
  motions_->step(config_.dt_s);
  sets_->step(tick_, input, computed_);
  if (tick_ % behavior_divisor == 0) update_high_level();
  catalog_.signals.gather(row_);
  plant_.step(std::llround(config_.dt_s * 1e9));
  ++tick_;
}

void JointBench::run(double duration_s) {
  const auto ticks = std::llround(duration_s / config_.dt_s);
  for (long long i = 0; i < ticks; ++i) tick();
}

}  // namespace kadans::testing
