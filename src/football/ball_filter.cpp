#include "ball_filter.h"

namespace kadans::football {

BallFilter::Track BallFilter::at_time(const Track& track, double time_s) const noexcept {
  const double passed_s = time_s - track.time_s;
  Track later = track;
  if (!(passed_s > 0)) return later;
  later.time_s = time_s;
  const BallBelief rolled =
      rolled_on({.at = track.at, .velocity_m_s = track.velocity_m_s}, passed_s, config_.deceleration_m_s2);
  later.at = rolled.at;
  later.velocity_m_s = rolled.velocity_m_s;
  // While nothing is seen, an error of the velocity ends as the ball does: it lasts for two seconds at most.
  const double t = std::min(passed_s, 2.0), q = config_.push_sd_m_s2 * config_.push_sd_m_s2;
  later.pp = track.pp + 2 * t * track.pv + t * t * track.vv + q * t * t * t / 3;
  later.pv = track.pv + t * track.vv + q * t * t / 2;
  later.vv = track.vv + q * t;
  return later;
}

bool BallFilter::fits(const Track& track, const BallSighting& sighting) const noexcept {
  const Point error = sighting.at - track.at;
  return dot(error, error) <= config_.fits * (track.pp + sighting.sd_m * sighting.sd_m);
}

void BallFilter::correct(Track& track, const BallSighting& sighting) const noexcept {
  const double all = track.pp + sighting.sd_m * sighting.sd_m;
  const double place = track.pp / all, speed = track.pv / all;
  const Point error = sighting.at - track.at;
  track.at = track.at + place * error;
  track.velocity_m_s = track.velocity_m_s + speed * error;
  track.vv -= speed * track.pv;
  track.pv *= 1 - place;
  track.pp *= 1 - place;
  track.seen_s = sighting.time_s;
  track.probability += 0.4 * (1 - track.probability);
}

// Nothing where no ball could have rolled from one to the other.
std::optional<BallFilter::Track> BallFilter::from_two(const BallSighting& first,
                                                      const BallSighting& second) const noexcept {
  const double passed_s = second.time_s - first.time_s;
  if (!(passed_s > 0 && passed_s <= config_.agrees_s)) return std::nullopt;
  const Point way = second.at - first.at;
  const double sd_m = std::hypot(first.sd_m, second.sd_m);
  if (norm(way) > config_.ball_speed_max_m_s * passed_s + 2 * sd_m) return std::nullopt;
  Track track;
  track.time_s = track.seen_s = second.time_s;
  track.at = second.at;
  // The way may be noise: the more of it is beyond noise, the more of it is velocity.
  const double real = dot(way, way), noise = 2 * sd_m * sd_m;
  track.velocity_m_s = (real > noise ? (1 - noise / real) / passed_s : 0.0) * way;
  track.pp = second.sd_m * second.sd_m;
  track.vv = std::min(sd_m * sd_m / (passed_s * passed_s), 4.0);
  track.probability = 0.6;
  return track;
}

bool BallFilter::saw(const BallSighting& sighting) noexcept {
  const bool sound = finite(sighting.at) && std::isfinite(sighting.time_s) && sighting.sd_m > 0 && sighting.sd_m < 1e3;
  if (!sound || !(sighting.time_s > newest_s_)) return false;
  newest_s_ = sighting.time_s;
  if (track_ && estimate(sighting.time_s).known) {
    Track now = at_time(*track_, sighting.time_s);
    if (fits(now, sighting)) {
      correct(now, sighting);
      track_ = now;
      doubt_.reset();
      return true;
    }
  }
  const std::optional<Track> fresh = doubt_ ? from_two(*doubt_, sighting) : std::nullopt;
  doubt_ = sighting;
  if (!fresh) return true;
  track_ = fresh;
  doubt_.reset();
  ++beginnings_;
  return true;
}

void BallFilter::missed(double time_s) noexcept {
  if (track_ && time_s > track_->seen_s) track_->probability *= config_.missed_factor;
}

void BallFilter::forget() noexcept {
  track_.reset();
  doubt_.reset();
}

BallFilter::Estimate BallFilter::estimate(double time_s) const noexcept {
  if (!track_) return {};
  const Track now = at_time(*track_, time_s);
  const double age_s = time_s - track_->seen_s;
  const double probability = now.probability * std::max(1 - age_s / config_.forget_s, 0.0);
  return {now.at, now.velocity_m_s, std::sqrt(now.pp), age_s, probability, probability >= config_.lost_below};
}

BallBelief rolled_on(const BallBelief& ball, double time_s, double deceleration_m_s2) noexcept {
  BallBelief later = ball;
  later.age_s += time_s;
  const double speed_m_s = norm(ball.velocity_m_s);
  if (!(speed_m_s > 0) || !(time_s > 0)) return later;
  const double rolling_s = std::min(time_s, speed_m_s / deceleration_m_s2);
  const double way_m = speed_m_s * rolling_s - deceleration_m_s2 * rolling_s * rolling_s / 2;
  later.at = ball.at + (way_m / speed_m_s) * ball.velocity_m_s;
  later.velocity_m_s = (1 - deceleration_m_s2 * rolling_s / speed_m_s) * ball.velocity_m_s;
  return later;
}

}  // namespace kadans::football
