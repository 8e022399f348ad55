#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "kadans/control/plugin_glue.h"

namespace kadans {
namespace {

constexpr const char* own_name = "plugin";  // the program puts the object's real name in front

const char* without_prefix(const std::string& name, std::size_t length) { return name.c_str() + length; }

Link link_of(const PluginLink& given) {
  Link link;
  link.name = given.name;
  const double* i = given.inertia_kg_m2;
  link.inertia = {given.mass_kg, {given.com_m[0], given.com_m[1], given.com_m[2]}, i[0], i[1], i[2], i[3], i[4], i[5]};
  return link;
}

Joint joint_of(const PluginJoint& given) {
  Joint joint;
  joint.name = given.name;
  joint.type = static_cast<JointType>(given.type);
  joint.parent = given.parent;
  joint.origin.position_m = std::to_array(given.position_m);
  joint.origin.orientation = std::to_array(given.orientation);
  joint.axis = std::to_array(given.axis);
  joint.lower_rad = given.lower_rad;
  joint.upper_rad = given.upper_rad;
  joint.effort_max_Nm = given.effort_max_Nm;
  joint.velocity_max_rad_s = given.velocity_max_rad_s;
  joint.damping_Nms_per_rad = given.damping_Nms_per_rad;
  joint.friction_Nm = given.friction_Nm;
  if (given.mimics != no_joint) joint.mimic = Mimic{given.mimics, given.mimic_multiplier, given.mimic_offset};
  return joint;
}

RobotModel model_of(const PluginSetup& setup) {
  RobotModel model;
  model.name = setup.robot;
  for (std::uint32_t i = 0; i < setup.link_count; ++i) model.links.push_back(link_of(setup.links[i]));
  for (std::uint32_t i = 0; i < setup.joint_count; ++i) model.joints.push_back(joint_of(setup.joints[i]));
  return model;
}

ObjectOptions options_of(const PluginSetup& setup) {
  std::map<std::string, std::string> texts;
  for (std::uint32_t i = 0; i < setup.option_count; ++i) texts[setup.options[i].name] = setup.options[i].text;
  return texts;
}

ControlInput input_of(const PluginInput& input) noexcept {
  return {*input.joints, *input.status, *input.last, input.time_ns, input.dt_s};
}

}  // namespace

PluginInstance::PluginInstance(const PluginSetup& setup, Make make) : model_(model_of(setup)) {
  const ObjectSetup passed{model_, {setup.driven, setup.driven + setup.driven_count}, options_of(setup)};
  object_ = make(passed);
  for (const std::string& option : passed.options.asked()) setup.asked(setup.program, option.c_str());
  if (!object_) throw std::invalid_argument("it made no object");
}

void PluginInstance::declare(const PluginDeclaration& program) {
  Declaration declaration(own_name, 0, parameters_, setpoints_, signals_);
  object_->declare(declaration);
  const std::size_t own = std::string(own_name).size() + 1;
  for (ParameterId id = 0; id < parameters_.size(); ++id) {
    const Parameter& p = parameters_.info(id);
    program.parameter(program.program, without_prefix(p.name, own), p.unit.c_str(), p.min, p.max, p.initial,
                      p.doc.c_str());
  }
  for (SetpointId id = 0; id < setpoints_.size(); ++id) {
    const Setpoint& s = setpoints_[id];
    program.setpoint(program.program, without_prefix(s.name, own), s.unit.c_str(), s.min, s.max, s.doc.c_str(),
                     s.channel, s.joint);
  }
  const std::size_t control = std::string("control.").size() + own;
  for (SignalId id = 0; id < signals_.size(); ++id) {
    const Signal& s = signals_.info(id);
    program.signal(program.program, without_prefix(s.name, control), s.unit.c_str(), s.doc.c_str());
  }
}

void PluginInstance::start(const PluginInput& input) noexcept { object_->start(input_of(input)); }

void PluginInstance::step(const PluginInput& input, ActuationFrame& actuation) noexcept {
  object_->step(input_of(input), actuation);
}

void PluginInstance::set_parameter(std::uint32_t parameter, double value) noexcept {
  (void)parameters_.set(parameter, value);  // the program has checked the range, which it has from here
}

void PluginInstance::read_signals(double* values) const noexcept {
  signals_.gather(std::span(values, signals_.size()));
}

}  // namespace kadans
