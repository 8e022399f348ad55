// The driver and the emulated boards, on virtual time, with an ideal model behind them.
#include "hostmot2_bench.h"
#include "kadans/testing/allocation_count.h"

namespace kadans::hostmot2 {

using namespace bench;

TEST_CASE("Encoders are read in the joints' coordinates, one control period old, with that time") {
  Bench bench;
  bench.run(off, off, 10);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(0.1).epsilon(0.003));
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(-0.2).epsilon(0.003));
  CHECK(bench.sensors.joints[0].drive == DriveState::ready);
  CHECK(bench.sensors.joints[0].time_ns == 9 * ms);
  CHECK(bench.sensors.time_ns == 10 * ms);
  const std::uint32_t before = bench.sensors.joints[0].sequence;
  bench.run(off, off, 20);
  CHECK(bench.sensors.joints[0].sequence - before == 20 + 1 - 1);
  CHECK(bench.count("lost") == 0);
  CHECK(bench.count("refused") == 0);
}

TEST_CASE("Effort, impedance, position and velocity reach the joints") {
  Bench bench;
  bench.run(effort(0), effort(0.5), 20);
  const double before = bench.world.truth().velocity_rad_s[1];
  bench.run(effort(0), effort(0.5), 100);
  CHECK(bench.world.truth().velocity_rad_s[1] - before == doctest::Approx(0.05).epsilon(0.02));  // of 1 kg m2
  CHECK(bench.sensors.joints[1].motor_effort_Nm == doctest::Approx(0.5));
  CHECK(bench.sensors.joints[1].drive == DriveState::enabled);
  bench.run(position(0.3), position(-0.4), 3000);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(0.3).epsilon(0.01));
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(-0.4).epsilon(0.01));
  bench.run(velocity(0.2), velocity(-0.2), 2000);
  CHECK(bench.world.truth().velocity_rad_s[0] > 0.15);  // of a loop without an integral
  CHECK(bench.world.truth().velocity_rad_s[1] < -0.15);
  const JointActuation spring{
      .position_rad = 0, .stiffness_Nm_per_rad = 20, .damping_Nms_per_rad = 9, .mode = ActuationMode::impedance};
  bench.run(spring, spring, 4000);
  CHECK(std::abs(bench.sensors.joints[1].position_rad) < 0.01);
}

TEST_CASE("Every output type drives the amplifier that takes it, in both directions") {
  for (const PwmOutput output : {PwmOutput::pwm_dir, PwmOutput::dir_pwm, PwmOutput::up_down, PwmOutput::pdm}) {
    CAPTURE(static_cast<int>(output));
    HostMot2Settings settings = two_axes();
    for (DriveWiring& drive : settings.drives) drive.output = output;
    Bench bench(settings);
    bench.run(effort(0.4), effort(-0.4), 20);
    const double first = bench.world.truth().velocity_rad_s[0], second = bench.world.truth().velocity_rad_s[1];
    bench.run(effort(0.4), effort(-0.4), 100);
    CHECK(bench.world.truth().velocity_rad_s[0] - first == doctest::Approx(0.04).epsilon(0.01));
    CHECK(bench.world.truth().velocity_rad_s[1] - second == doctest::Approx(-0.04).epsilon(0.01));
  }
}

TEST_CASE("An amplifier of voltage gives the same effort, against the motor's own voltage") {
  HostMot2Settings settings = two_axes();
  for (DriveWiring& drive : settings.drives) {
    drive.amplifier.kind = AmplifierSettings::Kind::voltage;
    drive.amplifier.full = 24;
    drive.amplifier.winding_Ohm = 2;
  }
  Bench bench(settings);
  bench.run(effort(0.4), effort(-0.4), 20);
  const double first = bench.world.truth().velocity_rad_s[0];
  bench.run(effort(0.4), effort(-0.4), 1000);
  CHECK(bench.world.truth().velocity_rad_s[0] - first == doctest::Approx(0.4).epsilon(0.02));
}

TEST_CASE("A velocity goes to an amplifier of velocity as it is, and its own loop gives the effort that is asked for") {
  HostMot2Settings settings = two_axes();
  for (DriveWiring& drive : settings.drives) {
    drive.amplifier.kind = AmplifierSettings::Kind::velocity;
    drive.amplifier.full = 100;  // of the motor: 10 rad/s of the joint
    drive.amplifier.gain_Nms_per_rad = 8;
  }
  Bench bench(settings);
  bench.run(velocity(0.2), velocity(-0.2), 2000);
  CHECK(bench.world.truth().velocity_rad_s[0] == doctest::Approx(0.2).epsilon(0.02));  // its loop ends at the command
  CHECK(bench.world.truth().velocity_rad_s[1] == doctest::Approx(-0.2).epsilon(0.02));
  bench.run(effort(0.4), effort(-0.4), 20);
  const double first = bench.world.truth().velocity_rad_s[0];
  bench.run(effort(0.4), effort(-0.4), 500);
  CHECK(bench.world.truth().velocity_rad_s[0] - first == doctest::Approx(0.2).epsilon(0.05));
  bench.run(position(0.3), position(-0.4), 4000);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(0.3).epsilon(0.01));
  bench.run(effort(100), effort(0), 20);  // no more than 5 A, 2 Nm
  CHECK(bench.count("limited") > 15);
  CHECK(bench.sensors.joints[0].motor_effort_Nm <= 2.01);
  bench.run(off, off, 20);
  CHECK(bench.sensors.joints[0].drive == DriveState::ready);
}

TEST_CASE("No more current flows than the amplifier's limit, and cuts are counted") {
  Bench bench;
  bench.run(effort(100), effort(-100), 20);
  CHECK(bench.count("limited") > 30);
  double worst = 0;
  for (int i = 0; i < 50; ++i) {
    bench.run(effort(100), effort(-100), 1);
    worst = std::max(worst, std::abs(bench.world.truth().motor_torque_Nm[0]));
  }
  CHECK(worst <= 2.0001);  // 5 A of 0.4 Nm/A
  CHECK(worst > 1.99);
  bench.run(effort(std::nan("")), effort(0), 5);
  CHECK(bench.world.truth().motor_torque_Nm[0] == 0);
}

TEST_CASE("What does not fit is told before anything moves") {
  SUBCASE("no board") {
    Bench bench;
    bench.world.machine().wire(0).pulled = true;
    CHECK(has(bench.why_not(), "board 'io' at 192.168.1.121 does not answer"));
  }
  SUBCASE("another board") {
    HostMot2Settings there = two_axes();
    there.boards[0].card = "7I92";
    Bench bench(two_axes(), &there);
    CHECK(has(bench.why_not(), "board 'io' at 192.168.1.121 is a 7I92, the configuration says 7I96"));
  }
  SUBCASE("an encoder that its firmware has not") {
    HostMot2Settings settings = two_axes();
    settings.drives[1].encoder = 2;
    settings.drives[1].encoder_place = {.file = "robot.json", .line = 12, .column = 30, .message = {}};
    const HostMot2Settings there = two_axes();
    Bench bench(settings, &there);
    CHECK(bench.why_not() ==
          "robot.json:12:30: board 'io' at 192.168.1.121 has no encoder 2: its firmware has 3 ioports, 2 encoders, 2 "
          "pwmgens, 1 watchdog; also there: phase-locked loop");
  }
  SUBCASE("a PWM that its firmware has not") {
    HostMot2Settings settings = two_axes();
    settings.drives[1].pwm = 7;
    const HostMot2Settings there = two_axes();
    Bench bench(settings, &there);
    CHECK(has(bench.why_not(), "has no pwm 7"));
  }
  SUBCASE("a pin that is an encoder's") {
    HostMot2Settings settings = two_axes();
    settings.drives[0].brake = high(9);
    Bench bench(settings);
    CHECK(has(bench.why_not(), "has encoder 1 of drive 'knee' on pin 9: choose another pin"));
  }
  SUBCASE("a pin that is not there") {
    HostMot2Settings settings = two_axes();
    settings.drives[0].brake = high(51);
    const HostMot2Settings there = two_axes();
    Bench bench(settings, &there);
    CHECK(has(bench.why_not(), "has no pin 51, only 0..50"));
  }
  SUBCASE("a watchdog that would bite between two ticks") {
    HostMot2Settings settings = two_axes();
    settings.watchdog_s = 0.0019;
    CHECK_THROWS_WITH_AS(Bench{settings},
                         "robot.json: plant.hm2-eth.watchdog_s must be at least two periods of the bus, each of "
                         "which pets it",
                         InputError);
  }
  CHECK(Bench().why_not().empty());
}

TEST_CASE("A loop whose first tick comes late begins with a reading of that tick") {
  Bench bench;
  bench.world.start();
  for (int i = 0; i < 40; ++i) bench.world.step(ms);
  bench.world.read(bench.sensors);
  CHECK(bench.sensors.joints[0].time_ns == 40 * ms);
}

TEST_CASE("When the driver falls silent the board releases its outputs, and obeys again after reset and enable") {
  Bench bench;
  bench.run(effort(0.2), velocity(0.2), 100);
  CHECK(bench.world.machine().enabled(0));
  CHECK(bench.world.machine().enabled(1));
  bench.world.silent = true;
  bench.run(effort(0.2), velocity(0.2), 8);
  CHECK_FALSE(bench.board().bitten());
  bench.run(effort(0.2), velocity(0.2), 1);  // 10 ms after the last word
  CHECK(bench.board().bitten());
  CHECK_FALSE(bench.world.machine().enabled(0));
  CHECK_FALSE(bench.world.machine().enabled(1));
  const double speed = bench.world.truth().velocity_rad_s[0];
  bench.run(effort(0.2), velocity(0.2), 50);
  CHECK(bench.world.truth().velocity_rad_s[0] == doctest::Approx(speed));
  bench.world.silent = false;
  bench.run(effort(0.2), velocity(0.2), 50);
  CHECK(bench.board().bitten());  // by itself it stays off
  CHECK(bench.sensors.joints[0].drive == DriveState::fault);
  CHECK(bench.count("bites") == 1);
  bench.order(0, DriveOrder::reset);
  bench.order(1, DriveOrder::reset);
  bench.run(effort(0.2), velocity(0.2), 20);
  CHECK_FALSE(bench.board().bitten());
  CHECK(bench.sensors.joints[0].drive == DriveState::off);
  CHECK_FALSE(bench.world.machine().enabled(0));
  bench.order(0, DriveOrder::enable);
  bench.order(1, DriveOrder::enable);
  bench.run(effort(0.2), velocity(0.2), 20);
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
  CHECK(bench.world.machine().enabled(0));
  CHECK(bench.world.machine().enabled(1));
}

TEST_CASE("A bus that is slower than the control is asked at its own period, and its readings have their own times") {
  HostMot2Settings settings = two_axes();
  settings.period_s = 0.01;
  settings.watchdog_s = 0.05;
  Bench bench(settings);
  bench.run(position(0.3), position(-0.3), 1000);
  CHECK(bench.count("sent") == 102);  // before the loop, in its first tick, and every 10 ms
  CHECK(bench.count("lost") == 0);
  CHECK(bench.count("bites") == 0);
  const std::uint32_t sequence = bench.sensors.joints[0].sequence;
  const std::int64_t time_ns = bench.sensors.joints[0].time_ns;
  CHECK(bench.sensors.time_ns - time_ns == ms);  // at a whole multiple of its period it is as fresh as ever
  bench.run(position(0.3), position(-0.3), 9);
  CHECK(bench.sensors.joints[0].sequence == sequence);
  CHECK(bench.sensors.joints[0].time_ns == time_ns);
  bench.run(position(0.3), position(-0.3), 1);
  CHECK(bench.sensors.joints[0].sequence == sequence + 1);
  CHECK(bench.sensors.joints[0].time_ns == time_ns + 10 * ms);
  bench.run(position(0.3), position(-0.3), 3000);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(0.3).epsilon(0.01));
  bench.world.silent = true;
  bench.run(position(0), position(0), 45);
  CHECK_FALSE(bench.board().bitten());
  bench.run(position(0), position(0), 10);
  CHECK(bench.board().bitten());
  settings.period_s = 0.0015;
  CHECK_THROWS_WITH_AS(Bench{settings},
                       "robot.json: plant.hm2-eth.period_s must be a whole multiple of the control period", InputError);
}

TEST_CASE("At the end the amplifiers are off at once") {
  Bench bench;
  bench.run(effort(0.2), effort(0.2), 50);
  bench.world.driver().close();
  bench.board().pass(1);
  bench.board().pass(ms);
  CHECK(bench.board().bitten());
  CHECK_FALSE(bench.world.machine().enabled(0));
}

TEST_CASE("A tick neither allocates nor takes more than one datagram each way") {
  Bench bench;
  bench.run(effort(0.1), position(0.1), 50);
  CHECK(bench.count("sent") == 51);  // with the one before the loop
  CHECK(bench.count("received") == 51);
  CHECK(bench.world.cable(0).sent < 160);
  CHECK(bench.world.cable(0).received < 80);
  bench.world.cable(0).holds = true;
  Plant& driver = bench.world.driver();
  driver.write(bench.actuation);
  long allocations = 0;
  for (int i = 0; i < 10; ++i) {
    bench.world.cable(0).answer();
    if (i == 5) bench.order(0, DriveOrder::disable), bench.order(1, DriveOrder::reset);
    const testing::AllocationCount heap;
    driver.read(bench.sensors);
    driver.write(bench.actuation);
    allocations += heap.count();
  }
  CHECK(allocations == 0);
  bench.world.cable(0).answer();
  driver.read(bench.sensors);
  CHECK(bench.count("received") == 62);
  CHECK(bench.sensors.joints[0].drive == DriveState::off);
}

TEST_CASE("The same modules are driven through the registers of a card on PCI") {
  HostMot2Settings settings = two_axes();
  settings.boards = {{.name = "io", .resource = "hostmot2_resource", .card = "5I20"}};
  for (DriveWiring& drive : settings.drives) drive.home = Home::power_on;
  Bench bench(settings);
  bench.run(position(0.3), position(-0.4), 3000);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(0.3).epsilon(0.01));
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(-0.4).epsilon(0.01));
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
  bench.world.silent = true;
  bench.run(position(0.3), position(-0.4), 12);
  CHECK(bench.board().bitten());
  bench.world.silent = false;
  bench.run(position(0.3), position(-0.4), 3);
  CHECK(drive_code_words(bench.sensors.joints[0].code) == "its board's watchdog let go");
  settings.boards[0].card = "4I65";
  HostMot2Settings there = settings;
  there.boards[0].card = "5I20";
  Bench other(settings, &there);
  CHECK(has(other.why_not(), "board 'io' at hostmot2_resource is a MESA5I20, the configuration says 4I65"));
  std::remove("hostmot2_resource");
}

}  // namespace kadans::hostmot2
