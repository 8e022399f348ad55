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
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

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
  void start(const Takeover& takeover) noexcept;
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

void PlayerPhase::start() noexcept {
  turns = 0;
  step(0, 0);
}

void PlayerPhase::step(double rate_Hz, double dt_s) noexcept {
  rate_rad_s = 2 * std::numbers::pi * rate_Hz;
  turns += rate_Hz * dt_s;
  turns -= std::floor(turns);
  const double c = std::cos(2 * std::numbers::pi * turns), s = std::sin(2 * std::numbers::pi * turns);
  cosine[0] = c;
  sine[0] = s;
  for (std::size_t n = 1; n < harmonic_count; ++n) {
    cosine[n] = c * cosine[n - 1] - s * sine[n - 1];
    sine[n] = s * cosine[n - 1] + c * sine[n - 1];
  }
}

double HarmonicSeries::value(const PlayerPhase& phase) const noexcept {
  double sum = 0;
  for (std::size_t n = 0; n < harmonic_count; ++n) sum += cosine[n] * phase.cosine[n] + sine[n] * phase.sine[n];
  return sum;
}

double HarmonicSeries::rate(const PlayerPhase& phase) const noexcept {
  double sum = 0;
  for (std::size_t n = 0; n < harmonic_count; ++n) {
    sum += static_cast<double>(n + 1) * (sine[n] * phase.cosine[n] - cosine[n] * phase.sine[n]);
  }
  return phase.rate_rad_s * sum;
}

namespace {

void declare_series(AxisTables& tables, const char* what, const char* unit, double most, HarmonicSeries& series) {
  const auto coefficient = [&](const char* function, const char* doc, std::size_t order, double* value) {
    const std::string number = std::to_string(order);
    std::string name = what;
    name.append("_").append(function).append(number).append("_").append(unit);
    std::string sentence = doc;
    sentence.append(" of order ").append(number).append(" in the ").append(what).append(".");
    tables.tunable(name.c_str(), unit, -most, most, 0, value, sentence.c_str());
  };
  for (std::size_t n = 0; n < harmonic_count; ++n) {
    coefficient("cos", "Cosine", n + 1, &series.cosine[n]);
    coefficient("sin", "Sine", n + 1, &series.sine[n]);
  }
}

}  // namespace

void PlayerLaw::declare(AxisTables& tables) {
  law_.declare(tables, {"kp_Nm_per_rad", "kd_Nms_per_rad", "error_rad"});
  declare_series(tables, "position", "rad", 3.2, config_.position_rad);
  declare_series(tables, "effort", "Nm", axis_.effort_max_Nm, config_.effort_Nm);
  tables.setpoint("amplitude", "", 0, 1, "Share of the series that is played.", 0);
  tables.signal("amplitude", "", "Share of the series that is played.", &state_.amplitude);
  tables.signal("feedforward_Nm", "Nm", "Torque played, and that taken over.", &state_.feedforward_Nm);
}

void PlayerLaw::start(const Takeover& takeover) noexcept {
  state_ = {};
  effort_before_Nm_ = effort_before_Nm(takeover);
  law_.start(effort_before_Nm_);
  amplitude_.reset(0);
  continue_motion(posture_, takeover.state.position_rad, takeover.state.velocity_rad_s, axis_);
}

JointActuation PlayerLaw::step(const JointState& joint, double dt_s) noexcept {
  const Config& c = config_;
  const SetpointState& posture = posture_.step(dt_s);
  const SetpointState& amplitude = amplitude_.step(dt_s);
  const double series_rad = c.position_rad.value(*phase_);
  const double wanted_rad = posture.value + amplitude.value * series_rad;
  const double within_rad =
      std::clamp(wanted_rad, std::min(axis_.lower_rad, posture.value), std::max(axis_.upper_rad, posture.value));
  const double velocity_rad_s =
      posture.velocity + amplitude.velocity * series_rad + amplitude.value * c.position_rad.rate(*phase_);
  state_.amplitude = amplitude.value;
  state_.feedforward_Nm = effort_before_Nm_ + amplitude.value * c.effort_Nm.value(*phase_);
  return law_.step(within_rad, within_rad == wanted_rad ? velocity_rad_s : 0, state_.feedforward_Nm, joint);
}

FeedforwardPlayer::FeedforwardPlayer(const ObjectSetup& setup) : Jointwise(setup) {
  for (std::size_t i = 0; i < size(); ++i) law(i).follow(phase_);
}

void FeedforwardPlayer::declare(Declaration& declaration) {
  declaration.tunable("rate_Hz", "Hz", 0, 20, rate_Hz_, "Periods of the series in a second.");
  declaration.signal({"phase_turns", "", "Part of the period that has passed, 0 to 1."}, &phase_.turns);
  Jointwise::declare(declaration);
}

void FeedforwardPlayer::start(const ControlInput& input) noexcept {
  phase_.start();
  fresh_ = true;
  Jointwise::start(input);
}

void FeedforwardPlayer::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  phase_.step(rate_Hz_, std::exchange(fresh_, false) ? 0 : input.dt_s);
  Jointwise::step(input, actuation);
}

std::unique_ptr<ControlObject> make_feedforward_player(const ObjectSetup& setup) {
  return std::make_unique<FeedforwardPlayer>(setup);
}

}  // namespace kadans
