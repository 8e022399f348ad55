#include "positions.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace kadans::football {
namespace {

constexpr double penalty_spacing_m = 0.75;  // between robots that serve penalties

// How far a circle reaches into a box in front of the goal at -x of a team's frame, or at +x with `attacked`.
double depth_in_area_m(Point team_at, double radius_m, double length_m, double width_m, const Field& field,
                       bool attacked = false) noexcept {
  const double x_m = attacked ? -team_at.x_m : team_at.x_m;
  return std::min(length_m - field.length_m / 2 + radius_m - x_m, width_m / 2 + radius_m - std::abs(team_at.y_m));
}

Point team_point(const Match& match, Side side, Point at) noexcept {
  return {match.sign(side) * at.x_m, at.y_m};  // y is not turned: areas are symmetric in it
}

double area_depth_m(const Match& match, const RobotTruth& robot, Side side, const Field& field,
                    bool attacked) noexcept {
  return depth_in_area_m(team_point(match, side, robot.pose.at()), robot.radius_m, field.penalty_area_length_m,
                         field.penalty_area_width_m, field, attacked);
}

Positioning at_kick_off(const Match& match, const RobotTruth& robot, Side side, const Field& field) {
  const double r = robot.radius_m;
  const double team_x_m = match.sign(side) * robot.pose.x_m, centre_m = norm(robot.pose.at());
  const bool beyond_half = team_x_m > -(field.line_m / 2 + r);
  const bool in_circle = centre_m < field.circle_radius_m + r;
  if (match.kicking() != side) return beyond_half || in_circle ? Positioning::illegal : Positioning::legal;
  if (match.state() == GameState::set && centre_m < field.mark_m / 2 + r) return Positioning::illegal;
  if (!beyond_half) return Positioning::legal;
  return in_circle ? Positioning::only_for_kicker : Positioning::illegal;
}

Positioning at_penalty_kick(const Match& match, const RobotTruth& robot, RobotId id, const Field& field) {
  const double r = robot.radius_m;
  const Point team_at = team_point(match, id.side, robot.pose.at());
  const bool kicks = match.kicking() == id.side;
  const double mark_x_m = kicks ? field.penalty_mark_x_m() : -field.penalty_mark_x_m();
  const double mark_m = distance(team_at, {mark_x_m, 0});
  const bool near = area_depth_m(match, robot, id.side, field, kicks) > 0 || mark_m < field.circle_radius_m + r;
  if (kicks) {
    const bool on_mark = match.state() == GameState::set && mark_m < field.mark_m / 2 + r;
    if (on_mark || team_at.x_m > mark_x_m) return Positioning::illegal;
    return near ? Positioning::only_for_kicker : Positioning::legal;
  }
  if (match.team(id.side).keeper == id.number) return Positioning::legal;  // it is looked at apart
  return near || team_at.x_m < mark_x_m ? Positioning::illegal : Positioning::legal;
}

}  // namespace

const std::vector<RobotId>& all_robots() {
  static const std::vector<RobotId> everybody = [] {
    std::vector<RobotId> all;
    for (const Side side : both_sides) {
      for (std::uint8_t number = 1; number <= players_max; ++number) all.push_back({side, number});
    }
    return all;
  }();
  return everybody;
}

bool outside_field(const RobotTruth& robot, const Field& field) noexcept {
  return std::abs(robot.pose.x_m) > field.length_m / 2 + robot.radius_m ||
         std::abs(robot.pose.y_m) > field.width_m / 2 + robot.radius_m;
}

bool off_carpet(const RobotTruth& robot, const Field& field) noexcept {
  return std::abs(robot.pose.x_m) > field.length_m / 2 + field.border_m ||
         std::abs(robot.pose.y_m) > field.width_m / 2 + field.border_m;
}

bool on_own_goal_line(const Match& match, const RobotTruth& robot, Side side, const Field& field) noexcept {
  const double team_x_m = match.sign(side) * robot.pose.x_m;
  return std::abs(robot.pose.y_m) <= field.goal.width_m / 2 &&
         std::abs(team_x_m + field.goal_line_x_m()) <= robot.radius_m;
}

bool in_own_penalty_area(const Match& match, const Pose2& pose, double radius_m, Side side,
                         const Field& field) noexcept {
  return area_depth_m(match, {.pose = pose, .radius_m = radius_m}, side, field, false) >= 0;
}

double own_goal_area_depth_m(const Match& match, const RobotTruth& robot, Side side, const Field& field) noexcept {
  return depth_in_area_m(team_point(match, side, robot.pose.at()), robot.radius_m, field.goal_area_length_m,
                         field.goal_area_width_m, field);
}

bool avoidance_is_due(const Match& match) noexcept {
  const Restart restart = match.restart();
  return match.state() == GameState::playing && !match.stopped() && match.kicking().has_value() &&
         restart != Restart::none && restart != Restart::kick_off && restart != Restart::dropped_ball &&
         restart != Restart::penalty_kick;
}

bool in_avoidance_region(const Match& match, const WorldTruth& world, const Field& field, RobotId id) {
  const RobotTruth& robot = world.robot(id);
  if (!avoidance_is_due(match) || match.kicking() == id.side || !robot.present || !match.plays(id)) return false;
  if (on_own_goal_line(match, robot, id.side, field)) return false;
  const Point ball = team_point(match, id.side, world.ball);
  const bool ball_in_own_area = ball.x_m <= field.penalty_area_length_m - field.length_m / 2 &&
                                std::abs(ball.y_m) <= field.penalty_area_width_m / 2;
  return distance(robot.pose.at(), world.ball) < field.circle_radius_m + robot.radius_m ||
         (match.restart() == Restart::goal_kick && area_depth_m(match, robot, id.side, field, true) > 0) ||
         (ball_in_own_area && area_depth_m(match, robot, id.side, field, false) > 0);
}

Positioning positioning(const Match& match, const WorldTruth& world, const Field& field, RobotId id) {
  const RobotTruth& robot = world.robot(id);
  const bool looked_at = match.state() == GameState::set || (match.state() == GameState::playing && !match.stopped());
  if (!looked_at || !robot.present || !match.plays(id)) return Positioning::legal;
  switch (match.restart()) {
    case Restart::kick_off:
    case Restart::dropped_ball:
      return at_kick_off(match, robot, id.side, field);
    case Restart::penalty_kick:
      return at_penalty_kick(match, robot, id, field);
    case Restart::none:
      return Positioning::legal;
    default:
      return in_avoidance_region(match, world, field, id) ? Positioning::in_avoidance : Positioning::legal;
  }
}

std::optional<RobotId> nearest_kicker(const Match& match, const WorldTruth& world, const Field& field) {
  if (!match.kicking()) return std::nullopt;
  const Side side = *match.kicking();
  const Point mark =
      match.restart() == Restart::penalty_kick ? Point{match.sign(side) * field.penalty_mark_x_m(), 0} : Point{};
  std::optional<RobotId> nearest;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::uint8_t number = 1; number <= players_max; ++number) {
    const RobotId id{side, number};
    const double mark_m = distance(world.robot(id).pose.at(), mark);
    if (positioning(match, world, field, id) != Positioning::only_for_kicker || mark_m >= least_m) continue;
    nearest = id;
    least_m = mark_m;
  }
  return nearest;
}

unsigned robots_on_field(const Match& match, const WorldTruth& world, Side side) {
  unsigned count = 0;
  for (std::uint8_t number = 1; number <= players_max; ++number)
    count += match.plays({side, number}) && world.robot({side, number}).present ? 1U : 0U;
  return count;
}

Point ball_placement(const Match& match, Restart restart, std::optional<Side> side, Point ball, const Field& field) {
  const double goal_line_m = field.goal_line_x_m(), touchline_m = field.touchline_y_m();
  switch (restart) {
    case Restart::kick_off:
    case Restart::dropped_ball:
      return {};
    case Restart::penalty_kick:
      return {match.sign(*side) * field.penalty_mark_x_m(), 0};
    case Restart::goal_kick:
      return {std::copysign(field.length_m / 2 - field.goal_area_length_m + field.line_m / 2, ball.x_m),
              std::copysign((field.goal_area_width_m - field.line_m) / 2, ball.y_m)};
    case Restart::corner:
      return {std::copysign(goal_line_m, ball.x_m), std::copysign(touchline_m, ball.y_m)};
    case Restart::throw_in:
      return {std::clamp(ball.x_m, -goal_line_m, goal_line_m), std::copysign(touchline_m, ball.y_m)};
    case Restart::indirect_free_kick: {
      const double area_m = field.length_m / 2 - field.penalty_area_length_m + field.line_m / 2;
      const double sign = match.sign(*side);
      const bool inside =
          sign * ball.x_m > area_m && std::abs(ball.y_m) <= (field.penalty_area_width_m - field.line_m) / 2;
      return inside ? Point{sign * area_m, ball.y_m} : ball;
    }
    default:
      return ball;
  }
}

Pose2 penalty_placement(const Match& match, const WorldTruth& world, const Field& field, RobotId id,
                        std::span<const Point> taken) {
  const RobotTruth& robot = world.robot(id);
  const double sign = match.sign(id.side);
  const double y_m = std::copysign(field.width_m / 2 + field.border_m - robot.radius_m, robot.pose.y_m);
  const double least_m = robot.radius_m - field.length_m / 2, most_m = -robot.radius_m;
  const double start_m = std::clamp(-field.penalty_mark_x_m(), least_m, most_m);
  const auto room_m = [&](double team_x_m) {
    double room = std::numeric_limits<double>::infinity();
    const Point at{sign * team_x_m, y_m};
    for (const RobotId other_id : all_robots()) {
      const RobotTruth& truth = world.robot(other_id);
      if (other_id != id && truth.present) room = std::min(room, distance(truth.pose.at(), at));
    }
    for (const Point& point : taken) room = std::min(room, distance(point, at));
    return room;
  };
  double best_x_m = start_m, best_room_m = room_m(start_m);
  for (int k = 1; best_room_m < penalty_spacing_m && k * penalty_spacing_m < field.length_m; ++k) {
    for (const double team_x_m : {start_m - k * penalty_spacing_m, start_m + k * penalty_spacing_m}) {
      if (team_x_m < least_m || team_x_m > most_m || best_room_m >= penalty_spacing_m) continue;
      const double room = room_m(team_x_m);
      if (room > best_room_m) best_x_m = team_x_m, best_room_m = room;
    }
  }
  return {sign * best_x_m, y_m, y_m > 0 ? -std::numbers::pi / 2 : std::numbers::pi / 2};
}

Pose2 keeper_placement(const Match& match, const RobotTruth& keeper, Side side, const Field& field) noexcept {
  const double most_m = std::max(field.goal.width_m / 2 - keeper.radius_m, 0.0);
  return {-match.sign(side) * field.goal_line_x_m(), std::clamp(keeper.pose.y_m, -most_m, most_m),
          match.sign(side) > 0 ? 0 : std::numbers::pi};
}

}  // namespace kadans::football
