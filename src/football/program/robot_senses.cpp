#include "robot_senses.h"

#include <algorithm>
#include <optional>

namespace kadans::football {
namespace {

constexpr double false_share = 0.05, landmark_missed = 0.4, line_missed = 0.3, line_least_m = 0.4;
constexpr double placed_sd_m = 0.1, placed_sd_rad = 0.1, penalised_sd_m = 0.5, penalised_sd_rad = 0.25;
constexpr double penalised_edge_m = 0.2;  // from the carpet's edge
constexpr double near_m = 0.3;            // what lies nearer is below the camera
constexpr double battery_least = 0.8;     // of what a battery lasts: the poorest one
constexpr double ball_sd_m = 0.03;
constexpr std::size_t ways_kept = 40;  // 0.8 s
constexpr std::int64_t self_every_ns = 1'000'000'000;
constexpr std::int64_t owes_ns = 500'000'000;  // who does not say what it was told to in that time, says nothing

std::uint32_t entry_of(const Catalog& catalog, const std::string& name) {
  return static_cast<std::uint32_t>(std::ranges::find(catalog.seen, name, &SeenInfo::name) - catalog.seen.begin());
}

}  // namespace

RobotSenses::RobotSenses(const MatchConfig& match, MatchWorld& played_in, std::size_t number, RobotId id,
                         std::uint64_t seed)
    : match_(match),
      played_in_(played_in),
      number_(number),
      id_(id),
      team_number_(static_cast<std::uint8_t>(1 + index_of(id.side))),
      field_(match.field()),
      markings_(markings_of(field_)),
      random_(seed, "football.senses of " + robot_name(id)),
      camera_scale_(random_.uniform(0.95, 1.05)),
      camera_rad_(random_.uniform(-0.03, 0.03)),
      localisation_({.field = field_, .seed = seed + number}),
      ball_entry_(entry_of(played_in.catalog(number), "ball")),
      ball_seen_entry_(entry_of(played_in.catalog(number), "ball_seen")),
      field_entry_(entry_of(played_in.catalog(number), "field")),
      game_entry_(entry_of(played_in.catalog(number), "game")),
      whistle_entry_(entry_of(played_in.catalog(number), "whistle")),
      me_entry_(entry_of(played_in.catalog(number), "me")),
      radio_entry_(entry_of(played_in.catalog(number), "radio")),
      battery_entry_(entry_of(played_in.catalog(number), "battery")),
      battery_s_(match.team(id.side).battery_s *
                 RandomStream(seed, "football.battery of " + robot_name(id)).uniform(battery_least, 1)),
      policy_({.game_messages = static_cast<double>(match.rules.messages)}) {
  for (std::size_t i = 1; i <= robots_told; ++i)
    robot_entries_.push_back(entry_of(played_in.catalog(number), "robot_" + std::to_string(i)));
  placed(place_before(match, id));
}

void RobotSenses::placed(const Pose2& place) {
  const double sd_m = match_.begins ? match_.begins->robots_scatter_m : 0;
  const double sd_rad = match_.begins ? match_.begins->robots_scatter_rad : 0;
  localisation_.place(std::span(&place, 1), std::max(placed_sd_m, sd_m), std::max(placed_sd_rad, sd_rad));
  late_views_.clear();
  ball_.forget();
}

// Along the odometry's path, which does not jump as localisation may. Told is what this picture shows; of one that does
// not fit nothing is.
void RobotSenses::note_ball(const Observation& seen) {
  const auto then = std::ranges::find_if(ways_, [&](const auto& one) { return one.first >= seen.time_ns; });
  if (then == ways_.end()) return;
  const Pose2& pose = then->second;
  const Point at{seen.fields[0], seen.fields[1]};
  const double time_s = 1e-9 * static_cast<double>(seen.time_ns);
  const double sd_m = ball_sd_m + std::hypot(match_.senses.distance_noise, match_.senses.bearing_noise_rad) * norm(at);
  if (!ball_.saw({time_s, from_frame(pose, at), sd_m})) return;
  const BallFilter::Estimate ball = ball_.estimate(time_s);
  if (!ball.known || ball.age_s > 0) return;
  const Point place = in_frame(pose, ball.at), velocity_m_s = turned(ball.velocity_m_s, -pose.theta_rad);
  Observation told{
      .entry = ball_entry_, .time_ns = seen.time_ns, .confidence = seen.confidence, .source = SeenSource::scenario};
  told.fields = {place.x_m, place.y_m, velocity_m_s.x_m, velocity_m_s.y_m};
  played_in_.observe(number_, told);
}

std::optional<RobotSenses::BallNow> RobotSenses::ball() const noexcept {
  const BallFilter::Estimate ball = ball_.estimate(1e-9 * static_cast<double>(now_ns()));
  if (!ball.known || ways_.empty()) return std::nullopt;
  return BallNow{in_frame(ways_.back().second, ball.at), ball.age_s};
}

void RobotSenses::tell(std::uint32_t entry, std::initializer_list<double> fields) {
  Observation observation{.entry = entry, .time_ns = now_ns(), .source = SeenSource::scenario};
  std::ranges::copy(fields, observation.fields.begin());
  played_in_.observe(number_, observation);
}

void RobotSenses::step(const WorldTruth& world, double sign) {
  const std::int64_t at_ns = now_ns();
  localisation_.odometry(1e-9 * static_cast<double>(at_ns), played_in_.odometry(number_));
  if (at_ns >= picture_due_ns_) {
    picture_due_ns_ = at_ns + std::llround(1e9 / match_.senses.rate_Hz);
    take_picture(world, sign);
  }
  for (; !late_views_.empty() && late_views_.front().due_ns <= at_ns; late_views_.pop_front())
    (void)localisation_.view(late_views_.front().view);
  for (; !late_.empty() && late_.front().due_ns <= at_ns; late_.pop_front())
    played_in_.observe(number_, late_.front().observation);
  tell_place();
  ways_.emplace_back(at_ns, played_in_.odometry(number_));
  while (ways_.size() > ways_kept) ways_.pop_front();
  for (const Observation& seen : played_in_.take_observed(number_)) {
    if (seen.entry == ball_seen_entry_) note_ball(seen);
  }
  tell_self();
  advise(world.robot(id_).upright);
}

MessagePolicy::Known RobotSenses::message(bool upright) const {
  MessagePolicy::Known told{.fallen = !upright, .pose = belief_.pose};
  const BallFilter::Estimate seen = ball_.estimate(1e-9 * static_cast<double>(now_ns()));
  if (!seen.known || ways_.empty()) return told;
  const Pose2& way = ways_.back().second;
  told.ball = BallBelief{.at = from_frame(belief_.pose, in_frame(way, seen.at)),
                         .velocity_m_s = turned(seen.velocity_m_s, belief_.pose.theta_rad - way.theta_rad),
                         .sd_m = seen.sd_m,
                         .age_s = seen.age_s};
  return told;
}

MessagePolicy::Situation RobotSenses::situation() const noexcept {
  MessagePolicy::Situation now{.now_s = 1e-9 * static_cast<double>(now_ns())};
  now.players = static_cast<unsigned>(match_.team(id_.side).players);
  if (!game_) return now;
  now.state = game_->state;
  now.phase = game_->phase;
  now.remaining_s = game_->remaining_s + (game_->first_half ? match_.rules.half_s : 0);
  now.budget_left = game_->team(team_number_)->message_budget;
  now.budget_age_s = 1e-9 * static_cast<double>(now_ns() - game_heard_ns_);
  return now;
}

// The decisions are told when to say something, and how much they may still say. What they say unasked is counted.
void RobotSenses::advise(bool upright) {
  if (match_.team(id_.side).players < 2) return;
  const MessagePolicy::Situation now = situation();
  if (now_ns() - said_ns_ > owes_ns) owes_ = false;
  for (const std::uint64_t sent = played_in_.messages(number_); sent_ < sent; ++sent_) {
    if (!std::exchange(owes_, false)) policy_.sent(message(upright), now);
  }
  const bool plays = penalty_ == Penalty::none && game_ && !game_->stopped &&
                     (game_->state == GameState::set || game_->state == GameState::playing);
  const bool say = plays && policy_.send(message(upright), now);
  if (say) ++said_, owes_ = true, said_ns_ = now_ns();
  if (!say && now_ns() < radio_due_ns_) return;
  radio_due_ns_ = now_ns() + self_every_ns;
  tell(radio_entry_, {static_cast<double>(said_), std::max(policy_.allowed(now), 0.0)});
}

void RobotSenses::tell_place() {
  belief_ = localisation_.estimate();
  const Pose2 centre = in_frame(belief_.pose, Pose2{});
  tell(field_entry_, {centre.x_m, centre.y_m, centre.theta_rad, belief_.known ? 1.0 : 0.0});
}

void RobotSenses::tell_self() {
  if (now_ns() < self_due_ns_) return;
  self_due_ns_ = now_ns() + self_every_ns;
  const TeamSetup& team = match_.team(id_.side);
  tell(me_entry_,
       {static_cast<double>(id_.number), static_cast<double>(team.keeper), static_cast<double>(team.players),
        field_.length_m, field_.width_m, field_.goal.width_m, field_.circle_radius_m, field_.penalty_mark_m});
  if (battery_s_ > 0) tell(battery_entry_, {std::max(0.0, 1 - 1e-9 * static_cast<double>(now_ns()) / battery_s_)});
}

void RobotSenses::hear(Bytes packet) {
  const Checked<GameControl> read = read_game_control(packet);
  if (!read.value) return;
  const GameControl& control = *read.value;
  const TeamEntry* own = control.team(team_number_);
  const TeamEntry* others = control.team(static_cast<std::uint8_t>(3 - team_number_));
  if (own == nullptr || others == nullptr) return;
  game_ = control;
  game_heard_ns_ = now_ns();
  const Penalty penalty = own->robots.at(id_.index()).penalty;
  if (penalty != penalty_ && penalty != Penalty::none && penalty != Penalty::motion_in_set) {
    // It was carried to one of the touchlines, level with its own penalty mark, and faces the field.
    const double y_m = field_.width_m / 2 + field_.border_m - penalised_edge_m;
    const std::array<Pose2, 2> places{Pose2{-field_.penalty_mark_x_m(), y_m, -std::numbers::pi / 2},
                                      Pose2{-field_.penalty_mark_x_m(), -y_m, std::numbers::pi / 2}};
    localisation_.place(places, penalised_sd_m, penalised_sd_rad);
    late_views_.clear();
    ball_.forget();
  }
  penalty_ = penalty;
  const double ours = control.kicking_team == no_team ? -1 : control.kicking_team == team_number_ ? 1 : 0;
  tell(game_entry_, {static_cast<double>(control.state), static_cast<double>(control.set_play), ours,
                     control.stopped ? 1.0 : 0.0, static_cast<double>(penalty),
                     static_cast<double>(control.remaining_s), static_cast<double>(control.secondary_s),
                     static_cast<double>(own->score) - static_cast<double>(others->score)});
}

void RobotSenses::hear_whistle() {
  ++whistles_;
  tell(whistle_entry_, {static_cast<double>(whistles_)});
}

bool RobotSenses::sees(const Point& at) const noexcept {
  const double far_m = norm(at);
  return far_m > near_m && far_m < match_.senses.far_m &&
         std::abs(std::atan2(at.y_m, at.x_m)) < match_.senses.view_rad / 2;
}

Point RobotSenses::noisy(const Point& at) {
  const double far_m =
      norm(at) * (camera_scale_ + match_.senses.distance_noise * random_.normal()) + 0.03 * random_.normal();
  const double bearing_rad =
      std::atan2(at.y_m, at.x_m) + camera_rad_ + match_.senses.bearing_noise_rad * random_.normal();
  return turned({far_m, 0.02 * random_.normal()}, bearing_rad);
}

Point RobotSenses::nothing() {
  const double half_rad = match_.senses.view_rad / 2;
  return turned({random_.uniform(0.5, match_.senses.far_m), 0}, random_.uniform(-half_rad, half_rad));
}

void RobotSenses::see_landmark(FieldView& view, const Pose2& camera, LandmarkKind kind, const Point& on_field) {
  const Point at = in_frame(camera, on_field);
  if (!sees(at) || random_.uniform() < landmark_missed) return;
  if (random_.uniform() < false_share)
    view.landmarks.push_back({static_cast<LandmarkKind>(random_.next() % 6), nothing()});
  else
    view.landmarks.push_back({kind, noisy(at)});
}

void RobotSenses::see_line(FieldView& view, const Pose2& camera, const Segment& on_field) {
  constexpr int pieces = 30;
  std::optional<Segment> seen;
  for (int i = 0; i <= pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    const Point at = in_frame(camera, on_field.from + share * (on_field.to - on_field.from));
    if (!sees(at)) continue;
    if (!seen) seen = Segment{at, at};
    seen->to = at;
  }
  if (!seen || distance(seen->from, seen->to) < line_least_m || random_.uniform() < line_missed) return;
  if (random_.uniform() < false_share) seen = Segment{nothing(), nothing()};
  view.lines.push_back({noisy(seen->from), noisy(seen->to)});
}

void RobotSenses::take_picture(const WorldTruth& world, double sign) {
  const RobotTruth& self = world.robot(id_);
  if (!self.upright) return;
  const Pose2 camera = world_pose(self.pose, sign);  // in the team's frame: a half turn is its own inverse
  see_robots(world);
  if (!match_.senses.field_seen) return;
  FieldView view{1e-9 * static_cast<double>(now_ns()), {}, {}};
  for (const Crossing& crossing : markings_.crossings)
    see_landmark(view, camera, static_cast<LandmarkKind>(crossing.kind), crossing.at);
  for (const Point& post : markings_.posts) see_landmark(view, camera, LandmarkKind::post, post);
  for (const Point& mark : markings_.marks) see_landmark(view, camera, LandmarkKind::mark, mark);
  see_landmark(view, camera, LandmarkKind::circle, {});
  for (const Segment& line : markings_.lines) see_line(view, camera, line);
  const std::int64_t due_ns = now_ns() + std::llround(1e9 * match_.senses.latency_s);
  late_views_.push_back({due_ns, std::move(view)});
}

void RobotSenses::see_robots(const WorldTruth& world) {
  struct Near {
    Point at;
    bool mate;
  };
  std::vector<Near> near;
  const Pose2& self = world.robot(id_).pose;
  for (const RobotId other : all_robots()) {
    const RobotTruth& robot = world.robot(other);
    if (other == id_ || !robot.present) continue;
    const Point at = in_frame(self, robot.pose.at());
    if (sees(at) && !(random_.uniform() < match_.senses.missed)) near.push_back({noisy(at), other.side == id_.side});
  }
  std::ranges::sort(near, {}, [](const Near& one) { return norm(one.at); });
  const std::int64_t due_ns = now_ns() + std::llround(1e9 * match_.senses.latency_s);
  for (std::size_t i = 0; i < std::min(near.size(), robot_entries_.size()); ++i) {
    Observation seen{.entry = robot_entries_[i], .time_ns = now_ns(), .source = SeenSource::scenario};
    seen.fields = {near[i].at.x_m, near[i].at.y_m, near[i].mate ? 1.0 : 0.0};
    late_.push_back({due_ns, seen});
  }
}

}  // namespace kadans::football
