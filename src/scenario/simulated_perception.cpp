#include "simulated_perception.h"

#include <algorithm>
#include <variant>

#include "config/json/problems.h"
#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

template <typename Named>
std::size_t find_named(const std::vector<Named>& all, const PlacedName& wanted, const char* what,
                       const std::string& file) {
  const auto found = std::ranges::find(all, wanted.name, &Named::name);
  if (found == all.end()) refuse_unknown(file, wanted, what, names_of(all));
  return static_cast<std::size_t>(found - all.begin());
}

}  // namespace

SimulatedSight::SimulatedSight(const SightSettings& settings, std::size_t ball, std::uint64_t seed)
    : settings_(settings), ball_(ball), random_(seed, "sight/ball") {}

void SimulatedSight::look(std::int64_t time_ns, const PlantTruth& truth) noexcept {
  // Always as many numbers, so that nothing that is missed shifts what follows.
  const bool missed = random_.uniform() < settings_.missed;
  const double distance_off = settings_.distance_noise * random_.normal();
  const double bearing_off_rad = settings_.bearing_noise_rad * random_.normal();
  const SightLine ball(truth.objects[ball_].pose.position_m, truth.base);
  if (missed || !ball.in_view(settings_)) return;
  const double seen_m = ball.far_m * (1 + distance_off), seen_rad = ball.bearing_rad + bearing_off_rad;
  pictures_.send({.time_ns = time_ns,
                  .x_m = seen_m * std::cos(seen_rad),
                  .y_m = seen_m * std::sin(seen_rad),
                  .confidence = 1 - 0.5 * ball.far_m / settings_.far_m});
}

const SeenBall& SimulatedSight::at(std::int64_t time_ns, const PlantTruth& truth) noexcept {
  pictures_.step(
      settings_, time_ns, [&] { look(time_ns, truth); }, [&](const SeenBall& seen) { arrived_ = seen; });
  return arrived_;
}

SimulatedPerception::SimulatedPerception(const ScenarioPerception& settings, const std::vector<SeenInfo>& seen,
                                         const std::vector<WorldObject>& objects, std::uint64_t seed,
                                         const std::string& file)
    : settings_(settings),
      entry_(static_cast<std::uint32_t>(find_named(seen, settings.entry, "entry of the world model", file))),
      object_(find_named(objects, settings.object, "object", file)),
      places_(seen[entry_].places),
      random_(seed, "perception/" + settings.entry.name) {
  if (places_ < 2 || seen[entry_].fields.size() != places_)
    refuse(file, settings.entry.place,
           "entry '" + settings.entry.name + "' is not a place alone: what else it says is not simulated");
  for (std::size_t i = 0; i < objects.size() && settings.hidden; ++i) {
    if (i == object_) continue;
    if (const auto* box = std::get_if<WorldBox>(&objects[i].shape))
      blockers_.push_back({i, 0.5 * std::min(box->size_m[0], box->size_m[1]), 0.5 * box->size_m[2]});
    if (const auto* ball = std::get_if<WorldBall>(&objects[i].shape))
      blockers_.push_back({i, ball->radius_m, ball->radius_m});
  }
}

// Whether a cylinder cuts the line from the base to the thing.
bool SimulatedPerception::hidden(const PlantTruth& truth) const noexcept {
  const Vec3 &eye_m = truth.base.position_m, &thing_m = truth.objects[object_].pose.position_m;
  const double x_m = thing_m[0] - eye_m[0], y_m = thing_m[1] - eye_m[1], far2 = x_m * x_m + y_m * y_m;
  return std::ranges::any_of(blockers_, [&](const Blocker& blocker) {
    const Vec3& at_m = truth.objects[blocker.object].pose.position_m;
    const double bx_m = at_m[0] - eye_m[0], by_m = at_m[1] - eye_m[1];
    const double share = far2 > 0 ? (bx_m * x_m + by_m * y_m) / far2 : 0;
    if (!(share > 0 && share < 1)) return false;
    const double z_m = eye_m[2] + share * (thing_m[2] - eye_m[2]);
    const double off_x_m = bx_m - share * x_m, off_y_m = by_m - share * y_m;
    return std::abs(z_m - at_m[2]) < blocker.half_height_m &&
           off_x_m * off_x_m + off_y_m * off_y_m < blocker.radius_m * blocker.radius_m;
  });
}

void SimulatedPerception::send(std::int64_t time_ns, double far_m, double bearing_rad, double heading_rad) noexcept {
  Observation seen{.entry = entry_,
                   .time_ns = time_ns,
                   .confidence = 1 - 0.5 * std::min(far_m / settings_.settings.far_m, 1.0),
                   .source = SeenSource::scenario};
  seen.fields[0] = far_m * std::cos(bearing_rad);
  seen.fields[1] = far_m * std::sin(bearing_rad);
  if (places_ == 3) seen.fields[2] = heading_rad;
  pictures_.send(seen);
}

void SimulatedPerception::take_picture(std::int64_t time_ns, const PlantTruth& truth) noexcept {
  const SightSettings& s = settings_.settings;
  // Always as many numbers, so that nothing that is missed shifts what follows.
  const bool missed = random_.uniform() < s.missed, imagined = random_.uniform() < settings_.imagined;
  const double distance_off = s.distance_noise * random_.normal(),
               bearing_off_rad = s.bearing_noise_rad * random_.normal();
  const double imagined_m = s.far_m * random_.uniform(), imagined_rad = s.view_rad * (random_.uniform() - 0.5);
  const Pose& thing = truth.objects[object_].pose;
  const SightLine at(thing.position_m, truth.base);
  const double heading_rad =
      places_ == 3 ? std::remainder(roll_pitch_yaw(thing.orientation)[2] - at.yaw_rad, 2 * std::numbers::pi) : 0;
  if (imagined) return send(time_ns, imagined_m, imagined_rad, heading_rad);
  if (missed || !at.in_view(s) || hidden(truth)) return;
  send(time_ns, std::max(0.0, at.far_m * (1 + distance_off)), at.bearing_rad + bearing_off_rad,
       heading_rad + bearing_off_rad);
}

void SimulatedPerception::look(std::int64_t time_ns, const PlantTruth& truth, ObservationSink& sink) noexcept {
  pictures_.step(
      settings_.settings, time_ns, [&] { take_picture(time_ns, truth); },
      [&](const Observation& seen) { sink.observe(seen); });
}

}  // namespace kadans
