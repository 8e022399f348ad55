// Where the robot was, by its odometry: an observation is older than now, and it is put where the robot was then.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kadans {

// A pose along the path of the odometry (OdometryStatus).
struct PastPose {
  std::int64_t time_ns = 0;
  double x_m = 0, y_m = 0, heading_rad = 0;
  std::uint32_t breaks = 0;
  std::uint32_t reserved = 0;
};

// One owner. Never allocates.
class OdometryPast {
 public:
  static constexpr std::size_t poses_max = 256;  // 2.5 s of behavior ticks

  // One that is not newer than the last is not taken.
  void add(const PastPose& pose) noexcept;
  // Between two poses it went straight; after the newest it stands. nullopt: before the oldest, or there is none.
  std::optional<PastPose> at(std::int64_t time_ns) const noexcept;
  std::size_t size() const noexcept { return count_; }

 private:
  const PastPose& nth(std::size_t n) const noexcept { return ring_[(first_ + n) % poses_max]; }  // 0: the oldest

  std::array<PastPose, poses_max> ring_{};
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace kadans
