#include "plugin_object.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace kadans {
namespace {

PluginLink link_of(const Link& link) {
  const Inertia& i = link.inertia;
  return {link.name.c_str(), i.mass_kg, {i.com_m[0], i.com_m[1], i.com_m[2]}, {i.xx, i.yy, i.zz, i.xy, i.xz, i.yz}};
}

PluginJoint joint_of(const Joint& joint) {
  const Vec3& p = joint.origin.position_m;
  const Quat& q = joint.origin.orientation;
  const Mimic mimic = joint.mimic.value_or(Mimic{no_joint, 1, 0});
  return {.name = joint.name.c_str(),
          .type = static_cast<std::uint32_t>(joint.type),
          .parent = static_cast<std::uint32_t>(joint.parent),
          .mimics = static_cast<std::uint32_t>(mimic.joint),
          .position_m = {p[0], p[1], p[2]},
          .orientation = {q[0], q[1], q[2], q[3]},
          .axis = {joint.axis[0], joint.axis[1], joint.axis[2]},
          .lower_rad = joint.lower_rad,
          .upper_rad = joint.upper_rad,
          .effort_max_Nm = joint.effort_max_Nm,
          .velocity_max_rad_s = joint.velocity_max_rad_s,
          .damping_Nms_per_rad = joint.damping_Nms_per_rad,
          .friction_Nm = joint.friction_Nm,
          .mimic_multiplier = mimic.multiplier,
          .mimic_offset = mimic.offset};
}

std::string reason(PluginError& error) {
  error.text[sizeof error.text - 1] = '\0';
  return error.text[0] == '\0' ? "the plug-in refuses, without a reason" : error.text;
}

std::string text(const char* given) { return given == nullptr ? "" : given; }

PluginInput passed(const ControlInput& input) noexcept {
  return {&input.joints, &input.status, &input.last, input.time_ns, input.dt_s};
}

}  // namespace

struct PluginObject::Told {
  std::vector<Parameter> parameters;
  std::vector<Setpoint> setpoints;
  std::vector<Signal> signals;

  static Told& of(void* program) { return *static_cast<Told*>(program); }
  PluginDeclaration seam() {
    return {.program = this,
            .parameter =
                [](void* program, const char* name, const char* unit, double min, double max, double initial,
                   const char* doc) {
                  of(program).parameters.push_back({text(name), text(unit), min, max, initial, text(doc)});
                },
            .setpoint =
                [](void* program, const char* name, const char* unit, double min, double max, const char* doc,
                   std::uint32_t channel, std::uint32_t joint) {
                  of(program).setpoints.push_back({.name = text(name),
                                                   .unit = text(unit),
                                                   .min = min,
                                                   .max = max,
                                                   .doc = text(doc),
                                                   .channel = channel,
                                                   .joint = joint});
                },
            .signal =
                [](void* program, const char* name, const char* unit, const char* doc) {
                  of(program).signals.push_back({text(name), text(unit), text(doc)});
                }};
  }
};

// Whatever is thrown stays here, and the object is not called again.
template <typename Call>
void PluginObject::call(Call&& call) const noexcept {
  if (threw_.load(std::memory_order_relaxed)) return;
  try {
    call();
  } catch (...) {
    threw_.store(true, std::memory_order_relaxed);
  }
}

PluginObject::PluginObject(const PluginType& type, const ObjectSetup& setup) : type_(type), joints_(setup.joints) {
  std::vector<PluginLink> links;
  std::vector<PluginJoint> joints;
  std::vector<PluginOption> options;
  for (const Link& link : setup.model.links) links.push_back(link_of(link));
  for (const Joint& joint : setup.model.joints) joints.push_back(joint_of(joint));
  for (const auto& [name, given] : setup.options.given()) options.push_back({name.c_str(), given.c_str()});
  const std::vector<std::uint32_t> driven(setup.joints.begin(), setup.joints.end());
  std::vector<std::string> asked;
  const PluginSetup passed_setup{
      .program = &asked,
      .asked = [](void* program,
                  const char* option) { static_cast<std::vector<std::string>*>(program)->push_back(text(option)); },
      .options = options.data(),
      .robot = setup.model.name.c_str(),
      .links = links.data(),
      .joints = joints.data(),
      .driven = driven.data(),
      .option_count = static_cast<std::uint32_t>(options.size()),
      .link_count = static_cast<std::uint32_t>(links.size()),
      .joint_count = static_cast<std::uint32_t>(joints.size()),
      .driven_count = static_cast<std::uint32_t>(driven.size())};
  PluginError error{};
  try {
    object_ = type_.create(&passed_setup, &error);
  } catch (...) {
    throw std::invalid_argument("the plug-in threw while it made the object");
  }
  if (object_ == nullptr) throw std::invalid_argument(reason(error));
  for (const std::string& option : asked) (void)setup.options.find(option);
}

PluginObject::~PluginObject() {
  threw_ = false;  // a last call, whatever happened before
  call([&] { type_.destroy(object_); });
}

void PluginObject::declare(Declaration& declaration) {
  Told told;
  const PluginDeclaration seam = told.seam();
  PluginError error{};
  bool declared = false;
  try {
    declared = type_.declare(object_, &seam, &error) != 0;
  } catch (...) {
    throw std::invalid_argument("the plug-in threw while it declared the object");
  }
  if (!declared) throw std::invalid_argument(reason(error));
  parameters_.resize(told.parameters.size());
  signals_.resize(told.signals.size());
  for (std::size_t i = 0; i < parameters_.size(); ++i) declaration.parameter(told.parameters[i], &parameters_[i]);
  for (const Setpoint& setpoint : told.setpoints) {
    if (setpoint.joint >= max_joints && setpoint.joint != no_joint) {
      throw std::invalid_argument("set-point " + setpoint.name + " is of a joint that is none");
    }
    declaration.setpoint(setpoint);
  }
  for (std::size_t i = 0; i < signals_.size(); ++i) declaration.signal(told.signals[i], &signals_[i]);
  declaration.signal({"failed", "", "Whether the plug-in threw; its joints damp."}, &failed_);
  passed_on_ = parameters_;
}

void PluginObject::start(const ControlInput& input) noexcept {
  const PluginInput seen = passed(input);
  call([&] { type_.start(object_, &seen); });
}

void PluginObject::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const PluginInput seen = passed(input);
  call([&] {
    type_.step(object_, &seen, &actuation);
    type_.read_signals(object_, signals_.data());
  });
  failed_ = threw_.load(std::memory_order_relaxed);
  if (!failed_) return;
  for (const std::size_t joint : joints_) {
    actuation.joints[joint] = {.effort_Nm = std::numeric_limits<double>::quiet_NaN(), .mode = ActuationMode::effort};
  }
}

void PluginObject::set_point(std::uint32_t channel, double value, double duration_s) noexcept {
  call([&] { type_.set_point(object_, channel, value, duration_s); });
}

void PluginObject::cancel_motion(std::uint32_t channel) noexcept {
  call([&] { type_.cancel_motion(object_, channel); });
}

double PluginObject::motion_remaining_s() const noexcept {
  double remaining_s = 0;
  call([&] { remaining_s = type_.motion_remaining_s(object_); });
  return remaining_s >= 0 && std::isfinite(remaining_s) ? remaining_s : 0;
}

void PluginObject::parameters_changed() noexcept {
  call([&] {
    for (std::uint32_t i = 0; i < parameters_.size(); ++i) {
      if (parameters_[i] == passed_on_[i]) continue;
      passed_on_[i] = parameters_[i];
      type_.set_parameter(object_, i, parameters_[i]);
    }
    type_.parameters_changed(object_);
  });
}

void PluginObject::update(const Snapshot& snapshot) {
  call([&] { type_.update(object_, &snapshot); });
}

}  // namespace kadans
