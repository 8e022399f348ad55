// When a team message is worth its price. A team has 12000 messages a game (HSL-Rules, game.tex 3079e99, "Wireless
// communication"); they buy most where the mates would be wrong without one. What a message says, and how it is checked
// when it comes, is the decisions' (docs/supervisor.md).
//
// Worth: the mates go on from the last message, so the policy does the same and measures by how much they are wrong
// about the ball and the robot's place; a fall counts as one error of its own. A ball that a mate sees as well counts
// less. Silence makes any message worth more, up to a heartbeat. News of another role or pass are told unasked.
// Price: a bucket fills at the rate that the budget left and the time left allow for each robot. The fuller it is, the
// cheaper a message. So quiet minutes save for busy ones.
//
// The budget is never overspent: as long as the game controller is heard, the policy counts all that mates may have
// sent since it told the budget; when it is not, a robot spends only what is left of its own share of the game.
#pragma once

#include <cstdint>
#include <optional>

#include "ball_filter.h"
#include "field.h"
#include "game_control.h"

namespace kadans::football {

class MessagePolicy {
 public:
  // What a message says, in the team's frame: the field's centre, x toward the goal that the team attacks.
  struct Known {
    bool fallen = false;
    std::optional<Pose2> pose;
    std::optional<BallBelief> ball;
  };
  struct Config {
    double game_messages = 12000;  // of the team
    double rate_max_hz = 5;        // of one robot
    double heartbeat_s = 3;        // silence that makes a message worth 1
    double burst = 10;             // messages that the bucket holds
    double ball_error_m = 0.4;     // that makes a message worth 1
    double pose_error_m = 0.6, pose_error_rad = 0.8;
    double known_ball_factor = 0.25;  // of a ball that mates see, too
  };
  struct Situation {
    double now_s = 0;
    GameState state = GameState::initial;
    GamePhase phase = GamePhase::normal;
    double remaining_s = 0;                    // of the game: both halves
    std::optional<std::uint16_t> budget_left;  // as the game controller told it; none: never heard
    double budget_age_s = 0;                   // since it told it
    unsigned players = 5;                      // of the team that may send
    bool mates_see_ball = false;
  };

  explicit MessagePolicy(const Config& config) : config_(config), tokens_(config.burst / 2) {}

  // True: send it now; it counts as sent.
  bool send(const Known& message, const Situation& situation) noexcept;
  // A message that was sent without asking, such as the news of another role: it counts and is paid for.
  void sent(const Known& message, const Situation& situation) noexcept;
  // Messages that this robot may still send: its share of what is surely left.
  double allowed(const Situation& situation) const noexcept;
  // In errors; 1 is worth a message at half a bucket.
  double worth(const Known& message, const Situation& situation) const noexcept;
  double price() const noexcept;
  std::uint64_t counted_sent() const noexcept { return counted_; }

 private:
  static bool counts(const Situation& situation) noexcept;
  bool spend(const Known& message, double now_s) noexcept;

  Config config_;
  double tokens_;
  std::optional<double> seen_s_;  // of the last call
  std::optional<Known> last_;
  double last_s_ = 0;
  std::uint64_t counted_ = 0;  // sent in ready, set and playing
};

}  // namespace kadans::football
