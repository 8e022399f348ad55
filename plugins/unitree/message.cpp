#include "message.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "low_level.h"  // made by idlc from low_level.idl

namespace unitree {
namespace {

static_assert(std::endian::native == std::endian::little, "the structs are the messages");

using GoCommand = unitree_go_msg_dds__LowCmd_;
using GoState = unitree_go_msg_dds__LowState_;
using HgCommand = unitree_hg_msg_dds__LowCmd_;
using HgState = unitree_hg_msg_dds__LowState_;
static_assert(sizeof(GoCommand) == 4 * command_words(Family::go) && sizeof(GoState) == 4 * state_words(Family::go));
static_assert(sizeof(HgCommand) == 4 * command_words(Family::hg) && sizeof(HgState) == 4 * state_words(Family::hg));

constexpr std::array<std::uint8_t, 3> low_level{0xFE, 0xEF, 0xFF};  // head and level flag of go

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte << 24U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U) ^ ((crc >> 31U) * 0x04C11DB7U);
    table[byte] = crc;
  }
  return table;
}

template <typename Struct>
Struct struct_of(const Packet& packet) noexcept {
  static_assert(std::is_trivially_copyable_v<Struct>);
  Struct message;
  std::memcpy(&message, packet.words.data(), sizeof message);
  return message;
}

template <typename Struct>
void seal(const Struct& message, Packet& packet) noexcept {
  packet.count = sizeof message / 4;
  std::memcpy(packet.words.data(), &message, sizeof message);
  packet.words[packet.count - 1] = checksum(packet.used());
}

// All bytes 0, padding included.
template <typename Struct>
Struct blank() noexcept {
  Struct message;
  std::memset(&message, 0, sizeof message);
  return message;
}

bool is_whole(const Packet& packet, std::size_t words, bool check) noexcept {
  return packet.count == words && (!check || packet.words[words - 1] == checksum(packet.used()));
}

template <typename Message>
bool is_low_level(const Message& message) noexcept {
  return message.head[0] == low_level[0] && message.head[1] == low_level[1] && message.level_flag == low_level[2];
}

template <typename Message>
void say_low_level(Message& message) noexcept {
  message.head[0] = low_level[0];
  message.head[1] = low_level[1];
  message.level_flag = low_level[2];
}

template <typename Motor>
void put(const MotorCommand& is, Motor& motor) noexcept {
  motor.mode = is.mode;
  motor.q = is.q;
  motor.dq = is.dq;
  motor.tau = is.tau;
  motor.kp = is.kp;
  motor.kd = is.kd;
}

template <typename Motor>
MotorCommand command_in(const Motor& motor) noexcept {
  return {.mode = motor.mode, .q = motor.q, .dq = motor.dq, .tau = motor.tau, .kp = motor.kp, .kd = motor.kd};
}

template <typename Imu>
void put_imu(const State& state, Imu& imu) noexcept {
  std::ranges::copy(state.quaternion, imu.quaternion);
  std::ranges::copy(state.gyroscope_rad_s, imu.gyroscope);
  std::ranges::copy(state.accelerometer_m_s2, imu.accelerometer);
  std::ranges::copy(state.rpy_rad, imu.rpy);
}

template <typename Imu>
void imu_in(const Imu& imu, State& state) noexcept {
  std::ranges::copy(imu.quaternion, state.quaternion.begin());
  std::ranges::copy(imu.gyroscope, state.gyroscope_rad_s.begin());
  std::ranges::copy(imu.accelerometer, state.accelerometer_m_s2.begin());
  std::ranges::copy(imu.rpy, state.rpy_rad.begin());
}

template <typename Motor>
void put_motor(const MotorState& is, Motor& motor) noexcept {
  motor.mode = is.mode;
  motor.q = is.q;
  motor.dq = is.dq;
  motor.tau_est = is.tau;
}

template <typename Motor>
MotorState motor_in(const Motor& motor) noexcept {
  return {.mode = motor.mode, .q = motor.q, .dq = motor.dq, .tau = motor.tau_est};
}

bool is_finite(const MotorCommand& motor) noexcept {
  return 0 * motor.q + 0 * motor.dq + 0 * motor.tau + 0 * motor.kp + 0 * motor.kd == 0;
}

bool is_finite(const State& state, std::size_t motors) noexcept {
  float sum = 0 * state.supply_V;
  for (const float x : state.gyroscope_rad_s) sum += 0 * x;
  for (const float x : state.accelerometer_m_s2) sum += 0 * x;
  for (std::size_t i = 0; i < motors; ++i) sum += 0 * state.motors[i].q + 0 * state.motors[i].tau;
  return sum == 0;
}

}  // namespace

std::uint32_t checksum(std::span<const std::uint32_t> message) noexcept {
  static constexpr std::array<std::uint32_t, 256> table = crc_table();
  std::uint32_t crc = 0xFFFFFFFF;
  for (const std::uint32_t word : message.first(message.size() - 1)) {
    crc ^= word;
    for (int byte = 0; byte < 4; ++byte) crc = (crc << 8U) ^ table[crc >> 24U];
  }
  return crc;
}

void encode(Family family, const Command& command, Packet& packet) noexcept {
  if (family == Family::go) {
    auto message = blank<GoCommand>();
    say_low_level(message);
    for (std::size_t i = 0; i < motors_of(family); ++i) put(command.motors[i], message.motor_cmd[i]);
    return seal(message, packet);
  }
  auto message = blank<HgCommand>();
  message.mode_pr = command.mode_pr;
  message.mode_machine = command.mode_machine;
  for (std::size_t i = 0; i < motors_of(family); ++i) put(command.motors[i], message.motor_cmd[i]);
  seal(message, packet);
}

void encode(Family family, const State& state, Packet& packet) noexcept {
  if (family == Family::go) {
    auto message = blank<GoState>();
    say_low_level(message);
    put_imu(state, message.imu_state);
    for (std::size_t i = 0; i < motors_of(family); ++i) {
      const MotorState& is = state.motors[i];
      put_motor(is, message.motor_state[i]);
      message.motor_state[i].temperature = static_cast<std::uint8_t>(is.temperature_C);
      message.motor_state[i].lost = is.lost;
    }
    std::ranges::copy(state.foot_force, message.foot_force);
    message.tick = state.tick;
    message.power_v = state.supply_V;
    return seal(message, packet);
  }
  auto message = blank<HgState>();
  message.mode_pr = state.mode_pr;
  message.mode_machine = state.mode_machine;
  message.tick = state.tick;
  put_imu(state, message.imu_state);
  for (std::size_t i = 0; i < motors_of(family); ++i) {
    const MotorState& is = state.motors[i];
    put_motor(is, message.motor_state[i]);
    message.motor_state[i].temperature[0] = static_cast<std::int16_t>(is.temperature_C);
    message.motor_state[i].vol = is.supply_V;
    message.motor_state[i].motorstate = is.code;
  }
  seal(message, packet);
}

Verdict decode(Family family, const Packet& packet, Command& command) noexcept {
  if (!is_whole(packet, command_words(family), true)) return Verdict::corrupt;
  Command read;
  if (family == Family::go) {
    const auto message = struct_of<GoCommand>(packet);
    if (!is_low_level(message)) return Verdict::foreign;
    for (std::size_t i = 0; i < motors_of(family); ++i) read.motors[i] = command_in(message.motor_cmd[i]);
  } else {
    const auto message = struct_of<HgCommand>(packet);
    read.mode_pr = message.mode_pr;
    read.mode_machine = message.mode_machine;
    for (std::size_t i = 0; i < motors_of(family); ++i) read.motors[i] = command_in(message.motor_cmd[i]);
  }
  if (!std::ranges::all_of(read.motors, [](const MotorCommand& motor) { return is_finite(motor); }))
    return Verdict::not_finite;
  command = read;
  return Verdict::good;
}

Verdict decode(Family family, const Packet& packet, bool check, State& state) noexcept {
  if (!is_whole(packet, state_words(family), check)) return Verdict::corrupt;
  state = {};
  if (family == Family::go) {
    const auto message = struct_of<GoState>(packet);
    imu_in(message.imu_state, state);
    for (std::size_t i = 0; i < motors_of(family); ++i) {
      const auto& motor = message.motor_state[i];
      state.motors[i] = motor_in(motor);
      state.motors[i].temperature_C = motor.temperature;
      state.motors[i].lost = motor.lost;
    }
    std::ranges::copy(message.foot_force, state.foot_force.begin());
    state.tick = message.tick;
    state.supply_V = message.power_v;
  } else {
    const auto message = struct_of<HgState>(packet);
    state.mode_pr = message.mode_pr;
    state.mode_machine = message.mode_machine;
    state.tick = message.tick;
    imu_in(message.imu_state, state);
    for (std::size_t i = 0; i < motors_of(family); ++i) {
      const auto& motor = message.motor_state[i];
      state.motors[i] = motor_in(motor);
      state.motors[i].temperature_C = std::max(motor.temperature[0], motor.temperature[1]);
      state.motors[i].supply_V = motor.vol;
      state.motors[i].code = motor.motorstate;
    }
  }
  return is_finite(state, motors_of(family)) ? Verdict::good : Verdict::not_finite;
}

}  // namespace unitree
