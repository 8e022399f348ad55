// A robot that walks about on the field, with odometry that drifts and a camera that sees a part of the field: late,
// with noise, with misses, and with things that are not there.
#pragma once

#include <deque>
#include <vector>

#include "football/localisation.h"
#include "kadans/signal/random.h"

namespace kadans::football {

class SeenField {
 public:
  static constexpr double step_s = 0.02;     // of odometry
  static constexpr double latency_s = 0.06;  // of pictures
  static constexpr double picture_s = 1.0 / 15;
  static constexpr double range_m = 5.5, half_view_rad = 0.6, pan_rad = 0.9;

  SeenField(const Field& field, std::uint64_t seed, double false_share = 0.05)
      : field_(field),
        markings_(markings_of(field)),
        random_(seed, "football.seen_field"),
        false_share_(false_share),
        scale_(random_.uniform(0.94, 1.06)),
        drift_rad_per_m_(random_.uniform(-0.06, 0.06)),
        camera_scale_(random_.uniform(0.93, 1.07)),
        camera_rad_(random_.uniform(-0.04, 0.04)) {
    const Point start = somewhere();
    truth = {-std::abs(start.x_m), start.y_m, random_.uniform(-3, 3)};
    goal_ = somewhere();
  }

  double time_s = 0;
  Pose2 truth, odometry;
  bool blind = false;  // nothing is seen, nothing moves

  // Moves on; what it says goes to the localisation.
  void step(Localisation& localisation) {
    time_s += step_s;
    if (!blind) walk();
    localisation.odometry(time_s, odometry);
    if (!blind && time_s >= next_picture_s_) {
      next_picture_s_ = time_s + picture_s;
      pictures_.push_back(picture());
    }
    while (!pictures_.empty() && pictures_.front().time_s + latency_s <= time_s) {
      localisation.view(pictures_.front());
      pictures_.pop_front();
    }
  }
  // It is put there; odometry does not know.
  void carry_to(const Pose2& pose) {
    truth = pose;
    pictures_.clear();
    goal_ = somewhere();
  }
  Point somewhere() {
    const double x_m = field_.length_m / 2, y_m = field_.width_m / 2;
    return {random_.uniform(-x_m, x_m), random_.uniform(-y_m, y_m)};
  }
  RandomStream& random() { return random_; }

 private:
  void walk() {
    const Point way = goal_ - truth.at();
    if (norm(way) < 0.3 || random_.uniform() < 0.001) goal_ = somewhere();
    const double off_rad = wrapped(std::atan2(way.y_m, way.x_m) - truth.theta_rad);
    const double turn_rad = std::clamp(off_rad, -0.6 * step_s, 0.6 * step_s);
    const double way_m = std::abs(off_rad) < 0.5 ? 0.25 * step_s : 0;
    truth = from_frame(truth, Pose2{way_m, 0, turn_rad});
    const double noise_m = 0.3 * std::sqrt(way_m * 0.1) * 0.2;
    odometry = from_frame(odometry, Pose2{scale_ * way_m + random_.normal() * noise_m, random_.normal() * noise_m,
                                          turn_rad * scale_ + drift_rad_per_m_ * way_m});
  }

  Point noisy(const Point& at) {
    const double r = camera_scale_ * norm(at), bearing_rad = std::atan2(at.y_m, at.x_m) + camera_rad_;
    return turned({r + random_.normal() * (0.03 + 0.04 * r), random_.normal() * (0.02 + 0.02 * r)}, bearing_rad);
  }
  bool sees(const Point& at, double pan) const {
    const double r = norm(at);
    return r > 0.3 && r < range_m && std::abs(wrapped(std::atan2(at.y_m, at.x_m) - pan)) < half_view_rad;
  }
  Point nothing(double pan) {
    return turned({random_.uniform(0.5, range_m), 0}, pan + random_.uniform(-half_view_rad, half_view_rad));
  }
  void landmark(FieldView& view, LandmarkKind kind, const Point& on_field, double pan) {
    const Point at = in_frame(truth, on_field);
    if (!sees(at, pan) || random_.uniform() < 0.4) return;
    if (random_.uniform() < false_share_)
      view.landmarks.push_back({static_cast<LandmarkKind>(random_.next() % 6), nothing(pan)});
    else
      view.landmarks.push_back({kind, noisy(at)});
  }
  void line(FieldView& view, const Segment& on_field, double pan) {
    std::optional<Segment> seen;
    for (int i = 0; i <= 30; ++i) {
      const Point at = in_frame(truth, on_field.from + (i / 30.0) * (on_field.to - on_field.from));
      if (!sees(at, pan)) continue;
      if (!seen) seen = Segment{at, at};
      seen->to = at;
    }
    if (!seen || distance(seen->from, seen->to) < 0.4 || random_.uniform() < 0.3) return;
    if (random_.uniform() < false_share_) seen = Segment{nothing(pan), nothing(pan)};
    view.lines.push_back({noisy(seen->from), noisy(seen->to)});
  }
  FieldView picture() {
    FieldView view{time_s, {}, {}};
    const double pan = pan_rad * std::sin(1.6 * time_s);
    for (const Crossing& crossing : markings_.crossings)
      landmark(view, static_cast<LandmarkKind>(crossing.kind), crossing.at, pan);
    for (const Point& post : markings_.posts) landmark(view, LandmarkKind::post, post, pan);
    for (const Point& mark : markings_.marks) landmark(view, LandmarkKind::mark, mark, pan);
    landmark(view, LandmarkKind::circle, {}, pan);
    for (const Segment& segment : markings_.lines) line(view, segment, pan);
    return view;
  }

  Field field_;
  Markings markings_;
  RandomStream random_;
  double false_share_, scale_, drift_rad_per_m_, camera_scale_, camera_rad_;
  Point goal_;
  double next_picture_s_ = 0;
  std::deque<FieldView> pictures_;
};

}  // namespace kadans::football
