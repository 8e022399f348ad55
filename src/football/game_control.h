// The game controller's protocol, version 20 (control) and 4 (return), as pure functions over bytes. What comes from
// the network is hostile until it is checked: another version, another length and impossible values are refused, each
// with a sentence.
//
// Sources: RoboCup-HumanoidSoccerLeague/GameController, game_controller_msgs/headers/RoboCupGameControlData.h and
// game_controller_api (1294e0e, 4477e47), and the copies of version 20 in HULKs/hulk (774a8a6) and
// bit-bots/bitbots_main (8ad6ddd). 3838/UDP broadcast from the game controller, 2 Hz; 3939/UDP to it, 0.5 to 2 Hz for
// each robot.
//
//   control, 158 bytes, little-endian            team, 70 bytes          robot, 3 bytes
//     0 "RGme" to players, "RGTD" to monitors     0 team number           0 penalty
//     4 version 20          12 first half         1 colour                1 s until it ends
//     5 packet number       13 kicking team       2 keeper's colour       2 cautions
//     6 players a team      14 i16 s remaining    3 keeper, 0 none
//     7 competition type    16 i16 s secondary    4 score               return, 32 bytes
//     8 stopped             18 team that defends  5 penalty shots         0 "RGrt"      8 f32 x_mm, y_mm, theta_rad
//     9 game phase             the left goal      6 u16 shots scored      4 version 4  20 f32 s since ball seen, -1
//    10 state               88 the other team     8 u16 message budget    5 player     24 f32 ball x_mm, y_mm
//    11 set play                                 10 20 robots             6 team        7 fallen
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "packet.h"
#include "plane.h"

namespace kadans::football {

inline constexpr std::size_t control_bytes = 158, return_bytes = 32;
inline constexpr std::uint8_t control_version = 20, return_version = 4;
inline constexpr std::uint16_t control_port = 3838, return_port = 3939;
inline constexpr std::size_t players_max = 20;  // numbers 1..20
inline constexpr std::uint8_t no_team = 255;    // kicks off: a dropped ball

enum class GamePhase : std::uint8_t { normal, penalty_shoot_out, extra_time, timeout };
enum class GameState : std::uint8_t { initial, ready, set, playing, finished };
enum class SetPlay : std::uint8_t {
  none,
  direct_free_kick,
  indirect_free_kick,
  penalty_kick,
  throw_in,
  goal_kick,
  corner
};
enum class Penalty : std::uint8_t {
  none,
  illegal_positioning,
  motion_in_set,
  motion_in_stop,
  local_game_stuck,
  incapable_robot,
  pick_up,
  ball_holding,
  leaving_the_field,
  playing_with_arms,
  pushing,
  cautioned,
  sent_off,
  substitute
};
enum class TeamColour : std::uint8_t { blue, red, yellow, black, white, green, orange, purple, brown, gray };

std::string_view name_of(GameState state) noexcept;  // "playing"
std::string_view name_of(SetPlay play) noexcept;     // "throw-in"; none: ""
std::string_view name_of(Penalty penalty) noexcept;  // "motion in set"

struct RobotEntry {
  Penalty penalty = Penalty::none;
  std::uint8_t penalty_left_s = 0;
  std::uint8_t cautions = 0;

  friend bool operator==(const RobotEntry&, const RobotEntry&) = default;
};

struct TeamEntry {
  std::uint8_t number = 0;
  TeamColour colour = TeamColour::blue, keeper_colour = TeamColour::blue;
  std::uint8_t keeper = 0;  // player's number; 0: there is none
  std::uint8_t score = 0;
  std::uint8_t penalty_shots = 0;                // taken
  std::uint16_t shots_scored = 0;                // bit i: shot i
  std::uint16_t message_budget = 0;              // left
  std::array<RobotEntry, players_max> robots{};  // [number - 1]

  friend bool operator==(const TeamEntry&, const TeamEntry&) = default;
};

struct GameControl {
  std::uint8_t packet_number = 0;
  std::uint8_t players_per_team = 0;
  std::uint8_t competition_type = 0;  // 0 small, 1 middle, 2 large
  bool stopped = false;               // play is stopped, whatever the state
  GamePhase phase = GamePhase::normal;
  GameState state = GameState::initial;
  SetPlay set_play = SetPlay::none;
  bool first_half = true;
  std::uint8_t kicking_team = no_team;  // its number
  std::int16_t remaining_s = 0;         // of the half; may be below 0
  std::int16_t secondary_s = 0;         // of ready, set play, timeout or break; may be below 0
  std::array<TeamEntry, 2> teams{};     // [0] defends the left goal

  // The team with this number; nullptr: it does not play here.
  const TeamEntry* team(std::uint8_t number) const noexcept;
  friend bool operator==(const GameControl&, const GameControl&) = default;
};

// Monitors get the true state, players one whose change to playing may be hidden: a player that reads the monitors'
// packets cheats, so each reads its own.
enum class ControlReader : std::uint8_t { player, monitor };

Checked<GameControl> read_game_control(Bytes packet, ControlReader reader = ControlReader::player);
std::array<std::byte, control_bytes> write_game_control(const GameControl& control,
                                                        ControlReader reader = ControlReader::player) noexcept;

// What a robot tells the game controller. The origin is the field's centre, x points to the goal that it attacks.
struct RobotReturn {
  std::uint8_t player = 1, team = 0;
  bool fallen = false;
  Pose2 pose;
  std::optional<double> ball_age_s;  // since it was seen; none: never
  Point ball;                        // in the robot's frame: x forward, y left
};

// Refuses what the game controller refuses, and infinite numbers and ages below 0 other than -1.
Checked<RobotReturn> read_robot_return(Bytes packet);
std::array<std::byte, return_bytes> write_robot_return(const RobotReturn& told) noexcept;

}  // namespace kadans::football
