// The messages of the low level, lowcmd and lowstate, for both families of robots: as they lie in memory as C structs,
// and what they say.
//
// A message is a row of little-endian words; the last is its checksum: CRC-32 (polynomial 04C11DB7, begun with
// FFFFFFFF, neither reflected nor inverted) over the other words, each from its highest bit on. Padding between fields
// is 0, and counts.
//
// Free functions over plain data: any thread, no allocation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace unitree {

enum class Family : std::uint8_t { go, hg };

inline constexpr std::size_t motors_max = 35;
constexpr std::size_t motors_of(Family family) noexcept { return family == Family::go ? 20 : 35; }
constexpr std::size_t command_words(Family family) noexcept { return family == Family::go ? 203 : 251; }
constexpr std::size_t state_words(Family family) noexcept { return family == Family::go ? 295 : 523; }

struct Packet {
  std::size_t count = 0;  // words in use
  std::array<std::uint32_t, 523> words{};
  std::span<const std::uint32_t> used() const noexcept { return std::span(words).first(count); }
};

// Of all words but the last one.
std::uint32_t checksum(std::span<const std::uint32_t> message) noexcept;

// The motor's torque is tau + kp (q - its position) + kd (dq - its velocity).
struct MotorCommand {
  std::uint8_t mode = 0;  // 0: no torque
  float q = 0, dq = 0, tau = 0, kp = 0, kd = 0;
};
inline constexpr std::uint8_t motor_on = 1;

struct Command {
  std::uint8_t mode_pr = 0;       // hg: 0: ankles and waist as pitch and roll; 1: as their two motors
  std::uint8_t mode_machine = 0;  // hg: as the robot says it
  std::array<MotorCommand, motors_max> motors{};
};

struct MotorState {
  std::uint8_t mode = 0;
  float q = 0, dq = 0, tau = 0;
  float temperature_C = 0;
  std::uint32_t code = 0;  // hg: of what is wrong with it
  std::uint32_t lost = 0;  // go: messages between the robot's board and the motor that were lost
  float supply_V = 0;      // hg
};

struct State {
  std::uint32_t tick = 0;  // ms of the robot's clock
  std::uint8_t mode_pr = 0, mode_machine = 0;
  std::array<float, 4> quaternion{1, 0, 0, 0};  // w, x, y, z
  std::array<float, 3> gyroscope_rad_s{}, accelerometer_m_s2{}, rpy_rad{};
  std::array<MotorState, motors_max> motors{};
  std::array<std::int16_t, 4> foot_force{};  // go: FR, FL, RR, RL, in counts
  float supply_V = 0;                        // go
};

// corrupt: its checksum or length is wrong. foreign: it is not of the low level.
enum class Verdict : std::uint8_t { good, corrupt, foreign, not_finite };

void encode(Family family, const Command& command, Packet& packet) noexcept;
void encode(Family family, const State& state, Packet& packet) noexcept;
// Without `check`, the checksum is not looked at. A command that is not good leaves `command` as it was. A state that
// is not_finite is read all the same: which motor it is of shows in it.
Verdict decode(Family family, const Packet& packet, Command& command) noexcept;
Verdict decode(Family family, const Packet& packet, bool check, State& state) noexcept;

}  // namespace unitree
