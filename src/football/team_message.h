// What robots of a team tell each other: one small datagram, typed, bounded and quantised, and what a robot keeps of
// the others. All silent is normal: what was not heard of lately is not there.
//
// The rules give no format, only limits (HSL-Rules, game.tex 3079e99, "Wireless communication"; GameController 6.0.1):
// UDP broadcast on port 10000 + team number, at most 512 bytes each, 12000 a team and game. So the header is ours.
//
//   0 "KDtm"      7 u16 sequence   11 flags: 1 fallen, 2 pose, 4 ball, 8 target, 16 time to ball
//   4 version 1   9 role           12 player whom a pass is for, 0 none
//   5 team       10 intention      13 opponents seen, 0..5
//   6 player                       14 what the flags say, then the opponents
//
// Metres are sent as i16 mm, radians as i16 0.1 mrad, times as u16 ms (to the ball: 10 ms), all little-endian.
// Positions are in the team's frame: origin at the field's centre, x toward the goal that the team attacks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "field.h"
#include "game_control.h"
#include "packet.h"

namespace kadans::football {

inline constexpr std::size_t team_message_bytes_max = 512;  // of the rules; ours has up to 75
inline constexpr std::size_t opponents_told_max = 5;
inline constexpr std::uint16_t team_port_base = 10000;

enum class Role : std::uint8_t { none, striker, supporter, defender, keeper };
enum class Intention : std::uint8_t {
  none,
  take_position,
  search_ball,
  go_to_ball,
  dribble,
  pass,
  shoot,
  block,
  receive,
  get_up
};

// A pose with the standard deviations of its errors and the correlation of the first two, -1..1.
struct PoseBelief {
  Pose2 pose;
  double sd_x_m = 0.1, sd_y_m = 0.1, sd_theta_rad = 0.1;
  double correlation_xy = 0;
};

struct BallBelief {
  Point at, velocity_m_s;
  double sd_m = 0.1;
  double age_s = 0;  // since it was seen
};

struct OpponentSeen {
  Point at;
  double age_s = 0;
};

struct TeamMessage {
  std::uint8_t team = 0, player = 1;
  std::uint16_t sequence = 0;
  Role role = Role::none;
  Intention intention = Intention::none;
  bool fallen = false;
  std::uint8_t pass_to = 0;  // 0: no one
  std::optional<PoseBelief> pose;
  std::optional<BallBelief> ball;
  std::optional<Point> target;  // where it goes, or where the ball shall go
  std::optional<double> time_to_ball_s;
  std::array<OpponentSeen, opponents_told_max> opponents{};
  std::size_t opponent_count = 0;
};

struct TeamDatagram {
  std::array<std::byte, team_message_bytes_max> bytes{};
  std::size_t size = 0;
  Bytes span() const noexcept { return Bytes(bytes).first(size); }
};

// Refuses with a sentence what the format does not hold: nothing is clamped. A standard deviation is rounded up, so
// that no one is told of more certainty than there is.
Checked<TeamDatagram> write_team_message(const TeamMessage& message);
Checked<TeamMessage> read_team_message(Bytes packet);

// A mate as it was heard of last.
struct Mate {
  TeamMessage message;
  double heard_s = 0;
  std::uint64_t messages = 0;
};

class TeamInbox {
 public:
  struct Settings {
    std::uint8_t team = 0, player = 1;
    Field field;
    double silent_after_s = 6;  // then a mate counts as not there, and its sequence may begin anew
  };
  struct Counts {
    std::uint64_t taken = 0, refused = 0;
  };

  explicit TeamInbox(const Settings& settings) : settings_(settings) {}

  // "": taken. Otherwise why not: malformed, of another team, one's own, older than what is known, or from places where
  // no robot of this field can be.
  std::string accept(Bytes packet, double now_s);
  // nullptr: not heard of, or not lately.
  const Mate* mate(std::uint8_t player, double now_s) const noexcept;
  // What the mates know best of the ball, moved on to now and aged; nothing when none saw it within `age_max_s`.
  std::optional<BallBelief> ball(double now_s, double age_max_s = 3) const noexcept;
  Counts counts() const noexcept { return counts_; }

 private:
  std::string place_mistake(const TeamMessage& message) const;

  Settings settings_;
  std::array<std::optional<Mate>, players_max> mates_{};
  Counts counts_;
};

// Where a ball that rolls on grass is after a time: it slows down evenly.
inline constexpr double ball_deceleration_m_s2 = 0.5;
BallBelief rolled_on(const BallBelief& ball, double time_s, double deceleration_m_s2 = ball_deceleration_m_s2) noexcept;

}  // namespace kadans::football
