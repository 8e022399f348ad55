// When to step, with which foot, and where to: from the divergent component of motion, xi, alone. No torques here.
//
//   stands  both feet as they were put; nothing is asked for. Steps when xi, looked ahead by its rate, leaves what the
//           soles hold, forward or backward
//   swings  the foot that xi leaves behind goes past the other one, to where xi will be when it comes down, seen anew
//           each tick. Feet that stand staggered need no push off: the push itself loads the one in front
//   bears   both feet as they landed. Steps again when xi leaves them
//
// Everything is seen from the foot `stance`, in the heading frame. One owner, the control thread; nothing allocates.
#pragma once

#include <array>
#include <cstdint>

#include "kadans/control/dcm_measure.h"
#include "kadans/control/step_geometry.h"

namespace kadans {

class StepPlan {
 public:
  enum class Phase : std::uint8_t { stands, swings, bears };

  struct Config {
    Sole sole;              // of what the centre of pressure may be
    double front_m = 0.10;  // xi before the foot in front beyond which it steps
    double back_m = 0.07;   // xi behind the foot behind
    double ahead_s = 0.02;  // how far xi is looked ahead
    double again_m = 0.03;  // the same beyond the soles, once it has stepped
    double settle_s = 0.1;  // after a landing, before the next step
    double swing_s = 0.26;
    double lift_m = 0.03;
    double extra_x_m = 0.05;  // further than xi
    double extra_y_m = 0.03;
    double apart_min_m = 0.17;  // between the feet
    double apart_max_m = 0.42;
    double reach_m = 0.40;       // longest step
    double pressure_gain = 1.0;  // of p - xi, per xi - goal
    double goal_x_m = 0.0;       // where xi shall rest, forward of the feet's middle
    double touch_N = 15;         // a foot that bears this has landed
    double trust_per_s = 15;     // in what is measured of xi, once it has stepped
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
    Vec3 from_m{};           // where the other foot left, or landed
    GroundPoint foothold;
    GroundPoint dcm;           // over the stance foot
    double dcm_rate_m_s = 0;   // forward
    GroundPoint goal;          // where xi shall rest
    double right_share = 0.5;  // of the load, asked for
    GroundPoint in_sole;       // of the centre of pressure
    std::uint32_t steps = 0;
  };

  void reset() noexcept { state_ = {}; }
  void advance(const Config& config, const Sight& sight, double dt_s) noexcept;

  const State& state() const noexcept { return state_; }
  // Where the other foot's frame shall be, from the stance foot's.
  Vec3 other_foot(const Config& config) const noexcept;

 private:
  GroundPoint foot(std::size_t foot) const noexcept;
  void look(const Config& config, const Sight& sight, double dt_s) noexcept;
  void see_feet(const Sight& sight) noexcept;
  void enter(Phase phase) noexcept;
  void begin_swing(const Sight& sight, std::size_t swing) noexcept;
  void choose_foothold(const Config& config, double rate_per_s) noexcept;
  void stand(const Config& config, const Sight& sight) noexcept;
  void swing(const Config& config, const Sight& sight) noexcept;
  void land(const Sight& sight) noexcept;
  void bear(const Config& config, const Sight& sight, double dt_s) noexcept;

  State state_;
  bool looked_ = false;
};

}  // namespace kadans
