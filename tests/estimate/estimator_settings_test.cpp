#include <cmath>
#include <stdexcept>
#include <string>

#include <doctest/doctest.h>

#include "estimate/estimator.h"
#include "estimate/tulip_fixture.h"

using namespace kadans;
using kadans::test::tulip;
using kadans::test::tulip_settings;

TEST_CASE("Wrong settings are refused with key, joint or foot, value and range") {
  struct Case {
    void (*spoil)(EstimateSettings&);
    const char* message;
  };
  const Case cases[] = {
      {[](EstimateSettings& s) { s.velocity_cutoff_Hz = 450; },
       "estimate: joint 'l_hip_yaw': velocity: cutoff_Hz = 450.000000 is outside (0, 450.000000)"},
      {[](EstimateSettings& s) { s.joint_velocity_cutoff_Hz = {50}; },
       "estimate: joint_velocity_cutoff_Hz has 1 values, the robot 14 joints"},
      {[](EstimateSettings& s) { s.spring_Nm_per_rad.assign(15, 0); },
       "estimate: spring_Nm_per_rad has 15 values, the robot 14 joints"},
      {[](EstimateSettings& s) { s.sample_divisor.assign(13, 1); },
       "estimate: sample_divisor has 13 values, the robot 14 joints"},
      {[](EstimateSettings& s) { s.spring_Nm_per_rad.assign(14, -3); },
       "estimate: joint 'l_hip_yaw': spring_Nm_per_rad = -3.000000 must be >= 0"},
      {[](EstimateSettings& s) { s.sample_divisor.assign(14, 0); },
       "estimate: joint 'l_hip_yaw': sample_divisor = 0 must be >= 1"},
      {[](EstimateSettings& s) { s.sample_divisor.assign(14, 5); },
       "estimate: joint 'l_hip_yaw': velocity: cutoff_Hz = 100.000000 is outside (0, 90.000000)"},
      {[](EstimateSettings& s) { s.accelerometer_gain_per_s = -1; },
       "estimate: base orientation: accelerometer_gain_per_s = -1.000000 must be >= 0"},
      {[](EstimateSettings& s) { s.gravity_tolerance = 0; },
       "estimate: base orientation: gravity_tolerance = 0.000000 must be > 0"},
      {[](EstimateSettings& s) { s.contact_off_N = 9; },
       "estimate: foot 'l_ankle_roll_link': contact_on_N = 8.000000, contact_off_N = 9.000000: must be 0 < "
       "contact_off_N <= contact_on_N"},
      {[](EstimateSettings& s) { s.feet[1].link = "r_foot"; }, "estimate: foot: the robot has no link 'r_foot'"},
      {[](EstimateSettings& s) { s.feet.resize(9, s.feet[0]); }, "estimate: 9 feet, at most 8"},
  };
  for (const Case& wrong : cases) {
    EstimateSettings settings = tulip_settings();
    wrong.spoil(settings);
    CHECK_THROWS_WITH_AS(Estimator(tulip(), settings, 0.001), wrong.message, std::invalid_argument);
  }
  CHECK_THROWS_AS(Estimator(tulip(), tulip_settings(), 0), std::invalid_argument);
  CHECK_THROWS_AS(Estimator(tulip(), tulip_settings(), std::nan("")), std::invalid_argument);
}

TEST_CASE("Every estimate is a signal under its name") {
  test::TulipFixture robot;
  Snapshot snapshot;
  SignalTable table;
  declare_signals(table, tulip(), tulip_settings(), snapshot);
  CHECK(table.size() == 14 * 3 + 9 + 2 * 4 + 3);
  const std::size_t knee = test::joint_of("l_knee");
  robot.sensors.joints[knee].position_rad = 0.25;
  robot.sensors.joints[knee].motor_effort_Nm = 3;
  robot.sensors.imu.angular_velocity_rad_s = {0.1, 0.2, 0.3};
  robot.sensors.feet[1].force_N = {0, 0, 10, 10};
  robot.advance();
  snapshot.joints = robot.joints;
  snapshot.status = robot.status;
  std::vector<double> row(table.size());
  table.gather(row);
  const auto value = [&](const char* name) {
    const auto id = table.find(name);
    REQUIRE_MESSAGE(id.has_value(), name);
    return row[*id];
  };
  CHECK(value("joint.l_knee.position_rad") == 0.25);
  CHECK(value("joint.l_knee.velocity_rad_s") == 0);
  CHECK(value("joint.l_knee.effort_Nm") == 3);
  CHECK(value("base.rate_x_rad_s") == doctest::Approx(0.1));
  CHECK(value("base.rate_z_rad_s") == doctest::Approx(0.3));
  CHECK(value("base.height_m") > 0.8);
  CHECK(value("base.tilt_rad") == robot.status.base.tilt_rad);
  CHECK(value("base.yaw_rad") == robot.status.base.yaw_rad);
  CHECK(value("base.posture") == 0);
  CHECK(value("foot.r_ankle_roll_link.contact") == 1);
  CHECK(value("foot.r_ankle_roll_link.force_N") == 20);
  CHECK(value("foot.r_ankle_roll_link.cop_x_m") == doctest::Approx(0.14));
  CHECK(value("support.force_N") == doctest::Approx(88));
  for (SignalId id = 0; id < table.size(); ++id) CHECK(table.info(id).doc.size() >= 5);
  CHECK_THROWS_AS(declare_signals(table, tulip(), tulip_settings(), snapshot), std::invalid_argument);
}
