#include "wiggle.h"

#include <algorithm>
#include <cmath>

namespace kadans {

Wiggle::Wiggle(const Settings& settings) : settings_(settings) { set_turn(); }

// effort = inertia reach / quarter^2 lets it move by `reach`. Where friction holds it, the effort grows beyond that.
void Wiggle::set_turn() {
  const double most_Nm = 1.5 * settings_.inertia_kg_m2 * settings_.reach_rad / (fastest_s * fastest_s);
  const double limit_Nm = std::min(settings_.effort_max_Nm, most_Nm);
  const double reach_Nms2 = settings_.least_inertia_kg_m2 * settings_.reach_rad;
  effort_Nm_ = effort_Nm_ == 0 ? reach_Nms2 / (slowest_s * slowest_s) : growth * effort_Nm_;
  last_ = effort_Nm_ >= limit_Nm;
  effort_Nm_ = std::min(effort_Nm_, limit_Nm);
  quarter_s_ = std::clamp(std::sqrt(reach_Nms2 / effort_Nm_), fastest_s, slowest_s);
}

void Wiggle::begin(const BenchSight& sight) {
  phase_ = 4;  // a rest first: the drive is enabled, a brake opens
  since_s_ = read_at_s_ = sight.time_s;
  turn_begun_ = false;
  late_turns_ = 0;
}

void Wiggle::end_turn() {
  late_turns_ = late_ ? late_turns_ + 1 : 0;
  if (late_) return;
  const auto answered = [&](double rad) { return std::abs(rad) >= settings_.seen_rad; };
  bool any = false, same = true;
  for (std::size_t i = 0; i < settings_.joints; ++i) {
    // Its fourth difference: what drifts or falls is no answer, and a stop on one side does not turn it round.
    const double answer_rad =
        first_ / 2 * (at_rad_[0][i] - 4 * at_rad_[1][i] + 6 * at_rad_[2][i] - 4 * at_rad_[3][i] + at_rad_[4][i]);
    if (answered(answer_rad)) {
      any = true;
      same = same && (seen_turns_ == 0 || answer_rad * last_answers_rad_[i] >= 0);
    }
    last_answers_rad_[i] = answer_rad;
  }
  if (any && same) {
    ++seen_turns_;
    answers_rad_ = last_answers_rad_;
    return;
  }
  seen_turns_ = 0;
  ended_ = last_;
  if (last_) return;
  set_turn();
}

double Wiggle::step(const BenchSight& sight) {
  told_Nm_ = std::max(told_Nm_, std::abs(sight.effort_Nm[settings_.joint]));
  if (sight.since_s[settings_.joint] > 0) read_at_s_ = sight.time_s;
  late_ = late_ || (phase_ < 4 && std::max(sight.dt_s, sight.time_s - read_at_s_) > quarter_s_);
  const double passed_s = sight.time_s - since_s_;
  if (passed_s >= (phase_ == 4 ? rest_s : quarter_s_) - 1e-9) {
    since_s_ = sight.time_s;
    if (phase_ == 4 && turn_begun_) end_turn();
    phase_ = (phase_ + 1) % 5;
    if (phase_ == 0) {
      first_ = -first_;  // what friction lets drift comes back
      turn_begun_ = true;
      late_ = false;
    }
    at_rad_[static_cast<std::size_t>(phase_)] = sight.position_rad;
  }
  if (phase_ == 4) return 0;
  return phase_ == 0 || phase_ == 3 ? first_ * effort_Nm_ : -first_ * effort_Nm_;
}

}  // namespace kadans
