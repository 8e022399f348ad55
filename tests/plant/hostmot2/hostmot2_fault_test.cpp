// What may go wrong between the driver and the emulated boards, and on them.
#include "hostmot2_bench.h"

namespace kadans::hostmot2 {

using namespace bench;

namespace {

std::string_view words(const Bench& bench, std::size_t joint) {
  return drive_code_words(bench.sensors.joints[joint].code);
}

}  // namespace

TEST_CASE("Datagrams that are lost, late and doubled are counted, and no false reading is taken") {
  HostMot2Settings settings = two_axes();
  settings.watchdog_s = 0.02;  // the bench looks twice a tick
  Bench bench(settings);
  bench.run(effort(0), effort(0), 50);
  bench.world.machine().wire(0).faults = {.lost = 0.05, .duplicated = 0.05, .late = 0.05};
  double worst_rad = -1, worst_Nm = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double Nm = 0.5 * std::sin(0.01 * i);
    bench.run(effort(Nm), effort(-Nm), 1);
    const PlantTruth& truth = bench.world.truth();
    for (std::size_t k = 0; k < 2; ++k) {
      const double slack = 1e-3 + 0.02 * std::abs(truth.velocity_rad_s[k]);
      worst_rad = std::max(worst_rad, std::abs(bench.sensors.joints[k].position_rad - truth.position_rad[k]) - slack);
      worst_Nm = std::max(worst_Nm, std::abs(truth.motor_torque_Nm[k]));
    }
  }
  CHECK(bench.count("lost") > 1000);
  CHECK(bench.count("unheard") > 500);
  CHECK(bench.count("unheard") < bench.count("lost"));
  CHECK(bench.count("reordered") > 500);
  CHECK(bench.count("duplicates") > 500);
  CHECK(bench.count("refused") == 0);
  CHECK(bench.count("bites") == 0);
  CHECK(worst_rad < 0);
  CHECK(worst_Nm < 0.51);
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
}

TEST_CASE("Replies that are bent, cut, stretched or of somebody else are no readings") {
  Bench bench;
  bench.run(effort(0), effort(0), 50);
  RandomStream random(3, "hostile");
  auto& wire = bench.world.machine().wire(0);
  const double before_rad = bench.sensors.joints[0].position_rad;
  std::size_t taken = 0;
  for (int i = 0; i < hostile_count(); ++i) {
    const std::uint32_t sequence = bench.sensors.joints[0].sequence;
    wire.replace = [&](std::vector<std::uint8_t>& bytes) {
      switch (random.next() % 4) {
        case 0:
          bytes.resize(random.next() % bytes.size());
          break;
        case 1:
          bytes.resize(bytes.size() + 1 + random.next() % 900);
          break;
        case 2:
          for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
          break;
        default:
          bytes[random.next() % 8] ^= static_cast<std::uint8_t>(1U << random.next() % 8);  // its number, or its cookie
          break;
      }
    };
    bench.run(effort(0.01), effort(0.01), 1);
    taken += bench.sensors.joints[0].sequence - sequence;
    if (i % 3 == 2) {
      wire.replace = nullptr;
      bench.run(effort(0), effort(0), 1);
    }
  }
  CHECK(taken == 0);
  CHECK(bench.count("refused") > static_cast<std::uint64_t>(hostile_count() / 2));
  CHECK(std::abs(bench.sensors.joints[0].position_rad - bench.world.truth().position_rad[0]) < 0.01);
  CHECK(std::abs(before_rad - 0.1) < 0.01);
}

TEST_CASE(
    "A cable that is pulled and put back: the board releases its outputs, the joints say so, reset brings them back") {
  Bench bench;
  bench.run(effort(0.1), velocity(0.1), 100);
  auto& wire = bench.world.machine().wire(0);
  wire.pulled = true;
  bench.run(effort(0.1), velocity(0.1), 8);
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);  // nobody can know yet
  bench.run(effort(0.1), velocity(0.1), 5);
  CHECK(bench.board().bitten());
  CHECK_FALSE(bench.world.machine().enabled(0));
  CHECK(bench.sensors.joints[0].drive == DriveState::fault);
  CHECK(words(bench, 0) == "its board does not answer");
  wire.pulled = false;
  bench.run(effort(0.1), velocity(0.1), 20);
  CHECK_FALSE(bench.world.machine().enabled(0));
  for (const std::size_t joint : {0U, 1U}) bench.order(joint, DriveOrder::reset);
  bench.run(effort(0.1), velocity(0.1), 10);
  for (const std::size_t joint : {0U, 1U}) bench.order(joint, DriveOrder::enable);
  bench.run(effort(0.1), velocity(0.1), 10);
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
  CHECK(bench.sensors.joints[1].drive == DriveState::enabled);
}

TEST_CASE("A board that lost its power for a moment gives no torque, and is told") {
  Bench bench;
  bench.run(effort(0.1), velocity(0.1), 100);
  bench.world.machine().switch_power();
  bench.run(effort(0.1), velocity(0.1), 5);
  CHECK_FALSE(bench.world.machine().enabled(0));
  CHECK(words(bench, 0) == "its board lost its settings");
  bench.order(0, DriveOrder::reset);
  bench.run(effort(0.1), velocity(0.1), 5);
  bench.order(0, DriveOrder::enable);
  bench.run(effort(0.1), velocity(0.1), 20);
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
  CHECK(bench.sensors.joints[1].drive == DriveState::fault);  // each joint is reset for itself
}

TEST_CASE("An amplifier's fault line stops its joint alone") {
  Bench bench;
  bench.run(effort(0.1), effort(0.1), 100);
  bench.world.machine().fail_amplifier(0, true);
  bench.run(effort(0.1), effort(0.1), 5);
  CHECK(words(bench, 0) == "its amplifier reports a fault");
  CHECK(bench.sensors.joints[1].drive == DriveState::enabled);
  bench.order(0, DriveOrder::reset);
  bench.run(effort(0.1), effort(0.1), 5);
  CHECK(bench.sensors.joints[0].drive == DriveState::fault);  // it is still there
  bench.world.machine().fail_amplifier(0, false);
  bench.run(effort(0.1), effort(0.1), 5);
  bench.order(0, DriveOrder::reset);
  bench.run(effort(0.1), effort(0.1), 5);
  bench.order(0, DriveOrder::enable);
  bench.run(effort(0.1), effort(0.1), 5);
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
}

TEST_CASE("At a limit switch a joint is pushed back only") {
  HostMot2Settings settings = two_axes();
  settings.drives[0].high = high(23);
  settings.drives[0].low = low(24);
  Bench bench(settings);
  bench.world.machine().block(0, -0.5, 0.2);
  for (int i = 0; i < 1000 && bench.sensors.joints[0].position_rad < 0.2; ++i) bench.run(velocity(0.3), off, 10);
  bench.run(effort(1), off, 5);
  CHECK(bench.world.truth().motor_torque_Nm[0] == 0);
  bench.run(effort(-1), off, 5);
  CHECK(bench.world.truth().motor_torque_Nm[0] == doctest::Approx(-1).epsilon(0.01));
}

TEST_CASE("A joint looks for its zero: by index, by probe and by switch, and counts from there") {
  for (const Home home : {Home::index, Home::probe, Home::home_switch}) {
    CAPTURE(static_cast<int>(home));
    HostMot2Settings settings = two_axes();
    settings.drives[0].home = home;
    settings.drives[0].home_rad = 0.3;
    settings.drives[0].home_rad_s = 0.4;
    settings.drives[0].home_switch = high(25);
    Bench bench(settings);
    bench.run(effort(0), off, 20);
    CHECK_FALSE(bench.sensors.joints[0].homed);
    CHECK(std::abs(bench.sensors.joints[0].position_rad - bench.world.truth().position_rad[0]) > 0.1);
    bench.order(0, DriveOrder::home);
    bench.run(effort(0), off, 5);
    CHECK(bench.sensors.joints[0].drive == DriveState::homing);
    for (int i = 0; i < 300 && !bench.sensors.joints[0].homed; ++i) bench.run(effort(0), off, 10);
    CHECK(bench.sensors.joints[0].homed);
    bench.run(effort(0), off, 10);
    CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
    CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(bench.world.truth().position_rad[0]).epsilon(0.01));
  }
}

TEST_CASE("A zero that is not found is a fault, and the joint stops") {
  HostMot2Settings settings = two_axes();
  settings.drives[0].home = Home::home_switch;
  settings.drives[0].home_switch = high(25);
  settings.drives[0].home_rad = 50;
  settings.drives[0].home_timeout_s = 0.5;
  Bench bench(settings);
  bench.run(effort(0), off, 20);
  bench.order(0, DriveOrder::home);
  bench.run(effort(0), off, 600);
  CHECK(words(bench, 0) == "its zero was not found");
  CHECK_FALSE(bench.world.machine().enabled(0));
}

TEST_CASE("An encoder that jumps further than the joint can is not believed") {
  HostMot2Settings settings = two_axes();
  settings.drives[0].velocity_max_rad_s = 20;
  Bench bench(settings);
  bench.run(effort(0), effort(0), 50);
  const double before = bench.sensors.joints[0].position_rad;
  bench.board().turn_to(0, 9000);
  bench.run(effort(0), effort(0), 1);
  CHECK(bench.count("strange") == 1);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(before).epsilon(0.01));
}

TEST_CASE("Switches under the soles, inputs and the emergency stop are read") {
  HostMot2Settings settings = two_axes();
  settings.inputs = {{.name = "lid", .board = "io", .pin = low(30)}};
  settings.emergency_board = "io";
  settings.emergency = low(31);
  Bench bench(settings);
  bench.run(off, off, 5);
  CHECK(bench.sensors.channels[0].value == 0);
  CHECK_FALSE(bench.sensors.emergency);
  bench.world.machine().set_sensor("lid", true);
  bench.world.machine().press_emergency(true);
  bench.run(off, off, 5);
  CHECK(bench.sensors.channels[0].value == 1);
  CHECK(bench.sensors.emergency);
  CHECK(bench.sensors.channels[0].sequence >= 9);
}

TEST_CASE("A brake opens with its drive, closes without, and obeys orders") {
  HostMot2Settings settings = two_axes();
  settings.drives[0].brake = high(26);
  Bench bench(settings);
  bench.run(off, off, 5);
  CHECK(bench.sensors.joints[0].braked);
  CHECK(bench.board().level(26) == 0);
  bench.run(effort(0.1), off, 5);
  CHECK_FALSE(bench.sensors.joints[0].braked);
  CHECK(bench.board().level(26) == 1);
  bench.order(0, DriveOrder::brake);
  bench.run(effort(0.1), off, 5);
  CHECK(bench.board().level(26) == 0);
  bench.order(0, DriveOrder::release);
  bench.run(off, off, 5);
  CHECK(bench.board().level(26) == 1);
  bench.world.silent = true;
  bench.run(off, off, 20);
  CHECK(bench.board().level(26) == 0);  // the watchdog closes it
}

}  // namespace kadans::hostmot2
