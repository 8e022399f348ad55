// Emulated servos against the bytes of ROBOTIS' manual, without the driver.
#include <doctest/doctest.h>

#include "kadans/signal/random.h"
#include "plant/dynamixel/emulator/emulated_bus.h"

namespace kadans::dynamixel {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr double rad_a_pulse = 6.283185307179586 / 4096;

void place(EmulatedServo& servo, int pulse) { servo.stands((pulse - 2048) * rad_a_pulse, 0, 0, 12); }

struct Wire {
  EmulatedBus bus{0, 1};
  std::int64_t now_ns = 0;
  Wire() {
    for (const std::uint8_t id : Bytes{1, 2})
      bus.servos.emplace_back(EmulatedServo::Settings{.id = id, .firmware = 38});
    place(bus.servos[0], 166);
    place(bus.servos[1], 2079);
  }
  Bytes ask(const Bytes& packet, std::uint32_t baud = 1'000'000) {
    bus.receive(packet, now_ns, baud);
    now_ns += 100'000'000;
    Bytes answer(1000);
    answer.resize(bus.take(answer, now_ns));
    return answer;
  }
};

const Bytes done{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x04, 0x00, 0x55, 0x00, 0xA1, 0x0C};
const Bytes ping{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x01, 0x19, 0x4E};
const Bytes ping_answer{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x07, 0x00, 0x55, 0x00, 0x06, 0x04, 0x26, 0x65, 0x5D};

}  // namespace

TEST_CASE("Emulated servos answer the manual's packets with the manual's bytes") {
  Wire wire;
  CHECK(wire.ask(ping) == ping_answer);
  CHECK(wire.ask({0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x07, 0x00, 0x02, 0x84, 0x00, 0x04, 0x00, 0x1D, 0x15}) ==
        Bytes{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x08, 0x00, 0x55, 0x00, 0xA6, 0x00, 0x00, 0x00, 0x8C, 0xC0});
  CHECK(wire.ask({0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x09, 0x00, 0x03, 0x74, 0x00, 0x00, 0x02, 0x00, 0x00, 0xCA, 0x89}) ==
        done);
  CHECK(wire.ask({0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x09, 0x00, 0x82, 0x84, 0x00, 0x04, 0x00, 0x01, 0x02, 0xCE, 0xFA}) ==
        Bytes{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x08, 0x00, 0x55, 0x00, 0xA6, 0x00, 0x00, 0x00, 0x8C, 0xC0,
              0xFF, 0xFF, 0xFD, 0x00, 0x02, 0x08, 0x00, 0x55, 0x00, 0x1F, 0x08, 0x00, 0x00, 0xBA, 0xBE});
  CHECK(wire.ask({0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x11, 0x00, 0x83, 0x74, 0x00, 0x04, 0x00,
                  0x01, 0x96, 0x00, 0x00, 0x00, 0x02, 0xAA, 0x00, 0x00, 0x00, 0x82, 0x87})
            .empty());
  Bytes goal;
  (void)wire.bus.servos[1].read(116, 4, goal);
  CHECK(goal == Bytes{0xAA, 0, 0, 0});
  CHECK(wire.ask({0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x08, 0x2F, 0x4E}) == done);
  CHECK(wire.ask(ping).empty());  // it reboots
  for (int i = 0; i < 400; ++i) wire.bus.servos[0].pass(1'000'000);
  CHECK(wire.ask(ping) == ping_answer);
}

TEST_CASE("Emulated servos know their own baud rate, and take the time of their bytes") {
  Wire wire;
  CHECK(wire.ask(ping, 57'600).empty());
  wire.now_ns = 0;
  EmulatedBus bus(0, 1);
  bus.servos.emplace_back(EmulatedServo::Settings{.id = 1, .firmware = 38});
  bus.receive(ping, 0, 1'000'000);
  CHECK(bus.due_ns() == 100'000 + 500'000 + 140'000);  // 10 bytes, the return delay of a new servo, 14 bytes
}

TEST_CASE("Emulated servos refuse what the manual says they refuse") {
  EmulatedServo servo({.id = 1});
  const auto write = [&](unsigned address, Bytes bytes) { return servo.write(address, bytes); };
  CHECK(write(11, {0}) == EmulatedServo::none);
  CHECK(write(11, {2}) == EmulatedServo::range);
  CHECK(write(132, {0, 0, 0, 0}) == EmulatedServo::access);
  CHECK(write(64, {1}) == EmulatedServo::none);
  CHECK(write(7, {5}) == EmulatedServo::access);  // EEPROM while torque is on
  CHECK(write(168, {132, 0}) == EmulatedServo::access);
  CHECK(write(102, {0xFF, 0x7F}) == EmulatedServo::range);
  CHECK(write(64, {0}) == EmulatedServo::none);
  CHECK(write(168, {10, 0}) == EmulatedServo::range);
  CHECK(write(168, {65, 0}) == EmulatedServo::none);
  CHECK(write(224, {1}) == EmulatedServo::none);  // through the indirect data
  Bytes led;
  CHECK(servo.read(65, 1, led) == EmulatedServo::none);
  CHECK(led == Bytes{1});
  CHECK(write(98, {5}) == EmulatedServo::none);
  CHECK(write(64, {1}) == EmulatedServo::none);
  for (int i = 0; i < 100; ++i) servo.pass(1'000'000);
  CHECK(servo.tripped());
  CHECK(write(102, {1, 0}) == EmulatedServo::range);
  CHECK(write(98, {0}) == EmulatedServo::none);
  CHECK(write(102, {1, 0}) == EmulatedServo::none);
  servo.break_down(0x20);
  CHECK_FALSE(servo.torque());
  CHECK(write(64, {1}) == EmulatedServo::failed);
}

TEST_CASE("Garbage does nothing to emulated servos but confuse them for its own length") {
  Wire wire;
  RandomStream random(1, "garbage");
  for (int i = 0; i < 2000; ++i) {
    Bytes bytes(random.next() % 60);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
    if (i % 3 == 0) bytes.insert(bytes.begin(), {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x20, 0x00});
    (void)wire.ask(bytes);
  }
  CHECK_FALSE(wire.bus.servos[0].torque());
  (void)wire.ask(Bytes(1100, 0));
  CHECK(wire.ask(ping) == ping_answer);
}

}  // namespace kadans::dynamixel
