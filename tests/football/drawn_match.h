// A match drawn by hand: two teams on the middle field, which do what a test says and go where the referee places them.
// Home defends the left goal, which is at +x; so home plays toward -x.
#pragma once

#include <string>
#include <vector>

#include "football/referee.h"

namespace kadans::football {

inline constexpr Side home = Side::home, away = Side::away;

class DrawnMatch {
 public:
  static constexpr std::int64_t step_ns = 20'000'000;

  explicit DrawnMatch(MatchRules rules = {}, unsigned robots = 5)
      : field(league_field(Division::middle, FieldSize::middle)),
        referee({.match = {.rules = rules}, .field = field, .ball = league_ball(Division::middle)}) {
    for (const Side side : both_sides) {
      for (std::uint8_t number = 1; number <= robots; ++number) put({side, number}, lined_up({side, number}));
    }
  }

  // Far from everything: the keeper on its line, the others in their own half.
  Pose2 lined_up(RobotId id) const {
    const double sign = referee.match().sign(id.side), back_rad = sign > 0 ? 0 : std::numbers::pi;
    if (id.number == 1) return {-sign * field.goal_line_x_m(), 0, back_rad};
    return {-sign * 3.2, -4.5 + 1.6 * id.number - 0.8, back_rad};
  }
  void line_up() {
    for (const RobotId id : all_robots()) {
      if (world.robot(id).present && referee.match().plays(id)) put(id, lined_up(id));
    }
  }
  RobotTruth& robot(Side side, std::uint8_t number) { return world.robot({side, number}); }
  void put(RobotId id, const Pose2& pose) {
    world.robot(id).present = true;
    world.robot(id).pose = pose;
    world.robot(id).upright = true;
  }

  const RefereeReport& step() {
    const RefereeReport& report = referee.step(step_ns, world);
    for (const Decision& decision : report.decisions) lines.push_back(decision.line());
    if (report.ball) world.ball = *report.ball;
    for (const RobotPlacement& placed : report.robots) put(placed.robot, placed.pose);
    whistles += report.whistles_short;
    return report;
  }
  void run(double seconds) {
    for (double passed_s = 0; passed_s < seconds; passed_s += 1e-9 * static_cast<double>(step_ns)) step();
  }
  // False: it did not come within 200 s.
  bool run_until(GameState state) {
    for (int i = 0; i < 10'000 && referee.match().state() != state; ++i) step();
    return referee.match().state() == state;
  }
  // Playing, with the ball free.
  bool kick_off() {
    line_up();
    if (!run_until(GameState::playing)) return false;
    run(11);
    return referee.match().restart() == Restart::none;
  }
  void touch(Side side, std::uint8_t number) {
    robot(side, number).touches_ball = true;
    step();
    robot(side, number).touches_ball = false;
  }
  // Rolls there in 0.2 s.
  void roll(const Point& to) {
    const Point from = world.ball;
    for (int i = 1; i <= 10; ++i) {
      world.ball = from + (0.1 * i) * (to - from);
      step();
      if (world.ball == referee_ball()) return;
    }
  }
  void walk(RobotId id, const Pose2& to, double seconds) {
    const Pose2 from = world.robot(id).pose;
    const int steps = static_cast<int>(seconds * 50);
    for (int i = 1; i <= steps; ++i) {
      const Point at = from.at() + (1.0 * i / steps) * (to.at() - from.at());
      world.robot(id).pose = {at.x_m, at.y_m, to.theta_rad};
      step();
    }
  }
  bool said(const std::string& part) const {
    for (const std::string& line : lines) {
      if (line.find(part) != std::string::npos) return true;
    }
    return false;
  }
  std::string all_lines() const {
    std::string all;
    for (const std::string& line : lines) all += line + "\n";
    return all;
  }

  Field field;
  Referee referee;
  WorldTruth world;
  std::vector<std::string> lines;
  int whistles = 0;

 private:
  Point referee_ball() const {
    const Match& match = referee.match();
    return match.stopped() ? world.ball : Point{1e9, 0};
  }
};

}  // namespace kadans::football
