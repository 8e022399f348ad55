#include "small_robots.h"

namespace kadans::test {
namespace {

void complete(Robot& robot) {
  const std::size_t joints = robot.model.joints.size();
  robot.settings.drives.resize(joints);
  robot.settings.encoders.resize(joints);
  robot.settings.position_rad.resize(joints);
}

ActuationFrame one_joint(const JointActuation& actuation) {
  ActuationFrame frame;
  frame.joint_count = 1;
  frame.joints[0] = actuation;
  return frame;
}

Link chain_link(const std::string& name, const Vec3& com_m) {
  Link link;
  link.name = name;
  link.inertia = {
      .mass_kg = 1.5, .com_m = com_m, .xx = 0.02, .yy = 0.03, .zz = 0.025, .xy = 0.004, .xz = -0.003, .yz = 0.002};
  return link;
}

}  // namespace

Robot box(double mass_kg, const Vec3& size_m) {
  Robot robot;
  const auto [x, y, z] = size_m;
  Link link;
  link.name = "box";
  link.inertia = {.mass_kg = mass_kg,
                  .xx = mass_kg * (y * y + z * z) / 12,
                  .yy = mass_kg * (x * x + z * z) / 12,
                  .zz = mass_kg * (x * x + y * y) / 12};
  link.collisions.push_back({"box", "box", {}, Box{size_m}});
  robot.model.name = "box";
  robot.model.links.push_back(link);
  FootSettings foot;
  foot.link = "box";
  foot.sensors_m = {
      {{-x / 2, -y / 2, -z / 2}, {-x / 2, y / 2, -z / 2}, {x / 2, -y / 2, -z / 2}, {x / 2, y / 2, -z / 2}}};
  robot.settings.feet.push_back(foot);
  return robot;
}

Robot pendulum(double mass_kg, double com_m, double inertia_kg_m2) {
  Robot robot;
  const double own = inertia_kg_m2 - mass_kg * com_m * com_m;
  Link base, arm;
  base.name = "base";
  base.inertia = {.mass_kg = 1, .xx = 0.1, .yy = 0.1, .zz = 0.1};
  arm.name = "arm";
  arm.inertia = {.mass_kg = mass_kg, .com_m = {0, 0, -com_m}, .xx = own, .yy = own, .zz = own};
  robot.model.links = {base, arm};
  Joint joint;
  joint.name = "swing";
  joint.type = JointType::continuous;
  joint.axis = {0, 1, 0};
  robot.model.joints.push_back(joint);
  robot.settings.fixed_base = true;
  robot.settings.base.position_m = {0, 0, 2};
  robot.settings.gravity_m_s2 = {0, 0, 0};
  complete(robot);
  return robot;
}

Robot neck() {
  Robot robot = pendulum(1, 0, 0.05);
  Link head;
  head.name = "head";
  head.inertia = {.mass_kg = 1, .xx = 0.03, .yy = 0.03, .zz = 0.02};
  robot.model.links.push_back(head);
  robot.model.joints[0].name = "tilt";
  Joint pan;
  pan.name = "pan";
  pan.type = JointType::continuous;
  pan.parent = 1;
  pan.axis = {0, 0, 1};
  robot.model.joints.push_back(pan);
  robot.model.transmissions.emplace_back(
      Transmission::Settings{.kind = Transmission::Kind::differential, .joints = {0, 1}, .drives = {"left", "right"}});
  complete(robot);
  return robot;
}

Robot tumbling_chain() {
  Robot robot;
  robot.model.links = {chain_link("root", {0.02, -0.01, 0.03}), chain_link("middle", {0.05, 0.03, -0.1}),
                       chain_link("end", {-0.03, 0.1, 0.06})};
  Joint first, second;
  first.name = "first";
  first.type = second.type = JointType::continuous;
  first.origin = {{0.1, 0.05, 0.2}, {0.8, 0.6, 0, 0}};
  first.axis = {0.6, 0, 0.8};
  second.name = "second";
  second.parent = 1;
  second.origin = {{0, 0.2, -0.1}, {0.6, 0, 0.8, 0}};
  second.axis = {0, 1, 0};
  robot.model.joints = {first, second};
  robot.settings.gravity_m_s2 = {0, 0, 0};
  robot.settings.base.position_m = {0, 0, 5};
  complete(robot);
  for (DriveSettings& drive : robot.settings.drives) drive.torque_max_Nm = 1;
  return robot;
}

ActuationFrame effort(double effort_Nm) { return one_joint({.effort_Nm = effort_Nm, .mode = ActuationMode::effort}); }
ActuationFrame position(double position_rad) {
  return one_joint({.position_rad = position_rad, .mode = ActuationMode::position});
}
ActuationFrame velocity(double velocity_rad_s) {
  return one_joint({.velocity_rad_s = velocity_rad_s, .mode = ActuationMode::velocity});
}
ActuationFrame impedance(double position_rad, double stiffness_Nm_per_rad, double damping_Nms_per_rad) {
  return one_joint({.position_rad = position_rad,
                    .stiffness_Nm_per_rad = stiffness_Nm_per_rad,
                    .damping_Nms_per_rad = damping_Nms_per_rad,
                    .mode = ActuationMode::impedance});
}

ActuationFrame both(const JointActuation& first, const JointActuation& second) {
  ActuationFrame frame;
  frame.joint_count = 2;
  frame.joints[0] = first;
  frame.joints[1] = second;
  return frame;
}

void run(World& plant, int steps, std::int64_t dt_ns) {
  for (int i = 0; i < steps; ++i) plant.step(dt_ns);
}

std::uint64_t state_hash(const World& plant) {
  StateHash hash;
  plant.hash(hash);
  return hash.value();
}

}  // namespace kadans::test
