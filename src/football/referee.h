// The automatic referee: it is given the truth of the world each step, on simulated time, and runs the match by the
// rules. It says what it decided, where ball and robots are to be placed, and when it whistles. Pure logic: no clock,
// no socket, no physics; the same truth gives the same match.
//
// Sources: HSL-Rules game.tex 3079e99 for the rules of the middle division; GameController's
// game_controller_autoreferee (ad1cc83) for tolerances, placements and the order in which it looks. Beyond the official
// one it judges pushing, holding, arms and incapable robots (fouls.h). Left to a person: extra time, shoot-outs,
// timeouts, substitutes, cautions.
//
// What a caller does in each step: move the world, fill a WorldTruth, call step(), then place what the report names,
// before the next step. control() gives the game controller's packets.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fouls.h"

namespace kadans::football {

struct Decision {
  std::int64_t time_ns = 0;
  bool first_half = true;
  double remaining_s = 0;  // of the half
  std::string text;        // "throw-in for away: the ball left at (1.20, 4.61)"
  std::string_view rule;   // where it stands: "game.tex, Kick-in / Throw-in"

  std::string line() const;  // "12.340 s, half 1, 587.7 s left: throw-in for away: ... [game.tex, Kick-in / Throw-in]"
};

struct RobotPlacement {
  RobotId robot;
  Pose2 pose;  // upright
};

struct RefereeReport {
  std::vector<Decision> decisions;
  std::optional<Point> ball;  // place it here, at rest
  std::vector<RobotPlacement> robots;
  std::vector<RobotId> penalised;  // whose penalties began
  int whistles_short = 0, whistles_long = 0;
};

class Referee {
 public:
  struct Setup {
    Match::Setup match;
    Field field;
    Ball ball;
  };

  explicit Referee(const Setup& setup);

  // A drill begins in the middle of a match, before the first step: in play (Restart::none), or with a free kick or
  // penalty kick of `side`. Returns where the ball is to be placed.
  Point begin_with(Restart restart, Side side, const Point& ball);
  // Valid until the next step.
  const RefereeReport& step(std::int64_t step_ns, const WorldTruth& world);
  const Match& match() const noexcept { return match_; }
  GameControl control(ControlReader reader) noexcept { return match_.control(reader); }
  void team_message(Side side, std::size_t bytes) noexcept { match_.count_message(side, bytes); }

 private:
  // The restart whose restrictions hold until another robot has touched the ball.
  struct Kick {
    Restart restart = Restart::none;
    Side side = Side::home;
    std::optional<RobotId> kicker;
    std::int64_t kicked_ns = 0;
    Point from;
    bool other_touch = false, outside_circle = false, clearly_moved = false;
  };
  struct Watch {                       // of one robot
    Pose2 still;                       // where it was when it moved last
    std::optional<Pose2> stand_still;  // where it has to stay, in set and stop
    std::optional<std::int64_t> ball_between_legs_ns, touched_ns;
    std::int64_t placed_ns = -1'000'000'000;
    bool returning = false, left_avoidance = false, in_goal_area = false;
  };

  Watch& watch(RobotId id) { return watches_.at(index_of(id.side)).at(id.index()); }
  void decide(std::string_view rule, std::string text);
  void heed_clocks(const Match::Passed& passed);
  void follow(const WorldTruth& world);
  void heed_touches(const WorldTruth& world);
  void heed_touch(RobotId id, const WorldTruth& world);
  void heed_second_touch(RobotId id, const WorldTruth& world);
  void judge_fouls(std::int64_t step_ns, const WorldTruth& world);
  void judge_positions(const WorldTruth& world);
  bool is_illegal(RobotId id, const WorldTruth& world);
  void judge_goal_areas(const WorldTruth& world);
  void judge_keeper(const WorldTruth& world);
  void judge_motion(const WorldTruth& world);
  void judge_stuck(const WorldTruth& world);
  void clear_ball(const WorldTruth& world);
  void judge_ball_out(const WorldTruth& world);
  void judge_goal(Side scorer);
  void judge_penalty_kick();
  void judge_time();
  void keep_penalised_out(const WorldTruth& world);
  void enter_set(const WorldTruth& world);
  void begin_ready(Restart restart, std::optional<Side> side);
  void begin_free_kick(Restart restart, Side side, const Point& ball);
  void penalise(RobotId id, Penalty penalty, const WorldTruth& world, std::string_view rule, const std::string& why);
  void place(RobotId id, const Pose2& pose);
  void watch_motion_from(double after_s);
  bool ball_rests(std::int64_t since_ns) const noexcept;
  std::int64_t now_ns() const noexcept { return match_.play_time_ns(); }

  Setup setup_;
  Match match_;
  FoulJudge fouls_;
  RefereeReport report_;
  std::array<std::array<Watch, players_max>, 2> watches_{};
  std::optional<Kick> kick_;
  std::optional<RobotId> kicker_;  // who alone may come near at a kick-off or penalty kick
  std::optional<Side> last_contact_;
  std::optional<std::pair<RobotId, std::int64_t>> last_touch_;
  std::optional<Point> ball_reference_, stuck_at_;
  std::int64_t ball_moved_ns_ = 0, robot_moved_ns_ = 0, stuck_since_ns_ = 0, near_ball_ns_ = 0, restart_ns_ = 0;
  std::optional<std::int64_t> still_from_ns_;  // on the match's time: who moves later is penalised
  bool still_noted_ = false, penalty_kick_runs_ = false;
};

}  // namespace kadans::football
