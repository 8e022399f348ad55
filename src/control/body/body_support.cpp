#include "body_support.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kadans/model/kinematics.h"

namespace kadans {
namespace {

double cross2(const Vec3& o, const Vec3& a, const Vec3& b) noexcept {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double half_sole_m(const BodyLayout::Sole& sole, const BodySettings& s) noexcept {
  return std::max(1e-3, (sole.tilts_sideways ? s.side_m : std::min(s.toe_m, s.heel_m)) - s.edge_m);
}

}  // namespace

double bent_max_rad(const BodyLayout& layout, const BodySettings& s, std::size_t foot, double load_N) noexcept {
  const BodyLayout::Sole& sole = layout.soles[foot];
  if (!(sole.tilts_forward || sole.tilts_sideways) || !(s.passive_Nm_per_rad > 0))
    return std::numeric_limits<double>::infinity();
  return half_sole_m(sole, s) * load_N / s.passive_Nm_per_rad;
}

double bent_load_N(const BodyLayout& layout, const BodySettings& s, std::size_t foot, double bent_rad) noexcept {
  const BodyLayout::Sole& sole = layout.soles[foot];
  if (!(sole.tilts_forward || sole.tilts_sideways)) return 0;
  return s.passive_Nm_per_rad * std::abs(bent_rad) / half_sole_m(sole, s);
}

// The hull is Andrew's monotone chain (1979, Information Processing Letters 9(5)).
BodySupport support_of(const BodyLayout& layout, const BodySettings& s,
                       const std::array<const Pose*, body_feet_max>& feet) noexcept {
  std::array<Vec3, 4 * body_feet_max> corners{};
  std::size_t count = 0;
  const bool both = feet[0] != nullptr && feet[1] != nullptr;
  for (std::size_t i = 0; i < layout.feet.size(); ++i) {
    if (feet[i] == nullptr) continue;
    const BodyLayout::Sole& sole = layout.soles[i];
    const double along = both && sole.tilts_forward ? 0 : 1, across = both && sole.tilts_sideways ? 0 : 1;
    for (const double x : {s.toe_m, -s.heel_m}) {
      for (const double y : {s.side_m, -s.side_m})
        corners[count++] = transform(*feet[i], {along * x, across * y, -s.sole_m});
    }
  }
  BodySupport support;
  if (count == 0) return support;
  const auto last = corners.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(corners.begin(), last, last);  // gcc believes that std::sort leaves so small an array
  std::array<Vec3, 8 * body_feet_max + 1> hull{};
  std::size_t size = 0;
  const auto add = [&](const Vec3& corner, std::size_t kept) {
    while (size >= kept + 2 && cross2(hull[size - 2], hull[size - 1], corner) <= 0) --size;
    hull[size++] = corner;
  };
  for (std::size_t i = 0; i < count; ++i) add(corners[i], 0);
  const std::size_t lower = size - 1;
  for (std::size_t i = count - 1; i-- > 0;) add(corners[i], lower);
  for (std::size_t i = 0; i + 1 < size && support.count < support.edges.size(); ++i) {
    const double x = hull[i + 1][0] - hull[i][0], y = hull[i + 1][1] - hull[i][1], length = std::hypot(x, y);
    if (!(length > 1e-9)) continue;
    const double nx = y / length, ny = -x / length;  // outward, for a hull that goes round to the left
    support.edges[support.count++] = {nx, ny, nx * hull[i][0] + ny * hull[i][1]};
  }
  return support;
}

}  // namespace kadans
