// Pushing, holding, stuck games, penalty kicks, time.
#include <doctest/doctest.h>

#include "drawn_match.h"

using namespace kadans::football;

namespace {

// `a` walks into `b` at a speed, from behind or front to front.
void walk_into(DrawnMatch& drawn, RobotId a, RobotId b, double speed_m_s, double b_heading_rad) {
  drawn.put(b, {-2, 2, b_heading_rad});
  drawn.put(a, {-2 - 1.4, 2, 0});
  drawn.run(0.1);
  drawn.walk(a, {-2.4, 2, 0}, 1 / speed_m_s);
  drawn.world.contacts = {{a, b}};
  drawn.step();
}

}  // namespace

TEST_CASE("who runs an opponent down pushes, and who stands does not") {
  for (const bool away_walks : {true, false}) {
    DrawnMatch drawn;
    const Match& match = drawn.referee.match();
    REQUIRE(drawn.kick_off());
    walk_into(drawn, {away, 2}, {home, 2}, 0.4, 0);
    (away_walks ? drawn.robot(home, 2) : drawn.robot(away, 2)).upright = false;  // the one who falls
    drawn.run(0.1);
    INFO(drawn.all_lines());
    CHECK((match.penalty({away, 2}) == Penalty::pushing) == away_walks);
    CHECK(match.plays({home, 2}));
  }
}

TEST_CASE("front to front no one pushes, unless one is clearly faster") {
  for (const double speed_m_s : {0.15, 0.5}) {
    DrawnMatch drawn;
    REQUIRE(drawn.kick_off());
    walk_into(drawn, {away, 2}, {home, 2}, speed_m_s, std::numbers::pi);
    drawn.robot(home, 2).upright = false;
    drawn.run(0.1);
    CHECK(drawn.referee.match().plays({away, 2}) == (speed_m_s < 0.2));
  }
}

TEST_CASE("contact for more than 5 s is pushing, of team-mates it is not") {
  for (const Side victim : {home, away}) {
    DrawnMatch drawn;
    const Match& match = drawn.referee.match();
    REQUIRE(drawn.kick_off());
    drawn.world.ball = {-2, 0.8};
    walk_into(drawn, {away, 2}, {victim, 3}, 0.2, 0);
    drawn.run(4.5);
    CHECK(match.plays({away, 2}));
    drawn.run(0.6);
    CHECK(match.plays({away, 2}) == (victim == away));
  }
}

TEST_CASE("pushing near the ball is a direct free kick, in the own penalty area a penalty kick") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.kick_off());
  drawn.world.ball = {-2.5, 1};
  walk_into(drawn, {away, 2}, {home, 2}, 0.4, 0);
  drawn.robot(home, 2).upright = false;
  drawn.step();
  CHECK(match.restart() == Restart::direct_free_kick);
  CHECK(match.kicking() == home);
  CHECK(drawn.world.ball == Point{-2.5, 1});
  CHECK(match.penalty({away, 2}) == Penalty::pushing);

  DrawnMatch area;
  REQUIRE(area.kick_off());
  area.world.ball = {-5, 0.5};
  area.put({home, 2}, {-5, 1.2, 0});
  area.put({away, 2}, {-6, 1.2, 0});
  area.run(0.1);
  area.walk({away, 2}, {-5.4, 1.2, 0}, 1.5);
  area.world.contacts = {{{away, 2}, {home, 2}}};
  area.step();
  area.robot(home, 2).upright = false;
  area.step();
  INFO(area.all_lines());
  CHECK(area.referee.match().restart() == Restart::penalty_kick);
  CHECK(area.referee.match().state() == GameState::ready);
  CHECK(area.referee.match().kicking() == home);
  CHECK(area.referee.control(ControlReader::player).set_play == SetPlay::penalty_kick);
}

TEST_CASE("the ball is held for 5 s, by the keeper in its area for 10, and letting go lets the time run back") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.kick_off());
  drawn.world.ball = drawn.robot(home, 2).pose.at() + Point{-0.25, 0};
  drawn.robot(home, 2).holds_ball = true;
  drawn.run(4);
  drawn.robot(home, 2).holds_ball = false;
  drawn.run(2);
  drawn.robot(home, 2).holds_ball = true;
  drawn.run(2.9);
  CHECK(match.plays({home, 2}));
  drawn.run(0.2);
  CHECK(match.penalty({home, 2}) == Penalty::ball_holding);
  CHECK(match.restart() == Restart::direct_free_kick);
  CHECK(match.kicking() == away);

  DrawnMatch keeper;
  REQUIRE(keeper.kick_off());
  keeper.world.ball = {6.7, 0};
  keeper.robot(home, 1).holds_ball = true;
  for (int i = 0; i < 9; ++i) keeper.run(1), keeper.world.ball.y_m = 0.2 * (i % 2);  // else it were stuck
  keeper.run(0.8);
  CHECK(keeper.referee.match().plays({home, 1}));
  keeper.run(0.4);
  CHECK(keeper.referee.match().penalty({home, 1}) == Penalty::ball_holding);
  CHECK(keeper.referee.match().restart() == Restart::penalty_kick);
}

TEST_CASE("arms play the ball only of a keeper in its area and at a throw-in") {
  DrawnMatch drawn;
  REQUIRE(drawn.kick_off());
  drawn.robot(home, 1).uses_arms = drawn.robot(home, 2).uses_arms = true;
  drawn.robot(home, 3).uses_arms = true;
  drawn.robot(home, 3).upright = false;  // falls on it
  drawn.step();
  CHECK(drawn.referee.match().plays({home, 1}));
  CHECK(drawn.referee.match().penalty({home, 2}) == Penalty::playing_with_arms);
  CHECK(drawn.referee.match().plays({home, 3}));
}

TEST_CASE("a ball that is stuck locally costs the nearest robot, globally it is dropped") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.kick_off());
  drawn.put({home, 2}, {1, 0, 0});
  drawn.put({away, 2}, {1, 0.9, 0});
  drawn.world.ball = {1.4, 0};
  drawn.run(9.8);
  CHECK(match.plays({home, 2}));
  drawn.run(0.4);
  CHECK(match.penalty({home, 2}) == Penalty::local_game_stuck);
  CHECK(match.state() == GameState::playing);

  drawn.put({away, 2}, {-6, 3, 0});
  drawn.world.ball = {1.4, 4};
  drawn.run(29.9);
  CHECK(match.state() == GameState::playing);
  drawn.run(0.3);
  CHECK(match.state() == GameState::ready);
  CHECK(match.restart() == Restart::dropped_ball);
  CHECK(drawn.referee.control(ControlReader::player).kicking_team == no_team);
  drawn.line_up();
  REQUIRE(drawn.run_until(GameState::set));
  drawn.put({home, 3}, {1, 0, 0});  // nobody has the circle
  drawn.run(0.1);
  CHECK(match.penalty({home, 3}) == Penalty::illegal_positioning);
  REQUIRE(drawn.run_until(GameState::playing));
  CHECK(match.restart() == Restart::none);
  drawn.touch(home, 4);
  drawn.world.ball = {-7.2, 0};
  drawn.step();
  CHECK(match.score(home) == 1);  // straight
}

TEST_CASE("a ball between the legs is moved in front of the robot after a second") {
  DrawnMatch drawn;
  REQUIRE(drawn.kick_off());
  drawn.put({home, 2}, {1, 0, 0});
  drawn.world.ball = {1.05, 0};
  drawn.robot(home, 2).touches_ball = true;
  drawn.run(0.9);
  CHECK(drawn.world.ball == Point{1.05, 0});
  drawn.run(0.2);
  CHECK(drawn.world.ball.x_m == doctest::Approx(1 + 0.2 + 0.095 + 0.1));
}

namespace {

// Home has a penalty kick against the goal at -x, in playing.
DrawnMatch penalty_kick(MatchRules rules = {}) {
  DrawnMatch drawn(rules);
  REQUIRE(drawn.kick_off());
  drawn.put({away, 2}, {-5, 1, 0});
  drawn.world.ball = {-4.6, 1};
  drawn.robot(away, 2).holds_ball = true;
  drawn.run(5.2);
  REQUIRE(drawn.referee.match().restart() == Restart::penalty_kick);
  drawn.robot(away, 2).holds_ball = false;
  drawn.line_up();
  drawn.put({home, 2}, {-4.2, 0, std::numbers::pi});
  drawn.robot(away, 1).pose.x_m += 0.5;  // is put on its line
  REQUIRE(drawn.run_until(GameState::set));
  CHECK(drawn.robot(away, 1).pose.x_m == doctest::Approx(-6.975));
  CHECK(distance(drawn.world.ball, {-5, 0}) < 1e-9);
  REQUIRE(drawn.run_until(GameState::playing));
  CHECK(drawn.referee.match().plays({home, 2}));
  drawn.run(1);
  return drawn;
}

}  // namespace

TEST_CASE("a penalty kick may be a goal, and ends when the ball rests, at a second touch or after 60 s") {
  DrawnMatch scored = penalty_kick();
  scored.touch(home, 2);
  scored.world.ball = {-7.2, 1};
  scored.step();
  CHECK(scored.referee.match().score(home) == 1);

  DrawnMatch rests = penalty_kick();
  rests.touch(home, 2);
  rests.roll({-6, 0.5});
  rests.run(1.2);
  CHECK(rests.said("the penalty kick is over: the ball rests"));

  DrawnMatch again = penalty_kick();
  again.touch(home, 2);
  again.roll({-5.5, 0.5});
  again.run(0.3);
  again.touch(home, 2);
  CHECK(again.referee.match().restart() == Restart::indirect_free_kick);
  CHECK(again.referee.match().kicking() == away);

  DrawnMatch late = penalty_kick();
  late.run(59.5);
  CHECK(late.said("the time of the penalty kick is over"));
}

TEST_CASE("a keeper that leaves its line or its feet before the kick has conceded, after it not") {
  for (const bool kicked : {false, true}) {
    for (const bool falls : {false, true}) {
      DrawnMatch drawn = penalty_kick();
      if (kicked) drawn.touch(home, 2);
      if (falls)
        drawn.robot(away, 1).upright = false;
      else
        drawn.robot(away, 1).pose.x_m += 0.3;
      drawn.step();
      CHECK(drawn.referee.match().score(home) == (kicked ? 0 : 1));
    }
  }
}

TEST_CASE("others than kicker and keeper stay away from a penalty kick") {
  DrawnMatch drawn = penalty_kick();
  drawn.put({away, 3}, {-4.5, 2.5, 0});
  drawn.put({home, 3}, {-3.8, 0.5, 0});
  drawn.put({home, 4}, {-6, 3.6, 0});  // beside the area, but beyond the mark
  drawn.run(0.1);
  CHECK(drawn.referee.match().penalty({home, 4}) == Penalty::illegal_positioning);
  CHECK(drawn.referee.match().penalty({away, 3}) == Penalty::illegal_positioning);
  CHECK(drawn.referee.match().penalty({home, 3}) == Penalty::illegal_positioning);
}

TEST_CASE("a half goes on while the ball rolls, 10 s at most, and until a penalty kick is over") {
  MatchRules rules{.half_s = 30, .break_s = 10};
  DrawnMatch drawn(rules);
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.kick_off());
  double angle_rad = 0;
  while (match.remaining_s() > -9 && match.state() == GameState::playing) {
    drawn.world.ball = turned({2, 0}, angle_rad += 0.02);
    drawn.step();
  }
  CHECK(match.state() == GameState::playing);
  drawn.run(1);
  CHECK(match.state() == GameState::finished);
  CHECK(drawn.whistles >= 3);
  CHECK(match.first_half());
  CHECK(match.home_defends_left());
  drawn.run(5.2);
  CHECK_FALSE(match.home_defends_left());
  CHECK(drawn.referee.control(ControlReader::player).teams[0].number == 2);
  REQUIRE(drawn.run_until(GameState::ready));
  CHECK(match.kicking() == away);
  CHECK_FALSE(match.first_half());
  drawn.line_up();
  REQUIRE(drawn.run_until(GameState::playing));
  REQUIRE(drawn.run_until(GameState::finished));
  CHECK(match.over());
  CHECK(drawn.said("the match is over"));

  DrawnMatch penalty = penalty_kick({.half_s = 17, .break_s = 10});
  CHECK(penalty.referee.match().remaining_s() < 0);
  CHECK(penalty.referee.match().state() == GameState::playing);
  penalty.touch(home, 2);
  penalty.world.ball = {-7.2, 1};
  penalty.step();
  CHECK(penalty.referee.match().score(home) == 1);
  penalty.run(1.5);
  CHECK(penalty.referee.match().state() == GameState::finished);
}

TEST_CASE("players learn of playing 10 s after the whistle, or when something happens that set does not know") {
  DrawnMatch drawn;
  REQUIRE(drawn.run_until(GameState::playing));
  const auto told = [&](ControlReader reader) { return drawn.referee.control(reader); };
  CHECK(told(ControlReader::monitor).state == GameState::playing);
  CHECK(told(ControlReader::player).state == GameState::set);
  drawn.run(5);
  CHECK(told(ControlReader::player).remaining_s == 600);
  CHECK(told(ControlReader::monitor).remaining_s == 595);
  drawn.run(5.1);
  CHECK(told(ControlReader::player).state == GameState::playing);

  DrawnMatch out;
  REQUIRE(out.run_until(GameState::playing));
  out.run(1);
  out.touch(home, 2);
  CHECK(out.referee.control(ControlReader::player).state == GameState::set);  // ball free does not tell
  out.world.ball = {0, 4.7};
  out.step();
  CHECK(out.referee.control(ControlReader::player).state == GameState::playing);
  CHECK(out.referee.control(ControlReader::player).set_play == SetPlay::throw_in);
}

TEST_CASE("ten goals ahead end the match, and a team over its messages loses its goals") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  for (int goal = 0; goal < 10; ++goal) {
    REQUIRE(drawn.kick_off());
    drawn.touch(home, 2);
    drawn.world.ball = {-7.2, 0};
    drawn.step();
  }
  CHECK(match.over());
  CHECK(match.score(home) == 10);
  drawn.run(100);
  CHECK(match.over());

  MatchRules rules{.messages = 3};
  DrawnMatch talking(rules);
  for (int i = 0; i < 5; ++i) talking.referee.team_message(home, 100);  // initial: they do not count
  REQUIRE(talking.kick_off());
  talking.touch(home, 2);
  talking.world.ball = {-7.2, 0};
  talking.step();
  CHECK(talking.referee.match().score(home) == 1);
  for (int i = 0; i < 3; ++i) talking.referee.team_message(home, 512);
  CHECK(talking.referee.match().score(home) == 1);
  CHECK(talking.referee.control(ControlReader::player).teams[0].message_budget == 0);
  talking.referee.team_message(home, 10);
  CHECK(talking.referee.match().score(home) == 0);
  talking.referee.team_message(away, 513);
  REQUIRE(talking.kick_off());
  talking.touch(home, 2);
  talking.world.ball = {-7.2, 0};
  talking.step();
  CHECK(talking.referee.match().score(home) == 0);  // and no later one counts
}
