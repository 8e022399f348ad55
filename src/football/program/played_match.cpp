#include "played_match.h"

#include <algorithm>
#include <cstdio>

namespace kadans::football {
namespace {

constexpr std::int64_t referee_step_ns = 20'000'000, packet_every_ns = 500'000'000;
constexpr std::int64_t track_every_ns = 200'000'000;
constexpr double step_s = 1e-9 * static_cast<double>(referee_step_ns);
constexpr std::int64_t answer_every_ns = 1'000'000'000;
constexpr double carpet_edge_m = 0.2;  // from the edge, where a robot with a penalty stands
constexpr double upright_up = 0.6;     // z of the trunk's axis: less is no longer on its feet
constexpr double tries_rad_s = 0.3;    // joints that move so fast on the ground: it tries to get up
constexpr double rests_s = 3;          // the longest rest in an attempt
constexpr double holds_m = 0.12;       // a ball so near to the middle of the robot is within it
constexpr double still_m = 0.05, still_rad = 0.15;
constexpr double keepers_m = 1.6;       // a ball nearer to the goal's middle is the keeper's
constexpr double touching_far_m = 1.2;  // robots that touch each other are nearer

// What the page draws, and what is asked first of a match.
constexpr const char* shown_signals =
    "*plant.base.*@50, *world.*@50, *seen.*@10, *odometry.*@10, *supervisor.*@10, *behavior.*@20, "
    "*joint.*.position_rad@50, *safety.*@10";

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

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
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
    : PlayedMatch(match, seed, std::make_unique<SimulatedMatch>(match, seed), false) {}

PlayedMatch::PlayedMatch(const MatchConfig& match, std::uint64_t seed, std::unique_ptr<MatchWorld> played_in,
                         bool refereed_elsewhere)
    : match_(match),
      played_in_(std::move(played_in)),
      elsewhere_(refereed_elsewhere),
      referee_({.match = {.rules = match.rules,
                          .teams = {MatchTeam{.number = 1, .keeper = static_cast<std::uint8_t>(match.teams[0].keeper)},
                                    MatchTeam{.number = 2,
                                              .colour = TeamColour::red,
                                              .keeper_colour = TeamColour::orange,
                                              .keeper = static_cast<std::uint8_t>(match.teams[1].keeper)}}},
                .field = match.field(),
                .ball = league_ball(match.division)}),
      ball_(played_in_->object("ball")),
      ball_radius_m_(league_ball(match.division).radius_m) {
  const std::vector<RobotId> ids = match_.robots();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Player player;
    player.told.id = ids[i];
    player.told.name = robot_name(ids[i]);
    player.senses = std::make_unique<RobotSenses>(match_, *played_in_, i, ids[i], seed);
    player.arms = arms_of(*played_in_->catalog(i).model);
    players_.push_back(std::move(player));
  }
  if (match.begins) {
    const DrillStart& begin = *match.begins;
    const Point ball = referee_.begin_with(begin.restart, begin.side, drill_ball(match, seed));
    played_in_->world().put(ball_, {ball.x_m, ball.y_m, ball_radius_m_});
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
    const PlantTruth& truth = played_in_->robot(i).truth();
    const LinkSet& links = truth.objects.at(ball_).links;
    players_[i].touched_ball = players_[i].touched_ball || links.any();
    players_[i].touched_with_arms = players_[i].touched_with_arms || (links & players_[i].arms).any();
    players_[i].touched_robot = players_[i].touched_robot || truth.robot_links.any();
  }
}

// The truth, as the referee is given it.
void PlayedMatch::look() {
  const PlantTruth& first = played_in_->robot(0).truth();
  const Vec3& ball = first.objects.at(ball_).pose.position_m;
  world_.ball = {ball[0], ball[1]};
  world_.ball_z_m = ball[2];
  for (std::size_t i = 0; i < players_.size(); ++i) {
    Player& player = players_[i];
    const PlantTruth& truth = played_in_->robot(i).truth();
    RobotTruth& robot = world_.robot(player.told.id);
    robot.present = true;
    robot.pose = ground_pose(truth.base);
    robot.upright = up_of(truth.base) > upright_up;
    player.joints_still_s = fastest_joint(truth) > tries_rad_s ? 0 : player.joints_still_s + step_s;
    robot.getting_up = !robot.upright && player.joints_still_s < rests_s;
    robot.active = played_in_->active(i);
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
  const std::int64_t now_ns = played_in_->time_ns();
  if (!at_once && now_ns < packet_due_ns_) return;
  packet_due_ns_ = now_ns + packet_every_ns;
  const auto packet = write_game_control(referee_.control(ControlReader::player));
  played_in_->send(packet);
  for (const auto& came : played_in_->packets()) {
    for (Player& player : players_) player.senses->hear(came);
  }
}

// People put the robots where they begin; each knows where that is. In the first round a robot may still stand where
// another one goes, which is then put beside it.
void PlayedMatch::prepare_half() {
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < players_.size(); ++i) {
      const RobotId id = players_[i].told.id;
      const Pose2 place = place_before(match_, id), at = world_pose(place, sign(id.side));
      played_in_->robot(i).carry(at.x_m, at.y_m, at.theta_rad);
      if (round == 0) players_[i].senses->placed(place);
    }
  }
}

bool PlayedMatch::plays(RobotId id) const noexcept {
  if (!elsewhere_) return referee_.match().plays(id);
  const TeamEntry* team = told_.team(static_cast<std::uint8_t>(1 + index_of(id.side)));
  return team != nullptr && team->robots.at(id.index()).penalty == Penalty::none;
}

double PlayedMatch::sign(Side side) const noexcept {
  if (!elsewhere_) return referee_.match().sign(side);
  return told_.teams[0].number == 1 + index_of(side) ? -1 : 1;
}

bool PlayedMatch::others_kick(Side side) const noexcept {
  if (elsewhere_) return told_.set_play != SetPlay::none && told_.kicking_team != 1 + index_of(side);
  const Match& match = referee_.match();
  return match.restart() != Restart::none && match.kicking() != side;
}

bool PlayedMatch::over() const noexcept {
  return elsewhere_ ? told_.state == GameState::finished && !told_.first_half : referee_.match().over();
}

std::array<unsigned, 2> PlayedMatch::scores() const noexcept {
  if (!elsewhere_) return {referee_.match().score(Side::home), referee_.match().score(Side::away)};
  const TeamEntry *home = told_.team(1), *away = told_.team(2);
  return {home == nullptr ? 0U : home->score, away == nullptr ? 0U : away->score};
}

// By another game controller's packets.
void PlayedMatch::follow() {
  for (const auto& came : played_in_->packets()) {
    const Checked<GameControl> packet = read_game_control(came);
    if (!packet.value || packet.value->team(1) == nullptr || packet.value->team(2) == nullptr) continue;
    follow(*packet.value);
    for (Player& player : players_) player.senses->hear(came);
  }
  if (played_in_->time_ns() < answer_due_ns_) return;
  answer_due_ns_ = played_in_->time_ns() + answer_every_ns;
  answer_referee();
}

// What people around the field do when they hear it: the ball goes to the middle for a kick-off and to the mark for a
// penalty kick, robots with a penalty go to the touchline, level with their own mark.
void PlayedMatch::follow(const GameControl& packet) {
  const GameControl before = std::exchange(told_, packet);
  const Field field = match_.field();
  if (packet.state != before.state || packet.set_play != before.set_play || packet.stopped != before.stopped)
    lines_.push_back("the game controller: " + std::string(name_of(packet.state)) + " " +
                     std::string(name_of(packet.set_play)) + (packet.stopped ? ", stopped" : ""));
  if (packet.first_half != before.first_half) prepare_half();
  if (packet.state == GameState::set && before.state != GameState::set) {
    const bool at_mark = packet.set_play == SetPlay::penalty_kick;
    const double toward = packet.kicking_team == 1 ? sign(Side::home) : sign(Side::away);
    played_in_->world().put(ball_, {at_mark ? toward * field.penalty_mark_x_m() : 0, 0, ball_radius_m_});
  }
  for (std::size_t i = 0; i < players_.size(); ++i) {
    const RobotId id = players_[i].told.id;
    const auto number = static_cast<std::uint8_t>(1 + index_of(id.side));
    const TeamEntry* was = before.team(number);
    const Penalty now = packet.team(number)->robots.at(id.index()).penalty;
    const Penalty old = was == nullptr ? Penalty::none : was->robots.at(id.index()).penalty;
    if (now == old || now == Penalty::none || now == Penalty::motion_in_set) continue;
    ++players_[i].told.penalties;
    const double side = id.number % 2 == 0 ? 1 : -1;
    const Pose2 at = world_pose({-field.penalty_mark_x_m(), side * (field.width_m / 2 + field.border_m - carpet_edge_m),
                                 -side * std::numbers::pi / 2},
                                sign(id.side));
    played_in_->robot(i).carry(at.x_m, at.y_m, at.theta_rad);
  }
}

void PlayedMatch::answer_referee() {
  for (const Player& player : players_) {
    const RobotId id = player.told.id;
    const std::optional<RobotSenses::BallNow> ball = player.senses->ball();
    RobotReturn told{.player = id.number,
                     .team = static_cast<std::uint8_t>(1 + index_of(id.side)),
                     .fallen = !world_.robot(id).upright,
                     .pose = player.senses->belief().pose};
    if (ball) told.ball_age_s = ball->age_s, told.ball = ball->at;
    played_in_->answer_referee(told);
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
  if (report.ball) played_in_->world().put(ball_, {report.ball->x_m, report.ball->y_m, ball_radius_m_});
  for (const RobotPlacement& placed : report.robots) {
    for (std::size_t i = 0; i < players_.size(); ++i) {
      if (players_[i].told.id == placed.robot)
        played_in_->robot(i).carry(placed.pose.x_m, placed.pose.y_m, placed.pose.theta_rad);
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

// It lies, its drives let go, or the ball is its own: on its feet it is the nearest of its team. Who waits for the ball
// need not move: a robot whose mate is nearer, a keeper far from it, and who keeps away from a set play of the others.
bool PlayedMatch::has_to_move(const Player& player) const noexcept {
  const RobotId id = player.told.id;
  const RobotTruth& robot = world_.robot(id);
  if (!robot.upright || !robot.active) return true;
  if (others_kick(id.side)) return false;
  const Point own_goal = world_pose({-match_.field().goal_line_x_m(), 0, 0}, sign(id.side)).at();
  if (match_.team(id.side).keeper == id.number && distance(world_.ball, own_goal) > keepers_m) return false;
  const double own_m = distance(robot.pose.at(), world_.ball);
  return std::ranges::none_of(players_, [&](const Player& other) {
    const RobotId mate = other.told.id;
    if (mate.side != id.side || mate == id || !plays(mate) || !world_.robot(mate).upright) return false;
    return distance(world_.robot(mate).pose.at(), world_.ball) < own_m;
  });
}

void PlayedMatch::measure(Player& player) {
  const RobotTruth& robot = world_.robot(player.told.id);
  if (player.was_upright && !robot.upright) ++player.told.falls;
  player.was_upright = robot.upright;
  if (robot.upright) player.told.upright_s += step_s;
  const bool in_play = state() == GameState::playing && !stopped() && plays(player.told.id);
  const bool moved = distance(robot.pose.at(), player.still.at()) > still_m ||
                     std::abs(wrapped(robot.pose.theta_rad - player.still.theta_rad)) > still_rad;
  if (moved || !in_play) {
    player.still = robot.pose;
    player.still_s = player.frozen_s = 0;
  }
  if (!in_play) return;
  player.told.played_s += step_s;
  player.still_s += step_s;
  player.told.still_max_s = std::max(player.told.still_max_s, player.still_s);
  if (has_to_move(player)) player.frozen_s += step_s;
  player.told.frozen_max_s = std::max(player.told.frozen_max_s, player.frozen_s);
  if (!robot.upright) return;
  const Pose2 truth = world_pose(robot.pose, sign(player.told.id.side));
  const Pose2& thought = player.senses->belief().pose;
  player.off_m.push_back(distance(truth.at(), thought.at()));
  player.off_rad.push_back(std::abs(wrapped(truth.theta_rad - thought.theta_rad)));
}

void PlayedMatch::note_lines() {
  const std::string& first = players_.front().told.name;
  for (SaidLine& line : played_in_->take_lines()) {
    if (line.who.find('.') == std::string::npos) line.who.insert(0, first + ".");
    for (Player& player : players_) {
      if (line.kind != SaidLine::Kind::error || !line.who.starts_with(player.told.name + ".")) continue;
      if (++player.told.errors > 1) continue;
      const std::string text = text_of(line);
      player.told.first_error = text.substr(std::min(text.find_first_not_of(' '), text.size()));
    }
    lines_.push_back(text_of(line));
  }
}

void PlayedMatch::track_places() {
  if (played_in_->time_ns() < track_due_ns_) return;
  track_due_ns_ = played_in_->time_ns() + track_every_ns;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%.2f,%.3f,%.3f,%.3f", 1e-9 * static_cast<double>(played_in_->time_ns()),
                world_.ball.x_m, world_.ball.y_m, world_.ball_z_m);
  track_ += text.data();
  for (const Player& player : players_) {
    const RobotTruth& robot = world_.robot(player.told.id);
    const Pose2 thought = world_pose(player.senses->belief().pose, sign(player.told.id.side));
    std::snprintf(text.data(), text.size(), ",%.3f,%.3f,%.3f,%d,%.3f,%.3f,%.3f", robot.pose.x_m, robot.pose.y_m,
                  robot.pose.theta_rad, robot.upright ? 1 : 0, thought.x_m, thought.y_m, thought.theta_rad);
    track_ += text.data();
  }
  track_ += "\n";
}

bool PlayedMatch::step() {
  const Match& match = referee_.match();
  if (!result_.ended.empty()) return false;
  const std::int64_t until_ns = played_in_->time_ns() + referee_step_ns;
  try {
    while (played_in_->time_ns() < until_ns) {
      if (!played_in_->step()) {
        result_.ended = "because no robot is driven any more";
        return false;
      }
      note_touches();
    }
  } catch (const std::runtime_error& error) {
    result_.ended = error.what();
    return false;
  }
  look();
  for (std::size_t i = 0; i < players_.size(); ++i) {
    PlayedRobot& told = players_[i].told;
    const std::uint64_t sent = played_in_->messages(i);
    for (; told.messages < sent; ++told.messages) {
      if (match.runs() && match.message_budget(told.id.side) == 0) ++result_.over_budget.at(index_of(told.id.side));
      referee_.team_message(told.id.side, 0);
    }
  }
  if (state() == GameState::playing && !stopped()) result_.playing_s += step_s;
  if (elsewhere_)
    follow();
  else
    heed(referee_.step(referee_step_ns, world_));
  for (Player& player : players_) {
    player.senses->step(world_, sign(player.told.id.side));
    measure(player);
  }
  note_lines();
  track_places();
  if (over()) result_.ended = "by the rules";
  const std::array<unsigned, 2> score = scores();
  if (match_.goals > 0 && score[0] + score[1] >= match_.goals)
    result_.ended = "by its goals";
  else if (match_.playing_s > 0 && result_.playing_s >= match_.playing_s && result_.ended.empty())
    result_.ended = "by its time";
  return result_.ended.empty();
}

void PlayedMatch::record(const std::string& file, const std::string& signals, const std::string& repeat) {
  simulation().record({.file = file, .signals = signals.empty() ? shown_signals : signals, .repeat = repeat});
}

void PlayedMatch::end_record() {
  const MatchResult& all = result();
  simulation().end_record({{"ended", all.ended},
                           {"home_goals", std::to_string(all.score[0])},
                           {"away_goals", std::to_string(all.score[1])}});
}

const MatchResult& PlayedMatch::result() {
  result_.simulated_s = 1e-9 * static_cast<double>(played_in_->time_ns());
  result_.state_hash = played_in_->state_hash();
  result_.messages_left = {referee_.match().message_budget(Side::home), referee_.match().message_budget(Side::away)};
  result_.score = scores();
  result_.robots.clear();
  for (Player& player : players_) {
    player.told.off_median_m = median(player.off_m);
    player.told.off_median_rad = median(player.off_rad);
    player.told.off_most_m = player.off_m.empty() ? 0 : std::ranges::max(player.off_m);
    result_.robots.push_back(player.told);
  }
  return result_;
}

std::vector<std::string> PlayedMatch::take_lines() { return std::exchange(lines_, {}); }

}  // namespace kadans::football
