// Decides for a robot that walks which foot stands, when the other one comes down and where, from the divergent
// component of motion xi (dcm_measure.h). Computes no torques.
//
//   stands  Both feet are where they were put; nothing is asked for.
//   sways   Before the first step the load goes to the foot that will swing, until xi is where a step begins.
//   steps   One foot stands. The other one goes to its foothold, and stands from its landing on.
//   bears   After the last step both feet stand side by side, and xi comes to rest between them. When it leaves them,
//           the robot steps again, as often as it must.
//   rests   It has sunk, because a knee that bears alone has not torque enough. As xi is between the feet, both bear
//           until it is up again; then it steps on.
//
// While one foot stands, xi runs away from the centre of pressure p: xi(t) = p + (xi - p) e^(w t). A walk that repeats
// itself with the step (L, W) in the time T has at each landing the offset b between xi and the foot that landed:
//
//   b_x = L_x / (e^(wT) - 1)      b_y = L_y / (e^(wT) - 1) -+ W / (e^(wT) + 1)
//
// Place and time of the landing are found together (Khadiv et al., arXiv 1609.09822): of all times within bounds the
// plan takes the one where the time, the place and the offset together differ least from what was meant. Place and time
// are weak in that, the offset is strong. The passive ankle roll of a robot needs no torque for this.
//
// Positions are relative to the foot `stance`, in the heading frame, which is set anew at each landing. One owner, the
// control thread; nothing allocates.
#pragma once

#include <array>
#include <cstdint>

#include "control/balance/dcm_measure.h"
#include "kick_swing.h"
#include "step_geometry.h"

namespace kadans {

class WalkPlan {
 public:
  enum class Phase : std::uint8_t { stands, sways, steps, bears, rests };

  struct Config {
    double step_s = 0.2896, step_min_s = 0.162, step_max_s = 0.45;
    double width_m = 0.1755;  // between the feet, sideways
    double apart_min_m = 0.13, apart_max_m = 0.36;
    double reach_m = 0.38;    // longest step
    double lift_m = 0.03279;  // height of a swing
    double place_share = 1;   // how long before the end of a swing the foot is over its foothold, as share of it
    double sink_m_s = 0.25;   // how a late foot looks for the ground
    double place_weight = 0.01147, time_weight = 0.1837;  // of place and time beside that of the offset, 1
    double side_rate_share = 1.022;  // w across of the one along: the ankle roll's spring carries a part
    double trust_per_s = 12.88;      // observer gain for the measured xi
    double both_trust_per_s = 60;    // the same while both feet bear: none lands, and its velocity is right
    double by_load = 1;          // 1: each foot's measured xi counts by its load; 0: that of the stance foot alone does
    double edge_share = 0.5;     // how much of the measured pressure across counts for where xi will be
    double ankle_gain = 0.6986;  // shift of the pressure per error of xi
    double shift_x_m = -0.00455;  // where the pressure is meant to be, before the foot's frame
    double trim_per_s = 0.7;      // how fast the meant speed is corrected by the measured one
    double trim_max_m_s = 0.25;
    double touch_N = 15;          // a foot that bears this ..
    double touch_s = 0.003;       // .. for so long has landed
    double early_share = 0.6;     // of a swing, before which no landing counts
    double sway_gain = 1.0;       // shift of the load per error of xi, before the first step
    double sway_s = 0.4;          // longest such time
    double speed_max_m_s2 = 0.5;  // how fast the meant velocity changes
    double brake_m_s2 = 1.5;      // how fast it does once the robot shall stand
    double sunk_m = 0.04;         // how far the centre of mass may sink before it rests on both feet
    double rest_s = 0.5;          // longest rest
    Sole sole;
    KickSwing::Config kick;
  };
  struct Velocity {
    double forward_m_s = 0, left_m_s = 0, turn_rad_s = 0;
  };
  struct Wanted {
    Velocity velocity;
    bool go = false;
    Kick kick;
  };
  struct Sight {
    std::array<DcmMeasure::OverFoot, 2> over{};
    std::array<double, 2> force_N{}, cop_x_m{}, cop_y_m{};  // of each foot, in its frame
    double rate_per_s = 4;
    GroundPoint slope;  // of the ground, per metre
    double sunk_m = 0;  // how far the centre of mass is below its height
  };
  struct Feet {
    Vec3 from_m{};  // where the other foot lifted off, or landed
    Vec3 at_m{};    // where the other foot shall be now; heights are over the slope
    GroundPoint foothold;
  };
  struct Meant {
    Velocity velocity;         // now
    GroundPoint trim_m_s;      // added to it
    GroundPoint step, offset;  // of the next landing: where the other foot goes; the offset is b
    double begun_x_m = 0;      // the offset that was meant at the last landing, forward
    double turn_rad = 0;       // by which the heading turns at the next landing
  };
  struct State {
    Phase phase = Phase::stands;
    std::size_t stance = 0;  // 0 left, 1 right
    std::uint32_t steps = 0;
    double time_s = 0;  // in the phase
    double step_s = 0;  // when the foot is meant to land
    Feet feet;
    Touchdown touchdown;  // of the other foot
    Meant meant;
    GroundPoint dcm;  // over the stance foot
    double in_sole_x_m = 0;
    double in_sole_y_m = 0;   // the measured pressure, smoothed: the spring of the ankle roll decides it
    KickSwing kick;           // of this step
    bool prepares = false;    // the next step shall kick
    std::uint32_t kicks = 0;  // that were made
  };

  void reset() noexcept { state_ = {}; }
  // Begins with the foot that bears less. `sight` is in the frame of the heading.
  void begin(const Config& config, const Sight& sight) noexcept;
  // Where xi shall be while both feet bear.
  GroundPoint goal(const Config& config, const Sight& sight) const noexcept;
  // True in the tick of a landing: then turn the heading by meant.turn_rad and call turned().
  bool advance(const Config& config, const Wanted& wanted, const Sight& sight, double dt_s) noexcept;
  void turned(double by_rad) noexcept;

  // Where the other foot shall point, of the heading.
  double other_yaw_rad(const Config& config) const noexcept;

  const State& state() const noexcept { return state_; }
  void pass_state(auto& bytes) noexcept {
    bytes(state_, from_com_m_, step_time_s_);
    bytes.must(state_.stance < 2);
  }

 private:
  void follow_wanted(const Config& config, const Wanted& wanted, double dt_s) noexcept;
  void look(const Config& config, const Sight& sight, double dt_s) noexcept;
  void mean(const Config& config, const Sight& sight, const Kick& kick) noexcept;
  void choose(const Config& config, const Sight& sight) noexcept;
  void lead_foot(const Config& config) noexcept;
  void leave(const Sight& sight) noexcept;
  void land(const Config& config, const Wanted& wanted, const Sight& sight) noexcept;
  void trim(const Config& config, const Sight& sight) noexcept;
  bool between_feet(const Config& config, const Sight& sight, double share) const noexcept;
  void rest(const Config& config, const Wanted& wanted, const Sight& sight) noexcept;
  void sway(const Config& config, const Sight& sight) noexcept;
  bool swayed(const Config& config, const Sight& sight) noexcept;
  bool step_out(const Config& config, const Sight& sight) noexcept;

  State state_;
  GroundPoint from_com_m_;  // the centre of mass over the stance foot at the last landing
  double step_time_s_ = 0;  // of the last step
};

}  // namespace kadans
