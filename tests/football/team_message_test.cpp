// Team messages, and what they buy: over a network that loses and delays, and when nothing arrives.
#include "football/team_message.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "football/message_policy.h"
#include "kadans/signal/random.h"

using namespace kadans::football;
using kadans::RandomStream;

namespace {

TeamMessage full_message() {
  TeamMessage message{.team = 12, .player = 3, .sequence = 500, .role = Role::striker, .intention = Intention::pass};
  message.fallen = true;
  message.pass_to = 4;
  message.pose = PoseBelief{{1.25, -2.5, 3.1}, 0.12, 0.2, 0.05, -0.5};
  message.ball = BallBelief{{-3, 0.5}, {1.5, -0.25}, 0.08, 0.3};
  message.target = Point{6.9, 0};
  message.time_to_ball_s = 2.5;
  message.opponent_count = opponents_told_max;
  for (OpponentSeen& opponent : message.opponents) opponent = {{2, 3}, 1.5};
  return message;
}

TeamInbox inbox(std::uint8_t player = 1) {
  return TeamInbox({.team = 12, .player = player, .field = league_field(Division::middle, FieldSize::middle)});
}

}  // namespace

TEST_CASE("a team message comes back as it was, as fine as it is sent, in 75 bytes at most") {
  const TeamMessage sent = full_message();
  const Checked<TeamDatagram> written = write_team_message(sent);
  REQUIRE_MESSAGE(written.value.has_value(), written.refusal);
  CHECK(written.value->size == 75);
  const Checked<TeamMessage> read = read_team_message(written.value->span());
  REQUIRE_MESSAGE(read.value.has_value(), read.refusal);
  const TeamMessage& got = *read.value;
  CHECK(got.player == 3);
  CHECK(got.sequence == 500);
  CHECK(got.role == Role::striker);
  CHECK(got.intention == Intention::pass);
  CHECK(got.fallen);
  CHECK(got.pass_to == 4);
  CHECK(distance(got.pose->pose.at(), sent.pose->pose.at()) <= 0.001);
  CHECK(std::abs(got.pose->pose.theta_rad - 3.1) <= 0.0001);
  CHECK(got.pose->sd_x_m >= 0.12);
  CHECK(std::abs(got.pose->correlation_xy + 0.5) <= 0.005);
  CHECK(distance(got.ball->at, {-3, 0.5}) <= 0.001);
  CHECK(distance(got.ball->velocity_m_s, {1.5, -0.25}) <= 0.001);
  CHECK(got.ball->age_s == doctest::Approx(0.3));
  CHECK(*got.time_to_ball_s == doctest::Approx(2.5));
  CHECK(got.opponents.back().age_s == doctest::Approx(1.5));
  CHECK(write_team_message({.team = 12}).value->size == 14);
}

TEST_CASE("a team message that the format does not hold is refused, not clamped") {
  TeamMessage message = full_message();
  message.pose->pose.x_m = 40;
  CHECK(write_team_message(message).refusal == "pose is 40.000000, a team message takes -32.767000 to 32.767000");
  message = full_message();
  message.ball->at.y_m = std::nan("");
  CHECK(write_team_message(message).refusal.starts_with("ball is nan"));
  message = full_message();
  message.ball->velocity_m_s = {12, 12};
  CHECK(write_team_message(message).refusal == "the ball is faster than 15 m/s");
  message = full_message();
  message.pass_to = 3;
  CHECK(write_team_message(message).refusal == "a robot passes to itself");
  message = full_message();
  message.player = 0;
  CHECK(write_team_message(message).refusal == "the player's number is not within 1 to 20");
}

TEST_CASE("team messages from outside are checked before they count") {
  const TeamDatagram good = *write_team_message(full_message()).value;
  const auto changed = [&](std::size_t offset, int value) {
    TeamDatagram bad = good;
    bad.bytes.at(offset) = static_cast<std::byte>(value);
    return inbox().accept(bad.span(), 1);
  };
  CHECK(changed(0, 'X') == "the packet is no team message: it does not begin with KDtm and a header");
  CHECK(changed(4, 2) == "the team message has version 2; 1 is read: give all robots one program");
  CHECK(changed(5, 13) == "the message is of team 13");
  CHECK(changed(6, 1) == "the message is one's own, or another robot has one's number");
  CHECK(changed(6, 21) == "the team message cannot be: the player's number is not within 1 to 20");
  CHECK(changed(9, 9) == "the team message cannot be: the role is none of those that there are");
  CHECK(changed(11, 64) == "the team message has flags that there are not");
  CHECK(changed(11, 0) == "the team message has 75 bytes, by its flags it has 44");
  CHECK(changed(13, 6) == "the team message tells of more than 5 opponents");
  CHECK(changed(15, 0x7F) == "the robot is not near this field");
  CHECK(inbox().accept(good.span().first(74), 1) == "the team message has 74 bytes, by its flags it has 75");
  CHECK(inbox().accept({}, 1).starts_with("the packet is no team message"));
  const std::vector<std::byte> long_one(600, std::byte{1});
  CHECK_FALSE(inbox().accept(long_one, 1).empty());

  RandomStream random(3, "football.hostile_team_messages");
  TeamInbox team = inbox();
  bool right = true;
  for (int i = 0; i < 200'000; ++i) {
    TeamDatagram bad = good;
    for (std::uint64_t change = random.next() % 6; change > 0; --change)
      bad.bytes.at(random.next() % good.size) = static_cast<std::byte>(random.next() & 0xFFU);
    const Checked<TeamMessage> read = read_team_message(bad.span());
    right = right && read.value.has_value() == read.refusal.empty();
    if (read.value) right = right && write_team_message(*read.value).value.has_value();
    (void)team.accept(bad.span(), i * 0.01);
  }
  CHECK(right);
  CHECK(team.counts().taken > 1000);
  CHECK(team.counts().refused > 1000);
}

TEST_CASE("a mate ages and falls silent, and late and double messages do not count") {
  TeamInbox team = inbox();
  TeamMessage message = full_message();
  const auto send = [&](std::uint16_t sequence, double now_s) {
    message.sequence = sequence;
    return team.accept(write_team_message(message).value->span(), now_s);
  };
  CHECK(team.mate(3, 0) == nullptr);
  CHECK(send(65535, 1) == "");
  CHECK(send(65535, 1.1) == "the message is not newer than one that was heard before");
  CHECK(send(2, 1.2) == "");  // the number wraps
  CHECK_FALSE(send(65535, 1.3) == "");
  REQUIRE(team.mate(3, 7) != nullptr);
  CHECK(team.mate(3, 7)->messages == 2);
  CHECK(team.mate(3, 7.3) == nullptr);
  CHECK(send(0, 7.4) == "");  // it began anew
  CHECK(team.mate(21, 7.4) == nullptr);

  const std::optional<BallBelief> ball = team.ball(8.4);
  REQUIRE(ball.has_value());
  CHECK(ball->age_s == doctest::Approx(1.3));
  CHECK(ball->at.x_m > -2);  // it rolled on
  CHECK_FALSE(team.ball(12).has_value());
}

namespace {

// A game of five robots that know truly where they and the ball are, and believe of their mates what they hear. Play is
// quiet for half a minute, then lively for ten seconds.
struct Played {
  double sent = 0, ball_error_m = 0, mate_error_m = 0;
  int frozen = 0;  // robots that did not end the game
};

struct Network {
  double loss = 0, delay_s = 0;
  bool silent = false;
};

template <typename Decide>
Played play_game(std::uint64_t seed, Network network, Decide&& decide, double seconds = 1200) {
  struct Robot {
    Point at, goal;
    Role role = Role::supporter;
    std::uint16_t sequence = 0;
    std::unique_ptr<TeamInbox> heard;
  };
  struct UnderWay {
    double due_s;
    std::uint8_t from;
    TeamDatagram datagram;
  };
  RandomStream random(seed, "football.message_game");
  std::array<Robot, 5> robots;
  for (std::uint8_t i = 0; i < robots.size(); ++i) robots.at(i).heard = std::make_unique<TeamInbox>(inbox(i + 1));
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
    for (std::uint8_t i = 0; i < robots.size(); ++i) {
      Robot& robot = robots.at(i);
      if (random.uniform() < step_s * (lively ? 0.4 : 0.03)) {
        robot.goal = {random.uniform(-6, 6), random.uniform(-4, 4)};
        robot.role = static_cast<Role>(1 + random.next() % 4);
      }
      const Point way = robot.goal - robot.at;
      if (norm(way) > 0.05) robot.at = robot.at + (0.4 * step_s / norm(way)) * way;
      TeamMessage message{.team = 12, .player = static_cast<std::uint8_t>(i + 1), .role = robot.role};
      message.pose = PoseBelief{{robot.at.x_m, robot.at.y_m, 0}};
      message.ball = ball;
      message.target = robot.goal;
      message.sequence = robot.sequence;
      const double remaining_s = std::max(seconds - now_s / 1.3, 0.0);
      const bool send = decide(i, message,
                               MessagePolicy::Situation{.now_s = now_s,
                                                        .state = GameState::playing,
                                                        .remaining_s = remaining_s,
                                                        .budget_left = static_cast<std::uint16_t>(std::max(told, 0.0)),
                                                        .budget_age_s = now_s - told_s});
      if (!send) continue;
      ++robot.sequence;
      ++played.sent;
      --budget;
      if (network.silent || random.uniform() < network.loss) continue;
      air.push_back({now_s + random.uniform(0, 2 * network.delay_s), static_cast<std::uint8_t>(i + 1),
                     *write_team_message(message).value});
    }
    std::erase_if(air, [&](const UnderWay& sent) {
      if (sent.due_s > now_s) return false;
      for (std::uint8_t i = 0; i < robots.size(); ++i) {
        if (i + 1 != sent.from) (void)robots.at(i).heard->accept(sent.datagram.span(), now_s);
      }
      return true;
    });
    if (!lively || tick % 5 != 0) continue;  // what is known counts when something happens
    ++samples;
    const auto known = robots[0].heard->ball(now_s);
    played.ball_error_m += known ? std::min(distance(known->at, ball.at), 3.0) : 3.0;
    for (std::uint8_t i = 1; i < robots.size(); ++i) {
      const Mate* mate = robots[0].heard->mate(static_cast<std::uint8_t>(i + 1), now_s);
      played.mate_error_m +=
          (mate != nullptr ? std::min(distance(mate->message.pose->pose.at(), robots.at(i).at), 3.0) : 3.0) / 4;
    }
  }
  played.ball_error_m /= static_cast<double>(samples);
  played.mate_error_m /= static_cast<double>(samples);
  return played;
}

Played play_by_policy(std::uint64_t seed, Network network, double game_messages = 12000) {
  std::vector<MessagePolicy> policies(5, MessagePolicy({.game_messages = game_messages}));
  return play_game(seed, network,
                   [&](std::size_t robot, const TeamMessage& message, MessagePolicy::Situation situation) {
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
                   [&](std::size_t robot, const TeamMessage&, const MessagePolicy::Situation& situation) {
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
    TeamMessage message{.team = 12, .player = 2};
    message.pose = PoseBelief{{random.uniform(-7, 7), random.uniform(-4, 4), 0}};
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
  TeamMessage message{.team = 12, .player = 2};
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
