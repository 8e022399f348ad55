// The driver and the emulated servos, on virtual time, with an ideal model behind them.
#include "plant/dynamixel/dynamixel_plant.h"

#include <cmath>

#include <doctest/doctest.h>

#include "kadans/plant/ideal_world.h"
#include "kadans/signal/input_error.h"
#include "kadans/testing/allocation_count.h"
#include "plant/dynamixel/emulator/servo_world.h"
#include "plant/two_joints.h"

namespace kadans::dynamixel {
namespace {

constexpr std::int64_t ms = 1'000'000;

DynamixelSettings two_servos(const char* model = "XM430-W210") {
  DynamixelSettings settings;
  settings.ports = {{.name = "bus", .device = "the bus", .baud = 1'000'000}};
  settings.servos = {{.drive = "hip", .port = "bus", .id = 1, .model = find_model(model), .zero_pulse = 1000},
                     {.drive = "knee", .port = "bus", .id = 2, .model = find_model(model), .reversed = true}};
  return settings;
}

PlantSite site() { return {.file = "robot.json", .layout = {.robot = "walker", .joints = {"hip", "knee"}}}; }

struct Bench {
  explicit Bench(const DynamixelSettings& settings = two_servos())
      : world(std::make_unique<IdealWorld>(test::two_joints(), PlantSettings{.position_rad = {0.1, -0.2}}), settings,
              site()) {}

  // Lets the joints do this for so long.
  void run(const JointActuation& first, const JointActuation& second, int milliseconds) {
    actuation.joint_count = 2;
    actuation.joints[0] = first;
    actuation.joints[1] = second;
    for (int i = 0; i < milliseconds; ++i) {
      world.read(sensors);
      world.write(actuation);
      world.step(ms);
    }
    world.read(sensors);
  }
  void order(std::size_t joint, DriveOrder what) {
    actuation.drives[joint] = {what, static_cast<std::uint8_t>(actuation.drives[joint].number + 1)};
  }
  std::uint64_t count(std::string_view name) {
    for (const PlantCount& one : world.driver().link_counts()) {
      if (one.name == name) return one.value;
    }
    return 0;
  }
  std::string why_not() {
    try {
      world.start();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  dynamixel::ServoWorld world;
  ActuationFrame actuation;
  SensorFrame sensors;
};

constexpr JointActuation off{};
JointActuation effort(double Nm) { return {.effort_Nm = Nm, .mode = ActuationMode::effort}; }
JointActuation position(double rad) { return {.position_rad = rad, .mode = ActuationMode::position}; }
JointActuation velocity(double rad_s) { return {.velocity_rad_s = rad_s, .mode = ActuationMode::velocity}; }

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("Servos are read in the joints' coordinates") {
  Bench bench;
  bench.run(off, off, 10);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(0.1).epsilon(0.01));
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(-0.2).epsilon(0.01));
  CHECK(bench.sensors.joints[0].drive == DriveState::ready);
  CHECK(bench.sensors.joints[0].temperature_C == doctest::Approx(30).epsilon(0.1));
  CHECK(bench.sensors.supply_V == doctest::Approx(12));
  CHECK(bench.count("lost") == 0);
  CHECK(bench.count("corrupt") == 0);
  const std::uint32_t before = bench.sensors.joints[0].sequence;
  bench.run(off, off, 20);
  CHECK(bench.sensors.joints[0].sequence - before >= 6);  // the bus needs three control periods
  CHECK(bench.sensors.joints[0].sequence - before <= 7);
  CHECK(bench.sensors.joints[0].time_ns > 24 * ms);
  CHECK(bench.sensors.joints[0].time_ns < 30 * ms);
}

TEST_CASE("Position, velocity, effort and impedance reach servos that change their modes on the way") {
  Bench bench;
  bench.run(position(0.5), position(-0.7), 50);
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(0.5).epsilon(0.01));
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(-0.7).epsilon(0.01));
  bench.run(velocity(0.6), velocity(-0.6), 30);
  const double from = bench.sensors.joints[1].position_rad;
  bench.run(velocity(0.6), velocity(-0.6), 100);
  CHECK(bench.sensors.joints[1].position_rad - from == doctest::Approx(-0.06).epsilon(0.1));
  bench.run(off, velocity(0), 50);
  bench.run(effort(0), effort(0.5), 20);
  const double before = bench.world.truth().velocity_rad_s[1];
  bench.run(effort(0), effort(0.5), 100);
  CHECK(bench.world.truth().velocity_rad_s[1] - before == doctest::Approx(0.05).epsilon(0.02));  // of 1 kg m2
  CHECK(bench.sensors.joints[1].motor_effort_Nm == doctest::Approx(0.5).epsilon(0.02));
  const JointActuation spring{
      .position_rad = 0, .stiffness_Nm_per_rad = 20, .damping_Nms_per_rad = 9, .mode = ActuationMode::impedance};
  bench.run(spring, spring, 4000);
  CHECK(std::abs(bench.sensors.joints[1].position_rad) < 0.01);
}

TEST_CASE("Servos without currents are driven by PWM") {
  for (const char* model : {"XL430-W250", "MX-28"}) {
    CAPTURE(model);
    Bench bench(two_servos(model));
    bench.run(effort(0.3), position(0), 20);
    const double before = bench.world.truth().velocity_rad_s[0];
    bench.run(effort(0.3), position(0), 100);
    CHECK(bench.world.truth().velocity_rad_s[0] - before == doctest::Approx(0.03).epsilon(0.1));
    CHECK(std::abs(bench.sensors.joints[1].position_rad) < 0.01);
    CHECK(bench.count("strange") == 0);
  }
}

TEST_CASE("Small servos show fewer registers, and are driven all the same") {
  Bench bench(two_servos("XL330-M288"));
  bench.run(effort(0.1), position(0.3), 20);
  const double before = bench.world.truth().velocity_rad_s[0];
  bench.run(effort(0.1), position(0.3), 100);
  CHECK(bench.world.truth().velocity_rad_s[0] - before == doctest::Approx(0.01).epsilon(0.05));
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(0.3).epsilon(0.01));
}

TEST_CASE("A joint that turns past the end of its servo's count goes on") {
  DynamixelSettings settings = two_servos();
  settings.servos[0].zero_pulse = 4090;
  Bench bench(settings);
  for (double rad = 0.1; rad < 3; rad += 0.1) bench.run(position(rad), off, 20);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(bench.world.truth().position_rad[0]).epsilon(0.01));
  bench.run(effort(0), off, 50);  // another mode counts within one turn
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(bench.world.truth().position_rad[0]).epsilon(0.01));
  const double before_rad = bench.world.truth().position_rad[0];
  for (int i = 0; i < 50; ++i) {
    bench.run(position(1.5), off, 1);
    CHECK(bench.world.truth().position_rad[0] >= 1.49);  // no other turn is aimed at, not for one cycle
    CHECK(bench.world.truth().position_rad[0] <= before_rad + 0.01);
  }
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(1.5).epsilon(0.01));
}

TEST_CASE("What does not fit is told before anything moves") {
  SUBCASE("a servo that is not there") {
    Bench bench;
    bench.world.servos().servo(1).unplug(true);
    const std::string why = bench.why_not();
    CHECK(has(why, "servo 2 ('knee') on the bus does not answer at 1000000 baud; these do: 1"));
  }
  SUBCASE("another model") {
    Bench bench;
    bench.world.servos().servo(0) = EmulatedServo({.id = 1, .model = 1020});
    CHECK(has(bench.why_not(), "servo 1 ('hip') on the bus is XM430-W350, the configuration says XM430-W210"));
  }
  SUBCASE("a hardware error") {
    Bench bench;
    bench.world.servos().servo(0).break_down(0x20);
    CHECK(has(bench.why_not(), "reports a hardware error: overload"));
  }
  SUBCASE("an id twice") {
    Bench bench;
    bench.world.servos().bus(0).servos.emplace_back(EmulatedServo::Settings{.id = 2});
    bench.world.servos().bus(0).servos.back().stands(1.5, 0, 0, 12);
    CHECK(has(bench.why_not(), "servo 2 ('knee') on the bus answers garbage: two servos have this id"));
  }
  SUBCASE("another baud rate") {
    DynamixelSettings settings = two_servos();
    Bench bench(settings);
    bench.world.servos().servo(0) = EmulatedServo({.id = 1, .baud_code = 1});
    CHECK(has(bench.why_not(), "servo 1 ('hip') on the bus does not answer at 1000000 baud; these do: 2"));
  }
  CHECK(Bench().why_not().empty());
}

TEST_CASE("Firmware without fast sync read is read one servo after the other") {
  Bench bench;
  bench.world.servos().servo(0) = EmulatedServo({.id = 1, .firmware = 44, .zero_pulse = 1000});
  bench.run(position(0.5), position(-0.7), 60);
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(0.5).epsilon(0.01));
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(-0.7).epsilon(0.01));
  CHECK(bench.count("lost") == 0);
  // An answer that comes again is not that of the next servo.
  bench.world.port(0).twice = status_bytes_min + IndirectLayout(*find_model("XM430-W210")).read_bytes();
  const std::uint32_t first = bench.sensors.joints[0].sequence, second = bench.sensors.joints[1].sequence;
  const std::uint64_t corrupt = bench.count("corrupt");
  bench.run(position(0.5), position(-0.7), 60);
  CHECK(bench.count("corrupt") > corrupt + 5);
  CHECK(bench.count("lost") == 0);
  CHECK(bench.sensors.joints[1].sequence - second == bench.sensors.joints[0].sequence - first);
}

TEST_CASE("A servo whose mode changes has no torque, and gets no goal, until a reading in the new mode is here") {
  Bench bench;
  bench.run(position(0.1), position(-0.2), 50);
  const EmulatedServo& servo = bench.world.servos().servo(0);
  const auto mode = [&] {
    std::vector<std::uint8_t> bytes;
    (void)servo.read(operating_mode.address, 1, bytes);
    return bytes.at(0);
  };
  std::uint64_t changed_in = 0, torque_in = 0;
  for (int i = 0; i < 60; ++i) {
    const bool torque_before = servo.torque();
    const std::uint8_t mode_before = mode();
    bench.run(velocity(0.5), position(-0.2), 1);
    if (mode() != mode_before) {
      CHECK(mode() == static_cast<std::uint8_t>(OperatingMode::velocity));
      CHECK_FALSE(torque_before);  // a reading has said so before the mode is written
      changed_in = bench.count("cycles");
    }
    if (servo.torque() && !torque_before && torque_in == 0) torque_in = bench.count("cycles");
  }
  CHECK((changed_in > 0 && torque_in >= changed_in + 2));  // in between, where it stands is read in the new mode
}

TEST_CASE("A servo that overheats lets go, says so in words, and comes back after reset and enable") {
  Bench bench;
  bench.run(position(0), position(0), 50);
  bench.world.servos().servo(1).heat_to(95);
  bench.run(position(0), position(0), 10);
  CHECK(bench.sensors.joints[1].drive == DriveState::fault);
  CHECK(bench.sensors.joints[1].code == 4);
  CHECK(drive_code_words(bench.sensors.joints[1].code) == "overheating");
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
  bench.order(1, DriveOrder::reset);
  bench.run(position(0), position(0), 1000);
  CHECK(bench.sensors.joints[1].drive == DriveState::off);
  bench.order(1, DriveOrder::enable);
  bench.run(position(0), position(0), 50);
  CHECK(bench.sensors.joints[1].drive == DriveState::enabled);
  CHECK(bench.sensors.joints[1].code == 0);
}

TEST_CASE("A servo that drops off the bus costs the others a few readings, and no more") {
  Bench bench;
  bench.run(position(0), position(0), 50);
  bench.world.servos().servo(0).unplug(true);
  bench.run(position(0), position(0.4), 200);
  CHECK(bench.sensors.joints[0].drive == DriveState::fault);
  CHECK(drive_code_words(bench.sensors.joints[0].code) == "does not answer");
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(0.4).epsilon(0.01));
  const std::uint64_t lost = bench.count("lost");
  CHECK(lost < 20);
  bench.run(position(0), position(0.4), 200);
  CHECK(bench.count("lost") == lost);
  bench.world.servos().servo(0).unplug(false);
  bench.order(0, DriveOrder::reset);
  bench.run(position(0), position(0.4), 100);
  bench.order(0, DriveOrder::enable);
  bench.run(position(0), position(0.4), 50);
  CHECK(bench.sensors.joints[0].drive == DriveState::enabled);
}

TEST_CASE("A servo that lost its power for a moment is not believed, and is told") {
  Bench bench;
  bench.run(position(0.3), position(0.3), 50);
  SUBCASE("and answers at once") { bench.world.servos().servo(0).switch_power(); }
  SUBCASE("and begins anew for a while") { bench.world.servos().servo(0).reboot(); }
  bool believed = true;
  for (int i = 0; i < 400; ++i) {
    bench.run(position(0.3), position(0.3), 1);
    believed = believed && std::abs(bench.sensors.joints[0].position_rad - 0.3) < 0.02;
  }
  CHECK(believed);
  CHECK(bench.sensors.joints[0].drive == DriveState::fault);
  CHECK(bench.sensors.joints[1].drive == DriveState::enabled);
}

TEST_CASE("When the driver falls silent the servos stop, and obey again when it speaks") {
  Bench bench;
  bench.run(effort(0.2), velocity(0.5), 100);
  bench.world.silent = true;
  bench.run(effort(0.2), velocity(0.5), 90);
  CHECK_FALSE(bench.world.servos().any_watchdog_tripped());
  bench.run(effort(0.2), velocity(0.5), 30);  // 0.1 s, in steps of 20 ms
  CHECK(bench.world.servos().any_watchdog_tripped());
  const double speed = bench.world.truth().velocity_rad_s[0];
  bench.run(effort(0.2), velocity(0.5), 100);
  CHECK(bench.world.truth().velocity_rad_s[0] == doctest::Approx(speed));
  CHECK(bench.world.truth().velocity_rad_s[1] == doctest::Approx(0));
  bench.world.silent = false;
  bench.run(velocity(0), velocity(0.5), 100);
  CHECK_FALSE(bench.world.servos().any_watchdog_tripped());
  CHECK(bench.world.truth().velocity_rad_s[1] == doctest::Approx(0.5).epsilon(0.02));
}

TEST_CASE("At the end the servos have no torque") {
  Bench bench;
  bench.run(position(0.3), position(0.3), 50);
  CHECK(bench.world.servos().any_torque());
  bench.world.driver().close();
  CHECK_FALSE(bench.world.servos().any_torque());
}

TEST_CASE("With bytes lost and bent on the wire no false reading is taken and no torque is beyond its limit") {
  Bench bench;
  bench.run(effort(0), effort(0), 50);
  bench.world.servos().bus(0).faults = {.corrupt = 0.002, .lost = 0.002};
  double worst_rad = -1, worst_Nm = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double Nm = 0.5 * std::sin(0.01 * i);
    bench.run(effort(Nm), effort(-Nm), 1);
    const PlantTruth& truth = bench.world.truth();
    for (std::size_t k = 0; k < 2; ++k) {
      // A reading is up to a few cycles old.
      const double slack = 0.01 + 0.05 * std::abs(truth.velocity_rad_s[k]);
      worst_rad = std::max(worst_rad, std::abs(bench.sensors.joints[k].position_rad - truth.position_rad[k]) - slack);
      worst_Nm = std::max(worst_Nm, std::abs(truth.motor_torque_Nm[k]));
      if (bench.sensors.joints[k].drive == DriveState::fault) bench.order(k, DriveOrder::reset);
      if (bench.sensors.joints[k].drive == DriveState::off) bench.order(k, DriveOrder::enable);
    }
  }
  CHECK(bench.count("corrupt") > 100);
  CHECK(bench.count("lost") > 100);
  CHECK(worst_rad < 0);
  CHECK(worst_Nm < 0.51);
}

TEST_CASE("The cycle takes no more than its bytes and the adapter do, as computed beforehand") {
  Bench bench;
  const CycleNeed need = cycle_need(two_servos(), two_servos().ports[0]);
  bench.run(position(0), position(0), 50);
  const std::size_t before = bench.world.port(0).sent + bench.world.port(0).received;
  bench.run(position(0), position(0), 2);
  CHECK(bench.world.port(0).sent + bench.world.port(0).received - before == need.bytes);
  CHECK(bench.world.cycle_ns <= need.needed_ns);
  CHECK(bench.world.cycle_ns >= need.wire_ns);
  bench.world.servos().bus(0).set_usb_latency(0);  // then the bytes' own time is nearly all of it
  bench.run(position(0), position(0), 6);
  CHECK(5 * bench.world.cycle_ns <= 6 * need.wire_ns);
  DynamixelSettings many{.ports = {{.name = "bus", .device = "the bus", .baud = 3'000'000}}};
  for (std::uint32_t id = 0; id < 20; ++id)
    many.servos.push_back({.drive = "", .port = "bus", .id = id, .model = find_model("XM430-W350")});
  CHECK(cycle_need(many, many.ports[0]).bytes == 14 + 20 * 14 + 34 + 8 + 20 * 19);
  CHECK(bus_period_ns(many, ms) == 4 * ms);
}

TEST_CASE("Neither the tick nor a cycle of a serial port allocates") {
  // Answers of both servos, as they stand still, to whatever is asked.
  class StillPort final : public SerialPort {
   public:
    bool send(Octets) noexcept override {
      asked_ = true;
      return true;
    }
    std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override {
      now_ = until_ns;
      if (!std::exchange(asked_, false)) return 0;
      std::array<std::uint8_t, 8 + 2 * 19> bytes{0xFF, 0xFF, 0xFD, 0x00, 0xFE, 1 + 2 * 19, 0, 0x55};
      for (std::size_t i = 0; i < 2; ++i) {
        std::uint8_t* const block = bytes.data() + 8 + 19 * i;
        block[1] = static_cast<std::uint8_t>(i + 1);
        block[2 + 12] = 120;
        block[2 + 14] = 30;
        const std::uint16_t crc = crc16({bytes.data(), 8 + 19 * i + 17});
        block[17] = static_cast<std::uint8_t>(crc);
        block[18] = static_cast<std::uint8_t>(crc >> 8);
      }
      std::ranges::copy(bytes, into.begin());
      return bytes.size();
    }
    void discard() noexcept override {}
    std::int64_t now_ns() const noexcept override { return now_; }

   private:
    std::int64_t now_ = 0;
    bool asked_ = false;
  };
  StillPort port;
  const DynamixelSettings settings = two_servos();
  PortCycle cycle(port, {}, {Servo(settings.servos[0], 0, 0.1), Servo(settings.servos[1], 1, 0.1)});
  Bench bench;
  bench.run(effort(0.1), position(0.1), 50);
  ActuationFrame asked = bench.actuation;
  const testing::AllocationCount heap;
  for (int i = 0; i < 10; ++i) {
    cycle.run(asked);
    bench.world.driver().read(bench.sensors);
    bench.world.driver().write(asked);
  }
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(cycle.sample().counts.answers == 20);
}

}  // namespace kadans::dynamixel
