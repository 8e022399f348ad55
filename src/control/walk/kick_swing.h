// The way of a foot that kicks a ball inside a step: from where it lifted off, through the ball, to its foothold.
//
// The tip of the foot meets the ball in the direction of the kick, at the speed that is asked for. Until then the foot
// goes on a quintic from rest at lift-off to this place and velocity. When the place is nearer than such a way is long,
// the foot goes back first: this is the backswing. After the strike a second quintic leads from there to the foothold,
// which balance chooses and may still change.
//
// Positions are of the foot's frame, relative to the foot that stands, in the heading frame. Mathematics only.
#pragma once

#include <algorithm>

#include "kadans/signal/frames.h"
#include "step_geometry.h"

namespace kadans {

// What is asked for. Without speed: no kick.
struct Kick {
  GroundPoint ball;
  double rad = 0;  // its direction; to the left is positive
  double m_s = 0;  // of the foot at the strike
};

struct KickSwing {
  struct Config {
    double ball_radius_m = 0.095, tip_m = 0.14;  // of the foot, before its frame
    double strike_s = 0.19, after_s = 0.1;       // from lift-off to the strike; least time from there to the landing
    double step_s = 0.32;                        // time of the whole step
    double swing_s_per_m_s = 0.118;       // least time to the strike by the foot's speed: strong kicks swing longer
    double follow_m = 0.03;               // how far the foot goes on beyond the strike, forward
    double lead_s = 0.025;                // how far the reference is ahead, for the lag of the leg
    double height_m = 0.045;              // of the sole at the strike
    double near_m = -0.04, far_m = 0.15;  // where the foot may be at the strike, forward
    double rad_max = 0.6;                 // how far to a side it may go
    double inside_m = 0.13, outside_m = 0.26;  // and to its side
  };

  // Where the foot is at the strike.
  static GroundPoint strike_of(const Config& config, const Kick& asked) noexcept;
  // The times of this kick; a strong one takes longer, before the strike.
  static double strike_s(const Config& config, const Kick& asked) noexcept {
    return std::max(config.strike_s, config.swing_s_per_m_s * asked.m_s);
  }
  static double step_s(const Config& config, const Kick& asked) noexcept {
    return config.step_s + strike_s(config, asked) - config.strike_s;
  }
  // Whether the foot at this side (1 left, -1 right) reaches the ball in this way from where it stands.
  static bool reaches(const Config& config, const Kick& asked, double side) noexcept;

  void begin(const Config& config, const Kick& asked) noexcept;
  void end() noexcept { kick = {}; }
  bool kicks() const noexcept { return kick.m_s > 0; }

  // Where the foot shall be; heights are over the slope.
  Vec3 at(const Config& config, const Vec3& from_m, const GroundPoint& foothold, double time_s,
          double whole_s) const noexcept;
  // Where it points, of the heading.
  double yaw_rad(const Config& config, double time_s) const noexcept;

  Kick kick;
  GroundPoint strike;  // where the foot is then
};

}  // namespace kadans
