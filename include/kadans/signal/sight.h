// What perception sees. A simulated camera fills it in scenarios, a real one on the robot; behaviors cannot tell which.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "kadans/signal/capacity.h"

namespace kadans {

// The ball as it was last seen. It stays what it is until the ball is seen again; the age tells how old that is.
struct alignas(8) SeenBall {
  std::int64_t time_ns = 0;  // of the picture, on the engine's clock
  // In the heading frame of the time of the picture: the origin is below the base frame's origin, x points forward
  // along the ground where the base points.
  double x_m = std::numeric_limits<double>::quiet_NaN(), y_m = std::numeric_limits<double>::quiet_NaN();
  double confidence = 0;                                    // 0..1; 0: not seen yet
  double age_s = std::numeric_limits<double>::quiet_NaN();  // of the picture; the control engine computes it
};
static_assert(std::is_trivially_copyable_v<SeenBall> && sizeof(SeenBall) == 40);

// Who told an entry of the world model.
enum class SeenSource : std::uint8_t { none, scenario, perception, message, record };
inline constexpr std::size_t seen_sources = 5;
const char* name(SeenSource source) noexcept;

// What is known of one thing (kadans/signal/seen_info.h says which fields it has). The supervisor keeps its place along
// the path of the odometry, where it stays while the robot moves. The control engine shows it in each tick as it is
// seen from where the robot is then.
struct alignas(8) SeenEntry {
  std::int64_t time_ns = 0;                                 // of the observation, on the engine's clock
  double confidence = 0;                                    // 0..1; 0: nothing is known
  double age_s = std::numeric_limits<double>::quiet_NaN();  // of the observation; the control engine computes it
  std::array<double, max_seen_fields> fields{};
  std::uint32_t breaks = 0;  // OdometryStatus::breaks at the time of the observation
  std::uint8_t places = 0;   // SeenInfo::places
  SeenSource source = SeenSource::none;
  bool carried = false;  // the odometry tells the whole way since the observation; the control engine computes it
  std::uint8_t reserved = 0;
};

struct alignas(8) SeenEntries {
  std::uint32_t count = 0;
  std::uint32_t reserved = 0;
  std::array<SeenEntry, max_seen> entries{};  // in the order of Catalog::seen
};
static_assert(std::is_trivially_copyable_v<SeenEntries> && sizeof(SeenEntry) == 96 &&
              sizeof(SeenEntries) == 8 + 96 * max_seen);

inline void copy_used(const SeenEntries& from, SeenEntries& to) noexcept {
  to.count = from.count;
  for (std::uint32_t i = 0; i < from.count; ++i) to.entries[i] = from.entries[i];
}

}  // namespace kadans
