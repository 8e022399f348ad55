#include "body_way.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace kadans {
namespace {

using Eigen::Index;
using Wrench = Eigen::Vector<double, 6>;

// A joint that turns by this much in 1/16 of the time, and that much faster than in the mean, jumps. The peak of a
// minimum-jerk motion is 1.9 times its mean. A step of the longest length is cut off there (body_reach.cpp).
constexpr double jump_rad = 0.3, jump_steps = 16, jump_per_mean = 2.8, longest_rad = 0.39;
constexpr double least_room_m = 0.003;  // to an edge at rest: below this no time is long enough

// The square of the time in which `moved` becomes as large as what `rest` leaves.
double least_time2(double moved, double rest) noexcept { return moved > 0 ? moved / rest : 0; }

double least_time2(const BodySettings& s, const BodySupport& support, const Wrench& rest,
                   const Wrench& moved) noexcept {
  double most = 0;
  for (const BodyEdge& edge : support) {
    const double room_m = edge.distance_m - s.edge_m;
    const auto beyond = [&](const Wrench& w) { return -edge.x * w[4] + edge.y * w[3] - room_m * w[2]; };
    most = std::max(most, least_time2(beyond(moved), std::max(-beyond(rest), least_room_m * rest[2])));
  }
  const double grip = s.friction / std::numbers::sqrt2;
  for (const Index k : {0, 1}) most = std::max(most, least_time2(std::abs(moved[k]) - grip * moved[2], grip * rest[2]));
  return most;
}

}  // namespace

BodyWay::BodyWay(const BodyLayout& layout) : layout_(&layout) {
  before_.setZero(static_cast<Index>(layout.model->joints.size() + (layout.floating ? 6 : 0)));
  velocity_ = acceleration_ = before_;
}

void BodyWay::begin(const BodySettings& settings, const BodySupport& support, int steps, double time_s) noexcept {
  settings_ = &settings;
  support_ = &support;
  steps_ = steps;
  time_s_ = time_s;
  number_ = 0;
  fails_ = false;
  before_.setZero();
  joints_ = {};
  result_ = {};
}

BodyWay::Time BodyWay::time() const noexcept {
  Time time = result_;
  for (const JointAxis& axis : layout_->joints) {
    const Steps& steps = joints_[axis.joint];
    const double peak_rad = steps.largest_rad * steps_, share = static_cast<double>(steps.at) / steps_;
    const bool large = peak_rad > jump_rad * jump_steps, sudden = peak_rad > jump_per_mean * steps.sum_rad;
    if (!(large && sudden) && peak_rad < longest_rad * jump_steps) continue;
    if (time.jumps != no_body_joint && time.smooth_share <= share) continue;
    time.jumps = axis.joint;
    time.smooth_share = share;
  }
  return time;
}

void BodyWay::need(double least_s, std::size_t joint) noexcept {
  if (least_s > time_s_ && !std::exchange(fails_, true)) result_.fails_after_s = time_s_ * number_ / steps_;
  if (!(least_s > result_.least_s)) return;
  result_.least_s = least_s;
  result_.joint = joint;
}

void BodyWay::add(BodyGeometry& posture, const Eigen::VectorXd& step) noexcept {
  for (const JointAxis& axis : layout_->joints) {
    const double step_rad = std::abs(step[posture.base_size() + static_cast<Index>(axis.joint)]);
    Steps& steps = joints_[axis.joint];
    steps.sum_rad += step_rad;
    if (step_rad > steps.largest_rad) steps = {steps.sum_rad, step_rad, number_};
    need(step_rad * steps_ / (settings_->velocity_share * axis.velocity_max_rad_s), axis.joint);
  }
  if (support_->count > 0) {
    velocity_ = 0.5 * steps_ * (before_ + step);
    acceleration_ = steps_ * steps_ * (step - before_);
    Wrench rest = Wrench::Zero();
    rest[2] = body_gravity_m_s2 * posture.mass_kg();
    rest[3] = posture.com_m()[1] * rest[2];
    rest[4] = -posture.com_m()[0] * rest[2];
    const Wrench moved = posture.ground_wrench(velocity_, acceleration_) - rest;
    need(std::sqrt(least_time2(*settings_, *support_, rest, moved)), no_body_joint);
  }
  before_ = step;
  ++number_;
}

}  // namespace kadans
