#include "seen_entries.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "signal/sine_cosine.h"

namespace kadans {

void show_seen(const SeenEntries& kept, const OdometryStatus& odometry, std::int64_t time_ns,
               SeenEntries& shown) noexcept {
  shown.count = kept.count;
  if (kept.count == 0) return;
  const auto [sin, cos] = sine_cosine(odometry.path_heading_rad);
  for (std::uint32_t i = 0; i < kept.count; ++i) {
    const SeenEntry& from = kept.entries[i];
    SeenEntry& to = shown.entries[i];
    to = from;
    if (!(from.confidence > 0)) {
      to.fields.fill(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    to.age_s = 1e-9 * static_cast<double>(time_ns - from.time_ns);
    to.carried = from.breaks == odometry.breaks;
    if (from.places < 2) continue;
    const double x_m = from.fields[0] - odometry.path_x_m, y_m = from.fields[1] - odometry.path_y_m;
    to.fields[0] = cos * x_m + sin * y_m;
    to.fields[1] = cos * y_m - sin * x_m;
    if (from.places == 3)
      to.fields[2] = std::remainder(from.fields[2] - odometry.path_heading_rad, 2 * std::numbers::pi);
  }
}

void declare_seen(SignalTable& table, const std::vector<SeenInfo>& declared, const SeenEntries& shown) {
  for (std::size_t i = 0; i < declared.size() && i < max_seen; ++i) {
    const SeenInfo& info = declared[i];
    const SeenEntry& entry = shown.entries[i];
    const std::string topic = "seen." + info.name + ".";
    for (std::size_t f = 0; f < info.fields.size() && f < max_seen_fields; ++f) {
      const SeenField& field = info.fields[f];
      table.add({topic + field.name, field.unit, field.doc + "; NaN while nothing is known."}, &entry.fields[f]);
    }
    table.add({topic + "age_s", "s", "Time since the observation; NaN while nothing is known."}, &entry.age_s);
    table.add({topic + "confidence", "", "How certain it is, 0..1; 0 while nothing is known."}, &entry.confidence);
    table.add({topic + "carried", "", "Whether the odometry tells the whole way since the observation."},
              &entry.carried);
  }
}

}  // namespace kadans
