// Plays a periodic motion and the torque that belongs to it, around the posture in which it started, in effort mode:
// type "feedforward_player". The known torque is fed forward, a PD only corrects (Craig, Introduction to Robotics, 3rd
// ed., sec. 9.9). The series may come from a model, from a record of an earlier run or from iterative learning.
//
//   phi' = 2 pi rate,   s_x(phi) = sum over n = 1..3 of  x_cos<n> cos(n phi) + x_sin<n> sin(n phi)
//   q_ref = q_0 + A s_position(phi)
//   u = limit(u_0 + A s_effort(phi) + kp (q_ref - q) + kd (v_ref - v), +-effort_max)
//
// All joints share one phase phi, which is 0 at the start. The amplitude A is a set-point of each joint. It is 0 at the
// start; moving it fades the series in and out. q_0 is where the joint comes to rest after the start, u_0 the torque
// from before the start.
//
// Set-points  <joint>.amplitude, 0..1, reached along a minimum-jerk curve in the time given.
// Parameters  rate_Hz of the object; gains and series of each joint. A changed coefficient acts at once: change it
//             while the amplitude is 0.
#pragma once

#include <array>
#include <memory>

#include "kadans/control/jointwise.h"
#include "kadans/control/position_reference.h"
#include "kadans/control/spring_damper.h"

namespace kadans {

inline constexpr std::size_t harmonic_count = 3;

// The phase that all joints of a player share, with the cosines and sines of its multiples.
class PlayerPhase {
 public:
  void start() noexcept;
  void step(double rate_Hz, double dt_s) noexcept;

  double turns = 0;  // 0..1
  double rate_rad_s = 0;
  std::array<double, harmonic_count> cosine{}, sine{};
};

// A Fourier series without its constant term.
struct HarmonicSeries {
  std::array<double, harmonic_count> cosine{}, sine{};
  double value(const PlayerPhase& phase) const noexcept;
  double rate(const PlayerPhase& phase) const noexcept;  // its derivative by time
};

class PlayerLaw {
 public:
  struct Config {
    HarmonicSeries position_rad, effort_Nm;
  };
  struct State {
    double amplitude = 0;
    double feedforward_Nm = 0;  // u_0 and the series
  };
  static constexpr std::uint32_t channels = 1;

  explicit PlayerLaw(const JointAxis& axis) : axis_(axis) {}
  void follow(const PlayerPhase& phase) noexcept { phase_ = &phase; }  // before start
  void declare(AxisTables& tables);
  void start(const Handover& handover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void set_point(std::uint32_t, double value, double duration_s) noexcept { amplitude_.move(value, duration_s); }
  void cancel(std::uint32_t) noexcept { amplitude_.move(0, cancel_time_s); }
  double remaining_s() const noexcept { return amplitude_.remaining_s(); }
  void pass_state(StateBytes& bytes) noexcept { bytes(state_, law_, posture_, amplitude_, effort_before_Nm_); }

 private:
  JointAxis axis_;
  Config config_;
  State state_;
  SpringDamper law_;
  MinimumJerk posture_, amplitude_;
  double effort_before_Nm_ = 0;
  const PlayerPhase* phase_ = nullptr;
};

class FeedforwardPlayer final : public Jointwise<PlayerLaw> {
 public:
  explicit FeedforwardPlayer(const ObjectSetup& setup);
  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void pass_state(StateBytes& bytes) noexcept override {
    Jointwise::pass_state(bytes);
    bytes(phase_, fresh_);
  }

 private:
  double rate_Hz_ = 1;
  PlayerPhase phase_;
  bool fresh_ = false;
};

std::unique_ptr<ControlObject> make_feedforward_player(const ObjectSetup& setup);

}  // namespace kadans
