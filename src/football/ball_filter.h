// Where the ball is and how it rolls, from single sightings that are late, noisy and sometimes of something else.
//
// A Kalman filter of place and velocity on the field; the ball slows down evenly as on grass, so that it comes to rest.
// A sighting that does not fit is kept as a doubt. When the next ones agree with the doubt and not with the filter, the
// ball was kicked, or the filter followed something else: it begins anew there, with the velocity between them. A false
// sighting alone moves nothing.
//
// Lost: each look at where the ball should be that does not find it makes it less likely to be there; so does age.
// Back: a lost ball is taken from two sightings that agree.
//
// Sightings carry the time of their picture; those that come in the wrong order are refused. One thread, no allocation.
#pragma once

#include <cstdint>
#include <optional>

#include "plane.h"

namespace kadans::football {

struct BallSighting {
  double time_s = 0;  // of the picture
  Point at;           // on the field
  double sd_m = 0.1;  // of an error in each direction
};

class BallFilter {
 public:
  struct Config {
    double deceleration_m_s2 = 0.5;
    double push_sd_m_s2 = 0.6;  // accelerations that nobody knows: touches, slopes, holes in the grass
    double fits = 12;           // squared error over its variance, of two directions
    double agrees_s = 0.4, ball_speed_max_m_s = 6;
    double missed_factor = 0.75;  // of the probability, for each look that finds nothing
    double forget_s = 8;          // without a sighting
    double lost_below = 0.15;
  };
  struct Estimate {
    Point at, velocity_m_s;
    double sd_m = 0;
    double age_s = 0;        // since it was seen
    double probability = 0;  // that it is there
    bool known = false;
  };

  explicit BallFilter(const Config& config) : config_(config) {}

  // False: refused, not finite or older than another that was taken.
  bool saw(const BallSighting& sighting) noexcept;
  // The place where the ball should have been was seen, and it was not there.
  void missed(double time_s) noexcept;
  void forget() noexcept;

  Estimate estimate(double time_s) const noexcept;
  std::uint64_t beginnings() const noexcept { return beginnings_; }  // how often it began anew

 private:
  struct Track {
    double time_s = 0, seen_s = 0;
    Point at, velocity_m_s;
    double pp = 0, pv = 0, vv = 0;  // covariance of each direction
    double probability = 0.5;
  };

  Track at_time(const Track& track, double time_s) const noexcept;
  bool fits(const Track& track, const BallSighting& sighting) const noexcept;
  void correct(Track& track, const BallSighting& sighting) const noexcept;
  std::optional<Track> from_two(const BallSighting& first, const BallSighting& second) const noexcept;

  Config config_;
  std::optional<Track> track_;
  std::optional<BallSighting> doubt_;
  double newest_s_ = -1e18;
  std::uint64_t beginnings_ = 0;
};

// What somebody believes of the ball.
struct BallBelief {
  Point at, velocity_m_s;
  double sd_m = 0.1;
  double age_s = 0;  // since it was seen
};

// Where a ball that rolls on grass is after a time: it slows down evenly.
inline constexpr double ball_deceleration_m_s2 = 0.5;
BallBelief rolled_on(const BallBelief& ball, double time_s, double deceleration_m_s2 = ball_deceleration_m_s2) noexcept;

}  // namespace kadans::football
