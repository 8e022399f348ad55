#include "kadans/plant/modelled_drives.h"

#include <doctest/doctest.h>

#include "kadans/plant/ideal_world.h"
#include "small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

// A frame after another with an order to the first drive.
struct Asked {
  ActuationFrame frame;

  const ActuationFrame& to(DriveOrder order) {
    frame.drives[0] = {order, static_cast<std::uint8_t>(frame.drives[0].number + 1)};
    return frame;
  }
};

JointSample sample_of(Plant& plant) {
  SensorFrame sensors;
  plant.read(sensors);
  return sensors.joints[0];
}

Robot braked_pendulum(double brake_Nm) {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.drive() = {.torque_max_Nm = 5, .enabled = false, .enable_s = 0.01, .brake_Nm = brake_Nm};
  robot.settings.position_rad = {0.5};
  robot.settings.gravity_m_s2 = {0, 0, -g};
  return robot;
}

}  // namespace

TEST_CASE_TEMPLATE("A drive that is not enabled gives no torque, its brake holds, and it is enabled after its time",
                   Model, BulletWorld, IdealWorld) {
  const Robot robot = braked_pendulum(2);
  Model plant(robot.model, robot.settings, 1);
  Asked asked{effort(3)};
  plant.write(asked.frame);
  run(plant, 200);
  CHECK(sample_of(plant).drive == DriveState::ready);
  CHECK(sample_of(plant).braked);
  CHECK(plant.truth().motor_torque_Nm[0] == 0);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.5).epsilon(1e-3));
  plant.write(asked.to(DriveOrder::enable));
  run(plant, 9);
  CHECK(sample_of(plant).drive == DriveState::ready);
  run(plant, 1);
  CHECK(sample_of(plant).drive == DriveState::enabled);
  CHECK_FALSE(sample_of(plant).braked);
  plant.write(asked.frame);
  run(plant, 50);
  CHECK(plant.truth().motor_torque_Nm[0] == doctest::Approx(3));
  CHECK(plant.truth().position_rad[0] > 0.503);  // 3 Nm for 50 ms, on the ideal plant's 1 kg m2
  plant.write(asked.to(DriveOrder::disable));
  run(plant, 300);
  CHECK(sample_of(plant).drive == DriveState::ready);
  const double stopped_rad = plant.truth().position_rad[0];
  run(plant, 100);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(stopped_rad).epsilon(1e-3));
}

TEST_CASE("A brake holds no more than its torque, and lets go when somebody releases it") {
  for (const double brake_Nm : {0.2, 2.0}) {
    const Robot robot = braked_pendulum(brake_Nm);
    const bool holds = brake_Nm > g * 0.1 * 0.48;  // weight, lever, sin(0.5)
    BulletWorld plant(robot.model, robot.settings, 1);
    Asked asked;
    asked.frame.joint_count = 1;
    plant.write(asked.frame);
    run(plant, 300);
    CHECK((plant.truth().position_rad[0] > 0.49) == holds);
    plant.write(asked.to(DriveOrder::release));
    CHECK_FALSE(sample_of(plant).braked);
    CHECK(sample_of(plant).drive == DriveState::ready);
    run(plant, 200);
    CHECK(plant.truth().position_rad[0] < 0.45);
    plant.write(asked.to(DriveOrder::brake));
    CHECK(sample_of(plant).braked);
  }
}

TEST_CASE(
    "A brake holds a joint whose drive is enabled and asked for nothing, and follows no hand when it is enabled anew") {
  const Robot robot = braked_pendulum(2);
  BulletWorld plant(robot.model, robot.settings, 1);
  Asked asked;
  asked.frame.joint_count = 1;
  plant.write(asked.to(DriveOrder::enable));
  run(plant, 300);
  CHECK(sample_of(plant).drive == DriveState::enabled);
  CHECK(sample_of(plant).braked);
  CHECK(plant.truth().position_rad[0] > 0.49);
  plant.write(asked.to(DriveOrder::brake));
  asked.frame.joints[0] = {.effort_Nm = 0, .mode = ActuationMode::effort};
  plant.write(asked.frame);
  CHECK(sample_of(plant).braked);
  plant.write(asked.to(DriveOrder::enable));
  CHECK_FALSE(sample_of(plant).braked);
  run(plant, 200);
  CHECK(plant.truth().position_rad[0] < 0.45);
}

TEST_CASE("An order that stands in every frame is carried out once") {
  ModelledDrives drives({{.torque_max_Nm = 1, .brake_Nm = 1}}, 1);
  Asked asked;
  asked.frame.joint_count = 1;
  drives.write(asked.to(DriveOrder::disable));
  drives.write(asked.to(DriveOrder::enable));
  drives.step(ms);
  CHECK(drives.enabled(0));
  ActuationFrame old;  // of somebody who has given no order: the next session's first
  old.joint_count = 1;
  drives.write(old);
  drives.write(asked.frame);  // enabled again, which it is
  CHECK(drives.enabled(0));
  for (int i = 0; i < 300; ++i) {  // the number wraps
    drives.write(asked.to(i % 2 == 0 ? DriveOrder::disable : DriveOrder::enable));
    drives.write(asked.frame);
    drives.step(ms);
    CHECK(drives.enabled(0) == (i % 2 == 1));
  }
}

TEST_CASE("Drives as they start leave a world's hash as it was, and one that is disabled changes it") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.drive().torque_max_Nm = 5;
  BulletWorld plant(robot.model, robot.settings, 1);
  const std::uint64_t before = state_hash(plant);
  Asked asked{effort(0)};
  plant.write(asked.to(DriveOrder::disable));
  CHECK(state_hash(plant) != before);
  plant.write(asked.to(DriveOrder::enable));
  plant.step(ms);
  BulletWorld other(robot.model, robot.settings, 1);
  other.write(effort(0));
  other.step(ms);
  CHECK(state_hash(plant) == state_hash(other));
}
