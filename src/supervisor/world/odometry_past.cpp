#include "kadans/supervisor/odometry_past.h"

#include <cmath>
#include <numbers>

namespace kadans {

void OdometryPast::add(const PastPose& pose) noexcept {
  if (count_ > 0 && pose.time_ns <= nth(count_ - 1).time_ns) return;
  if (count_ == poses_max) {
    first_ = (first_ + 1) % poses_max;
    --count_;
  }
  ring_[(first_ + count_++) % poses_max] = pose;
}

std::optional<PastPose> OdometryPast::at(std::int64_t time_ns) const noexcept {
  if (count_ == 0 || time_ns < nth(0).time_ns) return std::nullopt;
  std::size_t before = 0, end = count_;  // the last pose that is not after it
  while (end - before > 1) {
    const std::size_t middle = before + (end - before) / 2;
    (nth(middle).time_ns <= time_ns ? before : end) = middle;
  }
  PastPose pose = nth(before);
  pose.time_ns = time_ns;
  if (before + 1 == count_) return pose;
  const PastPose& next = nth(before + 1);
  const double share =
      static_cast<double>(time_ns - nth(before).time_ns) / static_cast<double>(next.time_ns - nth(before).time_ns);
  pose.x_m += share * (next.x_m - pose.x_m);
  pose.y_m += share * (next.y_m - pose.y_m);
  pose.heading_rad += share * std::remainder(next.heading_rad - pose.heading_rad, 2 * std::numbers::pi);
  return pose;
}

}  // namespace kadans
