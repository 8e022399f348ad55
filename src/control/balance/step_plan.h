// Decides when to step, with which foot and where to, from the divergent component of motion xi alone. Computes no
// torques.
//
//   stands  Both feet are where they were put; nothing is asked for. A step begins when xi, predicted by its rate,
//           leaves what the soles can hold, forward or backward.
//   swings  The foot that xi moves away from passes the other foot and goes to where xi will be at touch-down; this
//           place is computed anew each tick. Staggered feet need no push-off: the push itself loads the front foot.
//   bears   Both feet are where they landed. The next step begins when xi leaves the soles.
//
// Positions are relative to the foot `stance`, in the heading frame. One owner, the control thread; nothing allocates.
#pragma once

#include <array>
#include <cstdint>

#include "dcm_measure.h"
#include "kadans/signal/frames.h"

namespace kadans {

// The geometry of stepping, in the heading frame: where to put a foot, and where the centre of pressure can be.
//
// While one foot stands, the divergent component of motion xi runs away from the centre of pressure p: xi(t) = p + (xi
// - p) e^(w0 t). The swing foot is put where xi will be at that time, so that the next centre of pressure can hold xi
// (Pratt et al. 2006, Capture Point; Khadiv et al., arXiv 1609.09822). This needs no torque of the ankles' roll.
struct GroundPoint {
  double x_m = 0, y_m = 0;
};

// The usable part of a sole, without a margin at its edges, relative to the foot's frame.
struct Sole {
  double heel_m = 0.07, toe_m = 0.12;  // behind and before; > 0
  double half_width_m = 0.03;
  double middle_m() const noexcept { return (toe_m - heel_m) / 2; }
};

// How two feet share the load so that the centre of pressure is at one point of the hull of their parallel soles.
struct LoadSplit {
  double right_share = 0.5;
  GroundPoint in_sole;  // from a foot's frame, the same in both
  GroundPoint at;       // the point itself
};
// For the point that is nearest to `wanted`, or nearly so. `left` and `right` are the feet's frames.
LoadSplit split_load(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                     const GroundPoint& wanted) noexcept;

// Distance from `point` to the point that split_load finds for it; 0 inside the hull.
double beyond_soles(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                    const GroundPoint& point) noexcept;

// xi after time_s, with a constant centre of pressure.
GroundPoint run_away(const GroundPoint& dcm, const GroundPoint& pressure, double rate_per_s, double time_s) noexcept;

// Whether a foot that swings has landed: it bears more than touch_N for touch_s. One reading alone may be noise: the
// sum of four sensors with 2 N of it each passes 15 N in the air once in some minutes.
struct Touchdown {
  double held_s = 0;

  void look(double force_N, double touch_N, double dt_s) noexcept { held_s = force_N > touch_N ? held_s + dt_s : 0; }
  bool landed(double touch_s) const noexcept { return held_s > 0 && held_s > touch_s - 1e-9; }
};

// Of a swing, over the share of its time that has passed (0..1): its way, from 0 to 1 with rest at both ends, and its
// height, 0..1.
double swing_way(double share) noexcept;
double swing_lift(double share) noexcept;

class StepPlan {
 public:
  enum class Phase : std::uint8_t { stands, swings, bears };

  struct Config {
    Sole sole;              // where the centre of pressure may be
    double front_m = 0.10;  // steps when xi is further than this before the front foot
    double back_m = 0.07;   // steps when xi is further than this behind the rear foot
    double ahead_s = 0.02;  // how far ahead xi is predicted for that
    double again_m = 0.03;  // after a step: steps again when xi is further than this beyond the soles
    double settle_s = 0.1;  // shortest time from a landing to the next step
    double swing_s = 0.26;
    double lift_m = 0.03;
    double extra_x_m = 0.05;  // how far beyond xi the foot is put
    double extra_y_m = 0.03;
    double apart_min_m = 0.17;  // between the feet, sideways
    double apart_max_m = 0.42;
    double reach_m = 0.40;       // longest step
    double pressure_gain = 1.0;  // (p - xi) / (xi - goal)
    double goal_x_m = 0.0;       // where xi shall rest, forward of the middle between the feet
    double touch_N = 15;         // a foot that bears this ..
    double touch_s = 0.003;      // .. for so long has landed
    double trust_per_s = 15;     // after the first step: observer gain for the measured xi
  };
  struct Sight {
    std::array<DcmMeasure::OverFoot, 2> over{};
    std::array<double, 2> force_N{}, cop_x_m{};  // of each foot
    double rate_per_s = 4;
  };
  struct State {
    Phase phase = Phase::stands;
    std::size_t stance = 0;  // 0 left, 1 right
    double time_s = 0;       // in the phase
    Touchdown touchdown;     // of the other foot
    Vec3 from_m{};           // where it lifted off, or landed
    GroundPoint foothold;
    GroundPoint dcm;           // over the stance foot
    double dcm_rate_m_s = 0;   // forward
    GroundPoint goal;          // where xi shall rest
    double right_share = 0.5;  // wanted share of the load on the right foot
    GroundPoint in_sole;       // wanted centre of pressure, from a foot's frame
    std::uint32_t steps = 0;
  };

  void reset() noexcept { state_ = {}; }
  void advance(const Config& config, const Sight& sight, double dt_s) noexcept;

  const State& state() const noexcept { return state_; }
  // Where the other foot's frame shall be, relative to the stance foot's frame.
  Vec3 other_foot(const Config& config) const noexcept;
  void pass_state(auto& bytes) noexcept {
    bytes(state_, looked_);
    bytes.must(state_.stance < 2);
  }

 private:
  GroundPoint foot(std::size_t foot) const noexcept;
  void look(const Config& config, const Sight& sight, double dt_s) noexcept;
  void see_feet(const Sight& sight) noexcept;
  void enter(Phase phase) noexcept;
  void begin_swing(const Sight& sight, std::size_t swing) noexcept;
  void choose_foothold(const Config& config, double rate_per_s) noexcept;
  void stand(const Config& config, const Sight& sight) noexcept;
  void swing(const Config& config, const Sight& sight, double dt_s) noexcept;
  void land(const Sight& sight) noexcept;
  void bear(const Config& config, const Sight& sight, double dt_s) noexcept;

  State state_;
  bool looked_ = false;
};

}  // namespace kadans
