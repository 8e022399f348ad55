// Whether a joint stays stable while two control objects take turns, not only whether one switch makes no step. Two
// stable loops that take turns can be unstable: switching at the right moments puts energy in (Liberzon, Switching in
// Systems and Control, Birkhauser 2003, ch. 2). So the switching is looked for that excites the joint most, while it
// follows a motion under the load of the bench.
//
//   const auto make = [] { return std::make_unique<JointBench>(config, objects); };
//   CHECK(switching_stability(make, "soft", "stiff") <= StabilityLimits{});
//
// A motion with switches is compared with the same motion without: with the worse of the two objects alone. Compared
// are the tracking error (RMS) and how far the mechanical energy of the joint swings (kinetic, and that of its weight).
// That energy is the plant's alone, so that no object's own notion of energy counts. `growth` needs no other motion:
// how far the energy swings in the second half of the time, as a multiple of the first half. Of a joint that runs away
// it is far above 1.
//
// An object that is led by no position, but by a velocity or by nothing, lets the joint drift, and keeps the error that
// it inherits. The other one has to bring the joint back, and that takes energy, however rare the switches are. So such
// a pair is compared with switches twice as far apart as the rarest that are tried, too. An object that is led by
// nothing follows no motion: no error is judged then.
//
// An object gets its set-points in the tick of its switch, as from one transaction, and is led along the motion from
// then on. An object that begins its motion anew where the joint is, at each switch, holds the joint at many places in
// turn; switched fast it is not stable, whatever the object.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>

namespace kadans::testing {

class JointBench;

using MakeBench = std::function<std::unique_ptr<JointBench>()>;  // each motion begins with a new one

// The motion, offset + amplitude sin(2 pi f t), which begins softly, and where to look for the worst switching.
struct SwitchingSearch {
  double amplitude_rad = 0.3, offset_rad = 0, frequency_Hz = 0.7;
  double settle_s = 1, duration_s = 5;           // judged from settle_s on
  double period_min_s = 0.04, period_max_s = 2;  // of two switches: 0.04 s are 50 switches a second
  double dwell_s = 0;                            // least time between two switches (switch_dwell_s)
  int periods = 10;      // tried first, evenly in the logarithm, each with three shares and two phases
  int refinements = 10;  // drawn around the worst
  std::uint64_t seed = 1;
};

struct SwitchingPattern {
  double period_s = 0;  // 0: no switch
  double share = 0.5;   // of the period in which the second object is active
  double phase = 0;     // how far the period is when the motion begins, 0..1
};

struct SwitchedMotion {
  SwitchingPattern pattern;
  double energy_J = 0;  // from its lowest to its highest
  double growth = 0;    // of that, from the first half of the time to the second
  double rms_error_rad = 0, peak_error_rad = 0;
};

struct SwitchingStability {
  std::string first, second;
  bool one_drifts = false, one_coasts = false;  // one of them is led by no position, by nothing at all
  SwitchedMotion first_alone, second_alone;
  SwitchedMotion most_energy, most_error, most_growth;  // of all that were tried
  SwitchedMotion rarest;                                // when one drifts: the worst of the rarest switches
  double energy_ratio = 0, error_ratio = 0;             // of the worst to the worse of the two alone, or to the rarest
  int motions = 0;                                      // that were tried
};

struct StabilityLimits {
  double energy_ratio = 1.2, error_ratio = 1.2;
  double error_resolution_rad = 1e-3;  // a smaller error is not judged
  double energy_resolution_J = 1e-3;   // nor so small an energy, of a joint that rests
};

SwitchedMotion switched_motion(const MakeBench& make, std::string_view first, std::string_view second,
                               const SwitchingPattern& pattern, const SwitchingSearch& search = {});
SwitchingStability switching_stability(const MakeBench& make, std::string_view first, std::string_view second,
                                       const SwitchingSearch& search = {});

bool operator<=(const SwitchingStability& found, const StabilityLimits& limits) noexcept;
std::ostream& operator<<(std::ostream& out, const SwitchingStability& found);
std::ostream& operator<<(std::ostream& out, const StabilityLimits& limits);

}  // namespace kadans::testing
