// What the robot knows of the world: one entry for each thing that the configuration declares, each with the newest
// observation of it, its time, its confidence and its source.
//
// An observation tells where a thing was, as seen from the robot, some time ago. The model looks up where the robot was
// then, and keeps the place along the path of the odometry. There it stays while the robot walks on; whoever reads it
// sees it from where the robot is by then (SeenEntry). When the odometry lost the way meanwhile, because the robot fell
// or was lifted, the entry says that it is not carried.
//
// Whatever comes is checked, whoever sends it: what is not finite, outside of its range, from the future, older than
// what is known or older than the odometry's past is refused and counted, and changes nothing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kadans/signal/observation.h"
#include "kadans/signal/seen_info.h"
#include "kadans/supervisor/odometry_past.h"

namespace kadans {

class WorldModel {
 public:
  enum class Answer : std::uint8_t { taken, unknown_entry, not_finite, out_of_range, future, older, too_old };
  static constexpr std::size_t answers = 7;
  static constexpr std::int64_t future_max_ns = 20'000'000;  // clocks of two programs on a machine are one clock

  // Throws std::invalid_argument when there are more entries than a snapshot shows, or one has too many fields.
  explicit WorldModel(std::vector<SeenInfo> declared);

  // Supervisor thread. Never allocates.
  Answer observe(const Observation& observation, const OdometryPast& past, std::int64_t now_ns) noexcept;
  // Entries that are too old are unknown again.
  void forget(std::int64_t now_ns) noexcept;

  const SeenEntries& entries() const noexcept { return entries_; }  // places along the path
  const std::vector<SeenInfo>& declared() const noexcept { return declared_; }
  std::uint64_t count(Answer answer) const noexcept { return counts_[static_cast<std::size_t>(answer)]; }

 private:
  Answer judge(const Observation& observation, std::int64_t now_ns) const noexcept;
  static void clear(SeenEntry& entry) noexcept;

  std::vector<SeenInfo> declared_;
  SeenEntries entries_;
  std::array<std::uint64_t, answers> counts_{};
};

}  // namespace kadans
