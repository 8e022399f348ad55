#include "fouls.h"

#include <algorithm>

namespace kadans::football {
namespace {

constexpr double velocity_filter_s = 0.15;
constexpr double long_contact_s = 5, contact_gap_s = 0.5, fall_after_contact_s = 1;
constexpr double standing_m_s = 0.05, clearly_faster_m_s = 0.2, front_cosine = 0.5;
constexpr double hold_max_s = 5, keeper_hold_max_s = 10;
constexpr double get_up_within_s = 20, inactive_max_s = 10;
constexpr int attempts_max = 3;  // one more when another robot disturbed it

bool match_runs(const Match& match) noexcept { return !match.stopped() && match.runs(); }

}  // namespace

void FoulJudge::forget(RobotId id) {
  track(id) = {};
  std::erase_if(touching_, [&](const Touching& touching) { return touching.a == id || touching.b == id; });
}

void FoulJudge::follow(double step_s, RobotId id, const RobotTruth& robot) {
  Track& state = track(id);
  if (state.known && step_s > 0) {
    const double share = step_s / (velocity_filter_s + step_s);
    const Point now_m_s = (1 / step_s) * (robot.pose.at() - state.at);
    state.velocity_m_s = state.velocity_m_s + share * (now_m_s - state.velocity_m_s);
  }
  state.known = true;
  state.at = robot.pose.at();
}

std::optional<RobotId> FoulJudge::pusher(const Touching& touching) noexcept {
  const double a_m_s = touching.approach_a_m_s, b_m_s = touching.approach_b_m_s;
  const double faster_m_s = std::max(a_m_s, b_m_s), slower_m_s = std::min(a_m_s, b_m_s);
  if (faster_m_s < standing_m_s) return std::nullopt;
  if (touching.front_to_front && faster_m_s - std::max(slower_m_s, 0.0) < clearly_faster_m_s) return std::nullopt;
  return a_m_s > b_m_s ? touching.a : touching.b;
}

void FoulJudge::note_contact(double step_s, const RobotContact& contact, const WorldTruth& world) {
  const auto same = [&](const Touching& touching) {
    return (touching.a == contact.a && touching.b == contact.b) || (touching.a == contact.b && touching.b == contact.a);
  };
  auto found = std::ranges::find_if(touching_, same);
  const bool fresh = found == touching_.end();
  if (fresh) {
    touching_.push_back({.a = contact.a, .b = contact.b});
    found = touching_.end() - 1;
  }
  Touching& touching = *found;
  const Pose2& a = world.robot(touching.a).pose;
  const Pose2& b = world.robot(touching.b).pose;
  const double apart_m = std::max(distance(a.at(), b.at()), 1e-6);
  const Point direction = (1 / apart_m) * (b.at() - a.at());
  touching.approach_a_m_s = std::max(touching.approach_a_m_s, dot(track(touching.a).velocity_m_s, direction));
  touching.approach_b_m_s = std::max(touching.approach_b_m_s, -dot(track(touching.b).velocity_m_s, direction));
  if (fresh) {
    touching.front_to_front = dot(turned({1, 0}, a.theta_rad), direction) > front_cosine &&
                              -dot(turned({1, 0}, b.theta_rad), direction) > front_cosine;
  }
  touching.lasts_s += step_s + touching.gap_s;
  touching.gap_s = -step_s;  // each step adds one
}

void FoulJudge::judge_pushing(double step_s, const Match& match, const WorldTruth& world) {
  for (const RobotContact& contact : world.contacts) {
    const bool both_play = match.plays(contact.a) && match.plays(contact.b) && world.robot(contact.a).present &&
                           world.robot(contact.b).present;
    if (both_play && contact.a.side != contact.b.side) note_contact(step_s, contact, world);
  }
  for (Touching& touching : touching_) {
    touching.gap_s += step_s;
    const std::optional<RobotId> offender = pusher(touching);
    if (!offender || !match.plays(*offender)) continue;
    const RobotId victim = *offender == touching.a ? touching.b : touching.a;
    const bool falls = track(victim).was_upright && !world.robot(victim).upright;
    const bool both_stand = world.robot(touching.a).upright && world.robot(touching.b).upright;
    if (falls && touching.gap_s <= fall_after_contact_s) {
      fouls_.push_back({*offender, Penalty::pushing, true, "brings an opponent down"});
    } else if (touching.lasts_s > long_contact_s && both_stand) {
      fouls_.push_back({*offender, Penalty::pushing, true, "pushes an opponent for more than 5 s"});
      touching.lasts_s = 0;
    }
  }
  std::erase_if(touching_, [](const Touching& touching) {
    return touching.gap_s > fall_after_contact_s ||
           (touching.gap_s > contact_gap_s && touching.lasts_s > contact_gap_s);
  });
}

void FoulJudge::judge_fallen(double step_s, RobotId id, const RobotTruth& robot) {
  Track& state = track(id);
  if (robot.upright) {
    state.fallen_s = state.attempt_s = 0;
    state.attempts = 0;
    state.disturbed = false;
    return;
  }
  const bool failed = (state.was_getting_up && !robot.getting_up) || state.attempt_s > get_up_within_s;
  if (failed) {
    ++state.attempts;
    state.attempt_s = state.fallen_s = 0;
  }
  (robot.getting_up ? state.attempt_s : state.fallen_s) += step_s;
  if (state.attempts >= attempts_max + (state.disturbed ? 1 : 0)) {
    fouls_.push_back({id, Penalty::incapable_robot, false, "failed to get up too often"});
  } else if (state.fallen_s > get_up_within_s) {
    fouls_.push_back({id, Penalty::incapable_robot, false, "lies and does not try to get up within 20 s"});
  }
}

void FoulJudge::judge_ball(double step_s, const Match& match, RobotId id, const RobotTruth& robot) {
  Track& state = track(id);
  const bool own_area = in_own_penalty_area(match, robot.pose, robot.radius_m, id.side, field_);
  const bool keeper = match.team(id.side).keeper == id.number && own_area;
  const bool throws_in = match.restart() == Restart::throw_in && match.kicking() == id.side;
  const bool holds = robot.holds_ball && robot.upright;
  state.hold_s = holds ? state.hold_s + step_s : std::max(state.hold_s - step_s, 0.0);
  const double most_s = keeper || throws_in ? keeper_hold_max_s : hold_max_s;
  if (holds && state.hold_s > most_s) {
    fouls_.push_back({id, Penalty::ball_holding, true,
                      most_s == hold_max_s ? "holds the ball for more than 5 s" : "holds the ball for more than 10 s"});
    state.hold_s = 0;
  }
  const bool uses_arms = robot.uses_arms && robot.upright && !robot.getting_up && !keeper && !throws_in;
  if (uses_arms && !state.used_arms)
    fouls_.push_back({id, Penalty::playing_with_arms, true, "plays the ball with its arms"});
  state.used_arms = uses_arms;
}

const std::vector<Foul>& FoulJudge::step(double step_s, const Match& match, const WorldTruth& world) {
  fouls_.clear();
  for (const RobotId id : all_robots()) {
    if (world.robot(id).present) follow(step_s, id, world.robot(id));
  }
  const bool playing = match.state() == GameState::playing && !match.stopped();
  if (playing) judge_pushing(step_s, match, world);
  for (const RobotId id : all_robots()) {
    const RobotTruth& robot = world.robot(id);
    if (!robot.present) continue;
    Track& state = track(id);
    if (match_runs(match) && match.plays(id)) {
      for (const RobotContact& contact : world.contacts)
        state.disturbed = state.disturbed || (robot.getting_up && (contact.a == id || contact.b == id));
      judge_fallen(step_s, id, robot);
      state.inactive_s =
          robot.active || !robot.upright || match.state() == GameState::set ? 0 : state.inactive_s + step_s;
      if (state.inactive_s > inactive_max_s)
        fouls_.push_back({id, Penalty::incapable_robot, false, "is inactive for more than 10 s"});
      if (playing) judge_ball(step_s, match, id, robot);
    }
    state.was_upright = robot.upright;
    state.was_getting_up = robot.getting_up;
  }
  return fouls_;
}

}  // namespace kadans::football
