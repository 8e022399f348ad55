#include "kadans/control/feedforward_player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace kadans {

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

constexpr double cancel_time_s = 0.1;

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
  Config& c = config_;
  const State& s = state_;
  const double most = axis_.effort_max_Nm;
  tables.tunable("kp_Nm_per_rad", "Nm/rad", 0, 5000, 0, &c.kp_Nm_per_rad, "Torque per position error.");
  tables.tunable("kd_Nms_per_rad", "Nm s/rad", 0, 500, 0, &c.kd_Nms_per_rad, "Torque per velocity error.");
  tables.tunable("effort_max_Nm", "Nm", 0, most, most, &c.effort_max_Nm, "Bound of the torque.");
  declare_series(tables, "position", "rad", 3.2, c.position_rad);
  declare_series(tables, "effort", "Nm", most, c.effort_Nm);
  tables.setpoint("amplitude", "", 0, 1, "Share of the series that is played.", 0);
  tables.signal("amplitude", "", "Share of the series that is played.", &s.amplitude);
  tables.signal("reference_rad", "rad", "Where the joint shall be.", &s.reference_rad);
  tables.signal("reference_velocity_rad_s", "rad/s", "Its velocity.", &s.reference_velocity_rad_s);
  tables.signal("feedforward_Nm", "Nm", "Torque played, and that taken over.", &s.feedforward_Nm);
  tables.signal("error_rad", "rad", "Reference minus position.", &s.error_rad);
  tables.signal("effort_Nm", "Nm", "Torque computed.", &s.effort_Nm);
  tables.signal("saturated", "", "Whether the torque was limited.", &s.saturated);
}

void PlayerLaw::start(const Handover& handover) noexcept {
  state_ = {};
  effort_before_Nm_ = state_.effort_Nm = effort_before_Nm(handover);
  amplitude_.reset(0);
  continue_motion(posture_, handover.state.position_rad, handover.state.velocity_rad_s, axis_);
}

JointActuation PlayerLaw::step(const JointState& joint, double dt_s) noexcept {
  const Config& c = config_;
  State& s = state_;
  const MinimumJerk::State& posture = posture_.step(dt_s);
  const MinimumJerk::State& amplitude = amplitude_.step(dt_s);
  const double series_rad = c.position_rad.value(*phase_);
  s.amplitude = amplitude.position;
  s.reference_rad = posture.position + amplitude.position * series_rad;
  s.reference_velocity_rad_s =
      posture.velocity + amplitude.velocity * series_rad + amplitude.position * c.position_rad.rate(*phase_);
  const double within_rad = std::clamp(s.reference_rad, std::min(axis_.lower_rad, posture.position),
                                       std::max(axis_.upper_rad, posture.position));
  if (within_rad != s.reference_rad) {
    s.reference_rad = within_rad;
    s.reference_velocity_rad_s = 0;
  }
  s.feedforward_Nm = effort_before_Nm_ + amplitude.position * c.effort_Nm.value(*phase_);
  s.error_rad = s.reference_rad - joint.position_rad;
  const double unlimited_Nm = s.feedforward_Nm + c.kp_Nm_per_rad * s.error_rad +
                              c.kd_Nms_per_rad * (s.reference_velocity_rad_s - joint.velocity_rad_s);
  s.effort_Nm = std::clamp(unlimited_Nm, -c.effort_max_Nm, c.effort_max_Nm);
  s.saturated = s.effort_Nm != unlimited_Nm;
  return {.effort_Nm = s.effort_Nm, .mode = ActuationMode::effort};
}

void PlayerLaw::set_point(std::uint32_t, double value, double duration_s) noexcept {
  amplitude_.move(value, duration_s);
}

void PlayerLaw::cancel(std::uint32_t) noexcept { amplitude_.move(0, cancel_time_s); }

FeedforwardPlayer::FeedforwardPlayer(const ObjectSetup& setup) : Jointwise(setup) {
  for (std::size_t i = 0; i < size(); ++i) law(i).follow(phase_);
}

void FeedforwardPlayer::declare(Declaration& declaration) {
  declaration.parameter({"rate_Hz", "Hz", 0, 20, 1, "Periods a second."}, &rate_Hz_);
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
