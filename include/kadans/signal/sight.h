// What perception sees. A simulated camera fills it in scenarios, a real one on the robot; behaviors cannot tell which.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

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

}  // namespace kadans
