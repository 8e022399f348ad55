#include "body_leader.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr double load_s = 0.3;                          // in which a foot takes its load, or leaves it
constexpr double brake_per_s = 8;                       // how the body comes to rest when there is no solution
constexpr double weigh_per_s = 15, least_weight = 0.2;  // the growth of a weight, per weight
constexpr double strict_weight = 100;
constexpr double alone_weight = 1, alone_per_s = 8, least_posture_weight = 0.005;  // of the posture without tasks

}  // namespace

Pose body_start(const BodyLayout& layout, const BodySettings& settings, Kinematics& kinematics,
                std::span<const double> position_rad, const Quat& base) noexcept {
  Pose start;
  if (layout.floating) {
    kinematics.update(position_rad, {{}, base});
    std::array<StandPoint, body_feet_max> feet;
    std::size_t count = 0;
    for (const std::size_t foot : layout.feet) feet[count++] = {layout.tasks[foot].link, {0, 0, -settings.sole_m}};
    start = base_over(kinematics, base, {feet.data(), count});
  }
  kinematics.update(position_rad, start);
  return start;
}

BodyLeader::BodyLeader(const BodyLayout& layout)
    : layout_(&layout),
      model_(*layout.model, layout.floating ? Dynamics::Base::floating : Dynamics::Base::fixed,
             layout.rotor_inertia_kg_m2),
      kinematics_(*layout.model),
      problem_(layout),
      acceleration_(model_.velocity),
      way_(model_.velocity) {}

void BodyLeader::begin(const BodyAim& aim) noexcept {
  std::ranges::copy_n(aim.start_rad.begin(), static_cast<std::ptrdiff_t>(model_.position_rad.size()),
                      model_.position_rad.begin());
  model_.base = body_start(*layout_, aim.settings, kinematics_, model_.position_rad, aim.base);
  model_.velocity.setZero();
  for (std::size_t i = 0; i < model_.position_rad.size(); ++i)
    model_.velocity[model_.base_size() + static_cast<Eigen::Index>(i)] = aim.start_rad_s[i];
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) feet_[i].share = 0;  // stand() puts it down
  acceleration_.setZero();
  fresh_ = true;
}

// A foot takes its load, or leaves it, before it is free.
void BodyLeader::stand(const BodyAim& aim, double dt_s) noexcept {
  const auto asked = [&](std::size_t i) { return aim.setpoints[layout_->contact_channel + i].value > 0.5; };
  bool any = false;
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) any = any || asked(i);
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    BodyStand& foot = feet_[i];
    const bool wanted = asked(i) || (!any && foot.stands());  // the last ones stay: it would fall
    if (wanted && !foot.stands()) {
      const Pose& link = model_.link(layout_->tasks[layout_->feet[i]].link);
      foot.pose = {{link.position_m[0], link.position_m[1], aim.settings.sole_m},
                   from_roll_pitch_yaw(0, 0, roll_pitch_yaw(link.orientation)[2])};
    }
    const double change = dt_s / (wanted ? 0.05 : load_s);
    foot.share = std::clamp(foot.share + (wanted ? change : -change), 0.0, 1.0);
    if (wanted && fresh_) foot.share = 1;
  }
}

// A task that comes or goes, or counts otherwise, does so smoothly: what it held back would else jump. One of the first
// level goes by way of the second, where it begins with a weight that lets the others hardly move it. Levels themselves
// act at once: a task that comes between others does so more smoothly by its weight.
void BodyLeader::weigh(const BodyAim& aim, double dt_s) noexcept {
  const bool second =
      std::ranges::any_of(ranks_, [](const BodyRank& rank) { return rank.level > 1 && rank.weight > 0; });
  for (std::size_t i = 0; i < layout_->tasks.size(); ++i) {
    BodyRank& rank = ranks_[i];
    const double wanted = aim.engaged[i] ? aim.settings.tasks[i].weight : 0;
    const int level = aim.settings.tasks[i].priority > 1 || (wanted == 0 && second) ? 2 : 1;
    if (level > rank.level && rank.weight > 0 && !fresh_) rank.weight = std::max(rank.weight, strict_weight);
    rank.level = level;
    const double change = weigh_per_s * dt_s * std::max(rank.weight, least_weight);
    rank.weight = fresh_ ? wanted : std::clamp(wanted, rank.weight - change, rank.weight + change);
  }
  const BodySettings& s = aim.settings;
  const double wanted = aim.alone ? std::max(s.posture_weight, alone_weight) : s.posture_weight;
  const double change = weigh_per_s * dt_s * std::max(posture_.weight, least_posture_weight);
  posture_.weight = fresh_ ? wanted : std::clamp(wanted, posture_.weight - change, posture_.weight + change);
  posture_.gain_per_s = aim.alone ? std::max(s.posture_per_s, alone_per_s) : s.posture_per_s;
}

void BodyLeader::step(const BodyAim& aim, double dt_s, BodyLead& lead) noexcept {
  if (!fresh_) {
    way_ = dt_s * model_.velocity + 0.5 * dt_s * dt_s * acceleration_;
    model_.move(way_);
    model_.velocity += dt_s * acceleration_;
  }
  model_.update();
  stand(aim, dt_s);
  weigh(aim, dt_s);
  const bool solved = problem_.solve(model_, aim, ranks_, posture_, feet_);
  if (solved)
    acceleration_ = problem_.acceleration();
  else
    acceleration_ = -brake_per_s * model_.velocity;
  lead.failures += solved ? 0 : 1;
  lead.period_s = dt_s > 0 ? dt_s : lead.period_s;
  fill(aim, lead);
  fresh_ = false;
}

void BodyLeader::fill(const BodyAim& aim, BodyLead& lead) const noexcept {
  for (std::size_t i = 0; i < layout_->joints.size(); ++i) {
    const std::size_t joint = layout_->joints[i].joint;
    const Eigen::Index at = model_.base_size() + static_cast<Eigen::Index>(joint);
    BodyLead::Joint& to = lead.joints[i];
    to.effort_before_Nm = fresh_ ? problem_.effort_Nm(joint) : to.effort_Nm;
    to = {model_.position_rad[joint], model_.velocity[at], acceleration_[at], problem_.effort_Nm(joint),
          to.effort_before_Nm};
  }
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    const Vec3& at = feet_[i].pose.position_m;
    const Vec3 turn = roll_pitch_yaw(feet_[i].pose.orientation);
    lead.feet[i] = {feet_[i].stands(),
                    feet_[i].stands() ? problem_.wrench(i).z() : 0,
                    {at[0], at[1], at[2] - aim.settings.sole_m, turn[0], turn[1], turn[2]}};
  }
  for (std::size_t i = 0; i < layout_->tasks.size(); ++i)
    lead.tasks[i] = present_task(layout_->tasks[i], aim.settings, aim.settings.tasks[i].point_m, model_);
  lead.com_m = model_.com_m();
  lead.iterations = problem_.iterations();
  lead.status = static_cast<double>(problem_.status());
  lead.activation = aim.activation;
}

void BodyLeader::pass_state(StateBytes& bytes) noexcept {
  const auto pass = [&](Eigen::VectorXd& vector) {
    for (double& value : vector) bytes.high_level(value);
  };
  for (double& value : model_.position_rad) bytes.high_level(value);
  pass(model_.velocity);
  pass(acceleration_);
  bytes.high_level(model_.base, feet_, ranks_, posture_, fresh_);
  problem_.pass_state(bytes);
}

}  // namespace kadans
