#include "game_control.h"

#include <algorithm>
#include <string>

namespace kadans::football {
namespace {

constexpr std::array<std::string_view, 5> state_names{"initial", "ready", "set", "playing", "finished"};
constexpr std::array<std::string_view, 7> set_play_names{
    "", "direct free kick", "indirect free kick", "penalty kick", "throw-in", "goal kick", "corner"};
constexpr std::array<std::string_view, 14> penalty_names{
    "none",     "illegal positioning", "motion in set",     "motion in stop",    "local game stuck", "incapable robot",
    "pick-up",  "ball holding",        "leaving the field", "playing with arms", "pushing",          "cautioned",
    "sent off", "substitute"};

bool begins_with(Bytes packet, std::string_view header) noexcept {
  if (packet.size() < header.size()) return false;
  return std::ranges::equal(packet.first(header.size()), std::as_bytes(std::span(header)));
}

std::string header_mistake(Bytes packet, std::string_view header, std::string_view of) {
  if (begins_with(packet, header)) return "";
  return "the packet does not begin with " + std::string(header) + ": it is no " + std::string(of);
}

// Takes one byte after the other and remembers the first that cannot be.
class Fields {
 public:
  explicit Fields(PacketReader& packet) noexcept : packet_(packet) {}

  std::uint8_t whole(std::string_view name, std::uint8_t least, std::uint8_t most) {
    const auto value = packet_.take<std::uint8_t>();
    if ((value < least || value > most) && refusal_.empty()) {
      refusal_ = where_ + std::string(name) + " is " + std::to_string(value) + ", which is not within " +
                 std::to_string(least) + " to " + std::to_string(most);
    }
    return value;
  }
  template <typename E>
  E choice(std::string_view name, E last) {
    return static_cast<E>(whole(name, 0, static_cast<std::uint8_t>(last)));
  }
  void within(std::string where) { where_ = std::move(where); }
  void refuse(std::string sentence) {
    if (refusal_.empty()) refusal_ = std::move(sentence);
  }
  const std::string& refusal() const noexcept { return refusal_; }

 private:
  PacketReader& packet_;
  std::string where_, refusal_;
};

TeamEntry read_team(PacketReader& packet, Fields& fields) {
  TeamEntry team;
  fields.within("");
  team.number = packet.take<std::uint8_t>();
  if (team.number == no_team) fields.refuse("a team has the number 255, which means that no team kicks off");
  fields.within("team " + std::to_string(team.number) + ": ");
  team.colour = fields.choice("colour", TeamColour::gray);
  team.keeper_colour = fields.choice("goalkeeper's colour", TeamColour::gray);
  team.keeper = fields.whole("goalkeeper", 0, players_max);
  team.score = packet.take<std::uint8_t>();
  team.penalty_shots = fields.whole("number of penalty shots", 0, 16);
  team.shots_scored = packet.take<std::uint16_t>();
  if (team.penalty_shots < 16 && (team.shots_scored >> team.penalty_shots) != 0)
    fields.refuse("team " + std::to_string(team.number) + " scored a penalty shot that it has not taken");
  team.message_budget = packet.take<std::uint16_t>();
  for (RobotEntry& robot : team.robots) {
    robot.penalty = fields.choice("a robot's penalty", Penalty::substitute);
    robot.penalty_left_s = packet.take<std::uint8_t>();
    robot.cautions = packet.take<std::uint8_t>();
  }
  return team;
}

std::string size_mistake(std::size_t size, std::size_t meant, std::string_view of) {
  if (size == meant) return "";
  return "the packet has " + std::to_string(size) + " bytes, " + std::string(of) + " has " + std::to_string(meant);
}

float millimetres(double metres) noexcept { return static_cast<float>(metres * 1000); }

}  // namespace

std::string_view name_of(GameState state) noexcept { return state_names.at(static_cast<std::size_t>(state)); }
std::string_view name_of(SetPlay play) noexcept { return set_play_names.at(static_cast<std::size_t>(play)); }
std::string_view name_of(Penalty penalty) noexcept { return penalty_names.at(static_cast<std::size_t>(penalty)); }

const TeamEntry* GameControl::team(std::uint8_t number) const noexcept {
  for (const TeamEntry& entry : teams) {
    if (entry.number == number) return &entry;
  }
  return nullptr;
}

Checked<GameControl> read_game_control(Bytes packet, ControlReader reader) {
  const bool monitor = reader == ControlReader::monitor;
  if (!monitor && begins_with(packet, "RGTD"))
    return {{}, "the packet holds the true state of the game, which is for monitors: players read RGme"};
  std::string wrong = header_mistake(packet, monitor ? "RGTD" : "RGme", "packet of a game controller");
  if (!wrong.empty()) return {{}, wrong};
  const unsigned version = packet.size() > 4 ? static_cast<unsigned>(packet[4]) : 0;
  if (version != control_version) {
    return {{},
            "the game controller speaks version " + std::to_string(version) + ", which is " +
                (version < control_version ? "older" : "newer") +
                " than 20, the only one that is read: use a game controller of RoboCup 2026 (v7)"};
  }
  wrong = size_mistake(packet.size(), control_bytes, "version 20");
  if (!wrong.empty()) return {{}, wrong};

  PacketReader bytes(packet.subspan(5));
  Fields fields(bytes);
  GameControl control;
  control.packet_number = bytes.take<std::uint8_t>();
  control.players_per_team = fields.whole("number of players a team", 1, players_max);
  control.competition_type = fields.whole("competition type", 0, 2);
  control.stopped = fields.whole("stopped", 0, 1) == 1;
  control.phase = fields.choice("game phase", GamePhase::timeout);
  control.state = fields.choice("state", GameState::finished);
  control.set_play = fields.choice("set play", SetPlay::corner);
  control.first_half = fields.whole("first half", 0, 1) == 1;
  control.kicking_team = bytes.take<std::uint8_t>();
  control.remaining_s = bytes.take<std::int16_t>();
  control.secondary_s = bytes.take<std::int16_t>();
  for (TeamEntry& team : control.teams) team = read_team(bytes, fields);
  if (control.teams[0].number == control.teams[1].number)
    fields.refuse("both teams have the number " + std::to_string(control.teams[0].number));
  if (control.kicking_team != no_team && control.team(control.kicking_team) == nullptr)
    fields.refuse("the kicking team is " + std::to_string(control.kicking_team) + ", which does not play");
  if (!fields.refusal().empty()) return {{}, fields.refusal()};
  return {control, ""};
}

std::array<std::byte, control_bytes> write_game_control(const GameControl& control, ControlReader reader) noexcept {
  std::array<std::byte, control_bytes> packet{};
  PacketWriter bytes(packet);
  for (const char c : std::string_view(reader == ControlReader::monitor ? "RGTD" : "RGme")) bytes.put(c);
  bytes.put(control_version);
  bytes.put(control.packet_number);
  bytes.put(control.players_per_team);
  bytes.put(control.competition_type);
  bytes.put(static_cast<std::uint8_t>(control.stopped));
  bytes.put(static_cast<std::uint8_t>(control.phase));
  bytes.put(static_cast<std::uint8_t>(control.state));
  bytes.put(static_cast<std::uint8_t>(control.set_play));
  bytes.put(static_cast<std::uint8_t>(control.first_half));
  bytes.put(control.kicking_team);
  bytes.put(control.remaining_s);
  bytes.put(control.secondary_s);
  for (const TeamEntry& team : control.teams) {
    bytes.put(team.number);
    bytes.put(static_cast<std::uint8_t>(team.colour));
    bytes.put(static_cast<std::uint8_t>(team.keeper_colour));
    bytes.put(team.keeper);
    bytes.put(team.score);
    bytes.put(team.penalty_shots);
    bytes.put(team.shots_scored);
    bytes.put(team.message_budget);
    for (const RobotEntry& robot : team.robots) {
      bytes.put(static_cast<std::uint8_t>(robot.penalty));
      bytes.put(robot.penalty_left_s);
      bytes.put(robot.cautions);
    }
  }
  return packet;
}

Checked<RobotReturn> read_robot_return(Bytes packet) {
  std::string wrong = header_mistake(packet, "RGrt", "robot's return message");
  if (!wrong.empty()) return {{}, wrong};
  const unsigned version = packet.size() > 4 ? static_cast<unsigned>(packet[4]) : 0;
  if (version != return_version)
    return {{}, "the robot's return message has version " + std::to_string(version) + "; 4 is read"};
  wrong = size_mistake(packet.size(), return_bytes, "a return message");
  if (!wrong.empty()) return {{}, wrong};

  PacketReader bytes(packet.subspan(5));
  Fields fields(bytes);
  RobotReturn told;
  told.player = fields.whole("player", 1, players_max);
  told.team = bytes.take<std::uint8_t>();
  told.fallen = fields.whole("fallen", 0, 1) == 1;
  std::array<double, 6> numbers{};
  for (double& number : numbers) {
    number = static_cast<double>(bytes.take_float());
    if (!std::isfinite(number)) fields.refuse("a number of the return message is not finite");
  }
  told.pose = {numbers[0] / 1000, numbers[1] / 1000, numbers[2]};
  if (numbers[3] >= 0)
    told.ball_age_s = numbers[3];
  else if (numbers[3] != -1)
    fields.refuse("the ball's age is below 0; -1 alone means never seen");
  told.ball = {numbers[4] / 1000, numbers[5] / 1000};
  if (!fields.refusal().empty()) return {{}, fields.refusal()};
  return {told, ""};
}

std::array<std::byte, return_bytes> write_robot_return(const RobotReturn& told) noexcept {
  std::array<std::byte, return_bytes> packet{};
  PacketWriter bytes(packet);
  for (const char c : std::string_view("RGrt")) bytes.put(c);
  bytes.put(return_version);
  bytes.put(told.player);
  bytes.put(told.team);
  bytes.put(static_cast<std::uint8_t>(told.fallen));
  bytes.put_float(millimetres(told.pose.x_m));
  bytes.put_float(millimetres(told.pose.y_m));
  bytes.put_float(static_cast<float>(told.pose.theta_rad));
  bytes.put_float(static_cast<float>(told.ball_age_s.value_or(-1)));
  bytes.put_float(millimetres(told.ball.x_m));
  bytes.put_float(millimetres(told.ball.y_m));
  return packet;
}

}  // namespace kadans::football
