// The torque loop of a series elastic drive against what its equations promise: a rotor on a spring, the joint held,
// free, or thrown against the ground.
#include "control/drive/spring_torque.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"

namespace spring_torque_test {

using namespace kadans;
using kadans::testing::AllocationCount;

namespace {

constexpr double dt_s = 0.001, spring = 300, rotor = 0.02, effort_max = 25;
constexpr double turn = 2 * std::numbers::pi;

// A rotor, a spring and a link (held when its inertia is 0); the ground is a stiff spring below 0.
struct Drive {
  double link = 0, viscous = 0.2, load_Nm = 0, ground_Nm_per_rad = 0, ground_Nms_per_rad = 0;
  int delay_ticks = 0;
  double rotor_rad = 0, rotor_rad_s = 0, link_rad = 0, link_rad_s = 0;
  std::array<double, 16> asked_Nm{};

  double torque_Nm() const { return spring * (rotor_rad - link_rad); }
  JointState measured() const { return {link_rad, link_rad_s, torque_Nm()}; }
  void tick(double motor_Nm) {
    std::rotate(asked_Nm.rbegin(), asked_Nm.rbegin() + 1, asked_Nm.rend());
    asked_Nm[0] = motor_Nm;
    const double given_Nm = asked_Nm[static_cast<std::size_t>(delay_ticks)];
    for (int i = 0; i < 20; ++i) {
      const double step_s = dt_s / 20, torque = torque_Nm();
      const double push_Nm = -ground_Nm_per_rad * link_rad - ground_Nms_per_rad * link_rad_s;
      const double ground_Nm = link_rad < 0 ? std::max(0.0, push_Nm) : 0;
      rotor_rad_s += step_s * (given_Nm - viscous * rotor_rad_s - torque) / rotor;
      if (link > 0) link_rad_s += step_s * (torque + load_Nm + ground_Nm) / link;
      rotor_rad += step_s * rotor_rad_s;
      link_rad += step_s * link_rad_s;
    }
  }
};

SpringTorqueLoop loop_of(double bandwidth_Hz = 22) {
  SpringTorqueLoop loop(dt_s);
  loop.config().bandwidth_Hz = bandwidth_Hz;
  loop.config().observer_Hz = 3;
  loop.config().effort_max_Nm = effort_max;
  return loop;
}

// Amplitude of the torque for one of 1 Nm wanted at this frequency, the joint held.
double gain_at(double frequency_Hz) {
  SpringTorqueLoop loop = loop_of();
  Drive drive;
  double in_phase = 0, quadrature = 0;
  const int settle = 2000, measure = static_cast<int>(std::lround(40 / frequency_Hz / dt_s));
  for (int i = 0; i < settle + measure; ++i) {
    const double angle = turn * frequency_Hz * dt_s * i;
    drive.tick(loop.step(std::sin(angle), drive.measured(), dt_s));
    if (i < settle) continue;
    in_phase += drive.torque_Nm() * std::sin(angle) * 2 / measure;
    quadrature += drive.torque_Nm() * std::cos(angle) * 2 / measure;
  }
  return std::hypot(in_phase, quadrature);
}

// Whether the loop comes to rest on a step of torque within 1 s.
bool settles(int delay_ticks) {
  SpringTorqueLoop loop = loop_of();
  Drive drive{.delay_ticks = delay_ticks};
  double worst_Nm = 0;
  for (int i = 0; i < 1000; ++i) {
    drive.tick(loop.step(5, drive.measured(), dt_s));
    if (i > 900) worst_Nm = std::max(worst_Nm, std::abs(drive.torque_Nm() - 5));
  }
  return worst_Nm < 0.2;
}

}  // namespace

TEST_CASE("The spring's torque answers a step as the second-order system that was asked for") {
  SpringTorqueLoop loop = loop_of();
  Drive drive{.viscous = 0};
  const double w = turn * 22, z = 0.7, wd = w * std::sqrt(1 - z * z);
  double worst_Nm = 0;
  for (int i = 1; i <= 200; ++i) {
    drive.tick(loop.step(10, drive.measured(), dt_s));
    const double t_s = i * dt_s;
    const double theory_Nm = 10 * (1 - std::exp(-z * w * t_s) * (std::cos(wd * t_s) + z * w / wd * std::sin(wd * t_s)));
    worst_Nm = std::max(worst_Nm, std::abs(drive.torque_Nm() - theory_Nm));
  }
  CHECK(worst_Nm < 1.0);  // of 10: half a tick and the filter of the rate
  CHECK(drive.torque_Nm() == doctest::Approx(10).epsilon(0.005));
}

TEST_CASE("The torque's bandwidth is what was asked for, without a resonance") {
  CHECK(gain_at(2) == doctest::Approx(1).epsilon(0.03));
  CHECK(gain_at(10) < 1.25);
  CHECK(gain_at(18) < 1.25);
  // Theory at w with a damping ratio of 0.7: 1 / (2 z) = 0.71.
  CHECK(gain_at(22) == doctest::Approx(0.71).epsilon(0.25));
  CHECK(gain_at(60) < 0.25);
}

TEST_CASE("The loop bears 2 ms of further delay, and not 8") {
  CHECK(settles(0));
  CHECK(settles(1));
  CHECK(settles(2));
  CHECK_FALSE(settles(8));
}

TEST_CASE("A rotor left to itself rings on its spring, in the loop it does not") {
  const auto overshoot = [](bool closed) {
    SpringTorqueLoop loop = loop_of();
    Drive drive;
    double most_Nm = 0;
    for (int i = 0; i < 300; ++i) {
      const double motor_Nm = loop.step(10, drive.measured(), dt_s);
      drive.tick(closed ? motor_Nm : 10);
      most_Nm = std::max(most_Nm, drive.torque_Nm());
    }
    return most_Nm / 10 - 1;
  };
  CHECK(overshoot(false) > 0.7);
  CHECK(overshoot(true) < 0.12);
}

TEST_CASE("What the model leaves out is found by the observer: a constant friction leaves no error") {
  const auto error_Nm = [](double observer_Hz) {
    SpringTorqueLoop loop = loop_of();
    loop.config().observer_Hz = observer_Hz;
    Drive drive;
    for (int i = 0; i < 1000; ++i) drive.tick(loop.step(5, drive.measured(), dt_s) - 2);
    return std::abs(drive.torque_Nm() - 5);
  };
  CHECK(error_Nm(0) > 1);
  CHECK(error_Nm(3) < 0.02);
}

TEST_CASE("At the motor's limit nothing winds up: the torque is back at once") {
  SpringTorqueLoop loop = loop_of();
  Drive drive;
  for (int i = 0; i < 2000; ++i) drive.tick(loop.step(60, drive.measured(), dt_s));
  CHECK(loop.state().saturated);
  CHECK(loop.state().motor_Nm == effort_max);
  CHECK(std::abs(loop.state().disturbance_Nm) < 0.1);
  for (int i = 0; i < 60; ++i) drive.tick(loop.step(5, drive.measured(), dt_s));
  CHECK(drive.torque_Nm() == doctest::Approx(5).epsilon(0.1));
}

TEST_CASE("A joint nearly as stiff as its spring, thrown against hard ground, comes to rest, 2 ms late too") {
  const auto fastest_rad_s = [](bool closed, int delay_ticks) {
    SpringTorqueLoop loop = loop_of();
    VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s});
    Drive drive{.link = 0.05,
                .load_Nm = -3,
                .ground_Nm_per_rad = 2e4,
                .ground_Nms_per_rad = 1,
                .delay_ticks = delay_ticks,
                .rotor_rad = 0.1,
                .rotor_rad_s = -3,
                .link_rad = 0.1,
                .link_rad_s = -3};
    double fastest = 0;
    for (int i = 0; i < 3000; ++i) {
      JointState joint = drive.measured();
      joint.velocity_rad_s = filter.update(joint.position_rad, dt_s);
      const double wanted_Nm = 0.8 * spring * (-0.02 - joint.position_rad) - 2 * joint.velocity_rad_s;
      const double motor_Nm = loop.step(wanted_Nm, joint, dt_s);
      drive.tick(closed ? motor_Nm : std::clamp(wanted_Nm, -effort_max, effort_max));
      if (i > 2000) fastest = std::max(fastest, std::abs(drive.link_rad_s));
    }
    return fastest;
  };
  CHECK(fastest_rad_s(true, 0) < 0.02);
  CHECK(fastest_rad_s(true, 2) < 0.02);
  CHECK(fastest_rad_s(false, 2) > 1);  // without the loop it hammers on
}

TEST_CASE("What is not finite is not used: the motor gets what is wanted of the joint") {
  SpringTorqueLoop loop = loop_of();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(loop.step(7, {0, 0, nan}, dt_s) == 7);
  CHECK(loop.step(7, {0, nan, 0}, dt_s) == 7);
  CHECK(std::isfinite(loop.step(7, {0, 0, 1}, dt_s)));
}

TEST_CASE("A lower cut-off of the torque's rate, set while the loop runs, makes it lag more") {
  RobotModel model;
  Joint& joint = model.joints.emplace_back();
  joint.name = "knee";
  joint.effort_max_Nm = effort_max;
  joint.velocity_max_rad_s = 8;
  model.links.resize(2);
  SpringTorque object(ObjectSetup{model, {0}, {}, {{.spring_Nm_per_rad = spring, .rotor_inertia_kg_m2 = rotor}}});
  ParameterTable parameters;
  SetpointTable setpoints;
  SignalTable signals;
  Declaration declaration("springs", 0, parameters, setpoints, signals);
  object.declare(declaration);
  const auto motor_Nm = [&](double cutoff_Hz) {
    REQUIRE(parameters.set(parameters.find("springs.knee.rate_cutoff_Hz").value(), cutoff_Hz));
    object.parameters_changed();
    JointStates joints;
    const RobotStatus status;
    ActuationFrame last, asked;
    const ControlInput input{joints, status, last, 0, dt_s};
    object.start(input);
    for (int i = 0; i < 10; ++i) {
      joints.joints[0].effort_Nm = 0.1 * i;  // 100 Nm/s
      asked.joints[0] = {.effort_Nm = 0, .mode = ActuationMode::effort};
      object.step(input, asked);
    }
    return asked.joints[0].effort_Nm;
  };
  CHECK(motor_Nm(20) > motor_Nm(200) + 0.5);  // less of the damping, which pulls against the ramp
}

TEST_CASE("SpringTorque refuses joints without a spring, leaves other modes alone, and does not allocate") {
  RobotModel model;
  model.links.resize(2);
  Joint& joint = model.joints.emplace_back();
  joint.name = "knee";
  joint.effort_max_Nm = effort_max;
  joint.velocity_max_rad_s = 8;
  CHECK_THROWS_AS(SpringTorque(ObjectSetup{model, {0}}), std::invalid_argument);
  CHECK_THROWS_AS(SpringTorque(ObjectSetup{model, {0}, {}, {DriveLaw{}}}), std::invalid_argument);

  SpringTorque object(ObjectSetup{model, {0}, {}, {{.spring_Nm_per_rad = spring, .rotor_inertia_kg_m2 = rotor}}});
  JointStates joints;
  joints.joints[0].effort_Nm = 4;
  const RobotStatus status;
  ActuationFrame last, asked;
  asked.joints[0] = {.effort_Nm = 1, .position_rad = 0.5, .mode = ActuationMode::position};
  const ControlInput input{joints, status, last, 0, dt_s};
  const AllocationCount heap;
  object.step(input, asked);
  const double of_position_Nm = asked.joints[0].effort_Nm;
  asked.joints[0] = {.effort_Nm = 10, .mode = ActuationMode::effort};
  object.step(input, asked);
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(of_position_Nm == 1);
  const double gain = turn * 22 * turn * 22 * rotor / spring - 1;
  CHECK(asked.joints[0].effort_Nm == doctest::Approx(10 + gain * (10 - 4)));
}

TEST_CASE("Of coupled joints SpringTorque controls the springs of the drives, in the drives' coordinates") {
  RobotModel model;
  model.links.resize(3);
  model.joints.resize(2);
  for (Joint& joint : model.joints) joint = {.name = "", .effort_max_Nm = 20, .velocity_max_rad_s = 8};
  model.joints[0].name = "tilt";
  model.joints[1].name = "pan";
  model.transmissions.emplace_back(
      Transmission::Settings{.kind = Transmission::Kind::differential, .joints = {0, 1}, .drives = {"left", "right"}});
  const DriveLaw left{.spring_Nm_per_rad = spring, .own_rotor_inertia_kg_m2 = rotor, .own_effort_max_Nm = 30};
  const DriveLaw right{.spring_Nm_per_rad = spring / 2, .own_rotor_inertia_kg_m2 = rotor, .own_effort_max_Nm = 30};
  CHECK_THROWS_WITH(SpringTorque(ObjectSetup{model, {0}, {}, {left, right}}),
                    "joint tilt is coupled with pan: their drives' springs need both");

  SpringTorque object(ObjectSetup{model, {0, 1}, {}, {left, right}});
  ParameterTable parameters;
  SetpointTable setpoints;
  SignalTable signals;
  Declaration declaration("springs", 0, parameters, setpoints, signals);
  object.declare(declaration);
  CHECK(parameters.find("springs.right.bandwidth_Hz").has_value());
  JointStates joints;
  joints.joints[0].effort_Nm = 4;  // left 3, right 1 Nm
  joints.joints[1].effort_Nm = 2;
  const RobotStatus status;
  ActuationFrame last, asked;
  asked.joints[0] = {.effort_Nm = 10, .mode = ActuationMode::effort};  // left 6, right 4 Nm
  asked.joints[1] = {.effort_Nm = 2, .mode = ActuationMode::effort};
  const ControlInput input{joints, status, last, 0, dt_s};
  object.step(input, asked);
  const double square = turn * 22 * turn * 22;
  const double left_Nm = 6 + (square * rotor / spring - 1) * (6 - 3);
  const double right_Nm = 4 + (square * rotor / (spring / 2) - 1) * (4 - 1);
  CHECK(asked.joints[0].effort_Nm == doctest::Approx(left_Nm + right_Nm));
  CHECK(asked.joints[1].effort_Nm == doctest::Approx(left_Nm - right_Nm));
  asked.joints[0].effort_Nm = 10;
  asked.joints[1] = {};  // off: the pair is left to its drives
  object.step(input, asked);
  CHECK(asked.joints[0].effort_Nm == 10);
}

}  // namespace spring_torque_test
