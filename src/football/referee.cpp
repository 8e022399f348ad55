#include "referee.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace kadans::football {
namespace {

// Tolerances of the official automatic referee.
constexpr double robot_moved_m = 0.005, robot_moved_rad = 0.05;
constexpr double ball_moved_m = 0.01, ball_clearly_moved_m = 0.1;
constexpr double must_stay_m = 0.1, must_stay_rad = 0.3, settle_s = 1;
constexpr double leave_avoidance_s = 10;
constexpr double globally_stuck_m = 1, locally_stuck_m = 0.5, stuck_ball_m = 0.1;
constexpr double clear_distance_m = 0.1;
constexpr int goal_area_robots_max = 3;

constexpr std::int64_t ms_ns = 1'000'000;
constexpr std::int64_t touch_pause_ns = 200 * ms_ns;    // touches of one robot within are one
constexpr std::int64_t restart_grace_ns = 500 * ms_ns;  // contacts right after a restart do not take it
constexpr std::int64_t rest_ns = 1000 * ms_ns;          // the ball rests
constexpr std::int64_t locally_stuck_ns = 10'000 * ms_ns, globally_stuck_ns = 30'000 * ms_ns;
constexpr std::int64_t between_legs_ns = 1000 * ms_ns;
constexpr std::int64_t placed_grace_ns = 500 * ms_ns;

std::string name_of(Side side) { return side == Side::home ? "home" : "away"; }
std::string name_of(RobotId id) { return name_of(id.side) + " " + std::to_string(id.number); }

std::string at(const Point& point) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "(%.2f, %.2f)", point.x_m, point.y_m);
  return text.data();
}

bool gives_direct_goal(Restart restart) noexcept {
  return restart != Restart::kick_off && restart != Restart::indirect_free_kick && restart != Restart::throw_in;
}

std::string_view rule_of(Restart restart) noexcept {
  switch (restart) {
    case Restart::throw_in:
      return "game.tex, Kick-in / Throw-in";
    case Restart::goal_kick:
      return "game.tex, Goal Kick";
    case Restart::corner:
      return "game.tex, Corner Kick";
    case Restart::penalty_kick:
      return "game.tex, Penalty Kick";
    default:
      return "game.tex, Law 13, Free Kicks";
  }
}

std::string_view rule_of(Penalty penalty) noexcept {
  switch (penalty) {
    case Penalty::pushing:
      return "game.tex, Pushing";
    case Penalty::ball_holding:
      return "game.tex, Ball Holding";
    case Penalty::playing_with_arms:
      return "game.tex, Playing with Arms or Hands";
    default:
      return "game.tex, Incapable Robot";
  }
}

}  // namespace

std::string Decision::line() const {
  std::array<char, 80> head{};
  std::snprintf(head.data(), head.size(), "%.3f s, half %d, %.1f s left: ", static_cast<double>(time_ns) * 1e-9,
                first_half ? 1 : 2, remaining_s);
  return head.data() + text + " [" + std::string(rule) + "]";
}

Referee::Referee(const Setup& setup) : setup_(setup), match_(setup.match), fouls_(setup.field) {
  const std::string wrong = field_mistake(setup.field);
  if (!wrong.empty()) throw std::invalid_argument("a match needs a field: " + wrong);
}

void Referee::decide(std::string_view rule, std::string text) {
  report_.decisions.push_back({match_.time_ns(), match_.first_half(), match_.remaining_s(), std::move(text), rule});
}

void Referee::place(RobotId id, const Pose2& pose) {
  report_.robots.push_back({id, pose});
  watch(id).placed_ns = match_.time_ns();
  watch(id).stand_still.reset();
  fouls_.forget(id);
}

void Referee::watch_motion_from(double after_s) {
  still_from_ns_ = match_.time_ns() + std::llround(after_s * 1e9);
  still_noted_ = false;
}

bool Referee::ball_rests(std::int64_t since_ns) const noexcept {
  return now_ns() >= std::max(ball_moved_ns_, since_ns) + rest_ns;
}

void Referee::begin_ready(Restart restart, std::optional<Side> side) {
  match_.begin_ready(restart, side);
  kick_.reset();
  kicker_.reset();
  penalty_kick_runs_ = restart == Restart::penalty_kick;
}

void Referee::begin_free_kick(Restart restart, Side side, const Point& ball) {
  match_.begin_free_kick(restart, side);
  kick_ = Kick{.restart = restart, .side = side};
  kicker_.reset();
  penalty_kick_runs_ = false;
  restart_ns_ = now_ns();
  for (auto& watches : watches_) {
    for (Watch& robot : watches) robot.left_avoidance = false;
  }
  report_.ball = ball_placement(match_, restart, side, ball, setup_.field);
  watch_motion_from(settle_s);
}

Point Referee::begin_with(Restart restart, Side side, const Point& ball) {
  if (restart == Restart::penalty_kick) {
    begin_ready(restart, side);
    return ball_placement(match_, restart, side, ball, setup_.field);
  }
  match_.begin_ready(Restart::dropped_ball, std::nullopt);
  match_.enter_set();
  match_.play();
  if (restart == Restart::none) return ball;
  begin_free_kick(restart, side, ball);
  return report_.ball.value_or(ball);
}

void Referee::penalise(RobotId id, Penalty penalty, const WorldTruth& world, std::string_view rule,
                       const std::string& why) {
  if (!match_.plays(id)) return;
  match_.penalise(id, penalty);
  report_.penalised.push_back(id);
  decide(rule, std::string(football::name_of(penalty)) + ", " + name_of(id) + ": " + why);
  if (penalty == Penalty::motion_in_set) return;  // it stays where it is
  watch(id).returning = true;
  std::vector<Point> taken;
  for (const RobotPlacement& placed : report_.robots) taken.push_back(placed.pose.at());
  place(id, penalty_placement(match_, world, setup_.field, id, taken));
}

void Referee::enter_set(const WorldTruth& world) {
  match_.enter_set();
  const std::optional<Side> side = match_.kicking();
  kick_.reset();
  if (side) kick_ = Kick{.restart = match_.restart(), .side = *side};
  kicker_ = nearest_kicker(match_, world, setup_.field);
  report_.ball = ball_placement(match_, match_.restart(), side, world.ball, setup_.field);
  decide("game.tex, Set", std::string("set: ") + football::name_of(match_.restart()) +
                              (side ? " for " + name_of(*side) : std::string()));
  watch_motion_from(settle_s);
  if (match_.restart() != Restart::penalty_kick) return;
  const RobotId keeper{other(*side), match_.team(other(*side)).keeper};
  if (keeper.number == 0 || !match_.plays(keeper)) return;
  const RobotTruth& robot = world.robot(keeper);
  if (robot.present && !on_own_goal_line(match_, robot, keeper.side, setup_.field))
    place(keeper, keeper_placement(match_, robot, keeper.side, setup_.field));
}

void Referee::heed_clocks(const Match::Passed& passed) {
  if (passed.sides_changed) decide("game.tex, Half-time", "the teams change sides");
  if (passed.break_is_over) decide("game.tex, Half-time", "the second half is prepared");
  for (const RobotId id : passed.free_again)
    decide("game.tex, Standard Removal Penalty", name_of(id) + " may play again");
  if (passed.resumed) {
    restart_ns_ = now_ns();
    still_from_ns_.reset();
    decide(rule_of(match_.restart()), std::string(football::name_of(match_.restart())) + " may be taken");
  }
  if (!passed.set_play_is_over) return;
  const Restart restart = match_.restart();
  decide(rule_of(restart), std::string("ball free: the time of the ") + football::name_of(restart) + " is over");
  match_.free_ball();
  if (kick_ && !kick_->kicker) kick_.reset();  // a failed kick lifts all restrictions
  penalty_kick_runs_ = false;
}

// What moved, and who came back to the field.
void Referee::follow(const WorldTruth& world) {
  if (!ball_reference_ || distance(world.ball, *ball_reference_) > ball_moved_m) {
    ball_reference_ = world.ball;
    ball_moved_ns_ = now_ns();
  }
  if (kick_ && kick_->kicker && distance(world.ball, kick_->from) > ball_clearly_moved_m) kick_->clearly_moved = true;
  for (const RobotId id : all_robots()) {
    const RobotTruth& robot = world.robot(id);
    if (!robot.present) continue;
    Watch& state = watch(id);
    if (distance(robot.pose.at(), state.still.at()) > robot_moved_m ||
        std::abs(wrapped(robot.pose.theta_rad - state.still.theta_rad)) > robot_moved_rad) {
      state.still = robot.pose;
      if (match_.plays(id)) robot_moved_ns_ = now_ns();
    }
    if (!match_.plays(id))
      state.returning = true;
    else if (!outside_field(robot, setup_.field))
      state.returning = false;
    if (avoidance_is_due(match_) && !in_avoidance_region(match_, world, setup_.field, id)) state.left_avoidance = true;
  }
}

void Referee::heed_touches(const WorldTruth& world) {
  std::vector<RobotId> touching;
  for (const RobotId id : all_robots()) {
    if (world.robot(id).present && world.robot(id).touches_ball) touching.push_back(id);
  }
  if (touching.empty()) return;
  const auto home = [](RobotId id) { return id.side == Side::home; };
  const bool both = std::ranges::any_of(touching, home) && !std::ranges::all_of(touching, home);
  for (const RobotId id : touching) heed_touch(id, world);
  if (both) last_contact_.reset();  // nobody can tell: the defending side gets the ball
}

void Referee::heed_touch(RobotId id, const WorldTruth& world) {
  const std::int64_t now = now_ns();
  last_contact_ = id.side;
  watch(id).touched_ns = now;
  const bool playing = match_.state() == GameState::playing && !match_.stopped();
  const bool grace = now < restart_ns_ + restart_grace_ns;
  if (playing && match_.restart() != Restart::none && match_.kicking() == id.side && !grace) {
    decide(rule_of(match_.restart()),
           std::string("ball free: ") + name_of(id) + " took the " + football::name_of(match_.restart()));
    match_.free_ball();
  }
  const bool same = last_touch_ && last_touch_->first == id && now <= last_touch_->second + touch_pause_ns;
  last_touch_ = {id, now};
  if (same || !playing || !kick_ || grace) return;
  const bool outside = norm(world.ball) > setup_.field.circle_radius_m + setup_.ball.radius_m;
  if (!kick_->kicker && id.side == kick_->side) {
    kick_->kicker = id;
    kick_->kicked_ns = now;
    kick_->from = world.ball;
    kick_->outside_circle = outside;
  } else if (kick_->kicker && *kick_->kicker == id) {
    kick_->outside_circle = kick_->outside_circle || outside;
    if (!kick_->other_touch && kick_->clearly_moved) heed_second_touch(id, world);
  } else {
    kick_->other_touch = true;
  }
}

void Referee::heed_second_touch(RobotId id, const WorldTruth& world) {
  const Restart restart = kick_->restart;
  if (restart == Restart::kick_off || restart == Restart::dropped_ball) return;  // it only bars the direct goal
  const bool penalty_kick = restart == Restart::penalty_kick;
  if (!penalty_kick && robots_on_field(match_, world, id.side) < 3) return;
  decide(rule_of(restart), "indirect free kick for " + name_of(other(id.side)) + ": " + name_of(id) +
                               " touched the ball twice after the " + football::name_of(restart));
  begin_free_kick(Restart::indirect_free_kick, other(id.side), world.ball);
}

void Referee::judge_fouls(std::int64_t step_ns, const WorldTruth& world) {
  const std::vector<Foul> fouls = fouls_.step(static_cast<double>(step_ns) * 1e-9, match_, world);
  for (const Foul& foul : fouls) {
    const bool in_play = match_.state() == GameState::playing && !match_.stopped() && match_.restart() == Restart::none;
    const Pose2 where = world.robot(foul.robot).pose;
    const bool near = distance(where.at(), world.ball) <= setup_.field.circle_radius_m;
    const bool own_area = in_own_penalty_area(match_, where, 0, foul.robot.side, setup_.field);
    const std::string_view rule = rule_of(foul.penalty);
    penalise(foul.robot, foul.penalty, world, rule, foul.what);
    if (!in_play || !foul.gives_free_kick || !near) continue;
    const Side side = other(foul.robot.side);
    if (own_area) {
      decide(rule_of(Restart::penalty_kick), "penalty kick for " + name_of(side));
      begin_ready(Restart::penalty_kick, side);
    } else {
      decide(rule_of(Restart::direct_free_kick), "direct free kick for " + name_of(side) + " at " + at(world.ball));
      begin_free_kick(Restart::direct_free_kick, side, world.ball);
    }
  }
}

bool Referee::is_illegal(RobotId id, const WorldTruth& world) {
  Watch& state = watch(id);
  const RobotTruth& robot = world.robot(id);
  if (match_.state() == GameState::set && !state.returning && outside_field(robot, setup_.field)) return true;
  switch (positioning(match_, world, setup_.field, id)) {
    case Positioning::illegal:
      return true;
    case Positioning::only_for_kicker:
      if (kicker_ && !match_.plays(*kicker_)) kicker_.reset();
      if (!kicker_ && match_.state() == GameState::playing) kicker_ = id;
      return kicker_ != id;
    case Positioning::in_avoidance:
      return state.left_avoidance || match_.set_play_age_s() >= leave_avoidance_s;
    default:
      return false;
  }
}

void Referee::judge_positions(const WorldTruth& world) {
  for (const RobotId id : all_robots()) {
    const RobotTruth& robot = world.robot(id);
    if (!robot.present || !match_.plays(id) || match_.time_ns() < watch(id).placed_ns + placed_grace_ns) continue;
    if (match_.runs() && off_carpet(robot, setup_.field)) {
      penalise(id, Penalty::leaving_the_field, world, "game.tex, Leaving the Field", "left the carpet");
    } else if (is_illegal(id, world)) {
      penalise(id, Penalty::illegal_positioning, world, "game.tex, Illegal Positioning",
               "is at " + at(robot.pose.at()) + " in " + std::string(football::name_of(match_.state())) + " of " +
                   football::name_of(match_.restart()));
    }
  }
}

// At most three robots of a team are in their own goal area: while playing the newest go, in set the outermost.
void Referee::judge_goal_areas(const WorldTruth& world) {
  const bool looked_at =
      match_.state() == GameState::set || (match_.state() == GameState::playing && !match_.stopped());
  for (const Side side : both_sides) {
    struct Inside {
      RobotId id;
      bool is_new;
      double depth_m;
    };
    std::vector<Inside> inside;
    for (std::uint8_t number = 1; number <= players_max; ++number) {
      const RobotId id{side, number};
      const RobotTruth& robot = world.robot(id);
      const double depth_m = own_goal_area_depth_m(match_, robot, side, setup_.field);
      const bool is_inside = robot.present && match_.plays(id) && depth_m >= 0;
      if (is_inside) inside.push_back({id, match_.state() == GameState::playing && !watch(id).in_goal_area, depth_m});
      watch(id).in_goal_area = is_inside;
    }
    if (!looked_at) continue;
    std::ranges::stable_sort(inside, [](const Inside& a, const Inside& b) {
      return a.is_new != b.is_new ? a.is_new : a.depth_m < b.depth_m;
    });
    const int over = static_cast<int>(inside.size()) - goal_area_robots_max;
    for (int i = 0; i < over; ++i) {
      penalise(inside.at(static_cast<std::size_t>(i)).id, Penalty::illegal_positioning, world,
               "game.tex, Illegal Positioning", "is the fourth in its own goal area");
    }
  }
}

// Before the ball is kicked the keeper stays on its line, on its feet.
void Referee::judge_keeper(const WorldTruth& world) {
  if (!kick_ || kick_->restart != Restart::penalty_kick || kick_->kicker || match_.state() != GameState::playing)
    return;
  const Side side = other(kick_->side);
  const RobotId keeper{side, match_.team(side).keeper};
  if (keeper.number == 0 || !match_.plays(keeper) || !world.robot(keeper).present) return;
  const RobotTruth& robot = world.robot(keeper);
  if (robot.upright && on_own_goal_line(match_, robot, side, setup_.field)) return;
  decide("game.tex, Penalty Kick", name_of(keeper) + " left its line or its feet before the kick");
  judge_goal(other(side));
}

void Referee::judge_motion(const WorldTruth& world) {
  const bool still = match_.state() == GameState::set || match_.stopped();
  if (!still) still_from_ns_.reset();
  if (!still_from_ns_ || match_.time_ns() < *still_from_ns_) return;
  for (const RobotId id : all_robots()) {
    const RobotTruth& robot = world.robot(id);
    std::optional<Pose2>& stays = watch(id).stand_still;
    if (!still_noted_) {
      stays.reset();
      if (robot.present && match_.plays(id)) stays = robot.pose;
      continue;
    }
    if (!stays || !robot.present || !match_.plays(id)) continue;
    const bool gets_up = !match_.stopped() && (robot.getting_up || !robot.upright);
    if (gets_up) stays = robot.pose;  // allowed in set, not in a stop
    if (distance(robot.pose.at(), stays->at()) <= must_stay_m &&
        std::abs(wrapped(robot.pose.theta_rad - stays->theta_rad)) <= must_stay_rad)
      continue;
    stays.reset();
    if (match_.stopped())
      penalise(id, Penalty::motion_in_stop, world, "game.tex, Motion in Stop", "moved while play is stopped");
    else
      penalise(id, Penalty::motion_in_set, world, "game.tex, Motion in Set", "moved in set");
  }
  still_noted_ = true;
}

void Referee::judge_stuck(const WorldTruth& world) {
  if (match_.stopped()) return;
  if (match_.state() != GameState::playing || match_.restart() != Restart::none) {
    near_ball_ns_ = now_ns();
    stuck_at_.reset();
    return;
  }
  std::optional<RobotId> nearest;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const RobotId id : all_robots()) {
    const RobotTruth& robot = world.robot(id);
    if (!robot.present || !match_.plays(id)) continue;
    const double edge_m = distance(robot.pose.at(), world.ball) - robot.radius_m;
    if (edge_m < nearest_m) nearest = id, nearest_m = edge_m;
  }
  if (nearest_m <= globally_stuck_m) near_ball_ns_ = now_ns();
  if (now_ns() >= near_ball_ns_ + globally_stuck_ns) {
    decide("game.tex, Global Game Stuck", "dropped ball: nobody was within 1 m of the ball for 30 s");
    begin_ready(Restart::dropped_ball, std::nullopt);
    return;
  }
  if (!stuck_at_ || distance(world.ball, *stuck_at_) > stuck_ball_m) {
    stuck_at_ = world.ball;
    stuck_since_ns_ = now_ns();
  }
  if (now_ns() < stuck_since_ns_ + locally_stuck_ns || !(nearest_m <= locally_stuck_m)) return;
  penalise(*nearest, Penalty::local_game_stuck, world, "game.tex, Local Game Stuck",
           "is nearest to a ball that did not move for 10 s");
  stuck_at_.reset();
}

void Referee::clear_ball(const WorldTruth& world) {
  if (match_.stopped() || report_.ball) return;
  for (const RobotId id : all_robots()) {
    const RobotTruth& robot = world.robot(id);
    Watch& state = watch(id);
    const bool touches = state.touched_ns && now_ns() <= *state.touched_ns + touch_pause_ns;
    const bool between = match_.state() == GameState::playing && robot.present && touches &&
                         distance(robot.pose.at(), world.ball) < robot.radius_m;
    if (!between) {
      state.ball_between_legs_ns.reset();
      continue;
    }
    if (!state.ball_between_legs_ns) state.ball_between_legs_ns = now_ns();
    if (now_ns() < *state.ball_between_legs_ns + between_legs_ns) continue;
    state.ball_between_legs_ns.reset();
    const double ahead_m = robot.radius_m + setup_.ball.radius_m + clear_distance_m;
    const Point there = from_frame(robot.pose, Point{ahead_m, 0});
    const double x_m = setup_.field.length_m / 2 - setup_.ball.radius_m;
    const double y_m = setup_.field.width_m / 2 - setup_.ball.radius_m;
    report_.ball = Point{std::clamp(there.x_m, -x_m, x_m), std::clamp(there.y_m, -y_m, y_m)};
    decide("game.tex, Clear Ball", "clear ball: it was between the legs of " + name_of(id));
    return;
  }
}

void Referee::judge_goal(Side scorer) {
  match_.count_goal(scorer);
  kick_.reset();
  kicker_.reset();
  penalty_kick_runs_ = false;
  decide("game.tex, Goal", "goal for " + name_of(scorer) + ": home " + std::to_string(match_.score(Side::home)) +
                               ", away " + std::to_string(match_.score(Side::away)));
  if (!match_.over()) return;
  report_.whistles_short = 2;
  report_.whistles_long = 1;
  decide("game.tex, Mercy Rule",
         "the match is over: one team leads by " + std::to_string(match_.rules().mercy_difference));
}

void Referee::judge_ball_out(const WorldTruth& world) {
  if (match_.state() != GameState::playing || match_.stopped()) return;
  const Field& field = setup_.field;
  const double r = setup_.ball.radius_m;
  const Point ball = world.ball;
  const bool over_goal_line = std::abs(ball.x_m) > field.length_m / 2 + r;
  const bool over_touchline = std::abs(ball.y_m) > field.width_m / 2 + r;
  if (!over_goal_line && !over_touchline) return;
  const bool in_goal = std::abs(ball.y_m) + r < field.goal.width_m / 2 && world.ball_z_m + r < field.goal.height_m;
  const Side defender = match_.sign(Side::home) * ball.x_m < 0 ? Side::home : Side::away;
  const Side attacker = other(defender);
  Restart restart = Restart::throw_in;
  Side side = last_contact_ ? other(*last_contact_) : defender;
  std::string why = "the ball left at " + at(ball);
  if (over_goal_line && in_goal) {
    const bool straight = kick_ && !kick_->other_touch;
    const bool own = straight && kick_->side == defender;
    const bool few = straight && kick_->restart == Restart::kick_off && kick_->outside_circle &&
                     robots_on_field(match_, world, attacker) <= 2;
    if (!straight || (!own && (gives_direct_goal(kick_->restart) || few))) return judge_goal(attacker);
    restart = own ? Restart::corner : Restart::goal_kick;
    side = own ? attacker : defender;
    why = std::string("no goal straight from the ") + football::name_of(kick_->restart);
  } else if (over_goal_line) {
    const bool by_attacker = last_contact_.value_or(attacker) == attacker;
    restart = by_attacker ? Restart::goal_kick : Restart::corner;
    side = by_attacker ? defender : attacker;
  }
  decide(rule_of(restart), std::string(football::name_of(restart)) + " for " + name_of(side) + ": " + why);
  begin_free_kick(restart, side, ball);
}

// After the kick a penalty kick ends when the ball rests, is touched by its kicker again or leaves the field.
void Referee::judge_penalty_kick() {
  if (!penalty_kick_runs_ || match_.state() != GameState::playing || !kick_ || !kick_->kicker) return;
  const bool late = now_ns() >= kick_->kicked_ns + std::llround(match_.rules().penalty_kick_s * 1e9);
  if (!late && !ball_rests(kick_->kicked_ns)) return;
  decide("game.tex, Penalty Kick",
         late ? "the penalty kick is over: its time is" : "the penalty kick is over: the ball rests");
  penalty_kick_runs_ = false;
  kick_.reset();
}

void Referee::judge_time() {
  if (!match_.runs() || !(match_.remaining_s() < 0) || penalty_kick_runs_) return;
  const bool rolls = !ball_rests(0) && match_.remaining_s() > -match_.rules().half_more_max_s;
  if (match_.state() == GameState::playing && rolls) return;
  match_.finish_half();
  report_.whistles_short = 2;
  report_.whistles_long = match_.over() ? 1 : 0;
  kick_.reset();
  decide("game.tex, Duration of the Match", match_.over() ? "the match is over" : "the first half is over");
}

void Referee::keep_penalised_out(const WorldTruth& world) {
  if (match_.state() == GameState::finished || match_.state() == GameState::initial) return;
  for (const RobotId id : all_robots()) {
    const RobotTruth& robot = world.robot(id);
    if (!robot.present || match_.plays(id) || match_.penalty(id) == Penalty::motion_in_set) continue;
    if (outside_field(robot, setup_.field) || match_.time_ns() < watch(id).placed_ns + placed_grace_ns) continue;
    decide("game.tex, Standard Removal Penalty", name_of(id) + " came onto the field before its penalty was over");
    match_.restart_penalty(id);
    std::vector<Point> taken;
    for (const RobotPlacement& placed : report_.robots) taken.push_back(placed.pose.at());
    place(id, penalty_placement(match_, world, setup_.field, id, taken));
  }
}

const RefereeReport& Referee::step(std::int64_t step_ns, const WorldTruth& world) {
  report_ = {};
  if (match_.over()) {
    (void)match_.advance(step_ns);
    return report_;
  }
  const GameState before = match_.state();
  const Match::Passed passed = match_.advance(step_ns);
  if (before == GameState::initial && match_.state() == GameState::ready) {
    begin_ready(match_.restart(), match_.kicking());
    decide("game.tex, Kick-off", "ready: kick-off for " + name_of(*match_.kicking()));
  }
  heed_clocks(passed);
  follow(world);
  heed_touches(world);
  judge_fouls(step_ns, world);
  judge_positions(world);
  judge_goal_areas(world);
  judge_keeper(world);
  judge_motion(world);
  judge_stuck(world);
  clear_ball(world);
  if (match_.state() == GameState::ready) {
    const double early_s = match_.rules().early_set_s;
    const double still_s = static_cast<double>(now_ns() - robot_moved_ns_) * 1e-9;
    if (passed.ready_is_over || (match_.state_age_s() > 2 * early_s && still_s > early_s)) enter_set(world);
  } else if (match_.state() == GameState::set && passed.set_is_over) {
    match_.play();
    report_.whistles_short = 1;
    restart_ns_ = now_ns();
    last_contact_.reset();
    decide("game.tex, Playing", "playing");
  }
  judge_ball_out(world);
  judge_penalty_kick();
  judge_time();
  keep_penalised_out(world);
  return report_;
}

}  // namespace kadans::football
