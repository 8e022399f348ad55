// What is particular at set plays: who may stay, who may touch again, which clocks stand.
#include <doctest/doctest.h>

#include "drawn_match.h"

using namespace kadans::football;

TEST_CASE("who kicks off may touch the ball again, it only bars the direct goal") {
  DrawnMatch drawn;
  REQUIRE(drawn.run_until(GameState::playing));
  drawn.run(1);
  drawn.touch(home, 2);
  drawn.roll({-0.5, 0});
  drawn.run(0.5);
  drawn.touch(home, 2);
  CHECK(drawn.referee.match().restart() == Restart::none);
}

TEST_CASE("a keeper on its line between the posts may stay near a free kick") {
  DrawnMatch drawn;
  REQUIRE(drawn.kick_off());
  drawn.world.ball = {-6, 0.5};
  const Match& match = drawn.referee.match();
  drawn.touch(away, 2);
  drawn.world.ball = {-7.2, 4.4};  // home's corner
  drawn.step();
  drawn.put({away, 1}, {-6.9, 1.2, 0});
  drawn.put({away, 3}, {-6.9, 3.6, 0});
  drawn.world.ball = {-6.975, 2};  // a referee that puts it nearer
  drawn.run(3 + 10.2);
  CHECK(match.plays({away, 1}));
  CHECK(match.penalty({away, 3}) == Penalty::illegal_positioning);
}

TEST_CASE("at an indirect free kick on the line of their penalty area the defenders leave all of it") {
  DrawnMatch drawn;
  REQUIRE(drawn.kick_off());
  const Match& match = drawn.referee.match();
  drawn.touch(home, 5);
  drawn.world.ball = {-7.2, 2};  // away's goal kick
  drawn.step();
  drawn.run(4);
  drawn.touch(away, 2);
  drawn.roll({-5, 1});
  drawn.run(0.5);
  drawn.touch(away, 2);
  REQUIRE(match.restart() == Restart::indirect_free_kick);
  CHECK(match.kicking() == home);
  CHECK(distance(drawn.world.ball, {-4.025, 1}) < 1e-9);
  drawn.put({away, 3}, {-6.5, -2.5, 0});
  drawn.put({away, 4}, {-6.5, -3.4, 0});
  drawn.run(3 + 10.2);
  CHECK(match.penalty({away, 3}) == Penalty::illegal_positioning);
  CHECK(match.plays({away, 4}));
}

TEST_CASE("penalties do not run while play is stopped, and offences that do not count make none longer") {
  DrawnMatch drawn;
  REQUIRE(drawn.kick_off());
  const Match& match = drawn.referee.match();
  for (std::uint8_t number = 2; number <= 4; ++number) {
    drawn.robot(away, number).upright = false;
    drawn.run(20.1);  // incapable
    CHECK(match.penalty_left_s({away, number}) == doctest::Approx(45).epsilon(0.01));
    drawn.world.ball = {-0.1 * number, 0};
    drawn.robot(home, 2).pose = {1, 0, 0};  // so that the game is not stuck
  }
  drawn.touch(home, 2);
  const double before_s = match.penalty_left_s({away, 4});
  drawn.world.ball = {0, 4.7};
  drawn.step();
  REQUIRE(match.stopped());
  drawn.run(2.9);
  CHECK(match.penalty_left_s({away, 4}) == doctest::Approx(before_s - 0.02).epsilon(0.001));
  drawn.run(1.1);
  CHECK(match.penalty_left_s({away, 4}) == doctest::Approx(before_s - 1).epsilon(0.01));
}

TEST_CASE("the teams change sides once, at half of the break") {
  DrawnMatch drawn({.half_s = 15, .break_s = 4});
  REQUIRE(drawn.run_until(GameState::finished));
  drawn.run(1.9);
  CHECK(drawn.referee.match().home_defends_left());
  drawn.run(0.2);
  for (int i = 0; i < 50; ++i) {
    CHECK_FALSE(drawn.referee.match().home_defends_left());
    drawn.step();
  }
}

TEST_CASE("a drill begins in play, with a corner, or with a penalty kick") {
  DrawnMatch play;
  CHECK(play.referee.begin_with(Restart::none, home, {1, 2}).x_m == 1);
  play.world.ball = {1, 2};
  play.run(0.1);
  CHECK(play.referee.match().state() == GameState::playing);
  CHECK(play.referee.match().restart() == Restart::none);
  CHECK_FALSE(play.referee.match().stopped());

  DrawnMatch corner;
  const Point at = corner.referee.begin_with(Restart::corner, home, {-3, 1});
  CHECK(at.x_m == doctest::Approx(-corner.field.goal_line_x_m()));
  CHECK(at.y_m == doctest::Approx(corner.field.touchline_y_m()));
  corner.world.ball = at;
  corner.run(0.1);
  CHECK(corner.referee.match().restart() == Restart::corner);
  CHECK(corner.referee.match().stopped());

  DrawnMatch penalty;
  penalty.world.ball = penalty.referee.begin_with(Restart::penalty_kick, home, {});
  CHECK(penalty.world.ball.x_m == doctest::Approx(-penalty.field.penalty_mark_x_m()));
  penalty.run(0.1);
  CHECK(penalty.referee.match().state() == GameState::ready);
  CHECK(penalty.referee.match().restart() == Restart::penalty_kick);
}
