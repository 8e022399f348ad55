#include "match.h"

#include <algorithm>

namespace kadans::football {
namespace {

std::int64_t ns(double seconds) noexcept { return std::llround(seconds * 1e9); }

// The game controller tells times rounded up to whole seconds.
std::int16_t whole_seconds(std::int64_t time_ns) noexcept {
  const std::int64_t second_ns = 1'000'000'000;
  const std::int64_t up = time_ns > 0 ? (time_ns + second_ns - 1) / second_ns : time_ns / second_ns;
  return static_cast<std::int16_t>(std::clamp<std::int64_t>(up, -32768, 32767));
}

SetPlay told(Restart restart) noexcept {
  switch (restart) {
    case Restart::direct_free_kick:
      return SetPlay::direct_free_kick;
    case Restart::indirect_free_kick:
      return SetPlay::indirect_free_kick;
    case Restart::penalty_kick:
      return SetPlay::penalty_kick;
    case Restart::throw_in:
      return SetPlay::throw_in;
    case Restart::goal_kick:
      return SetPlay::goal_kick;
    case Restart::corner:
      return SetPlay::corner;
    default:
      return SetPlay::none;
  }
}

// Offences that make a team's later penalties longer.
bool is_counted(Penalty penalty) noexcept {
  switch (penalty) {
    case Penalty::illegal_positioning:
    case Penalty::motion_in_set:
    case Penalty::local_game_stuck:
    case Penalty::incapable_robot:
    case Penalty::pick_up:
      return false;
    default:
      return true;
  }
}

bool ends_by_itself(Penalty penalty) noexcept {
  return penalty != Penalty::none && penalty != Penalty::sent_off && penalty != Penalty::substitute;
}

}  // namespace

const char* name_of(Restart restart) noexcept {
  switch (restart) {
    case Restart::kick_off:
      return "kick-off";
    case Restart::dropped_ball:
      return "dropped ball";
    default:
      return name_of(told(restart)).data();
  }
}

Match::Match(const Setup& setup) : setup_(setup), home_defends_left_(setup.home_defends_left) {
  for (TeamSide& side : sides_) {
    side.messages = setup.rules.messages;
    for (std::size_t i = setup.rules.players_per_team; i < players_max; ++i)
      side.robots.at(i).penalty = Penalty::substitute;
  }
  begin_half(true);
}

void Match::enter(GameState state) noexcept {
  now_.state = state;
  now_.stopped = false;
  state_since_ns_ = play_time_ns_;
}

void Match::begin_half(bool first) {
  first_half_ = first;
  kicked_off_ = false;
  remaining_ns_ = ns(setup_.rules.half_s);
  enter(GameState::initial);
  now_.restart = Restart::kick_off;
  now_.kicking = first ? setup_.first_kick_off : other(setup_.first_kick_off);
  now_.secondary_ns = 0;
  set_left_ns_ = ns(setup_.rules.initial_s);
}

void Match::begin_ready(Restart restart, std::optional<Side> side) {
  reveal();
  enter(GameState::ready);
  now_.restart = restart;
  now_.kicking = side;
  now_.secondary_ns =
      ns(restart == Restart::penalty_kick ? setup_.rules.penalty_kick_ready_s : setup_.rules.kick_off_ready_s);
}

void Match::enter_set() {
  enter(GameState::set);
  now_.secondary_ns = 0;
  set_left_ns_ = ns(setup_.rules.set_s);
}

void Match::play() {
  hidden_ = now_;
  hidden_left_ns_ = ns(setup_.rules.hidden_playing_s);
  hidden_remaining_ns_ = remaining_ns_;
  hidden_clock_stands_ = !kicked_off_;
  kicked_off_ = true;
  enter(GameState::playing);
  now_.secondary_ns = 0;
  if (now_.restart == Restart::kick_off) now_.secondary_ns = ns(setup_.rules.kick_off_free_s);
  if (now_.restart == Restart::penalty_kick) now_.secondary_ns = ns(setup_.rules.penalty_kick_s);
  if (now_.restart == Restart::dropped_ball) now_.restart = Restart::none;  // in play at once
}

void Match::begin_free_kick(Restart restart, Side side) {
  reveal();
  now_.restart = restart;
  now_.kicking = side;
  now_.secondary_ns = ns(setup_.rules.set_play_s);
  now_.stopped = true;
  stop_left_ns_ = ns(setup_.rules.stop_s);
}

void Match::free_ball() {
  now_.restart = Restart::none;
  now_.kicking.reset();
  now_.secondary_ns = 0;
}

void Match::count_goal(Side side) {
  reveal();
  TeamSide& scored = sides_.at(index_of(side));
  if (scored.goals_count) ++scored.score;
  const int ahead = static_cast<int>(scored.score) - static_cast<int>(score(other(side)));
  if (ahead >= setup_.rules.mercy_difference) {
    first_half_ = false;
    return finish_half();
  }
  begin_ready(Restart::kick_off, other(side));
}

void Match::finish_half() {
  reveal();
  for (TeamSide& side : sides_) {
    for (Entry& robot : side.robots) {
      if (ends_by_itself(robot.penalty)) robot = {};
    }
  }
  enter(GameState::finished);
  free_ball();
  if (first_half_) now_.secondary_ns = ns(setup_.rules.break_s);
}

void Match::penalise(RobotId robot, Penalty penalty) {
  TeamSide& side = sides_.at(index_of(robot.side));
  const double whole_s = penalty == Penalty::motion_in_set
                             ? setup_.rules.in_place_s
                             : setup_.rules.removal_s + setup_.rules.removal_more_s * side.offences;
  entry(robot) = {penalty, ns(whole_s), ns(whole_s)};
  if (is_counted(penalty)) ++side.offences;
}

void Match::restart_penalty(RobotId robot) noexcept { entry(robot).left_ns = entry(robot).whole_ns; }

void Match::count_message(Side side, std::size_t bytes) noexcept {
  if (!runs()) return;
  TeamSide& team = sides_.at(index_of(side));
  if (bytes > 512 || team.messages == 0) {
    team.goals_count = false;
    team.score = 0;
  }
  if (team.messages > 0) --team.messages;
}

void Match::advance_penalties(std::int64_t step_ns, Passed& passed) {
  const bool run = (now_.state == GameState::ready || now_.state == GameState::playing) && !now_.stopped;
  if (!run) return;
  for (const Side side : both_sides) {
    for (std::uint8_t number = 1; number <= players_max; ++number) {
      Entry& robot = entry({side, number});
      if (!ends_by_itself(robot.penalty)) continue;
      robot.left_ns -= step_ns;
      if (robot.left_ns > 0) continue;
      robot = {};
      passed.free_again.push_back({side, number});
    }
  }
}

// The teams change sides at half of the break.
void Match::advance_break(std::int64_t before_ns, Passed& passed) {
  const std::int64_t half_ns = ns(setup_.rules.break_s / 2);
  if (before_ns > half_ns && now_.secondary_ns <= half_ns) {
    home_defends_left_ = !home_defends_left_;
    passed.sides_changed = true;
  }
  if (now_.secondary_ns > 0) return;
  begin_half(false);
  passed.break_is_over = true;
}

Match::Passed Match::advance(std::int64_t step_ns) {
  Passed passed;
  time_ns_ += step_ns;
  if (over()) return passed;
  const bool clock_runs = now_.state == GameState::playing ||
                          ((now_.state == GameState::ready || now_.state == GameState::set) && kicked_off_);
  if (clock_runs) remaining_ns_ -= step_ns;
  if (hidden_) {
    hidden_left_ns_ -= step_ns;
    if (hidden_left_ns_ <= 0) reveal();
  }
  advance_penalties(step_ns, passed);
  if (now_.stopped) {
    stop_left_ns_ -= step_ns;
    if (stop_left_ns_ > 0) return passed;
    now_.stopped = false;
    passed.resumed = true;
    return passed;
  }
  play_time_ns_ += step_ns;
  const std::int64_t before_ns = now_.secondary_ns;
  if (now_.secondary_ns > 0) now_.secondary_ns -= step_ns;
  switch (now_.state) {
    case GameState::initial:
      set_left_ns_ -= step_ns;
      if (set_left_ns_ <= 0) begin_ready(now_.restart, now_.kicking);
      break;
    case GameState::ready:
      passed.ready_is_over = now_.secondary_ns <= 0;
      break;
    case GameState::set:
      set_left_ns_ -= step_ns;
      passed.set_is_over = set_left_ns_ <= 0;
      break;
    case GameState::playing:
      passed.set_play_is_over = now_.restart != Restart::none && now_.secondary_ns <= 0;
      break;
    case GameState::finished:
      advance_break(before_ns, passed);
      break;
  }
  return passed;
}

GameControl Match::control(ControlReader reader) noexcept {
  const bool hides = reader == ControlReader::player && hidden_.has_value();
  const Now& now = hides ? *hidden_ : now_;
  GameControl control;
  control.packet_number = packet_number_++;
  control.players_per_team = static_cast<std::uint8_t>(setup_.rules.players_per_team);
  control.competition_type = setup_.rules.competition_type;
  control.stopped = now.stopped;
  control.state = now.state;
  control.set_play = told(now.restart);
  control.first_half = first_half_;
  control.kicking_team = now.kicking ? team(*now.kicking).number : no_team;
  control.remaining_s = whole_seconds(hides && hidden_clock_stands_ ? hidden_remaining_ns_ : remaining_ns_);
  control.secondary_s = whole_seconds(now.secondary_ns);
  for (std::size_t i = 0; i < 2; ++i) {
    const Side side = (i == 0) == home_defends_left_ ? Side::home : Side::away;  // [0] defends the left goal
    const TeamSide& state = sides_.at(index_of(side));
    TeamEntry& entry = control.teams.at(i);
    entry.number = team(side).number;
    entry.colour = team(side).colour;
    entry.keeper_colour = team(side).keeper_colour;
    entry.keeper = team(side).keeper;
    entry.score = static_cast<std::uint8_t>(std::min(state.score, 255U));
    entry.message_budget = static_cast<std::uint16_t>(state.messages);
    for (std::size_t robot = 0; robot < players_max; ++robot) {
      entry.robots.at(robot).penalty = state.robots.at(robot).penalty;
      entry.robots.at(robot).penalty_left_s =
          static_cast<std::uint8_t>(std::clamp<int>(whole_seconds(state.robots.at(robot).left_ns), 0, 255));
    }
  }
  return control;
}

}  // namespace kadans::football
