#include "kadans/testing/switching_stability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>

#include "kadans/signal/random.h"
#include "kadans/testing/joint_bench.h"

namespace kadans::testing {
namespace {

constexpr double soft_s = 0.5;  // in which the motion begins
constexpr double shares[] = {0.5, 0.25, 0.75};

SetpointState reference(const SwitchingSearch& search, double time_s) {
  const double turn_rad_s = 2 * std::numbers::pi * search.frequency_Hz, angle = turn_rad_s * time_s;
  const double grown = std::min(1.0, time_s / soft_s), gain = search.amplitude_rad * grown * grown * (3 - 2 * grown);
  const double growth = time_s < soft_s ? search.amplitude_rad * 6 * grown * (1 - grown) / soft_s : 0;
  return {search.offset_rad + gain * std::sin(angle), gain * turn_rad_s * std::cos(angle) + growth * std::sin(angle),
          -gain * turn_rad_s * turn_rad_s * std::sin(angle)};
}

// Of the joint: kinetic, and that of its weight; 0 at rest where it hangs down.
double energy_J(JointBench& bench) {
  const OneJointPlant::Config& plant = bench.config().plant;
  const double velocity_rad_s = bench.velocity_rad_s();
  return 0.5 * (plant.inertia_kg_m2 + plant.rotor_inertia_kg_m2) * velocity_rad_s * velocity_rad_s +
         plant.gravity_Nm * (1 - std::cos(bench.position_rad())) - plant.load_Nm * bench.position_rad();
}

struct Swing {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  void add(double value) {
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  double size() const { return highest - lowest; }
};

bool second_is_due(const SwitchingPattern& pattern, double time_s) {
  if (!(pattern.period_s > 0)) return false;
  return std::fmod(time_s + pattern.phase * pattern.period_s + 1e-9, pattern.period_s) >=
         (1 - pattern.share) * pattern.period_s;
}

class Search {
 public:
  Search(const MakeBench& make, const SwitchingSearch& search, SwitchingStability& found)
      : make_(make), search_(search), found_(found) {}

  void try_pattern(SwitchingPattern pattern) {
    pattern.period_s = std::max(pattern.period_s, 2 * search_.dwell_s);
    const double least = search_.dwell_s / pattern.period_s;
    pattern.share = std::clamp(pattern.share, least, 1 - least);
    const SwitchedMotion motion = switched_motion(make_, found_.first, found_.second, pattern, search_);
    ++found_.motions;
    // What is not finite is the worst, and stays it.
    const auto worse = [](double now, double before) { return std::isfinite(before) && !(now <= before); };
    if (worse(motion.energy_J, found_.most_energy.energy_J)) found_.most_energy = motion;
    if (worse(motion.rms_error_rad, found_.most_error.rms_error_rad)) found_.most_error = motion;
    if (worse(motion.growth, found_.most_growth.growth)) found_.most_growth = motion;
  }
  void try_grid() {
    const double ratio = search_.period_max_s / search_.period_min_s;
    for (int i = 0; i < search_.periods; ++i) {
      const double at = search_.periods > 1 ? static_cast<double>(i) / (search_.periods - 1) : 0;
      for (const double share : shares) {
        for (const double phase : {0.0, 0.5}) try_pattern({search_.period_min_s * std::pow(ratio, at), share, phase});
      }
    }
    for (const double turns : {0.5, 1.0}) {  // in step with the motion
      const double period_s = turns / search_.frequency_Hz;
      if (period_s >= search_.period_min_s && period_s <= search_.period_max_s) try_pattern({period_s, 0.5, 0.0});
    }
  }
  void refine() {
    RandomStream random(search_.seed, "switching_stability");
    for (int i = 0; i < search_.refinements; ++i) {
      const SwitchingPattern& worst = (i % 2 == 0 ? found_.most_energy : found_.most_error).pattern;
      const double period_s = worst.period_s * std::exp(random.uniform(-0.3, 0.3));
      const double share = std::clamp(worst.share + random.uniform(-0.2, 0.2), 0.1, 0.9);
      try_pattern({std::clamp(period_s, search_.period_min_s, search_.period_max_s), share, random.uniform()});
    }
  }

 private:
  const MakeBench& make_;
  const SwitchingSearch& search_;
  SwitchingStability& found_;
};

std::ostream& operator<<(std::ostream& out, const SwitchedMotion& motion) {
  if (motion.pattern.period_s > 0)
    out << "period " << motion.pattern.period_s << " s, share " << motion.pattern.share << ": ";
  return out << "energy " << motion.energy_J << " J, growth " << motion.growth << ", error RMS " << motion.rms_error_rad
             << " rad, peak " << motion.peak_error_rad << " rad";
}

}  // namespace

SwitchedMotion switched_motion(const MakeBench& make, std::string_view first, std::string_view second,
                               const SwitchingPattern& pattern, const SwitchingSearch& search) {
  const std::unique_ptr<JointBench> bench = make();
  const auto ticks = std::llround(search.duration_s / bench->config().dt_s);
  const double half_s = 0.5 * (search.settle_s + search.duration_s);
  SwitchedMotion motion{.pattern = pattern};
  Swing first_half, second_half;
  bool second_active = false;
  double squares = 0, judged = 0;
  bench->switch_to(first);
  for (long long i = 0; i < ticks; ++i) {
    const double time_s = bench->config().dt_s * static_cast<double>(i);
    const SetpointState wanted = reference(search, time_s);
    if (const bool due = second_is_due(pattern, time_s); due != second_active) {
      bench->switch_to(due ? second : first);
      second_active = due;
    }
    const double error_rad = wanted.value - bench->position_rad();
    bench->lead(wanted);
    bench->tick();
    if (time_s < search.settle_s) continue;
    squares += error_rad * error_rad;
    ++judged;
    (time_s < half_s ? first_half : second_half).add(energy_J(*bench));
    if (!(std::abs(error_rad) <= motion.peak_error_rad)) motion.peak_error_rad = std::abs(error_rad);
  }
  motion.rms_error_rad = judged > 0 ? std::sqrt(squares / judged) : 0;
  motion.growth = second_half.size() / first_half.size();
  first_half.add(second_half.lowest);
  first_half.add(second_half.highest);
  motion.energy_J = first_half.size();
  // The bench replaces such torques by 0.
  if (bench->not_finite_ticks() > 0) motion.energy_J = motion.rms_error_rad = std::numeric_limits<double>::quiet_NaN();
  return motion;
}

namespace {

// What switches cost that are twice as far apart as any that is tried: the largest energy and error of several.
SwitchedMotion rarest_switches(const MakeBench& make, std::string_view first, std::string_view second,
                               SwitchingSearch search) {
  const double period_s = 2 * search.period_max_s;
  search.duration_s = std::max(search.duration_s, search.settle_s + 2 * period_s);
  SwitchedMotion rarest;
  for (const double share : shares) {
    for (int phase = 0; phase < 8; ++phase) {
      const SwitchedMotion motion = switched_motion(make, first, second, {period_s, share, 0.125 * phase}, search);
      rarest.energy_J = std::max(rarest.energy_J, motion.energy_J);
      rarest.rms_error_rad = std::max(rarest.rms_error_rad, motion.rms_error_rad);
    }
  }
  return rarest;
}

}  // namespace

SwitchingStability switching_stability(const MakeBench& make, std::string_view first, std::string_view second,
                                       const SwitchingSearch& search) {
  SwitchingStability found{.first = std::string(first), .second = std::string(second)};
  const auto bench = make();
  const JointBench::Led least = std::min(bench->led(first), bench->led(second));
  found.one_drifts = least != JointBench::Led::position;
  found.one_coasts = least == JointBench::Led::nothing;
  found.first_alone = switched_motion(make, first, first, {}, search);
  found.second_alone = switched_motion(make, second, second, {}, search);
  if (found.one_drifts) found.rarest = rarest_switches(make, first, second, search);
  Search trials(make, search, found);
  trials.try_grid();
  trials.refine();
  const double alone_J = std::max(found.first_alone.energy_J, found.second_alone.energy_J);
  found.energy_ratio = found.most_energy.energy_J / std::max(alone_J, found.rarest.energy_J);
  const double alone_rad = std::max(found.first_alone.rms_error_rad, found.second_alone.rms_error_rad);
  found.error_ratio = found.most_error.rms_error_rad / std::max(alone_rad, found.rarest.rms_error_rad);
  return found;
}

bool operator<=(const SwitchingStability& found, const StabilityLimits& limits) noexcept {
  const bool exact = found.one_coasts || found.most_error.rms_error_rad <= limits.error_resolution_rad;
  const bool rests = found.most_energy.energy_J <= limits.energy_resolution_J;
  return (rests || found.energy_ratio <= limits.energy_ratio) && (exact || found.error_ratio <= limits.error_ratio);
}

std::ostream& operator<<(std::ostream& out, const SwitchingStability& found) {
  out << "switching between " << found.first << " and " << found.second << ", " << found.motions << " motions\n  "
      << found.first << " alone: " << found.first_alone << "\n  " << found.second << " alone: " << found.second_alone
      << "\n  most energy (" << found.energy_ratio << " times): " << found.most_energy << "\n  largest error ("
      << found.error_ratio << " times): " << found.most_error << "\n";
  return out;
}

std::ostream& operator<<(std::ostream& out, const StabilityLimits& limits) {
  return out << "energy <= " << limits.energy_ratio << " times, error <= " << limits.error_ratio << " times";
}

}  // namespace kadans::testing
