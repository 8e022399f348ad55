// Where robots may be, and where robots and the ball are placed: geometry alone.
//
// Sources: RoboCup-HumanoidSoccerLeague/GameController, game_controller_autoreferee (ad1cc83), the official automatic
// referee: tolerances and placements; HSL-Rules game.tex 3079e99: Law 8 (kick-off), Law 13 (free kicks), penalty kick,
// "Illegal Positioning", "Standard Removal Penalty".
//
// Frame of the world: origin at the centre mark, x toward the left goal, as the game controller sees it. A robot is
// inside an area when its circle touches it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "field.h"
#include "match.h"

namespace kadans::football {

// The truth of one robot. What it touches holds for the step just done.
struct RobotTruth {
  bool present = false;
  Pose2 pose;
  double radius_m = 0.2;
  bool upright = true;
  bool getting_up = false;    // it tries to
  bool active = true;         // walks, turns, looks for the ball or at it
  bool touches_ball = false;  // with anything
  bool uses_arms = false;     // touches the ball with arms or hands
  bool holds_ball = false;    // more than half of the ball is within its convex hull
};

struct RobotContact {
  RobotId a, b;
};

struct WorldTruth {
  Point ball;
  double ball_z_m = 0;                                          // of its centre
  std::array<std::array<RobotTruth, players_max>, 2> robots{};  // [side][number - 1]
  std::vector<RobotContact> contacts;                           // robots that touch each other

  RobotTruth& robot(RobotId id) noexcept { return robots.at(index_of(id.side)).at(id.index()); }
  const RobotTruth& robot(RobotId id) const noexcept { return robots.at(index_of(id.side)).at(id.index()); }
};

// All that may be on the field: numbers 1 to 20 of both sides.
const std::vector<RobotId>& all_robots();

enum class Positioning : std::uint8_t {
  legal,
  illegal,
  only_for_kicker,  // legal for the one robot that takes the kick
  in_avoidance      // legal for the first seconds of a set play, for those that were there
};

Positioning positioning(const Match& match, const WorldTruth& world, const Field& field, RobotId id);
bool in_avoidance_region(const Match& match, const WorldTruth& world, const Field& field, RobotId id);
bool avoidance_is_due(const Match& match) noexcept;  // a free kick in play time

bool outside_field(const RobotTruth& robot, const Field& field) noexcept;  // wholly
bool off_carpet(const RobotTruth& robot, const Field& field) noexcept;
bool on_own_goal_line(const Match& match, const RobotTruth& robot, Side side, const Field& field) noexcept;
bool in_own_penalty_area(const Match& match, const Pose2& pose, double radius_m, Side side,
                         const Field& field) noexcept;
double own_goal_area_depth_m(const Match& match, const RobotTruth& robot, Side side,
                             const Field& field) noexcept;  // >= 0: inside

// Of those that may take a kick-off or penalty kick, the one nearest to the mark.
std::optional<RobotId> nearest_kicker(const Match& match, const WorldTruth& world, const Field& field);
unsigned robots_on_field(const Match& match, const WorldTruth& world, Side side);

// Where the ball lies for a restart; `ball` is where it was when play stopped.
Point ball_placement(const Match& match, Restart restart, std::optional<Side> side, Point ball, const Field& field);
// Where a robot serves its penalty: at the edge of the carpet, level with its own penalty mark or near it, facing the
// field. `taken`: where others were placed in the same step.
Pose2 penalty_placement(const Match& match, const WorldTruth& world, const Field& field, RobotId id,
                        std::span<const Point> taken);
// On its goal line between the posts, for a penalty kick.
Pose2 keeper_placement(const Match& match, const RobotTruth& keeper, Side side, const Field& field) noexcept;

}  // namespace kadans::football
