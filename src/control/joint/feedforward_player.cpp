#include "feedforward_player.h"

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

void PlayerLaw::start(const Handover& handover) noexcept {
  state_ = {};
  effort_before_Nm_ = effort_before_Nm(handover);
  law_.start(effort_before_Nm_);
  amplitude_.reset(0);
  continue_motion(posture_, handover.state.position_rad, handover.state.velocity_rad_s, axis_);
}

JointActuation PlayerLaw::step(const JointState& joint, double dt_s) noexcept {
  const Config& c = config_;
  const MinimumJerk::State& posture = posture_.step(dt_s);
  const MinimumJerk::State& amplitude = amplitude_.step(dt_s);
  const double series_rad = c.position_rad.value(*phase_);
  const double wanted_rad = posture.position + amplitude.position * series_rad;
  const double within_rad =
      std::clamp(wanted_rad, std::min(axis_.lower_rad, posture.position), std::max(axis_.upper_rad, posture.position));
  const double velocity_rad_s =
      posture.velocity + amplitude.velocity * series_rad + amplitude.position * c.position_rad.rate(*phase_);
  state_.amplitude = amplitude.position;
  state_.feedforward_Nm = effort_before_Nm_ + amplitude.position * c.effort_Nm.value(*phase_);
  return law_.step(within_rad, within_rad == wanted_rad ? velocity_rad_s : 0, state_.feedforward_Nm, joint);
}

FeedforwardPlayer::FeedforwardPlayer(const ObjectSetup& setup) : Jointwise(setup) {
  for (std::size_t i = 0; i < size(); ++i) law(i).follow(phase_);
}

void FeedforwardPlayer::declare(Declaration& declaration) {
  declaration.parameter({"rate_Hz", "Hz", 0, 20, 1, "Periods of the series in a second."}, &rate_Hz_);
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
