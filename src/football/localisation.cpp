#include "localisation.h"

#include <algorithm>
#include <limits>

namespace kadans::football {
namespace {

constexpr double odometry_memory_s = 1;
constexpr double gate = 11.8;  // of two squared errors: 99.7 %
constexpr std::size_t hypotheses_max = 8, memory_max = 200;
constexpr double until_settled_s = 1;
constexpr double least_sd_m = 0.02, least_sd_rad = 0.01;
constexpr double stay_near_m = 1.5, stay_near_rad = 1.0;

Point across(const Point& a) noexcept { return {-a.y_m, a.x_m}; }

// The place of the odometry's frame, so that odometry's `pose` lies at `at`.
Pose2 frame_for(const Pose2& at, const Pose2& pose) noexcept {
  const double theta_rad = wrapped(at.theta_rad - pose.theta_rad);
  const Point origin = at.at() - turned(pose.at(), theta_rad);
  return {origin.x_m, origin.y_m, theta_rad};
}

struct Scalar {  // a measurement of one number
  std::array<double, 3> h;
  double error, variance;
};

double spread(const PoseCovariance& covariance, const Scalar& of) noexcept {
  double sum = of.variance;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sum += of.h.at(i) * covariance.m.at(i).at(j) * of.h.at(j);
  }
  return sum;
}

// Returns how far the pose is moved.
std::array<double, 3> take(PoseCovariance& covariance, const Scalar& of) noexcept {
  const double all = spread(covariance, of);
  std::array<double, 3> gain{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) gain.at(i) += covariance.m.at(i).at(j) * of.h.at(j);
  }
  std::array<double, 3> move{};
  PoseCovariance after = covariance;
  for (std::size_t i = 0; i < 3; ++i) {
    move.at(i) = gain.at(i) / all * of.error;
    for (std::size_t j = 0; j < 3; ++j) after.m.at(i).at(j) -= gain.at(i) * gain.at(j) / all;
  }
  covariance = after;
  const std::array<double, 3> least{least_sd_m, least_sd_m, least_sd_rad};
  for (std::size_t i = 0; i < 3; ++i)
    covariance.m.at(i).at(i) = std::max(covariance.m.at(i).at(i), least.at(i) * least.at(i));
  return move;
}

void move_by(Pose2& pose, const std::array<double, 3>& move) noexcept {
  pose = {pose.x_m + move[0], pose.y_m + move[1], wrapped(pose.theta_rad + move[2])};
}

PoseCovariance diagonal(double sd_m, double sd_rad) noexcept {
  PoseCovariance covariance;
  covariance.m[0][0] = covariance.m[1][1] = sd_m * sd_m;
  covariance.m[2][2] = sd_rad * sd_rad;
  return covariance;
}

}  // namespace

Localisation::Localisation(const Config& config)
    : config_(config), markings_(markings_of(config.field)), random_(config.seed, "football.localisation") {
  for (const Crossing& crossing : markings_.crossings)
    landmarks_.at(static_cast<std::size_t>(crossing.kind)).push_back(crossing.at);
  landmarks_.at(static_cast<std::size_t>(LandmarkKind::post)) = markings_.posts;
  landmarks_.at(static_cast<std::size_t>(LandmarkKind::mark)) = markings_.marks;
  landmarks_.at(static_cast<std::size_t>(LandmarkKind::circle)) = {Point{}};
}

void Localisation::place(std::span<const Pose2> poses, double sd_m, double sd_rad) {
  const Pose2 now = past_.empty() ? Pose2{} : past_.back().pose;
  hypotheses_.clear();
  memory_.clear();
  for (const Pose2& pose : poses.first(std::min(poses.size(), hypotheses_max)))
    hypotheses_.push_back({frame_for(pose, now), diagonal(sd_m, sd_rad), config_.found_quality, 0, true});
  last_known_.reset();
  then_ = now;
  if (poses.size() == 1) last_known_ = poses[0];
}

void Localisation::carried() {
  hypotheses_.clear();
  memory_.clear();
  last_known_.reset();
  if (!past_.empty()) then_ = past_.back().pose;
}

std::optional<Pose2> Localisation::odometry_at(double time_s) const {
  if (past_.empty() || !(time_s >= past_.front().time_s && time_s <= past_.back().time_s)) return std::nullopt;
  const auto later = std::ranges::lower_bound(past_, time_s, {}, &TimedPose::time_s);
  if (later == past_.begin()) return later->pose;
  const TimedPose &a = *(later - 1), &b = *later;
  const double share = b.time_s > a.time_s ? (time_s - a.time_s) / (b.time_s - a.time_s) : 1;
  const Point at = a.pose.at() + share * (b.pose.at() - a.pose.at());
  return Pose2{at.x_m, at.y_m, wrapped(a.pose.theta_rad + share * wrapped(b.pose.theta_rad - a.pose.theta_rad))};
}

void Localisation::predict(Hypothesis& hypothesis, const Pose2& from, const Pose2& to, double passed_s) const {
  const Point step = from_frame(hypothesis.frame, to.at()) - from_frame(hypothesis.frame, from.at());
  const double way_m = norm(step), turn_rad = std::abs(wrapped(to.theta_rad - from.theta_rad));
  auto& p = hypothesis.covariance.m;
  // P = F P F', F moves x and y by the heading's error times the way.
  const double cx = -step.y_m, cy = step.x_m;
  const double p00 = p[0][0] + 2 * cx * p[0][2] + cx * cx * p[2][2];
  const double p11 = p[1][1] + 2 * cy * p[1][2] + cy * cy * p[2][2];
  const double p01 = p[0][1] + cx * p[1][2] + cy * p[0][2] + cx * cy * p[2][2];
  const double p02 = p[0][2] + cx * p[2][2], p12 = p[1][2] + cy * p[2][2];
  // A step's errors add up along the way as a random walk of steps of 0.1 m does.
  const double way_var =
      config_.way_sd * config_.way_sd * way_m * 0.1 + config_.rest_sd_m * config_.rest_sd_m * passed_s;
  const double turn_var = config_.turn_sd * config_.turn_sd * turn_rad * 0.2 +
                          config_.turn_sd_per_m * config_.turn_sd_per_m * way_m * 0.1 +
                          config_.rest_sd_rad * config_.rest_sd_rad * passed_s;
  p = {{{p00 + way_var, p01, p02}, {p01, p11 + way_var, p12}, {p02, p12, p[2][2] + turn_var}}};
}

void Localisation::odometry(double time_s, const Pose2& pose) {
  if (!finite(pose) || (!past_.empty() && !(time_s > past_.back().time_s))) return;
  if (!past_.empty()) {
    for (Hypothesis& hypothesis : hypotheses_)
      predict(hypothesis, past_.back().pose, pose, std::min(time_s - past_.back().time_s, 1.0));
  }
  past_.push_back({time_s, pose});
  while (past_.front().time_s < time_s - odometry_memory_s) past_.pop_front();
}

bool Localisation::update_landmark(Pose2& pose, PoseCovariance& covariance, const LandmarkSeen& seen) const {
  const double range_m = norm(seen.at);
  const Point there = from_frame(pose, seen.at);
  const Point sight = range_m > 1e-3 ? (1 / range_m) * (there - pose.at()) : Point{1, 0};
  const Point side = across(sight);
  const Point lever = across(there - pose.at());
  const double range_sd_m = config_.range_sd_m + config_.range_sd_per_m * range_m;
  const double side_sd_m = config_.bearing_sd_m + config_.bearing_sd_per_m * range_m;
  Scalar along{{sight.x_m, sight.y_m, dot(sight, lever)}, 0, range_sd_m * range_sd_m};
  Scalar beside{{side.x_m, side.y_m, dot(side, lever)}, 0, side_sd_m * side_sd_m};
  const double along_all = spread(covariance, along), beside_all = spread(covariance, beside);
  double least = gate;
  bool found = false;
  for (const Point& landmark : landmarks_.at(static_cast<std::size_t>(seen.kind))) {
    const Point error = landmark - there;
    const double a = dot(error, sight), b = dot(error, side);
    const double squared = a * a / along_all + b * b / beside_all;
    if (squared >= least) continue;
    least = squared;
    along.error = a;
    beside.error = b;
    found = true;
  }
  if (!found) return false;
  const auto first = take(covariance, along);
  beside.error -= beside.h[0] * first[0] + beside.h[1] * first[1] + beside.h[2] * first[2];
  const auto second = take(covariance, beside);
  move_by(pose, first);
  move_by(pose, second);
  return true;
}

bool Localisation::update_line(Pose2& pose, PoseCovariance& covariance, const Segment& seen) const {
  const Point middle = 0.5 * (seen.from + seen.to);
  const Point there = from_frame(pose, middle);
  const Point run = turned(seen.to - seen.from, pose.theta_rad);
  const double length_m = norm(run), range_m = norm(middle);
  if (!(length_m > 0.2)) return false;
  const double angle_sd_rad = config_.line_sd_rad / std::min(length_m, 1.0);
  const double offset_sd_m = config_.line_sd_m + config_.line_sd_per_m * range_m;
  double least = gate;
  std::optional<std::pair<Scalar, Scalar>> found;
  for (const Segment& line : markings_.lines) {
    const Point way = line.to - line.from;
    const double whole_m = norm(way);
    const Point direction = (1 / whole_m) * way, normal = across(direction);
    const double along_m = dot(there - line.from, direction);
    if (along_m < -0.3 || along_m > whole_m + 0.3) continue;
    double turn_rad = std::atan2(dot(direction, across(run)), dot(direction, run));  // from the line to what is seen
    turn_rad = -turn_rad;
    if (turn_rad > std::numbers::pi / 2) turn_rad -= std::numbers::pi;
    if (turn_rad < -std::numbers::pi / 2) turn_rad += std::numbers::pi;
    const Point lever = across(there - pose.at());
    const Scalar offset{
        {normal.x_m, normal.y_m, dot(normal, lever)}, -dot(there - line.from, normal), offset_sd_m * offset_sd_m};
    const Scalar angle{{0, 0, 1}, -turn_rad, angle_sd_rad * angle_sd_rad};
    const double squared = offset.error * offset.error / spread(covariance, offset) +
                           angle.error * angle.error / spread(covariance, angle);
    if (squared >= least) continue;
    least = squared;
    found = {offset, angle};
  }
  if (!found) return false;
  auto [offset, angle] = *found;
  const auto first = take(covariance, offset);
  angle.error -= first[2];
  const auto second = take(covariance, angle);
  move_by(pose, first);
  move_by(pose, second);
  return true;
}

// The share of the view that the hypothesis explains.
double Localisation::update(Hypothesis& hypothesis, const FieldView& view, const Pose2& odometry) const {
  Pose2 pose = from_frame(hypothesis.frame, odometry);
  double explained = 0, all = 0;
  for (const LandmarkSeen& seen : view.landmarks) {
    all += 1;
    if (update_landmark(pose, hypothesis.covariance, seen)) explained += 1;
  }
  for (const Segment& seen : view.lines) {  // more of them fit by chance
    all += 0.5;
    if (update_line(pose, hypothesis.covariance, seen)) explained += 0.5;
  }
  hypothesis.frame = frame_for(pose, odometry);
  const double x_m = config_.field.length_m / 2 + config_.field.border_m + 0.5;
  const double y_m = config_.field.width_m / 2 + config_.field.border_m + 0.5;
  if (std::abs(pose.x_m) > x_m || std::abs(pose.y_m) > y_m) hypothesis.quality = 0;  // no robot of this field is there
  return all > 0 ? explained / all : hypothesis.quality;
}

void Localisation::remember(const FieldView& view, const Pose2& odometry) {
  for (const LandmarkSeen& seen : view.landmarks)
    memory_.push_back({seen.kind, from_frame(odometry, seen.at), view.time_s, norm(seen.at)});
  while (!memory_.empty() && (memory_.size() > memory_max || memory_.front().time_s < view.time_s - config_.memory_s))
    memory_.pop_front();
}

bool Localisation::view(const FieldView& view) {
  const std::optional<Pose2> then = odometry_at(view.time_s);
  if (!then) return false;
  FieldView taken{view.time_s, {}, {}};
  std::ranges::copy_if(view.landmarks, std::back_inserter(taken.landmarks),
                       [](const LandmarkSeen& seen) { return finite(seen.at); });
  std::ranges::copy_if(view.lines, std::back_inserter(taken.lines),
                       [](const Segment& seen) { return finite(seen.from) && finite(seen.to); });
  remember(taken, *then);
  const double seen = static_cast<double>(taken.landmarks.size()) + 0.5 * static_cast<double>(taken.lines.size());
  for (Hypothesis& hypothesis : hypotheses_) {
    const double share = update(hypothesis, taken, *then);
    hypothesis.quality += 0.15 * std::min(seen / 4, 1.0) * (share - hypothesis.quality);
  }
  drop_the_poor();
  Hypothesis* leading = hypotheses_.empty() ? nullptr : &hypotheses_.front();
  if (leading != nullptr && leading->quality >= config_.lost_quality) {
    if (leading->quality >= config_.found_quality) {
      quality_was_good_s_ = view.time_s;
      if (view.time_s >= leading->settled_s) {
        if (!leading->right_end) leading->frame = with_right_end(leading->frame);  // it is known better by now
        leading->right_end = true;
        then_ = past_.back().pose;
        last_known_ = from_frame(leading->frame, then_);
      }
    }
    if (leading->quality >= config_.found_quality || view.time_s < searched_s_ + 1) return true;
  } else if (view.time_s < searched_s_ + 0.3) {
    return true;
  }
  search(view.time_s);
  return true;
}

double Localisation::judge(const Pose2& frame) const {
  double explained = 0;
  for (const Remembered& seen : memory_) {
    const Point there = from_frame(frame, seen.at);
    const double near_m = 0.2 + 0.1 * seen.range_m;
    double least_m = near_m;
    for (const Point& landmark : landmarks_.at(static_cast<std::size_t>(seen.kind)))
      least_m = std::min(least_m, distance(landmark, there));
    explained += 1 - (least_m / near_m) * (least_m / near_m);
  }
  return explained / static_cast<double>(std::max<std::size_t>(memory_.size(), 1));
}

// Of a candidate and its twin from the other end of the field the one that the robot can be at.
Pose2 Localisation::with_right_end(const Pose2& frame) const {
  const Pose2 twin = mirrored(frame);
  const Pose2 at = from_frame(frame, then_), at_twin = from_frame(twin, then_);
  if (last_known_) {
    const auto stays = [&](const Pose2& pose) {
      return distance(pose.at(), last_known_->at()) < stay_near_m &&
             std::abs(wrapped(pose.theta_rad - last_known_->theta_rad)) < stay_near_rad;
    };
    if (stays(at) != stays(at_twin)) return stays(at) ? frame : twin;
  }
  return at.x_m <= 0 ? frame : twin;
}

void Localisation::search(double time_s) {
  searched_s_ = time_s;
  // What was seen before it got lost belongs to another place.
  const double since_s = std::max(quality_was_good_s_ - 0.1, time_s - config_.memory_s);
  std::erase_if(memory_, [&](const Remembered& seen) { return seen.time_s < since_s; });
  if (memory_.size() < 6) return;
  std::vector<Candidate> candidates;
  const auto any = [&] { return memory_[static_cast<std::size_t>(random_.next() % memory_.size())]; };
  for (int tried = 0; tried < 60; ++tried) {
    const Remembered a = any(), b = any();
    const Point seen = b.at - a.at;
    const double seen_m = norm(seen);
    if (seen_m < 1) continue;
    for (const Point& on_a : landmarks_.at(static_cast<std::size_t>(a.kind))) {
      for (const Point& on_b : landmarks_.at(static_cast<std::size_t>(b.kind))) {
        const Point real = on_b - on_a;
        if (std::abs(norm(real) - seen_m) > 0.15 + 0.06 * (a.range_m + b.range_m)) continue;
        const double turn_rad = wrapped(std::atan2(real.y_m, real.x_m) - std::atan2(seen.y_m, seen.x_m));
        const Point origin = 0.5 * (on_a + on_b) - turned(0.5 * (a.at + b.at), turn_rad);
        const Pose2 frame = with_right_end({origin.x_m, origin.y_m, turn_rad});
        const Pose2 at = from_frame(frame, past_.back().pose);
        if (std::abs(at.x_m) > config_.field.length_m / 2 + config_.field.border_m ||
            std::abs(at.y_m) > config_.field.width_m / 2 + config_.field.border_m)
          continue;
        const double quality = judge(frame);
        if (quality > 0.45) candidates.push_back({frame, quality});
      }
    }
  }
  std::ranges::sort(candidates, std::greater{}, &Candidate::quality);
  std::size_t added = 0;
  for (const Candidate& candidate : candidates) {
    if (added >= 3 || candidate.quality < candidates.front().quality - 0.15) break;
    const Pose2 at = from_frame(candidate.frame, past_.back().pose);
    const auto same = [&](const Hypothesis& known) {
      const Pose2 there = from_frame(known.frame, past_.back().pose);
      return distance(there.at(), at.at()) < 0.5 && std::abs(wrapped(there.theta_rad - at.theta_rad)) < 0.4;
    };
    if (std::ranges::any_of(hypotheses_, same)) continue;
    hypotheses_.push_back({candidate.frame, diagonal(0.3, 0.15), std::min(candidate.quality, config_.found_quality),
                           time_s + until_settled_s, false});
    ++added;
  }
  drop_the_poor();
}

void Localisation::drop_the_poor() {
  std::ranges::stable_sort(hypotheses_, std::greater{}, &Hypothesis::quality);
  if (hypotheses_.size() > hypotheses_max) hypotheses_.resize(hypotheses_max);
  if (hypotheses_.empty()) return;
  const double least = std::max(hypotheses_.front().quality - 0.3, 0.25);
  std::erase_if(hypotheses_, [&](const Hypothesis& hypothesis) { return hypothesis.quality < least; });
  // Two that came together are one.
  const Pose2 now = past_.empty() ? Pose2{} : past_.back().pose;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    const Pose2 kept = from_frame(hypotheses_[i].frame, now);
    for (std::size_t j = hypotheses_.size() - 1; j > i; --j) {
      const Pose2 at = from_frame(hypotheses_[j].frame, now);
      if (distance(kept.at(), at.at()) < 0.25 && std::abs(wrapped(kept.theta_rad - at.theta_rad)) < 0.2)
        hypotheses_.erase(hypotheses_.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
}

const Localisation::Hypothesis* Localisation::best() const {
  return hypotheses_.empty() ? nullptr : &hypotheses_.front();
}

Localisation::Estimate Localisation::estimate() const {
  const Hypothesis* leading = best();
  if (leading == nullptr || past_.empty()) {
    Estimate guess;
    if (last_known_) guess.pose = *last_known_;
    guess.covariance = diagonal(config_.field.length_m / 2, std::numbers::pi);
    return guess;
  }
  return {from_frame(leading->frame, past_.back().pose), leading->covariance, leading->quality,
          leading->quality >= config_.lost_quality};
}

}  // namespace kadans::football
