#include "kadans/supervisor/world_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "signal/sine_cosine.h"

namespace kadans {
namespace {

constexpr double age_max_s = 1e6;  // of any observation

}  // namespace

WorldModel::WorldModel(std::vector<SeenInfo> declared) : declared_(std::move(declared)) {
  if (declared_.size() > max_seen)
    throw std::invalid_argument("the world model has at most " + std::to_string(max_seen) + " entries");
  for (const SeenInfo& info : declared_) {
    if (info.fields.size() > max_seen_fields || info.fields.size() < info.places)
      throw std::invalid_argument("entry '" + info.name + "' of the world model has " +
                                  std::to_string(info.fields.size()) + " fields");
  }
  entries_.count = static_cast<std::uint32_t>(declared_.size());
  for (std::size_t i = 0; i < declared_.size(); ++i) {
    entries_.entries[i].places = static_cast<std::uint8_t>(declared_[i].places);
    clear(entries_.entries[i]);
  }
}

void WorldModel::clear(SeenEntry& entry) noexcept {
  entry.time_ns = 0;
  entry.confidence = 0;
  entry.source = SeenSource::none;
  entry.fields.fill(std::numeric_limits<double>::quiet_NaN());
}

WorldModel::Answer WorldModel::judge(const Observation& observation, std::int64_t now_ns) const noexcept {
  if (observation.entry >= entries_.count) return Answer::unknown_entry;
  const SeenInfo& info = declared_[observation.entry];
  const SeenEntry& entry = entries_.entries[observation.entry];
  if (!(observation.confidence > 0 && observation.confidence <= 1))
    return std::isfinite(observation.confidence) ? Answer::out_of_range : Answer::not_finite;
  for (std::size_t i = 0; i < info.fields.size(); ++i) {
    const double value = observation.fields[i];
    if (!std::isfinite(value)) return Answer::not_finite;
    if (!(value >= info.fields[i].min && value <= info.fields[i].max)) return Answer::out_of_range;
  }
  if (observation.time_ns > now_ns + future_max_ns) return Answer::future;
  if (entry.confidence > 0 && observation.time_ns < entry.time_ns) return Answer::older;
  const double age_s = 1e-9 * (static_cast<double>(now_ns) - static_cast<double>(observation.time_ns));
  if (!(age_s < age_max_s)) return Answer::too_old;
  return info.forget_s > 0 && age_s > info.forget_s ? Answer::too_old : Answer::taken;
}

WorldModel::Answer WorldModel::observe(const Observation& observation, const OdometryPast& past,
                                       std::int64_t now_ns) noexcept {
  Answer answer = judge(observation, now_ns);
  std::optional<PastPose> at = PastPose{};
  if (answer == Answer::taken && entries_.entries[observation.entry].places > 0) {
    at = past.at(observation.time_ns);
    if (!at) answer = Answer::too_old;
  }
  ++counts_[static_cast<std::size_t>(answer)];
  if (answer != Answer::taken) return answer;
  SeenEntry& entry = entries_.entries[observation.entry];
  entry.time_ns = observation.time_ns;
  entry.confidence = observation.confidence;
  entry.source = observation.source;
  entry.breaks = at->breaks;
  std::copy_n(observation.fields.begin(), declared_[observation.entry].fields.size(), entry.fields.begin());
  if (entry.places == 0) return answer;
  const auto [sin, cos] = sine_cosine(at->heading_rad);
  const double x_m = observation.fields[0], y_m = observation.fields[1];
  entry.fields[0] = at->x_m + cos * x_m - sin * y_m;
  entry.fields[1] = at->y_m + sin * x_m + cos * y_m;
  if (entry.places == 3)
    entry.fields[2] = std::remainder(at->heading_rad + observation.fields[2], 2 * std::numbers::pi);
  return answer;
}

void WorldModel::forget(std::int64_t now_ns) noexcept {
  for (std::size_t i = 0; i < entries_.count; ++i) {
    SeenEntry& entry = entries_.entries[i];
    const double age_s = 1e-9 * static_cast<double>(now_ns - entry.time_ns);
    if (entry.confidence > 0 && declared_[i].forget_s > 0 && age_s > declared_[i].forget_s) clear(entry);
  }
}

}  // namespace kadans
