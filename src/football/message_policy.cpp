#include "message_policy.h"

#include <algorithm>
#include <cmath>

namespace kadans::football {

double MessagePolicy::worth(const Known& message, const Situation& situation) const noexcept {
  if (!last_) return 10;
  const Known& known = *last_;
  const double silent_s = situation.now_s - last_s_;
  double errors = silent_s / config_.heartbeat_s;
  if (message.fallen != known.fallen) errors += 1;
  const double ball_factor = situation.mates_see_ball ? config_.known_ball_factor : 1;
  if (message.ball && known.ball) {
    const BallBelief guessed = rolled_on(*known.ball, silent_s);
    const double error_m =
        distance(message.ball->at, guessed.at) + 0.3 * distance(message.ball->velocity_m_s, guessed.velocity_m_s);
    errors += ball_factor * error_m / (config_.ball_error_m + message.ball->sd_m);
  } else if (message.ball.has_value() != known.ball.has_value()) {
    errors += ball_factor;
  }
  if (message.pose && known.pose) {
    errors += distance(message.pose->at(), known.pose->at()) / config_.pose_error_m;
    errors += std::abs(wrapped(message.pose->theta_rad - known.pose->theta_rad)) / config_.pose_error_rad;
  } else if (message.pose.has_value() != known.pose.has_value()) {
    errors += 1;
  }
  return errors;
}

double MessagePolicy::price() const noexcept {
  if (!(tokens_ >= 1)) return 1e9;
  const double empty = 1 - std::min(tokens_ / config_.burst, 1.0);
  return 0.3 + 2.8 * empty * empty;  // half a bucket: 1
}

double MessagePolicy::allowed(const Situation& situation) const noexcept {
  constexpr double trusted_s = 5;  // a budget that was told longer ago is none
  const double players = std::max(situation.players, 1U);
  const double own = config_.game_messages / players - static_cast<double>(counted_);
  if (!situation.budget_left || !(situation.budget_age_s <= trusted_s)) return own;
  const double under_way = players * config_.rate_max_hz * (situation.budget_age_s + 1);  // 1 s: on their way
  return (*situation.budget_left - under_way) / players;
}

bool MessagePolicy::spend(const Known& message, double now_s) noexcept {
  last_ = message;
  last_s_ = now_s;
  return true;
}

bool MessagePolicy::counts(const Situation& situation) noexcept {
  return situation.phase != GamePhase::timeout && situation.state != GameState::initial &&
         situation.state != GameState::finished;
}

void MessagePolicy::sent(const Known& message, const Situation& situation) noexcept {
  (void)spend(message, situation.now_s);
  if (!counts(situation)) return;
  tokens_ = std::max(tokens_ - 1, -config_.burst);
  ++counted_;
}

bool MessagePolicy::send(const Known& message, const Situation& situation) noexcept {
  const double passed_s = seen_s_ ? std::max(situation.now_s - *seen_s_, 0.0) : 0;
  seen_s_ = situation.now_s;
  if (situation.phase == GamePhase::penalty_shoot_out) return false;  // a robot plays alone there
  const double silent_s = last_ ? situation.now_s - last_s_ : 1e9;
  if (!counts(situation)) return silent_s >= 1 && spend(message, situation.now_s);  // free
  const double left = allowed(situation);
  if (!(left >= 1)) return false;
  constexpr double stoppage_s = 60;  // play goes on a little when the clock is at its end
  const double rate_hz = left / (std::max(situation.remaining_s, 0.0) + stoppage_s);
  tokens_ = std::min(tokens_ + rate_hz * passed_s, config_.burst);
  if (silent_s * config_.rate_max_hz < 1 || !(worth(message, situation) >= price())) return false;
  tokens_ -= 1;
  ++counted_;
  return spend(message, situation.now_s);
}

}  // namespace kadans::football
