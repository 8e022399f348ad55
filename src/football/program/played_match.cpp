#include "played_match.h"

#include <algorithm>
#include <cstdio>

namespace kadans::football {
namespace {

constexpr std::int64_t referee_step_ns = 20'000'000, packet_every_ns = 500'000'000;
constexpr std::int64_t track_every_ns = 200'000'000;
constexpr double step_s = 1e-9 * static_cast<double>(referee_step_ns);
constexpr double upright_up = 0.6;   // z of the trunk's axis: less is no longer on its feet
constexpr double tries_rad_s = 0.3;  // joints that move so fast on the ground: it tries to get up
constexpr double rests_s = 3;        // the longest rest in an attempt
constexpr double holds_m = 0.12;     // a ball so near to the middle of the robot is within it
constexpr double still_m = 0.05, still_rad = 0.15;
constexpr double touching_far_m = 1.2;  // robots that touch each other are nearer

Pose2 pose_of(const Pose& base) {
  const Quat& q = base.orientation;
  const double yaw_rad = std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
  return {base.position_m[0], base.position_m[1], yaw_rad};
}

double up_of(const Pose& base) {
  const Quat& q = base.orientation;
  return 1 - 2 * (q[1] * q[1] + q[2] * q[2]);
}

double fastest_joint(const PlantTruth& truth) {
  double most = 0;
  for (std::uint32_t i = 0; i < truth.joint_count; ++i) most = std::max(most, std::abs(truth.velocity_rad_s.at(i)));
  return most;
}

LinkSet arms_of(const RobotModel& model) {
  LinkSet arms;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const std::string& name = model.links[i].name;
    const bool arm = name.find("shoulder") != std::string::npos || name.find("elbow") != std::string::npos ||
                     name.find("arm") != std::string::npos || name.find("hand") != std::string::npos;
    if (arm) arms.set(i);
  }
  return arms;
}

std::string text_of(const SaidLine& line) {
  const char* mark = line.kind == SaidLine::Kind::error     ? "error: "
                     : line.kind == SaidLine::Kind::warning ? "warning: "
                                                            : "";
  std::array<char, 32> time{};
  std::snprintf(time.data(), time.size(), "%9.2f s  ", 1e-9 * static_cast<double>(line.time_ns));
  return time.data() + line.who + ": " + mark + line.text;
}

}  // namespace

PlayedMatch::PlayedMatch(const MatchConfig& match, std::uint64_t seed)
    : match_(match),
      simulation_(scenario_of(match, seed), match.file, seed),
      referee_({.match = {.rules = match.rules,
                          .teams = {MatchTeam{.number = 1, .keeper = static_cast<std::uint8_t>(match.teams[0].keeper)},
                                    MatchTeam{.number = 2,
                                              .colour = TeamColour::red,
                                              .keeper_colour = TeamColour::orange,
                                              .keeper = static_cast<std::uint8_t>(match.teams[1].keeper)}}},
                .field = match.field(),
                .ball = league_ball(match.division)}),
      ball_(simulation_.object("ball")),
      ball_radius_m_(league_ball(match.division).radius_m) {
  const std::vector<RobotId> ids = match_.robots();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Player player;
    player.told.id = ids[i];
    player.told.name = robot_name(ids[i]);
    player.senses = std::make_unique<RobotSenses>(match_, simulation_, i, ids[i], seed);
    const Catalog& catalog = simulation_.catalog(i);
    player.arms = arms_of(*catalog.model);
    player.sent = catalog.signals.find("supervisor.sent");
    players_.push_back(std::move(player));
  }
  if (match.begins) {
    const DrillStart& begin = *match.begins;
    const Point ball = referee_.begin_with(begin.restart, begin.side, drill_ball(match, seed));
    simulation_.world().put(ball_, {ball.x_m, ball.y_m, ball_radius_m_});
  }
  result_.match = match.name;
  result_.seed = seed;
  track_ = "time_s,ball_x_m,ball_y_m,ball_z_m";
  for (const Player& player : players_) {
    for (const char* what : {"x_m", "y_m", "theta_rad", "upright", "thinks_x_m", "thinks_y_m", "thinks_theta_rad"})
      track_ += "," + player.told.name + "." + what;
  }
  track_ += "\n";
  look();
}

void PlayedMatch::note_touches() {
  for (std::size_t i = 0; i < players_.size(); ++i) {
    const PlantTruth& truth = simulation_.robot(i).truth();
    const LinkSet& links = truth.objects.at(ball_).links;
    players_[i].touched_ball = players_[i].touched_ball || links.any();
    players_[i].touched_with_arms = players_[i].touched_with_arms || (links & players_[i].arms).any();
    players_[i].touched_robot = players_[i].touched_robot || truth.robot_links.any();
  }
}

// The truth, as the referee is given it.
void PlayedMatch::look() {
  const PlantTruth& first = simulation_.robot(0).truth();
  const Vec3& ball = first.objects.at(ball_).pose.position_m;
  world_.ball = {ball[0], ball[1]};
  world_.ball_z_m = ball[2];
  for (std::size_t i = 0; i < players_.size(); ++i) {
    Player& player = players_[i];
    const PlantTruth& truth = simulation_.robot(i).truth();
    RobotTruth& robot = world_.robot(player.told.id);
    robot.present = true;
    robot.pose = pose_of(truth.base);
    robot.upright = up_of(truth.base) > upright_up;
    player.joints_still_s = fastest_joint(truth) > tries_rad_s ? 0 : player.joints_still_s + step_s;
    robot.getting_up = !robot.upright && player.joints_still_s < rests_s;
    robot.active = simulation_.status(i).safety.level < SafetyLevel::damp;
    robot.touches_ball = player.touched_ball;
    robot.uses_arms = player.touched_with_arms && robot.upright;
    robot.holds_ball = distance(robot.pose.at(), world_.ball) < holds_m;
  }
  note_contacts();
  for (Player& player : players_) player.touched_ball = player.touched_with_arms = player.touched_robot = false;
}

// Each robot that was touched by another, with the nearest one that was, too.
void PlayedMatch::note_contacts() {
  world_.contacts.clear();
  for (std::size_t i = 0; i < players_.size(); ++i) {
    if (!players_[i].touched_robot) continue;
    const Player* nearest = nullptr;
    double least_m = touching_far_m;
    for (const Player& other : players_) {
      if (&other == &players_[i] || !other.touched_robot) continue;
      const double far_m = distance(world_.robot(other.told.id).pose.at(), world_.robot(players_[i].told.id).pose.at());
      if (far_m < least_m) nearest = &other, least_m = far_m;
    }
    if (nearest == nullptr) continue;
    const RobotId a = players_[i].told.id, b = nearest->told.id;
    const bool known = std::ranges::any_of(
        world_.contacts, [&](const RobotContact& c) { return (c.a == a && c.b == b) || (c.a == b && c.b == a); });
    if (!known) world_.contacts.push_back({a, b});
  }
}

void PlayedMatch::tell_players(bool at_once) {
  const std::int64_t now_ns = simulation_.time_ns();
  if (!at_once && now_ns < packet_due_ns_) return;
  packet_due_ns_ = now_ns + packet_every_ns;
  const auto packet = write_game_control(referee_.control(ControlReader::player));
  for (Player& player : players_) player.senses->hear(packet);
}

// People put the robots where they begin; each knows where that is.
void PlayedMatch::prepare_half() {
  for (std::size_t i = 0; i < players_.size(); ++i) {
    const RobotId id = players_[i].told.id;
    const Pose2 place = place_before(match_, id), at = world_pose(place, referee_.match().sign(id.side));
    simulation_.robot(i).carry(at.x_m, at.y_m, at.theta_rad);
    players_[i].senses->placed(place);
  }
}

void PlayedMatch::heed(const RefereeReport& report) {
  const Match& match = referee_.match();
  for (const Decision& decision : report.decisions) {
    result_.decisions.push_back(decision);
    lines_.push_back(decision.line());
  }
  for (Player& player : players_)
    player.told.penalties += static_cast<std::uint64_t>(std::ranges::count(report.penalised, player.told.id));
  if (report.ball) simulation_.world().put(ball_, {report.ball->x_m, report.ball->y_m, ball_radius_m_});
  for (const RobotPlacement& placed : report.robots) {
    for (std::size_t i = 0; i < players_.size(); ++i) {
      if (players_[i].told.id == placed.robot)
        simulation_.robot(i).carry(placed.pose.x_m, placed.pose.y_m, placed.pose.theta_rad);
    }
  }
  if (report.whistles_short > 0) {
    for (Player& player : players_) player.senses->hear_whistle();
  }
  if (match.home_defends_left() != left_) prepare_half();
  left_ = match.home_defends_left();
  tell_players(match.stopped() != stopped_ || (match.state() != state_ && match.state() == GameState::ready));
  stopped_ = match.stopped();
  state_ = match.state();
}

void PlayedMatch::measure(Player& player) {
  const Match& match = referee_.match();
  const RobotTruth& robot = world_.robot(player.told.id);
  if (player.was_upright && !robot.upright) ++player.told.falls;
  player.was_upright = robot.upright;
  if (robot.upright) player.told.upright_s += step_s;
  const bool plays = match.state() == GameState::playing && !match.stopped() && match.plays(player.told.id);
  const bool moved = distance(robot.pose.at(), player.still.at()) > still_m ||
                     std::abs(wrapped(robot.pose.theta_rad - player.still.theta_rad)) > still_rad;
  if (moved || !plays) {
    player.still = robot.pose;
    player.still_s = 0;
  }
  if (!plays) return;
  player.told.played_s += step_s;
  player.still_s += step_s;
  player.told.still_max_s = std::max(player.told.still_max_s, player.still_s);
  if (!robot.upright) return;
  const Pose2 truth = world_pose(robot.pose, match.sign(player.told.id.side));
  player.off_m.push_back(distance(truth.at(), player.senses->belief().pose.at()));
}

void PlayedMatch::note_lines() {
  const std::string& first = players_.front().told.name;
  for (SaidLine& line : simulation_.take_lines()) {
    if (line.who.find('.') == std::string::npos) line.who.insert(0, first + ".");
    for (Player& player : players_) {
      if (line.kind == SaidLine::Kind::error && line.who.starts_with(player.told.name + ".")) ++player.told.errors;
    }
    lines_.push_back(text_of(line));
  }
}

void PlayedMatch::track_places() {
  if (simulation_.time_ns() < track_due_ns_) return;
  track_due_ns_ = simulation_.time_ns() + track_every_ns;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%.2f,%.3f,%.3f,%.3f", 1e-9 * static_cast<double>(simulation_.time_ns()),
                world_.ball.x_m, world_.ball.y_m, world_.ball_z_m);
  track_ += text.data();
  for (const Player& player : players_) {
    const RobotTruth& robot = world_.robot(player.told.id);
    const Pose2 thought = world_pose(player.senses->belief().pose, referee_.match().sign(player.told.id.side));
    std::snprintf(text.data(), text.size(), ",%.3f,%.3f,%.3f,%d,%.3f,%.3f,%.3f", robot.pose.x_m, robot.pose.y_m,
                  robot.pose.theta_rad, robot.upright ? 1 : 0, thought.x_m, thought.y_m, thought.theta_rad);
    track_ += text.data();
  }
  track_ += "\n";
}

bool PlayedMatch::step() {
  const Match& match = referee_.match();
  if (!result_.ended.empty()) return false;
  const std::int64_t until_ns = simulation_.time_ns() + referee_step_ns;
  try {
    while (simulation_.time_ns() < until_ns) {
      simulation_.step();
      note_touches();
    }
  } catch (const std::runtime_error& error) {
    result_.ended = error.what();
    return false;
  }
  look();
  for (std::size_t i = 0; i < players_.size(); ++i) {
    PlayedRobot& told = players_[i].told;
    if (!players_[i].sent) continue;
    const auto sent = static_cast<std::uint64_t>(simulation_.signal(i, *players_[i].sent));
    for (; told.messages < sent; ++told.messages) referee_.team_message(told.id.side, 0);
  }
  if (match.state() == GameState::playing && !match.stopped()) result_.playing_s += step_s;
  heed(referee_.step(referee_step_ns, world_));
  for (Player& player : players_) {
    player.senses->step(world_, match.sign(player.told.id.side));
    measure(player);
  }
  note_lines();
  track_places();
  if (match.over()) result_.ended = "by the rules";
  if (match_.goals > 0 && match.score(Side::home) + match.score(Side::away) >= match_.goals)
    result_.ended = "by its goals";
  else if (match_.playing_s > 0 && result_.playing_s >= match_.playing_s && result_.ended.empty())
    result_.ended = "by its time";
  return result_.ended.empty();
}

const MatchResult& PlayedMatch::result() {
  result_.simulated_s = 1e-9 * static_cast<double>(simulation_.time_ns());
  result_.state_hash = simulation_.state_hash();
  result_.score = {referee_.match().score(Side::home), referee_.match().score(Side::away)};
  result_.robots.clear();
  for (Player& player : players_) {
    std::vector<double> off = player.off_m;
    std::ranges::sort(off);
    if (!off.empty()) {
      player.told.off_median_m = off[off.size() / 2];
      player.told.off_most_m = off.back();
    }
    result_.robots.push_back(player.told);
  }
  return result_;
}

std::vector<std::string> PlayedMatch::take_lines() { return std::exchange(lines_, {}); }

}  // namespace kadans::football
