// A match as the game controller keeps it: states, clocks, set plays, penalties, scores, messages, and the packets that
// tell of them. It only counts and obeys; who touched what is the referee's (referee.h).
//
// Sources: RoboCup-HumanoidSoccerLeague/GameController 6.0.1 (30a47f8), game_controller_core: states, timers and when
// they run; HSL-Rules game.tex and variables.tex 3079e99 for the durations. Where they differ the rules are kept:
// penalties of 45 s and 10 s more for each earlier offence that counts, 15 s in place; the half's clock runs on in a
// brief stop. A person decides on extra time, shoot-outs, timeouts, substitutes and cautions: they are not here.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "game_control.h"

namespace kadans::football {

enum class Side : std::uint8_t { home, away };
inline constexpr std::array<Side, 2> both_sides{Side::home, Side::away};
inline Side other(Side side) noexcept { return side == Side::home ? Side::away : Side::home; }
inline std::size_t index_of(Side side) noexcept { return static_cast<std::size_t>(side); }

struct RobotId {
  Side side = Side::home;
  std::uint8_t number = 1;

  std::size_t index() const noexcept { return number - 1U; }
  friend bool operator==(const RobotId&, const RobotId&) = default;
};

// How play begins again. The protocol knows no kick-off: it is sent as set play 0 with a kicking team.
enum class Restart : std::uint8_t {
  none,
  kick_off,
  dropped_ball,  // a kick-off that no team has
  direct_free_kick,
  indirect_free_kick,
  penalty_kick,
  throw_in,
  goal_kick,
  corner
};
const char* name_of(Restart restart) noexcept;

struct MatchRules {
  unsigned players_per_team = 5;
  std::uint8_t competition_type = 1;  // as in the packet
  double initial_s = 5;               // before each half
  double half_s = 600, break_s = 600;
  double kick_off_ready_s = 45, kick_off_free_s = 10;
  double penalty_kick_ready_s = 45, penalty_kick_s = 60;
  double set_play_s = 45;
  double set_s = 5;        // in set, until the whistle
  double early_set_s = 5;  // ready ends when nobody moved for so long
  double stop_s = 3;       // of a stop for a free kick: the ball is placed meanwhile
  double removal_s = 45, removal_more_s = 10, in_place_s = 15;
  double hidden_playing_s = 10;  // so long the players' packets still say set after the whistle
  double half_more_max_s = 10;   // that a half goes on while the ball rolls
  int mercy_difference = 10;
  std::uint16_t messages = 12000;
};

struct MatchTeam {
  std::uint8_t number = 1;
  TeamColour colour = TeamColour::blue, keeper_colour = TeamColour::green;
  std::uint8_t keeper = 1;  // 0: none
};

class Match {
 public:
  struct Setup {
    MatchRules rules;
    std::array<MatchTeam, 2> teams{MatchTeam{.number = 1}, MatchTeam{.number = 2, .colour = TeamColour::red}};
    Side first_kick_off = Side::home;
    bool home_defends_left = true;  // in the first half
  };
  // What clocks did in a step.
  struct Passed {
    bool ready_is_over = false, set_is_over = false, set_play_is_over = false, resumed = false;
    bool sides_changed = false, break_is_over = false;
    std::vector<RobotId> free_again;  // their penalties are over
  };

  explicit Match(const Setup& setup);

  const MatchRules& rules() const noexcept { return setup_.rules; }
  const MatchTeam& team(Side side) const noexcept { return setup_.teams.at(index_of(side)); }
  std::int64_t time_ns() const noexcept { return time_ns_; }
  std::int64_t play_time_ns() const noexcept { return play_time_ns_; }  // stands still while play is stopped
  GameState state() const noexcept { return now_.state; }
  bool stopped() const noexcept { return now_.stopped; }
  bool first_half() const noexcept { return first_half_; }
  // Ready, set or playing.
  bool runs() const noexcept {
    return now_.state == GameState::ready || now_.state == GameState::set || now_.state == GameState::playing;
  }
  bool over() const noexcept { return now_.state == GameState::finished && !first_half_; }
  Restart restart() const noexcept { return now_.restart; }
  std::optional<Side> kicking() const noexcept { return now_.kicking; }
  double remaining_s() const noexcept { return static_cast<double>(remaining_ns_) * 1e-9; }
  double secondary_s() const noexcept { return static_cast<double>(now_.secondary_ns) * 1e-9; }
  // Since a free kick's 45 s began.
  double set_play_age_s() const noexcept { return setup_.rules.set_play_s - secondary_s(); }
  double state_age_s() const noexcept { return static_cast<double>(play_time_ns_ - state_since_ns_) * 1e-9; }
  unsigned score(Side side) const noexcept { return sides_.at(index_of(side)).score; }
  Penalty penalty(RobotId robot) const noexcept { return entry(robot).penalty; }
  bool plays(RobotId robot) const noexcept { return penalty(robot) == Penalty::none; }
  double penalty_left_s(RobotId robot) const noexcept { return static_cast<double>(entry(robot).left_ns) * 1e-9; }
  unsigned message_budget(Side side) const noexcept { return sides_.at(index_of(side)).messages; }
  bool home_defends_left() const noexcept { return home_defends_left_; }
  // The left goal is at +x. Times a team's own x: positive toward the goal that it attacks.
  double sign(Side side) const noexcept { return (side == Side::home) == home_defends_left_ ? -1 : 1; }

  Passed advance(std::int64_t step_ns);

  // Each is called only where the rules let it happen; the referee sees to that.
  void begin_ready(Restart restart, std::optional<Side> side);  // kick_off, dropped_ball, penalty_kick
  void enter_set();
  void play();                                       // the whistle
  void begin_free_kick(Restart restart, Side side);  // while playing; play is stopped
  void free_ball();                                  // the set play is over
  void count_goal(Side side);                        // the kick-off for the other side begins, or the match is over
  void finish_half();
  void penalise(RobotId robot, Penalty penalty);  // one that plays
  void restart_penalty(RobotId robot) noexcept;   // its time begins anew
  // A team message was heard; too long a one, or one too many, takes the team's goals.
  void count_message(Side side, std::size_t bytes) noexcept;

  // As it is, for monitors, or as players are told: they learn of playing 10 s later, or by the whistle.
  GameControl control(ControlReader reader) noexcept;

 private:
  struct Entry {
    Penalty penalty = Penalty::none;
    std::int64_t left_ns = 0, whole_ns = 0;
  };
  struct TeamSide {
    unsigned score = 0, offences = 0, messages = 0;
    bool goals_count = true;
    std::array<Entry, players_max> robots{};
  };
  struct Now {  // what is hidden for a while
    GameState state = GameState::initial;
    bool stopped = false;
    Restart restart = Restart::none;
    std::optional<Side> kicking;
    std::int64_t secondary_ns = 0;
  };

  const Entry& entry(RobotId robot) const noexcept { return sides_.at(index_of(robot.side)).robots.at(robot.index()); }
  Entry& entry(RobotId robot) noexcept { return sides_.at(index_of(robot.side)).robots.at(robot.index()); }
  void enter(GameState state) noexcept;
  void reveal() noexcept { hidden_.reset(); }
  void begin_half(bool first);
  void advance_penalties(std::int64_t step_ns, Passed& passed);
  void advance_break(std::int64_t before_ns, Passed& passed);

  Setup setup_;
  std::int64_t time_ns_ = 0, play_time_ns_ = 0, state_since_ns_ = 0;
  std::int64_t remaining_ns_ = 0;
  std::int64_t stop_left_ns_ = 0, set_left_ns_ = 0;
  bool first_half_ = true, kicked_off_ = false, home_defends_left_ = true;
  Now now_;
  std::optional<Now> hidden_;
  std::int64_t hidden_left_ns_ = 0, hidden_remaining_ns_ = 0;
  bool hidden_clock_stands_ = false;
  std::array<TeamSide, 2> sides_{};
  std::uint8_t packet_number_ = 0;
};

}  // namespace kadans::football
