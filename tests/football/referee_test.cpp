// Each rule by a small drawn situation.
#include "football/referee.h"

#include <doctest/doctest.h>

#include "drawn_match.h"

using namespace kadans::football;

TEST_CASE("a half begins with initial, 45 s of ready, set and the whistle") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  CHECK(match.state() == GameState::initial);
  REQUIRE(drawn.run_until(GameState::ready));
  CHECK(match.kicking() == home);
  double ready_s = 0;
  for (int i = 0; match.state() == GameState::ready; ++i) {
    drawn.robot(home, 3).pose.theta_rad = 0.1 * i;  // somebody moves to the end
    drawn.step();
    ready_s += 0.02;
  }
  CHECK(ready_s == doctest::Approx(45).epsilon(0.001));
  CHECK(match.state() == GameState::set);
  CHECK(drawn.world.ball == Point{});
  CHECK(match.remaining_s() == 600);  // the clock waits for the first kick-off
  REQUIRE(drawn.run_until(GameState::playing));
  CHECK(drawn.whistles == 1);
  drawn.run(9.9);
  CHECK(match.restart() == Restart::kick_off);
  drawn.run(0.2);
  CHECK(match.restart() == Restart::none);
  CHECK_FALSE(match.kicking().has_value());
  CHECK(match.remaining_s() == doctest::Approx(590).epsilon(0.001));
  CHECK(drawn.said("[game.tex, Playing]"));
}

TEST_CASE("ready ends early when nobody moves") {
  DrawnMatch drawn;
  REQUIRE(drawn.run_until(GameState::ready));
  drawn.run(10.1);
  CHECK(drawn.referee.match().state() == GameState::set);
}

TEST_CASE("at kick-off only its kicker is in the circle, and all stay in their half") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.run_until(GameState::ready));
  drawn.robot(home, 2).pose = {0.15, 0.5, 3};  // kicks
  drawn.robot(home, 3).pose = {0, 1.2, 3};     // one too many in the circle, on the halfway line
  drawn.robot(home, 4).pose = {-2, 3, 3};      // in the other half
  drawn.robot(away, 2).pose = {-1.5, 0, 0};    // in the circle
  drawn.robot(away, 3).pose = {0.4, -3, 0};    // in the other half
  drawn.robot(away, 4).pose = {-2, -3, 0};     // as it should be
  drawn.robot(away, 5).pose = {-2, -4.8, 0};   // beside the field
  REQUIRE(drawn.run_until(GameState::set));
  drawn.run(0.1);
  INFO(drawn.all_lines());
  CHECK(match.plays({home, 2}));
  CHECK(match.penalty({home, 3}) == Penalty::illegal_positioning);
  CHECK(match.penalty({home, 4}) == Penalty::illegal_positioning);
  CHECK(match.penalty({away, 2}) == Penalty::illegal_positioning);
  CHECK(match.penalty({away, 3}) == Penalty::illegal_positioning);
  CHECK(match.plays({away, 4}));
  CHECK(match.penalty({away, 5}) == Penalty::illegal_positioning);
  CHECK(match.penalty_left_s({away, 2}) == 45);  // not counted: no second one is longer
  CHECK(match.plays({home, 1}));
}

TEST_CASE("a kick-off cannot be a goal straight, but after another robot's touch it is one") {
  for (const bool passed : {false, true}) {
    DrawnMatch drawn;
    const Match& match = drawn.referee.match();
    REQUIRE(drawn.run_until(GameState::playing));
    drawn.run(1);
    drawn.touch(home, 2);
    CHECK(match.restart() == Restart::none);  // taken
    drawn.roll({-1, 0});
    if (passed) drawn.touch(home, 3);
    drawn.world.ball = {-7.2, 0.3};
    drawn.step();
    INFO(drawn.all_lines());
    CHECK(match.score(home) == (passed ? 1 : 0));
    CHECK(match.restart() == (passed ? Restart::kick_off : Restart::goal_kick));
    CHECK(match.kicking() == away);
    CHECK(match.state() == (passed ? GameState::ready : GameState::playing));
  }
}

TEST_CASE("a team of two may score straight when its kicker touched the ball again outside the circle") {
  DrawnMatch drawn({}, 2);
  REQUIRE(drawn.run_until(GameState::playing));
  drawn.run(1);
  drawn.touch(home, 2);
  drawn.roll({-1.8, 0});
  drawn.run(0.5);
  drawn.touch(home, 2);
  drawn.world.ball = {-7.2, 0};
  drawn.step();
  CHECK(drawn.referee.match().score(home) == 1);
}

TEST_CASE("the whole ball has to be over the line, between the posts and under the bar") {
  struct Case {
    Point ball;
    double z_m;
    Restart restart;
    unsigned score;
  };
  for (const Case& drawn_case :
       {Case{{-7.09, 0}, 0.1, Restart::none, 0}, Case{{-7.1, 0}, 0.1, Restart::kick_off, 1},
        Case{{-7.1, 1.25}, 0.1, Restart::goal_kick, 0}, Case{{-7.1, 0}, 1.75, Restart::goal_kick, 0},
        Case{{-3, 4.59}, 0.1, Restart::none, 0}, Case{{-3, 4.6}, 0.1, Restart::throw_in, 0}}) {
    DrawnMatch drawn;
    REQUIRE(drawn.kick_off());
    drawn.touch(home, 2);
    drawn.world.ball = drawn_case.ball;
    drawn.world.ball_z_m = drawn_case.z_m;
    drawn.step();
    INFO(drawn.all_lines());
    CHECK(drawn.referee.match().restart() == drawn_case.restart);
    CHECK(drawn.referee.match().score(home) == drawn_case.score);
  }
}

TEST_CASE("the ball that is out is placed as the rules say, for the team that did not touch it last") {
  struct Case {
    std::optional<Side> toucher;
    Point out, placed;
    Restart restart;
    Side side;
  };
  // Away defends -x.
  for (const Case& drawn_case : {Case{home, {-3, -4.7}, {-3, -4.475}, Restart::throw_in, away},
                                 Case{away, {8, 4.7}, {6.025, 1.975}, Restart::goal_kick, home},  // over both lines
                                 Case{away, {-7.2, 2}, {-6.975, 4.475}, Restart::corner, home},
                                 Case{home, {-7.2, 2}, {-6.025, 1.975}, Restart::goal_kick, away},
                                 Case{away, {7.2, -2}, {6.025, -1.975}, Restart::goal_kick, home},
                                 Case{std::nullopt, {-3, 4.7}, {-3, 4.475}, Restart::throw_in, away},
                                 Case{std::nullopt, {7.2, -2}, {6.025, -1.975}, Restart::goal_kick, home}}) {
    DrawnMatch drawn;
    const Match& match = drawn.referee.match();
    REQUIRE(drawn.kick_off());
    if (drawn_case.toucher) drawn.touch(*drawn_case.toucher, 2);
    drawn.world.ball = drawn_case.out;
    drawn.step();
    INFO(drawn.all_lines());
    CHECK(match.restart() == drawn_case.restart);
    CHECK(match.kicking() == drawn_case.side);
    CHECK(distance(drawn.world.ball, drawn_case.placed) < 1e-9);
    CHECK(match.stopped());
    const GameControl told = drawn.referee.control(ControlReader::player);
    CHECK(told.stopped);
    CHECK(told.secondary_s == 45);
    CHECK(told.kicking_team == match.team(drawn_case.side).number);
    drawn.run(3.1);
    CHECK_FALSE(match.stopped());
    drawn.run(44);
    CHECK(match.restart() == drawn_case.restart);
    drawn.run(1);
    CHECK(match.restart() == Restart::none);
    CHECK(drawn.said("ball free: the time of the"));
  }
}

TEST_CASE("a throw-in cannot be a goal straight, a corner can, and an own goal from a restart is a corner") {
  const auto kicked_into = [](Point out, Side toucher, double goal_x_m) {
    DrawnMatch drawn;
    REQUIRE(drawn.kick_off());
    drawn.touch(toucher, 2);
    drawn.world.ball = out;
    drawn.step();
    drawn.run(4);
    drawn.touch(other(toucher), 3);
    drawn.world.ball = {goal_x_m, 0};
    drawn.step();
    const Match& match = drawn.referee.match();
    return std::pair(match.restart(), match.score(home) + match.score(away));
  };
  CHECK(kicked_into({-3, 4.7}, away, -7.2) == std::pair(Restart::goal_kick, 0U));  // home throws in
  CHECK(kicked_into({-7.2, 2}, away, -7.2) == std::pair(Restart::kick_off, 1U));   // home's corner
  CHECK(kicked_into({-3, 4.7}, away, 7.2) == std::pair(Restart::corner, 0U));      // into home's own goal
}

TEST_CASE("defenders have 10 s to leave the ball at a free kick, and come near again at once never") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.kick_off());
  drawn.touch(away, 2);
  drawn.robot(away, 2).pose = {-3, 3.5, 0};
  drawn.robot(away, 3).pose = {-3, 2.7, 0};  // outside: 1.5 + 0.2 are kept
  drawn.world.ball = {-3, 4.7};
  drawn.step();
  drawn.run(3 + 9.9);
  CHECK(match.plays({away, 2}));
  drawn.run(0.3);
  CHECK(match.penalty({away, 2}) == Penalty::illegal_positioning);
  CHECK(match.plays({away, 3}));
  drawn.robot(away, 3).pose = {-3, 3.5, 0};
  drawn.run(0.1);
  CHECK(match.penalty({away, 3}) == Penalty::illegal_positioning);
  CHECK(match.plays({home, 2}));
}

TEST_CASE("who takes a free kick and touches the ball again gives an indirect free kick") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.kick_off());
  drawn.touch(away, 2);
  drawn.world.ball = {-5, 4.7};
  drawn.step();
  drawn.run(4);
  drawn.touch(home, 3);
  drawn.roll({-5, 2.5});
  drawn.run(0.5);
  drawn.touch(home, 3);
  INFO(drawn.all_lines());
  CHECK(match.restart() == Restart::indirect_free_kick);
  CHECK(match.kicking() == away);
  CHECK(drawn.world.ball == Point{-5, 2.5});
}

TEST_CASE("an indirect free kick in the other team's penalty area is taken from its line") {
  DrawnMatch drawn;
  REQUIRE(drawn.kick_off());
  const Match& match = drawn.referee.match();
  const Point placed = ball_placement(match, Restart::indirect_free_kick, home, {-6, 1}, drawn.field);
  CHECK(distance(placed, {-4.025, 1}) < 1e-9);
  CHECK(ball_placement(match, Restart::indirect_free_kick, away, {-6, 1}, drawn.field) == Point{-6, 1});
}

TEST_CASE("motion in set costs 15 s in place, in a stop the place") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.run_until(GameState::set));
  drawn.robot(home, 3).pose.x_m += 0.3;  // within the first second
  drawn.run(1.1);
  CHECK(match.plays({home, 3}));
  drawn.robot(home, 3).pose.x_m += 0.09;
  drawn.robot(away, 3).pose.theta_rad += 0.29;
  drawn.robot(home, 4).getting_up = true;  // is allowed
  drawn.robot(home, 4).upright = false;
  drawn.run(0.1);
  drawn.robot(home, 4).pose.x_m += 0.2;
  drawn.run(0.1);
  CHECK(match.plays({home, 3}));
  CHECK(match.plays({away, 3}));
  CHECK(match.plays({home, 4}));
  const Pose2 before = drawn.robot(away, 3).pose;
  drawn.robot(home, 3).pose.x_m += 0.02;
  drawn.robot(away, 3).pose.theta_rad += 0.02;
  drawn.run(0.1);
  CHECK(match.penalty({home, 3}) == Penalty::motion_in_set);
  CHECK(match.penalty({away, 3}) == Penalty::motion_in_set);
  CHECK(distance(drawn.robot(away, 3).pose.at(), before.at()) == 0);
  CHECK(match.penalty_left_s({away, 3}) == doctest::Approx(15));
  REQUIRE(drawn.run_until(GameState::playing));
  drawn.run(15.1);
  CHECK(match.plays({away, 3}));

  drawn.touch(home, 2);
  drawn.world.ball = {0, 4.7};
  drawn.step();
  drawn.run(1.2);
  drawn.robot(away, 2).pose.x_m -= 0.2;
  drawn.run(0.1);
  INFO(drawn.all_lines());
  CHECK(match.penalty({away, 2}) == Penalty::motion_in_stop);
  CHECK(std::abs(drawn.robot(away, 2).pose.y_m) == doctest::Approx(5.3));
}

TEST_CASE("a penalised robot stands at the carpet's edge for 45 s, 10 s more for each earlier offence that counts") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.kick_off());
  drawn.robot(away, 2).pose = {-3, 6, 0};
  drawn.step();
  CHECK(match.penalty({away, 2}) == Penalty::leaving_the_field);
  CHECK(match.penalty_left_s({away, 2}) == 45);
  CHECK(distance(drawn.robot(away, 2).pose.at(), {-5, 5.3}) < 1e-9);  // level with its own penalty mark
  CHECK(drawn.robot(away, 2).pose.theta_rad < 0);                     // faces the field
  drawn.robot(away, 3).pose = {-3, 6, 0};
  drawn.step();
  CHECK(match.penalty_left_s({away, 3}) == 55);
  CHECK(distance(drawn.robot(away, 3).pose.at(), {-5.75, 5.3}) < 1e-9);  // the mark's level is taken
  drawn.run(20);
  drawn.robot(away, 2).pose = {-3, 0, 0};
  drawn.step();
  CHECK(drawn.said("away 2 came onto the field before its penalty was over"));
  CHECK(outside_field(drawn.robot(away, 2), drawn.field));
  CHECK(match.penalty_left_s({away, 2}) == 45);
  drawn.run(44);
  CHECK_FALSE(match.plays({away, 2}));
  drawn.run(7);  // 5 s of them in set, before a dropped ball: they do not count
  CHECK(match.plays({away, 2}));
  CHECK(drawn.said("away 2 may play again"));
}

TEST_CASE("a robot that lies is incapable after 20 s without, or three failed, attempts to get up") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.kick_off());
  for (std::uint8_t number = 2; number <= 4; ++number) drawn.robot(home, number).upright = false;
  drawn.robot(away, 3).active = false;
  for (int attempt = 0; attempt < 3; ++attempt) {
    drawn.run(1);
    drawn.robot(home, 3).getting_up = drawn.robot(home, 4).getting_up = true;
    drawn.world.contacts = {{{home, 4}, {away, 4}}};  // disturbs: four attempts
    drawn.run(2);
    drawn.world.contacts.clear();
    drawn.robot(home, 3).getting_up = drawn.robot(home, 4).getting_up = false;
    CHECK(match.plays({home, 3}));
    drawn.step();
  }
  INFO(drawn.all_lines());
  CHECK(match.penalty({home, 3}) == Penalty::incapable_robot);
  CHECK(match.plays({home, 4}));
  CHECK(match.plays({away, 3}));
  drawn.run(1.2);  // 10.3 s by now
  CHECK(match.penalty({away, 3}) == Penalty::incapable_robot);
  CHECK(match.plays({home, 2}));
  drawn.run(9.9);
  CHECK(match.penalty({home, 2}) == Penalty::incapable_robot);
  CHECK(drawn.robot(home, 2).upright);  // placed
}

TEST_CASE("at most three robots are in their own goal area") {
  DrawnMatch drawn;
  const Match& match = drawn.referee.match();
  REQUIRE(drawn.kick_off());
  drawn.robot(home, 2).pose = {6.5, 1, 0};
  drawn.robot(home, 3).pose = {6.5, -1, 0};
  drawn.run(0.1);
  drawn.robot(home, 4).pose = {6.9, 0.5, 0};
  drawn.run(0.1);
  CHECK(match.penalty({home, 4}) == Penalty::illegal_positioning);
  CHECK(match.plays({home, 2}));
}

TEST_CASE("in set the outermost of four in their own goal area goes") {
  DrawnMatch drawn;
  REQUIRE(drawn.run_until(GameState::ready));
  drawn.put({home, 2}, {6.5, 1, 0});
  drawn.put({home, 3}, {6.15, 0, 0});
  drawn.put({home, 4}, {6.5, -1, 0});
  REQUIRE(drawn.run_until(GameState::set));
  drawn.run(0.1);
  CHECK(drawn.referee.match().penalty({home, 3}) == Penalty::illegal_positioning);
  CHECK(drawn.referee.match().plays({home, 2}));
  CHECK(drawn.referee.match().plays({home, 4}));
}

TEST_CASE("opponents of a goal kick leave the whole penalty area") {
  DrawnMatch drawn;
  REQUIRE(drawn.kick_off());
  drawn.touch(home, 5);
  drawn.put({home, 2}, {-4.1, -2.9, 0});
  drawn.put({home, 3}, {-3.7, -2.9, 0});
  drawn.world.ball = {-7.2, 2};
  drawn.step();
  REQUIRE(drawn.referee.match().restart() == Restart::goal_kick);
  drawn.run(3 + 9.9);
  CHECK(drawn.referee.match().plays({home, 2}));
  drawn.run(0.3);
  CHECK(drawn.referee.match().penalty({home, 2}) == Penalty::illegal_positioning);
  CHECK(drawn.referee.match().plays({home, 3}));
}
