// Packets written down byte by byte from the layout of version 20, and a million that nobody would send.
#include "football/game_control.h"

#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"

using namespace kadans::football;

namespace {

std::vector<std::byte> bytes_of(std::initializer_list<int> numbers) {
  std::vector<std::byte> bytes;
  for (const int number : numbers) bytes.push_back(static_cast<std::byte>(number));
  return bytes;
}

// Of the specification: every byte that is not 0 stands here.
std::vector<std::byte> written_control() {
  std::vector<std::byte> packet =
      bytes_of({'R', 'G', 'm', 'e', 20, 201, 5, 1, 1, 2, 3, 6, 0, 77, 0x2C, 0x01, 0xF6, 0xFF,
                // team 0: 12 ...
                12, 3, 9, 4, 2, 5, 0x15, 0x00, 0xE0, 0x2E});
  packet.resize(control_bytes);
  packet[28] = std::byte{3};  // its robot 1: motion in stop, 44 s, 1 caution
  packet[29] = std::byte{44};
  packet[30] = std::byte{1};
  packet[85] = std::byte{13};  // its robot 20: substitute
  const auto second = bytes_of({77, 0, 7, 0, 255, 16, 0xFF, 0xFF, 0xFF, 0xFF, 10, 255, 255});
  std::ranges::copy(second, packet.begin() + 88);
  packet[155] = std::byte{12};  // robot 20 of team 77: sent off
  packet[157] = std::byte{2};
  return packet;
}

std::string refusal_after(std::size_t offset, int value) {
  std::vector<std::byte> packet = written_control();
  packet[offset] = static_cast<std::byte>(value);
  const Checked<GameControl> read = read_game_control(packet);
  CHECK_FALSE(read.value.has_value());
  return read.refusal;
}

}  // namespace

TEST_CASE("each field of version 20 stands at its offset") {
  const std::vector<std::byte> packet = written_control();
  const Checked<GameControl> read = read_game_control(packet);
  REQUIRE_MESSAGE(read.value.has_value(), read.refusal);
  const GameControl& control = *read.value;
  CHECK(control.packet_number == 201);
  CHECK(control.players_per_team == 5);
  CHECK(control.competition_type == 1);
  CHECK(control.stopped);
  CHECK(control.phase == GamePhase::extra_time);
  CHECK(control.state == GameState::playing);
  CHECK(control.set_play == SetPlay::corner);
  CHECK_FALSE(control.first_half);
  CHECK(control.kicking_team == 77);
  CHECK(control.remaining_s == 300);
  CHECK(control.secondary_s == -10);
  const TeamEntry& first = control.teams[0];
  CHECK(first.number == 12);
  CHECK(first.colour == TeamColour::black);
  CHECK(first.keeper_colour == TeamColour::gray);
  CHECK(first.keeper == 4);
  CHECK(first.score == 2);
  CHECK(first.penalty_shots == 5);
  CHECK(first.shots_scored == 0x15);
  CHECK(first.message_budget == 12000);
  CHECK(first.robots[0] == RobotEntry{Penalty::motion_in_stop, 44, 1});
  CHECK(first.robots[1] == RobotEntry{});
  CHECK(first.robots[19].penalty == Penalty::substitute);
  const TeamEntry& second = control.teams[1];
  CHECK(second.number == 77);
  CHECK(second.keeper_colour == TeamColour::purple);
  CHECK(second.keeper == 0);
  CHECK(second.score == 255);
  CHECK(second.shots_scored == 0xFFFF);
  CHECK(second.message_budget == 65535);
  CHECK(second.robots[0] == RobotEntry{Penalty::pushing, 255, 255});
  CHECK(second.robots[19] == RobotEntry{Penalty::sent_off, 0, 2});
  CHECK(std::ranges::equal(write_game_control(control), packet));
  CHECK(control.team(77) == &second);
  CHECK(control.team(1) == nullptr);
}

TEST_CASE("other versions, lengths and headers are refused with a sentence") {
  CHECK(
      refusal_after(4, 19) ==
      "the game controller speaks version 19, which is older than 20, the only one that is read: use a game controller "
      "of RoboCup 2026 (v7)");
  CHECK(refusal_after(4, 21).starts_with("the game controller speaks version 21, which is newer than 20"));
  CHECK(refusal_after(0, 'S') == "the packet does not begin with RGme: it is no packet of a game controller");
  std::vector<std::byte> packet = written_control();
  packet.push_back({});
  CHECK(read_game_control(packet).refusal == "the packet has 159 bytes, version 20 has 158");
  packet.resize(157);
  CHECK(read_game_control(packet).refusal == "the packet has 157 bytes, version 20 has 158");
  CHECK(read_game_control({}).refusal == "the packet does not begin with RGme: it is no packet of a game controller");
  CHECK(read_game_control(Bytes(packet).first(4)).refusal.find("version 0") != std::string::npos);

  const GameControl control = *read_game_control(written_control()).value;
  const auto monitors = write_game_control(control, ControlReader::monitor);
  CHECK(read_game_control(monitors).refusal ==
        "the packet holds the true state of the game, which is for monitors: players read RGme");
  CHECK(read_game_control(monitors, ControlReader::monitor).value == control);
  CHECK_FALSE(read_game_control(written_control(), ControlReader::monitor).value.has_value());
}

TEST_CASE("values that cannot be are refused with the field and its range") {
  CHECK(refusal_after(6, 0) == "number of players a team is 0, which is not within 1 to 20");
  CHECK(refusal_after(6, 21) == "number of players a team is 21, which is not within 1 to 20");
  CHECK(refusal_after(7, 3) == "competition type is 3, which is not within 0 to 2");
  CHECK(refusal_after(8, 2) == "stopped is 2, which is not within 0 to 1");
  CHECK(refusal_after(9, 4) == "game phase is 4, which is not within 0 to 3");
  CHECK(refusal_after(10, 5) == "state is 5, which is not within 0 to 4");
  CHECK(refusal_after(11, 7) == "set play is 7, which is not within 0 to 6");
  CHECK(refusal_after(12, 2) == "first half is 2, which is not within 0 to 1");
  CHECK(refusal_after(13, 13) == "the kicking team is 13, which does not play");
  CHECK(refusal_after(18, 77) == "both teams have the number 77");
  CHECK(refusal_after(18, 255) == "a team has the number 255, which means that no team kicks off");
  CHECK(refusal_after(19, 10) == "team 12: colour is 10, which is not within 0 to 9");
  CHECK(refusal_after(20, 10) == "team 12: goalkeeper's colour is 10, which is not within 0 to 9");
  CHECK(refusal_after(21, 21) == "team 12: goalkeeper is 21, which is not within 0 to 20");
  CHECK(refusal_after(24, 0x35) == "team 12 scored a penalty shot that it has not taken");
  CHECK(refusal_after(155, 14) == "team 77: a robot's penalty is 14, which is not within 0 to 13");
}

TEST_CASE("a robot's return message has its fields at their offsets") {
  RobotReturn told{.player = 7, .team = 12, .fallen = true, .pose = {1.5, -2, 0.5}, .ball = {0.25, -1}};
  const auto never = write_robot_return(told);
  const auto meant = bytes_of({'R', 'G', 'r', 't',  4, 7, 12,   1,    0, 0x80, 0xBB, 0x44, 0, 0, 0xFA, 0xC4,
                               0,   0,   0,   0x3F, 0, 0, 0x80, 0xBF, 0, 0,    0x7A, 0x43, 0, 0, 0x7A, 0xC4});
  CHECK(std::ranges::equal(never, meant));
  Checked<RobotReturn> read = read_robot_return(never);
  REQUIRE(read.value.has_value());
  CHECK(read.value->player == 7);
  CHECK(read.value->team == 12);
  CHECK(read.value->fallen);
  CHECK(read.value->pose == told.pose);
  CHECK_FALSE(read.value->ball_age_s.has_value());
  CHECK(read.value->ball == told.ball);
  told.ball_age_s = 2.5;
  CHECK(read_robot_return(write_robot_return(told)).value->ball_age_s == 2.5);

  const auto refusal = [&](std::size_t offset, int value) {
    auto packet = never;
    packet.at(offset) = static_cast<std::byte>(value);
    return read_robot_return(packet).refusal;
  };
  CHECK(refusal(4, 3) == "the robot's return message has version 3; 4 is read");
  CHECK(refusal(5, 0) == "player is 0, which is not within 1 to 20");
  CHECK(refusal(7, 255) == "fallen is 255, which is not within 0 to 1");
  CHECK(refusal(23, 0xC0) == "the ball's age is below 0; -1 alone means never seen");
  told.pose.x_m = std::nan("");
  CHECK(read_robot_return(write_robot_return(told)).refusal == "a number of the return message is not finite");
  CHECK(read_robot_return(Bytes(never).first(31)).refusal == "the packet has 31 bytes, a return message has 32");
}

TEST_CASE("a million hostile packets are read rightly or refused with a sentence") {
  kadans::RandomStream random(20, "football.hostile_packets");
  const auto below = [&](std::uint64_t end) { return static_cast<std::size_t>(random.next() % end); };
  const std::vector<std::byte> good = written_control();
  const auto good_return = write_robot_return({.player = 3, .team = 9});
  std::size_t taken = 0, refused = 0;
  bool right = true;
  std::array<std::byte, 200> packet{};
  for (int i = 0; i < 1'000'000; ++i) {
    const bool control = i % 4 != 3;
    const Bytes base = control ? Bytes(good) : Bytes(good_return);
    std::size_t size = base.size();
    std::ranges::copy(base, packet.begin());
    const std::size_t changes = below(8);
    for (std::size_t change = 0; change < changes; ++change)  // mostly behind the version
      packet.at(below(20) == 0 ? below(size) : 5 + below(size - 5)) = static_cast<std::byte>(random.next() & 0xFFU);
    if (below(10) == 0) size = below(packet.size());
    const Bytes bytes = Bytes(packet).first(size);
    if (control) {
      const Checked<GameControl> read = read_game_control(bytes);
      right = right && read.value.has_value() == read.refusal.empty();
      if (read.value) right = right && std::ranges::equal(write_game_control(*read.value), bytes);
      ++(read.value ? taken : refused);
    } else {
      const Checked<RobotReturn> read = read_robot_return(bytes);
      right = right && read.value.has_value() == read.refusal.empty();
      if (read.value) right = right && finite(read.value->pose) && finite(read.value->ball);
      ++(read.value ? taken : refused);
    }
  }
  CHECK(right);
  CHECK(taken > 100'000);
  CHECK(refused > 100'000);
}
