// The messages of the low level: sizes, checksums and fields as the robots have them.
#include "message.h"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

using namespace unitree;

namespace {

constexpr Family families[] = {Family::go, Family::hg};

Command leading() {
  Command command{.mode_machine = 5};
  for (std::size_t i = 0; i < 20; ++i) {
    const float x = static_cast<float>(i) / 8;
    command.motors[i] = {.mode = motor_on, .q = x, .dq = -x, .tau = 2 * x, .kp = 40 + x, .kd = 1};
  }
  return command;
}

}  // namespace

TEST_CASE("The checksums of messages are the published ones") {
  Packet packet{.count = 203};
  CHECK(checksum(packet.used()) == 0x4B5A4880);  // a command of go, all 0
  packet.count = 251;
  CHECK(checksum(packet.used()) == 0xFE172F9F);  // of hg
  encode(Family::go, Command(), packet);         // with its head FE EF, and FF for the low level
  CHECK(packet.words[0] == 0x00FFEFFE);
  CHECK(packet.words[202] == 0x322AC991);
}

TEST_CASE("Commands and states arrive as they were sent, in both families") {
  for (const Family family : families) {
    Packet packet;
    Command command;
    encode(family, leading(), packet);
    CHECK(packet.count * 4 == (family == Family::go ? 812 : 1004));
    REQUIRE(decode(family, packet, command) == Verdict::good);
    CHECK(command.motors[7].kp == leading().motors[7].kp);
    CHECK(command.motors[19].tau == leading().motors[19].tau);
    CHECK(command.mode_machine == (family == Family::go ? 0 : 5));

    State state{.tick = 0xFFFFFFF0, .mode_machine = 4, .gyroscope_rad_s = {1, 2, 3}}, read;
    state.motors[11] = {
        .mode = 1, .q = 0.5, .dq = -2, .tau = 7, .temperature_C = 41, .code = 3, .lost = 9, .supply_V = 50};
    state.foot_force = {1, 2, 3, -4};
    state.supply_V = 28;
    encode(family, state, packet);
    CHECK(packet.count * 4 == (family == Family::go ? 1180 : 2092));
    REQUIRE(decode(family, packet, true, read) == Verdict::good);
    CHECK(read.tick == state.tick);
    CHECK(read.motors[11].q == 0.5F);
    CHECK(read.motors[11].tau == 7);
    CHECK(read.motors[11].temperature_C == 41);
    CHECK(read.gyroscope_rad_s == state.gyroscope_rad_s);
    if (family == Family::go) {
      CHECK(read.motors[11].lost == 9);
      CHECK(read.foot_force[3] == -4);
      CHECK(read.supply_V == 28);
    } else {
      CHECK(read.motors[11].code == 3);
      CHECK(read.motors[11].supply_V == 50);
      CHECK(read.mode_machine == 4);
    }
  }
}

TEST_CASE("Motors and the clock lie where the robots have them") {
  Packet packet;
  Command command;
  command.motors[1] = {.mode = motor_on, .q = 1};
  const std::uint32_t one = 0x3F800000;
  encode(Family::go, command, packet);
  CHECK(packet.words[6 + 9] == 1);  // 24 bytes of head, 36 a motor
  CHECK(packet.words[6 + 10] == one);
  encode(Family::hg, command, packet);
  CHECK(packet.words[1 + 7] == 1);  // 4 bytes of head, 28 a motor
  CHECK(packet.words[1 + 8] == one);
  State state{.tick = 0x01020304};
  encode(Family::go, state, packet);
  CHECK(packet.words[1100 / 4] == state.tick);
  encode(Family::hg, state, packet);
  CHECK(packet.words[12 / 4] == state.tick);
}

TEST_CASE("A message with any bit turned, too short, too long, or not of the low level is none") {
  for (const Family family : families) {
    Packet good;
    encode(family, leading(), good);
    Command command;
    for (std::size_t word = 0; word < good.count; ++word) {
      for (unsigned bit = 0; bit < 32; ++bit) {
        Packet bad = good;
        bad.words[word] ^= 1U << bit;
        REQUIRE(decode(family, bad, command) == Verdict::corrupt);
      }
    }
    for (const std::size_t count : {std::size_t{0}, good.count - 1, good.count + 1}) {
      Packet bad = good;
      bad.count = count;
      CHECK(decode(family, bad, command) == Verdict::corrupt);
    }
  }
  Packet high;
  encode(Family::go, leading(), high);
  high.words[0] ^= 0x00FF0000U;  // the level flag: 0
  high.words[high.count - 1] = checksum(high.used());
  Command command;
  CHECK(decode(Family::go, high, command) == Verdict::foreign);
}

TEST_CASE("Numbers that are none are told, and a command with one changes nothing") {
  for (const Family family : families) {
    for (const float none : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      Packet packet;
      Command command = leading(), read;
      command.motors[3].kd = none;
      encode(family, command, packet);
      CHECK(decode(family, packet, read) == Verdict::not_finite);
      CHECK(read.motors[0].mode == 0);
      State state, seen;
      state.motors[2].q = none;
      encode(family, state, packet);
      CHECK(decode(family, packet, true, seen) == Verdict::not_finite);
      CHECK_FALSE(std::isfinite(seen.motors[2].q));
    }
  }
}

TEST_CASE("A state without a checksum counts where the configuration says so") {
  Packet packet;
  State state{.tick = 7}, read;
  encode(Family::hg, state, packet);
  packet.words[packet.count - 1] = 0;
  CHECK(decode(Family::hg, packet, true, read) == Verdict::corrupt);
  CHECK(decode(Family::hg, packet, false, read) == Verdict::good);
  CHECK(read.tick == 7);
}
