#include "learnt_swing.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr double moment_s = 0.015;
constexpr std::size_t ahead = 1;       // moments by which a torque is given before it was needed: the leg is slow
constexpr double beside_share = 0.25;  // of the moments before and after, so that what is learnt stays smooth
constexpr double kept_share = 0.93;    // of what was learnt before: no two steps are quite the same
// The yaw turns the foot to a heading, and the ankle keeps its sole level by where the leg is: they have nothing to
// learn.
constexpr std::array<LegJoint, 3> learn_too{hip_roll, hip_pitch, knee};

}  // namespace

LearntSwing::Efforts LearntSwing::at(double time_s) const noexcept {
  const double place = time_s / moment_s - 0.5;  // in moments, of which each is known in its middle
  if (!(place < static_cast<double>(moments - 1))) return {};
  const double from = std::max(std::floor(place), 0.0), share = std::max(place - from, 0.0);
  const Efforts &a = learnt_Nm_[static_cast<std::size_t>(from)], &b = learnt_Nm_[static_cast<std::size_t>(from) + 1];
  Efforts effort_Nm{};
  for (std::size_t j = 0; j < leg_joints; ++j) effort_Nm[j] = a[j] + share * (b[j] - a[j]);
  return effort_Nm;
}

void LearntSwing::see(double time_s, const Efforts& spring_Nm) noexcept {
  const double place = time_s / moment_s;
  if (!(place < static_cast<double>(moments))) return;
  Seen& seen = seen_[static_cast<std::size_t>(std::max(place, 0.0))];
  for (std::size_t j = 0; j < leg_joints; ++j) seen.sum_Nm[j] += spring_Nm[j];
  ++seen.times;
}

void LearntSwing::learn(double share, const Efforts& most_Nm) noexcept {
  if (std::ranges::all_of(seen_, [](const Seen& seen) { return seen.times == 0; })) return;
  std::array<Efforts, moments> raw = learnt_Nm_;
  for (std::size_t i = 0; i + ahead < moments; ++i) {
    const Seen& seen = seen_[i + ahead];
    if (seen.times == 0) continue;
    for (const LegJoint j : learn_too) raw[i][j] = kept_share * raw[i][j] + share * seen.sum_Nm[j] / seen.times;
  }
  for (std::size_t i = 0; i < moments; ++i) {
    const Efforts &before = raw[i > 0 ? i - 1 : 0], &after = raw[std::min(i + 1, moments - 1)];
    for (std::size_t j = 0; j < leg_joints; ++j)
      learnt_Nm_[i][j] = std::clamp(beside_share * (before[j] + after[j]) + (1 - 2 * beside_share) * raw[i][j],
                                    -most_Nm[j], most_Nm[j]);
  }
  seen_ = {};
}

}  // namespace kadans
