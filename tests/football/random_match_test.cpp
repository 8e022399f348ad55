// Random plays: robots wander, fall, push, hold and kick without sense. Whatever they do, the match keeps to its rules.
#include <algorithm>

#include <doctest/doctest.h>

#include "drawn_match.h"
#include "kadans/signal/random.h"

using namespace kadans::football;
using kadans::RandomStream;

namespace {

// Moves all robots and the ball on by one step, with as little sense as the seed has it.
class Wanderers {
 public:
  Wanderers(DrawnMatch& drawn, std::uint64_t seed) : drawn_(drawn), random_(seed, "football.wanderers") {}

  void step() {
    constexpr double step_s = 0.02;
    WorldTruth& world = drawn_.world;
    ball_m_s_ = std::max(1 - 0.4 * step_s, 0.0) * ball_m_s_;
    world.ball = world.ball + step_s * ball_m_s_;
    world.ball_z_m = std::max(world.ball_z_m - step_s, 0.095);
    world.contacts.clear();
    for (const RobotId id : all_robots()) {
      RobotTruth& robot = world.robot(id);
      if (!robot.present) continue;
      move(id, robot, step_s);
    }
    if (drawn_.referee.match().stopped() || drawn_.referee.match().state() != GameState::playing) ball_m_s_ = {};
  }

 private:
  bool now(double per_s) { return random_.uniform() < per_s * 0.02; }

  void move(RobotId id, RobotTruth& robot, double step_s) {
    const Match& match = drawn_.referee.match();
    robot.touches_ball = robot.uses_arms = false;
    if (robot.upright && now(0.01)) robot.upright = false;
    if (!robot.upright) {
      if (now(0.5)) robot.getting_up = !robot.getting_up;
      if (robot.getting_up && now(0.6)) robot.upright = true, robot.getting_up = false;
      return;
    }
    if (now(robot.active ? 0.005 : 0.1)) robot.active = !robot.active;
    const bool obeys = match.state() == GameState::set || match.stopped() || !match.plays(id);
    bool& deaf = deaf_.at(index_of(id.side)).at(id.index());
    if (now(deaf ? 0.2 : 0.01)) deaf = !deaf;
    if (obeys && !deaf) return;
    if (robot.holds_ball && distance(robot.pose.at(), drawn_.world.ball) < 0.35 && !now(0.1)) return;
    robot.holds_ball = false;
    Point& goal = goals_.at(index_of(id.side)).at(id.index());
    if (now(0.3)) goal = now(25) ? drawn_.world.ball : Point{random_.uniform(-7.6, 7.6), random_.uniform(-5, 5)};
    if (match.state() == GameState::ready && !deaf) goal = drawn_.lined_up(id).at();
    const Point way = goal - robot.pose.at();
    if (norm(way) > 0.1) {
      const Point next = robot.pose.at() + (0.7 * step_s / norm(way)) * way;
      robot.pose = {next.x_m, next.y_m, std::atan2(way.y_m, way.x_m)};
    }
    for (const RobotId met : all_robots()) {
      if (met == id || !drawn_.world.robot(met).present) continue;
      if (distance(robot.pose.at(), drawn_.world.robot(met).pose.at()) < 0.4)
        drawn_.world.contacts.push_back({id, met});
    }
    const double ball_m = distance(robot.pose.at(), drawn_.world.ball);
    if (ball_m > 0.35) return;
    robot.holds_ball = now(0.3);
    robot.touches_ball = now(20);
    robot.uses_arms = now(0.1);
    if (now(4)) {
      const Point goal_way = Point{7 * match.sign(id.side), 0} - drawn_.world.ball;
      const double toward_rad =
          random_.uniform() < 0.7 ? std::atan2(goal_way.y_m, goal_way.x_m) : random_.uniform(-3, 3);
      ball_m_s_ = turned({random_.uniform(0.5, 5), 0}, toward_rad + random_.uniform(-0.3, 0.3));
      drawn_.world.ball_z_m = random_.uniform(0.095, 0.5);
      robot.touches_ball = true;
    }
  }

  DrawnMatch& drawn_;
  RandomStream random_;
  Point ball_m_s_;
  std::array<std::array<Point, players_max>, 2> goals_{};
  std::array<std::array<bool, players_max>, 2> deaf_{};
};

struct Seen {
  std::size_t decisions = 0, goals = 0;
  double seconds = 0;
};

Seen play(std::uint64_t seed, std::vector<std::string>& kinds) {
  const MatchRules rules{.half_s = 200, .break_s = 20};
  DrawnMatch drawn(rules, static_cast<unsigned>(3 + seed % 3));
  Wanderers wanderers(drawn, seed);
  const Match& match = drawn.referee.match();
  Seen seen;
  double remaining_s = match.remaining_s();
  std::array<unsigned, 2> score{};
  bool first_half = true;
  std::array<std::int64_t, 2 * players_max> out_until{};
  for (std::int64_t i = 0; !match.over() && i < 60'000; ++i) {  // 20 min for a match of 7
    wanderers.step();
    const RefereeReport& report = drawn.step();
    const bool half_begins = first_half && !match.first_half();
    CHECK_MESSAGE((match.remaining_s() <= remaining_s || half_begins), "the clock runs backward");
    remaining_s = match.remaining_s();
    first_half = match.first_half();

    unsigned goals = 0;
    for (const Decision& decision : report.decisions) {
      goals += decision.text.starts_with("goal for ") ? 1U : 0U;
      const std::string kind = decision.text.substr(0, decision.text.find_first_of(",:"));
      if (std::ranges::find(kinds, kind) == kinds.end()) kinds.push_back(kind);
      CHECK_FALSE(decision.rule.empty());
    }
    seen.decisions += report.decisions.size();
    seen.goals += goals;
    const unsigned grown = match.score(Side::home) + match.score(Side::away) - score[0] - score[1];
    CHECK_MESSAGE(grown == goals, "a score grew without a goal");
    CHECK(match.score(Side::home) >= score[0]);
    CHECK(match.score(Side::away) >= score[1]);
    score = {match.score(Side::home), match.score(Side::away)};

    const bool has_restart = match.restart() != Restart::none && match.restart() != Restart::dropped_ball;
    CHECK_MESSAGE(match.kicking().has_value() == has_restart, "exactly one team has a set play");
    if (i % 25 == 0) {
      for (const ControlReader reader : {ControlReader::player, ControlReader::monitor}) {
        const auto packet = write_game_control(drawn.referee.control(reader), reader);
        const auto read = read_game_control(packet, reader);
        CHECK_MESSAGE(read.value.has_value(), read.refusal);
      }
    }
    const bool runs =
        match.state() == GameState::ready || match.state() == GameState::set || match.state() == GameState::playing;
    for (const RobotId id : all_robots()) {
      const RobotTruth& robot = drawn.world.robot(id);
      std::int64_t& since = out_until.at(index_of(id.side) * players_max + id.index());
      const bool on_field = robot.present && runs && !match.plays(id) && match.penalty(id) != Penalty::motion_in_set &&
                            !outside_field(robot, drawn.field);
      since = on_field ? since + 1 : 0;
      if (since > 26) FAIL_CHECK("a penalised robot is on the field for more than half a second");
    }
    seen.seconds = 0.02 * static_cast<double>(i);
  }
  CHECK_MESSAGE(match.over(), "the match does not end");
  CHECK(match.state() == GameState::finished);
  const bool mercy = std::max(score[0], score[1]) >= std::min(score[0], score[1]) + 10;
  CHECK((mercy || remaining_s < 0));
  return seen;
}

}  // namespace

TEST_CASE("every match of random plays ends by the rules") {
  std::vector<std::string> kinds;
  Seen all;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const Seen seen = play(seed, kinds);
    all.decisions += seen.decisions;
    all.goals += seen.goals;
  }
  CHECK(all.goals > 10);
  CHECK(all.decisions > 1000);
  for (const char* kind : {"ready",
                           "set",
                           "playing",
                           "ball free",
                           "throw-in for home",
                           "corner for away",
                           "goal kick for home",
                           "goal for away",
                           "illegal positioning",
                           "motion in set",
                           "motion in stop",
                           "incapable robot",
                           "pushing",
                           "ball holding",
                           "local game stuck",
                           "playing with arms",
                           "direct free kick for home at (",
                           "penalty kick for away",
                           "dropped ball",
                           "the first half is over",
                           "the match is over"}) {
    const auto is = [&](const std::string& told) { return told.starts_with(kind); };
    CHECK_MESSAGE(std::ranges::any_of(kinds, is), std::string(kind));
  }
}

TEST_CASE("the same plays give the same decisions") {
  std::array<std::string, 2> told;
  for (std::string& text : told) {
    DrawnMatch drawn({.half_s = 60, .break_s = 10});
    Wanderers wanderers(drawn, 99);
    while (!drawn.referee.match().over()) {
      wanderers.step();
      drawn.step();
    }
    text = drawn.all_lines();
  }
  CHECK(told[0].size() > 1000);
  CHECK(told[0] == told[1]);
}
