// Two joints that two drives move through a coupling: what each drive gives, carries and resists acts on both joints.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"
#include "plant/small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

constexpr double tilt_kg_m2 = 0.08, pan_kg_m2 = 0.02;

Robot driven_neck(const DriveSettings& drive, ContactSolver solver = ContactSolver::tree) {
  Robot robot = neck();
  robot.settings.drives = {drive, drive};
  robot.settings.solver = solver;
  return robot;
}

JointActuation torque(double effort_Nm) { return {.effort_Nm = effort_Nm, .mode = ActuationMode::effort}; }
JointActuation place(double position_rad) { return {.position_rad = position_rad, .mode = ActuationMode::position}; }

}  // namespace

TEST_CASE("Each rotor of a differential turns with both joints, with either solver") {
  for (const ContactSolver solver : {ContactSolver::tree, ContactSolver::stock}) {
    Robot robot = driven_neck({.torque_max_Nm = 5, .rotor_inertia_kg_m2 = 0.03}, solver);
    robot.drive(1).rotor_inertia_kg_m2 = 0.01;
    robot.settings.solver_iterations = 200;
    BulletWorld plant(robot.model, robot.settings, 1);
    plant.write(both(torque(0.4), torque(0)));
    plant.step(ms);
    // M = diag(tilt, pan) + C^T diag(0.03, 0.01) C, while both joints are slow
    const double a = tilt_kg_m2 + 0.04, b = 0.02, d = pan_kg_m2 + 0.04, det = a * d - b * b;
    CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(1e-3 * 0.4 * d / det).epsilon(1e-4));
    CHECK(plant.truth().velocity_rad_s[1] == doctest::Approx(-1e-3 * 0.4 * b / det).epsilon(1e-4));
  }
}

TEST_CASE("A coupled drive gives at most its own torque, whatever its joints ask for together") {
  Robot robot = driven_neck({.torque_max_Nm = 2});
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(both(torque(3), torque(3)));  // the left drive alone: 3 Nm
  plant.step(ms);
  CHECK(plant.truth().motor_torque_Nm[0] == doctest::Approx(2));
  CHECK(plant.truth().motor_torque_Nm[1] == doctest::Approx(0));
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(1e-3 * 2 / tilt_kg_m2).epsilon(1e-4));
  CHECK(plant.truth().velocity_rad_s[1] == doctest::Approx(1e-3 * 2 / pan_kg_m2).epsilon(1e-4));
  SensorFrame sensors;
  plant.read(sensors);
  CHECK(sensors.joints[0].motor_effort_Nm == doctest::Approx(2));
  CHECK(sensors.joints[1].motor_effort_Nm == doctest::Approx(2));
  CHECK(sensors.joints[1].motor_position_rad == doctest::Approx(plant.truth().position_rad[1]));
}

TEST_CASE("The speed-torque line holds for a coupled drive's own speed, the sum of both joints'") {
  Robot robot = driven_neck({.torque_max_Nm = 4, .velocity_max_rad_s = 8, .knee_velocity_rad_s = 4});
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(both(torque(0.5), torque(0.5)));  // all by the left drive
  double fastest = 0;
  for (int i = 0; i < 3000; ++i) {
    plant.step(ms);
    fastest = std::max(fastest, plant.truth().velocity_rad_s[0] + plant.truth().velocity_rad_s[1]);
  }
  CHECK(fastest > 7.9);
  CHECK(fastest <= 8 + 1e-9);
}

TEST_CASE("Friction of the drives resists each joint by their sum, and what it takes is the same with either solver") {
  for (const ContactSolver solver : {ContactSolver::tree, ContactSolver::stock}) {
    Robot robot = driven_neck({.torque_max_Nm = 5, .coulomb_Nm = 0.3}, solver);
    robot.settings.solver_iterations = 400;
    BulletWorld plant(robot.model, robot.settings, 1);
    plant.write(both(torque(0.59), torque(0)));
    run(plant, 100);
    CHECK(std::abs(plant.truth().position_rad[0]) < 1e-6);
    plant.write(both(torque(0.8), torque(0)));
    run(plant, 50);
    CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(0.05 * 0.2 / tilt_kg_m2).epsilon(1e-3));
    CHECK(std::abs(plant.truth().velocity_rad_s[1]) < 1e-6);
  }
}

TEST_CASE("Position mode runs at the drives: both joints come to their places, under a load within the torque") {
  for (const ContactSolver solver : {ContactSolver::tree, ContactSolver::stock}) {
    Robot robot = driven_neck({.torque_max_Nm = 6,
                               .rotor_inertia_kg_m2 = 0.005,
                               .position_gain_Nm_per_rad = 500,
                               .velocity_gain_Nms_per_rad = 10},
                              solver);
    robot.settings.solver_iterations = 50;
    BulletWorld plant(robot.model, robot.settings, 1);
    plant.write(both(place(0.5), place(-0.3)));
    double most_Nm = 0;
    for (int i = 0; i < 2000; ++i) {
      plant.step(ms);
      for (std::size_t k = 0; k < 2; ++k) most_Nm = std::max(most_Nm, std::abs(plant.truth().motor_torque_Nm[k]));
    }
    CHECK(plant.truth().position_rad[0] == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(plant.truth().position_rad[1] == doctest::Approx(-0.3).epsilon(1e-4));
    CHECK(most_Nm > 5.9);
    CHECK(most_Nm <= 6 + 1e-9);
    // A joint that is pushed stands off by torque / (2 x the gain of a drive).
    plant.write(both({.effort_Nm = 1, .position_rad = 0.5, .mode = ActuationMode::position}, place(-0.3)));
    run(plant, 1000);
    CHECK(plant.truth().position_rad[0] == doctest::Approx(0.5 + 1.0 / 1000).epsilon(1e-5));
  }
}

TEST_CASE("A joint's limit holds against coupled drives, and the other joint goes on") {
  Robot robot = driven_neck({.torque_max_Nm = 5});
  robot.model.joints[0].type = JointType::revolute;
  robot.model.joints[0].lower_rad = -0.1;
  robot.model.joints[0].upper_rad = 0.1;
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(both(torque(1), torque(0.01)));
  run(plant, 500);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.1).epsilon(0.02));
  CHECK(plant.truth().velocity_rad_s[1] == doctest::Approx(0.5 * 0.01 / pan_kg_m2).epsilon(0.01));
}

TEST_CASE("A brake of one coupled drive leaves the pair one way to move: along the other drive") {
  Robot robot = driven_neck({.torque_max_Nm = 5, .brake_Nm = 20});
  robot.drive(1).enabled = false;
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(both(torque(0.4), torque(0.4)));
  run(plant, 200);
  const double tilt = plant.truth().position_rad[0], pan = plant.truth().position_rad[1];
  CHECK(tilt > 0.05);
  CHECK(pan == doctest::Approx(tilt).epsilon(1e-6));
}

TEST_CASE("A coupling keeps its energy: what the drives put in is what moves") {
  Robot robot = driven_neck({.torque_max_Nm = 5, .rotor_inertia_kg_m2 = 0.02});
  BulletWorld plant(robot.model, robot.settings, 1);
  double work_J = 0;
  plant.write(both(torque(0.3), torque(-0.2)));
  for (int i = 0; i < 200; ++i) {
    plant.step(ms);
    const auto& v = plant.truth().velocity_rad_s;
    work_J += 1e-3 * (0.3 * v[0] - 0.2 * v[1]);
  }
  const auto& v = plant.truth().velocity_rad_s;
  const double left = v[0] + v[1], right = v[0] - v[1];
  const double energy_J =
      0.5 * (tilt_kg_m2 * v[0] * v[0] + pan_kg_m2 * v[1] * v[1] + 0.02 * (left * left + right * right));
  CHECK(energy_J == doctest::Approx(work_J).epsilon(0.02));
}

TEST_CASE("Behind springs each coupled drive bends its own, and both joints feel the sum") {
  Robot robot = driven_neck({.torque_max_Nm = 5,
                             .rotor_inertia_kg_m2 = 0.01,
                             .viscous_Nms_per_rad = 0.3,
                             .spring_Nm_per_rad = 100,
                             .spring_damping_Nms_per_rad = 0.3});
  robot.drive(1).spring_Nm_per_rad = 20;
  for (Joint& joint : robot.model.joints) {
    joint.type = JointType::revolute;
    joint.lower_rad = -0.1;
    joint.upper_rad = 0.1;
  }
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(both(torque(0.4), torque(0.1)));  // left 0.25, right 0.15 Nm
  run(plant, 4000);                             // both joints at their stops
  SensorFrame sensors;
  plant.read(sensors);
  const auto bent_rad = [&](std::size_t i) {
    return sensors.joints[i].motor_position_rad - sensors.joints[i].position_rad;
  };
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.1).epsilon(0.02));
  CHECK(plant.truth().position_rad[1] == doctest::Approx(0.1).epsilon(0.02));
  CHECK(bent_rad(0) + bent_rad(1) == doctest::Approx(0.25 / 100).epsilon(1e-3));
  CHECK(bent_rad(0) - bent_rad(1) == doctest::Approx(0.15 / 20).epsilon(1e-3));
  CHECK(plant.truth().drive_torque_Nm[0] == doctest::Approx(0.4).epsilon(1e-3));
  CHECK(plant.truth().drive_torque_Nm[1] == doctest::Approx(0.1).epsilon(1e-3));
}

TEST_CASE("A coupling behind springs keeps its energy: in the joints, the rotors and the springs") {
  Robot robot = driven_neck({.torque_max_Nm = 5, .rotor_inertia_kg_m2 = 0.02, .spring_Nm_per_rad = 60});
  robot.drive(1).spring_Nm_per_rad = 30;
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(both(torque(0.3), torque(-0.2)));  // left 0.05, right 0.25 Nm
  const auto rotor_rad = [](const SensorFrame& frame, double sign) {
    return frame.joints[0].motor_position_rad + sign * frame.joints[1].motor_position_rad;
  };
  SensorFrame before, now;
  plant.read(now);
  double most_bent_rad = 0, off_J = 0, work_J = 0;
  for (int i = 0; i < 250; ++i) {
    before = now;
    plant.step(ms);
    plant.read(now);
    const double tilt_rad = now.joints[0].position_rad, pan_rad = now.joints[1].position_rad;
    const double left_rad = rotor_rad(now, 1) - (tilt_rad + pan_rad),
                 right_rad = rotor_rad(now, -1) - (tilt_rad - pan_rad);
    const double left_rad_s = (rotor_rad(now, 1) - rotor_rad(before, 1)) / 1e-3;
    const double right_rad_s = (rotor_rad(now, -1) - rotor_rad(before, -1)) / 1e-3;
    const auto& v = plant.truth().velocity_rad_s;
    const double energy_J = 0.5 * (tilt_kg_m2 * v[0] * v[0] + pan_kg_m2 * v[1] * v[1] +
                                   0.02 * (left_rad_s * left_rad_s + right_rad_s * right_rad_s) +
                                   60 * left_rad * left_rad + 30 * right_rad * right_rad);
    work_J = 0.05 * rotor_rad(now, 1) + 0.25 * rotor_rad(now, -1);
    off_J = std::max(off_J, std::abs(energy_J - work_J));
    most_bent_rad = std::max(most_bent_rad, std::abs(right_rad));
  }
  CHECK(most_bent_rad > 5e-3);
  CHECK(off_J < 0.02 * work_J);
}

TEST_CASE("A coupling of joints that do not carry each other is refused") {
  Robot fork = driven_neck({.torque_max_Nm = 5});
  fork.model.joints[1].parent = 0;
  CHECK_THROWS_WITH(BulletWorld(fork.model, fork.settings, 1),
                    "joints 'tilt' and 'pan' are coupled, but none of them carries the other");
}

TEST_CASE("What is asked of coupled joints and what that means for their drives move them alike, to the bit") {
  const Robot robot = driven_neck({.torque_max_Nm = 5, .rotor_inertia_kg_m2 = 0.03});
  BulletWorld by_joints(robot.model, robot.settings, 1), by_drives(robot.model, robot.settings, 1);
  ActuationFrame frame = both(torque(0.4), torque(-0.1));
  by_joints.write(frame);
  robot.model.transmissions.front().to_drives(frame);
  by_drives.write_drives(frame);
  StateHash joints, drives;
  by_joints.step(ms);
  by_drives.step(ms);
  by_joints.hash(joints);
  by_drives.hash(drives);
  CHECK(by_joints.truth().velocity_rad_s[0] > 0);
  CHECK(joints.value() == drives.value());
}
