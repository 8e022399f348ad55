// What team messages buy: over a network that loses and delays, and when nothing arrives.
#include "football/message_policy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"

using namespace kadans::football;
using kadans::RandomStream;

namespace {

// A game of five robots that know truly where they and the ball are, and believe of their mates what they hear. Play is
// quiet for half a minute, then lively for ten seconds.
struct Played {
  double sent = 0, ball_error_m = 0, mate_error_m = 0;
};

struct Network {
  double loss = 0, delay_s = 0;
  bool silent = false;
};

template <typename Decide>
Played play_game(std::uint64_t seed, Network network, Decide&& decide, double seconds = 1200) {
  struct Heard {
    MessagePolicy::Known message;
    double sent_s = -1e9;
  };
  struct Robot {
    Point at, goal;
    std::array<Heard, 5> mates;
  };
  struct UnderWay {
    double due_s;
    std::size_t from;
    Heard heard;
  };
  RandomStream random(seed, "football.message_game");
  std::array<Robot, 5> robots;
  std::deque<UnderWay> air;
  BallBelief ball{.sd_m = 0.05};
  Played played;
  double budget = 12000, told = 12000, told_s = 0;
  std::size_t samples = 0;
  constexpr double step_s = 0.05;
  for (int tick = 0; tick * step_s < seconds * 1.3; ++tick) {  // 30 % of the time the clock stands still
    const double now_s = tick * step_s;
    const bool lively = std::fmod(now_s, 40) > 30;
    if (random.uniform() < step_s * (lively ? 1.0 : 0.02))
      ball.velocity_m_s = turned({random.uniform(0.5, 3), 0}, random.uniform(-3.1, 3.1));
    ball = rolled_on(ball, step_s);
    ball.age_s = 0;
    if (std::abs(ball.at.x_m) > 7 || std::abs(ball.at.y_m) > 4.5) ball.at = {}, ball.velocity_m_s = {};
    if (tick % 10 == 0) told = budget, told_s = now_s;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      Robot& robot = robots.at(i);
      if (random.uniform() < step_s * (lively ? 0.4 : 0.03))
        robot.goal = {random.uniform(-6, 6), random.uniform(-4, 4)};
      const Point way = robot.goal - robot.at;
      if (norm(way) > 0.05) robot.at = robot.at + (0.4 * step_s / norm(way)) * way;
      const MessagePolicy::Known message{.pose = Pose2{robot.at.x_m, robot.at.y_m, 0}, .ball = ball};
      const double remaining_s = std::max(seconds - now_s / 1.3, 0.0);
      const bool send = decide(i, message,
                               MessagePolicy::Situation{.now_s = now_s,
                                                        .state = GameState::playing,
                                                        .remaining_s = remaining_s,
                                                        .budget_left = static_cast<std::uint16_t>(std::max(told, 0.0)),
                                                        .budget_age_s = now_s - told_s});
      if (!send) continue;
      ++played.sent;
      --budget;
      if (network.silent || random.uniform() < network.loss) continue;
      air.push_back({now_s + random.uniform(0, 2 * network.delay_s), i, {message, now_s}});
    }
    std::erase_if(air, [&](const UnderWay& sent) {
      if (sent.due_s > now_s) return false;
      for (Robot& robot : robots) {
        Heard& known = robot.mates.at(sent.from);
        if (sent.heard.sent_s > known.sent_s) known = sent.heard;
      }
      return true;
    });
    if (!lively || tick % 5 != 0) continue;  // what is known counts when something happens
    ++samples;
    // The first robot hears of the others.
    double ball_m = 3, age_s = 3;
    for (std::size_t i = 1; i < robots.size(); ++i) {
      const Heard& mate = robots[0].mates.at(i);
      const double silent_s = now_s - mate.sent_s;
      const double mate_m = silent_s < 6 ? distance(mate.message.pose->at(), robots.at(i).at) : 3;
      played.mate_error_m += std::min(mate_m, 3.0) / 4;
      if (!(silent_s < age_s)) continue;
      age_s = silent_s;
      ball_m = std::min(distance(rolled_on(*mate.message.ball, silent_s).at, ball.at), 3.0);
    }
    played.ball_error_m += ball_m;
  }
  played.ball_error_m /= static_cast<double>(samples);
  played.mate_error_m /= static_cast<double>(samples);
  return played;
}

Played play_by_policy(std::uint64_t seed, Network network, double game_messages = 12000) {
  std::vector<MessagePolicy> policies(5, MessagePolicy({.game_messages = game_messages}));
  return play_game(seed, network,
                   [&](std::size_t robot, const MessagePolicy::Known& message, MessagePolicy::Situation situation) {
                     if (game_messages < 12000) {  // the rest of the budget is not this team's
                       const double left = situation.budget_left.value_or(0) - (12000 - game_messages);
                       situation.budget_left = static_cast<std::uint16_t>(std::max(left, 0.0));
                     }
                     return policies.at(robot).send(message, situation);
                   });
}

Played play_evenly(std::uint64_t seed, Network network, double messages) {
  const double period_s = 1.3 * 1200 * 5 / messages;
  std::array<double, 5> due_s{};
  return play_game(seed, network,
                   [&](std::size_t robot, const MessagePolicy::Known&, const MessagePolicy::Situation& situation) {
                     if (situation.now_s < due_s.at(robot)) return false;
                     due_s.at(robot) = situation.now_s + period_s;
                     return true;
                   });
}

}  // namespace

TEST_CASE("no game goes over the budget of messages, with loss, delay and silence") {
  for (const Network& network :
       {Network{}, Network{.loss = 0.3, .delay_s = 0.1}, Network{.loss = 0, .delay_s = 1}, Network{.silent = true}}) {
    const Played played = play_by_policy(11, network);
    CAPTURE(played.sent);
    CHECK(played.sent <= 12000);
    CHECK(played.sent > 2000);
    const Played scarce = play_by_policy(12, network, 1200);
    CAPTURE(scarce.sent);
    CHECK(scarce.sent <= 1200);
    CHECK(scarce.sent > 600);
  }
}

TEST_CASE("a robot that never hears the game controller spends no more than its own share") {
  MessagePolicy policy({});
  RandomStream random(5, "football.lonely");
  std::uint64_t sent = 0;
  for (int tick = 0; tick < 100'000; ++tick) {
    const MessagePolicy::Known message{.pose = Pose2{random.uniform(-7, 7), random.uniform(-4, 4), 0}};
    if (policy.send(message, {.now_s = tick * 0.05, .state = GameState::playing, .remaining_s = 0})) ++sent;
  }
  CHECK(sent == 12000 / 5);
  CHECK(policy.counted_sent() == sent);
}

TEST_CASE("messages that are spent where they help tell more than the same number sent evenly") {
  for (const double messages : {1500.0, 6000.0}) {
    for (const Network& network : {Network{.delay_s = 0.05}, Network{.loss = 0.3, .delay_s = 0.1}}) {
      const Played helpful = play_by_policy(21, network, messages);
      const Played even = play_evenly(21, network, helpful.sent);
      CAPTURE(messages);
      CAPTURE(helpful.sent);
      CAPTURE(even.sent);
      CAPTURE(helpful.mate_error_m);
      CAPTURE(even.mate_error_m);
      CHECK(even.sent >= 0.97 * helpful.sent);
      CAPTURE(even.ball_error_m);
      CHECK(helpful.ball_error_m < 0.9 * even.ball_error_m);
    }
  }
}

TEST_CASE("a message that is sent without asking counts, and makes the next ones dearer") {
  MessagePolicy asked({}), unasked({});
  const auto at = [](double now_s) {
    return MessagePolicy::Situation{.now_s = now_s, .state = GameState::playing, .remaining_s = 1200};
  };
  const MessagePolicy::Known message;
  CHECK(asked.send(message, at(0)));
  unasked.sent(message, at(0));
  CHECK(unasked.counted_sent() == 1);
  CHECK(unasked.price() == doctest::Approx(asked.price()));
  CHECK(unasked.worth(message, at(0.1)) == doctest::Approx(asked.worth(message, at(0.1))));
  const double before = unasked.price(), left = unasked.allowed(at(0.1));
  for (int i = 0; i < 40; ++i) unasked.sent(message, at(0.2));
  CHECK(unasked.price() > before);
  CHECK(unasked.allowed(at(0.2)) == left - 40);
  unasked.sent(message, {.now_s = 1, .state = GameState::finished});
  CHECK(unasked.counted_sent() == 41);
}

TEST_CASE("messages are free before and after the game, and none is sent in a shoot-out") {
  MessagePolicy policy({});
  std::uint64_t sent = 0;
  for (int tick = 0; tick < 200; ++tick)
    sent += policy.send({}, {.now_s = tick * 0.05, .state = GameState::initial}) ? 1U : 0U;
  CHECK(sent == 10);
  CHECK(policy.counted_sent() == 0);
  CHECK_FALSE(policy.send({}, {.now_s = 100, .state = GameState::playing, .phase = GamePhase::penalty_shoot_out}));
}
