#include "team_message.h"

#include <algorithm>
#include <numbers>
#include <string_view>

namespace kadans::football {
namespace {

constexpr std::string_view team_header = "KDtm";
constexpr std::uint8_t team_version = 1;
constexpr std::size_t head_bytes = 14, pose_part_bytes = 13, ball_part_bytes = 12, target_part_bytes = 4,
                      time_part_bytes = 2, opponent_bytes = 6;
constexpr double metre_max = 32.767, ball_speed_max_m_s = 15, time_max_s = 65.535, sd_max = 65.535,
                 sd_angle_max_rad = 6.5535, to_ball_max_s = 655.35;
constexpr double fine_rad = 1e-4;

enum Flag : unsigned { fallen_flag = 1, pose_flag = 2, ball_flag = 4, target_flag = 8, time_flag = 16, all_flags = 31 };

// Puts quantised numbers and remembers the first that does not fit.
class QuantisedWriter {
 public:
  explicit QuantisedWriter(std::span<std::byte> bytes) noexcept : bytes_(bytes) {}

  template <std::integral T>
  void plain(T value) noexcept {
    bytes_.put(value);
  }
  void signed16(std::string_view name, double value, double unit, double most) {
    check(name, value, -most, most);
    bytes_.put(static_cast<std::int16_t>(refusal_.empty() ? std::lround(value / unit) : 0));
  }
  void unsigned16(std::string_view name, double value, double unit, double most) {
    check(name, value, 0, most);
    bytes_.put(static_cast<std::uint16_t>(refusal_.empty() ? std::lround(value / unit) : 0));
  }
  void deviation(std::string_view name, double value, double unit, double most) {
    check(name, value, 0, most);
    bytes_.put(static_cast<std::uint16_t>(refusal_.empty() ? std::max(std::ceil(value / unit), 1.0) : 1));
  }
  void metres(std::string_view name, const Point& point) {
    signed16(name, point.x_m, 1e-3, metre_max);
    signed16(name, point.y_m, 1e-3, metre_max);
  }
  void check(std::string_view name, double value, double least, double most) {
    constexpr double rounding = 1e-9;
    if (!(value >= least - rounding && value <= most + rounding) && refusal_.empty()) {
      refusal_ = std::string(name) + " is " + std::to_string(value) + ", a team message takes " +
                 std::to_string(least) + " to " + std::to_string(most);
    }
  }
  std::size_t size() const noexcept { return bytes_.size(); }
  const std::string& refusal() const noexcept { return refusal_; }

 private:
  PacketWriter bytes_;
  std::string refusal_;
};

Point take_point(PacketReader& bytes) noexcept {
  const double x_m = bytes.take<std::int16_t>() * 1e-3;
  return {x_m, bytes.take<std::int16_t>() * 1e-3};
}

std::size_t bytes_for(unsigned flags, std::size_t opponents) noexcept {
  return head_bytes + ((flags & pose_flag) != 0 ? pose_part_bytes : 0) +
         ((flags & ball_flag) != 0 ? ball_part_bytes : 0) + ((flags & target_flag) != 0 ? target_part_bytes : 0) +
         ((flags & time_flag) != 0 ? time_part_bytes : 0) + opponents * opponent_bytes;
}

unsigned flags_of(const TeamMessage& message) noexcept {
  return (message.fallen ? fallen_flag : 0U) | (message.pose ? pose_flag : 0U) | (message.ball ? ball_flag : 0U) |
         (message.target ? target_flag : 0U) | (message.time_to_ball_s ? time_flag : 0U);
}

bool beyond(const Point& at) noexcept {
  constexpr double most_m = metre_max + 1e-9;
  return !(std::abs(at.x_m) <= most_m && std::abs(at.y_m) <= most_m);
}

// "" or what cannot be in a message that has the right length.
std::string impossible(const TeamMessage& message) {
  if (message.player < 1 || message.player > players_max) return "the player's number is not within 1 to 20";
  if (message.role > Role::keeper) return "the role is none of those that there are";
  if (message.intention > Intention::get_up) return "the intention is none of those that there are";
  if (message.pass_to > players_max) return "the number of whom a pass is for is not within 0 to 20";
  if (message.pass_to == message.player) return "a robot passes to itself";
  bool far = (message.pose && beyond(message.pose->pose.at())) || (message.ball && beyond(message.ball->at)) ||
             (message.target && beyond(*message.target));
  for (std::size_t i = 0; i < message.opponent_count && i < opponents_told_max; ++i)
    far = far || beyond(message.opponents.at(i).at);
  if (far) return "a position is more than 32.767 m away";
  if (message.pose) {
    const PoseBelief& pose = *message.pose;
    if (!(std::abs(pose.pose.theta_rad) <= std::numbers::pi + fine_rad)) return "the heading is more than half a turn";
    if (!(pose.sd_x_m > 0 && pose.sd_y_m > 0 && pose.sd_theta_rad > 0)) return "the pose's standard deviation is 0";
    if (!(std::abs(pose.correlation_xy) <= 1)) return "the pose's correlation is not within -1 to 1";
  }
  if (message.ball) {
    if (!(norm(message.ball->velocity_m_s) <= ball_speed_max_m_s)) return "the ball is faster than 15 m/s";
    if (!(message.ball->sd_m > 0)) return "the ball's standard deviation is 0";
  }
  return "";
}

}  // namespace

Checked<TeamDatagram> write_team_message(const TeamMessage& message) {
  TeamDatagram datagram;
  QuantisedWriter out(datagram.bytes);
  for (const char c : team_header) out.plain(c);
  out.plain(team_version);
  out.plain(message.team);
  out.plain(message.player);
  out.plain(message.sequence);
  out.plain(static_cast<std::uint8_t>(message.role));
  out.plain(static_cast<std::uint8_t>(message.intention));
  out.plain(static_cast<std::uint8_t>(flags_of(message)));
  out.plain(message.pass_to);
  const std::size_t opponents = std::min(message.opponent_count, opponents_told_max);
  out.plain(static_cast<std::uint8_t>(opponents));
  if (message.pose) {
    out.metres("pose", message.pose->pose.at());
    out.signed16("pose.theta_rad", message.pose->pose.theta_rad, fine_rad, std::numbers::pi + fine_rad);
    out.deviation("pose.sd_x_m", message.pose->sd_x_m, 1e-3, sd_max);
    out.deviation("pose.sd_y_m", message.pose->sd_y_m, 1e-3, sd_max);
    out.deviation("pose.sd_theta_rad", message.pose->sd_theta_rad, fine_rad, sd_angle_max_rad);
    out.check("pose.correlation_xy", message.pose->correlation_xy, -1, 1);
    out.plain(static_cast<std::int8_t>(out.refusal().empty() ? std::lround(127 * message.pose->correlation_xy) : 0));
  }
  if (message.ball) {
    out.metres("ball", message.ball->at);
    out.metres("ball.velocity_m_s", message.ball->velocity_m_s);
    out.deviation("ball.sd_m", message.ball->sd_m, 1e-3, sd_max);
    out.unsigned16("ball.age_s", message.ball->age_s, 1e-3, time_max_s);
  }
  if (message.target) out.metres("target", *message.target);
  if (message.time_to_ball_s) out.unsigned16("time_to_ball_s", *message.time_to_ball_s, 1e-2, to_ball_max_s);
  for (std::size_t i = 0; i < opponents; ++i) {
    out.metres("opponent", message.opponents.at(i).at);
    out.unsigned16("opponent.age_s", message.opponents.at(i).age_s, 1e-3, time_max_s);
  }
  std::string wrong = out.refusal().empty() ? impossible(message) : out.refusal();
  if (!wrong.empty()) return {{}, wrong};
  datagram.size = out.size();
  return {datagram, ""};
}

Checked<TeamMessage> read_team_message(Bytes packet) {
  if (packet.size() < head_bytes || !std::ranges::equal(packet.first(4), std::as_bytes(std::span(team_header))))
    return {{}, "the packet is no team message: it does not begin with KDtm and a header"};
  if (packet.size() > team_message_bytes_max)
    return {{}, "the packet has " + std::to_string(packet.size()) + " bytes, a team message at most 512"};
  PacketReader in(packet.subspan(4));
  const unsigned version = in.take<std::uint8_t>();
  if (version != team_version)
    return {{}, "the team message has version " + std::to_string(version) + "; 1 is read: give all robots one program"};
  TeamMessage message;
  message.team = in.take<std::uint8_t>();
  message.player = in.take<std::uint8_t>();
  message.sequence = in.take<std::uint16_t>();
  message.role = static_cast<Role>(in.take<std::uint8_t>());
  message.intention = static_cast<Intention>(in.take<std::uint8_t>());
  const unsigned flags = in.take<std::uint8_t>();
  message.fallen = (flags & fallen_flag) != 0;
  message.pass_to = in.take<std::uint8_t>();
  message.opponent_count = in.take<std::uint8_t>();
  if (flags > all_flags) return {{}, "the team message has flags that there are not"};
  if (message.opponent_count > opponents_told_max) return {{}, "the team message tells of more than 5 opponents"};
  const std::size_t meant = bytes_for(flags, message.opponent_count);
  if (packet.size() != meant) {
    return {{},
            "the team message has " + std::to_string(packet.size()) + " bytes, by its flags it has " +
                std::to_string(meant)};
  }
  if ((flags & pose_flag) != 0) {
    PoseBelief& pose = message.pose.emplace();
    const Point at = take_point(in);
    pose.pose = {at.x_m, at.y_m, in.take<std::int16_t>() * fine_rad};
    pose.sd_x_m = in.take<std::uint16_t>() * 1e-3;
    pose.sd_y_m = in.take<std::uint16_t>() * 1e-3;
    pose.sd_theta_rad = in.take<std::uint16_t>() * fine_rad;
    pose.correlation_xy = in.take<std::int8_t>() / 127.0;
  }
  if ((flags & ball_flag) != 0) {
    BallBelief& ball = message.ball.emplace();
    ball.at = take_point(in);
    ball.velocity_m_s = take_point(in);
    ball.sd_m = in.take<std::uint16_t>() * 1e-3;
    ball.age_s = in.take<std::uint16_t>() * 1e-3;
  }
  if ((flags & target_flag) != 0) message.target = take_point(in);
  if ((flags & time_flag) != 0) message.time_to_ball_s = in.take<std::uint16_t>() * 1e-2;
  for (std::size_t i = 0; i < message.opponent_count; ++i) {
    message.opponents.at(i).at = take_point(in);
    message.opponents.at(i).age_s = in.take<std::uint16_t>() * 1e-3;
  }
  std::string wrong = impossible(message);
  if (!wrong.empty()) return {{}, "the team message cannot be: " + wrong};
  return {message, ""};
}

std::string TeamInbox::place_mistake(const TeamMessage& message) const {
  constexpr double beyond_carpet_m = 2;  // errors of localisation, and robots that are carried
  const double x_m = settings_.field.length_m / 2 + settings_.field.border_m + beyond_carpet_m;
  const double y_m = settings_.field.width_m / 2 + settings_.field.border_m + beyond_carpet_m;
  const auto off = [&](const Point& at) { return !(std::abs(at.x_m) <= x_m && std::abs(at.y_m) <= y_m); };
  if (message.pose && off(message.pose->pose.at())) return "the robot is not near this field";
  if (message.ball && off(message.ball->at)) return "the ball is not near this field";
  if (message.target && off(*message.target)) return "the target is not near this field";
  for (std::size_t i = 0; i < message.opponent_count; ++i) {
    if (off(message.opponents.at(i).at)) return "an opponent is not near this field";
  }
  return "";
}

std::string TeamInbox::accept(Bytes packet, double now_s) {
  const auto refuse = [this](std::string why) {
    ++counts_.refused;
    return why;
  };
  const Checked<TeamMessage> read = read_team_message(packet);
  if (!read.value) return refuse(read.refusal);
  const TeamMessage& message = *read.value;
  if (message.team != settings_.team) return refuse("the message is of team " + std::to_string(message.team));
  if (message.player == settings_.player) return refuse("the message is one's own, or another robot has one's number");
  std::string wrong = place_mistake(message);
  if (!wrong.empty()) return refuse(wrong);
  std::optional<Mate>& known = mates_.at(message.player - 1U);
  if (known && now_s - known->heard_s < settings_.silent_after_s) {
    const auto ahead =
        static_cast<std::int16_t>(static_cast<std::uint16_t>(message.sequence - known->message.sequence));
    if (ahead <= 0) return refuse("the message is not newer than one that was heard before");
  }
  known = Mate{message, now_s, known ? known->messages + 1 : 1};
  ++counts_.taken;
  return "";
}

const Mate* TeamInbox::mate(std::uint8_t player, double now_s) const noexcept {
  if (player < 1 || player > players_max) return nullptr;
  const std::optional<Mate>& known = mates_.at(player - 1U);
  return known && now_s - known->heard_s < settings_.silent_after_s ? &*known : nullptr;
}

std::optional<BallBelief> TeamInbox::ball(double now_s, double age_max_s) const noexcept {
  std::optional<BallBelief> best;
  double least_m = 0;
  for (std::uint8_t player = 1; player <= players_max; ++player) {
    const Mate* known = mate(player, now_s);
    if (known == nullptr || !known->message.ball) continue;
    BallBelief ball = rolled_on(*known->message.ball, now_s - known->heard_s);
    if (!(ball.age_s <= age_max_s)) continue;
    const double pose_m =
        known->message.pose ? std::max(known->message.pose->sd_x_m, known->message.pose->sd_y_m) : 1.0;
    ball.sd_m = std::hypot(ball.sd_m, pose_m);
    const double doubt_m = ball.sd_m + 0.3 * ball.age_s;
    if (!best || doubt_m < least_m) best = ball, least_m = doubt_m;
  }
  return best;
}

BallBelief rolled_on(const BallBelief& ball, double time_s, double deceleration_m_s2) noexcept {
  BallBelief later = ball;
  later.age_s += time_s;
  const double speed_m_s = norm(ball.velocity_m_s);
  if (!(speed_m_s > 0) || !(time_s > 0)) return later;
  const double rolling_s = std::min(time_s, speed_m_s / deceleration_m_s2);
  const double way_m = speed_m_s * rolling_s - deceleration_m_s2 * rolling_s * rolling_s / 2;
  later.at = ball.at + (way_m / speed_m_s) * ball.velocity_m_s;
  later.velocity_m_s = (1 - deceleration_m_s2 * rolling_s / speed_m_s) * ball.velocity_m_s;
  return later;
}

}  // namespace kadans::football
