// A match that is played: the simulation of its robots, the automatic referee on simulated time, and the people around
// the field, who place ball and robots as the referee says. What robots know of the game comes to them as the game
// controller's packets, byte by byte; what they tell each other goes over a simulated network, and counts.
//
// The same match file, team folders and seed give the same match, bit for bit, in a simulation. In a world that is
// served over the wire, the same referee judges, or a game controller of somebody else's: then the people around the
// field do by its packets what they would do by its words, and nobody judges here. One thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "football/referee.h"
#include "robot_senses.h"

namespace kadans::football {

struct PlayedRobot {
  RobotId id;
  std::string name;
  std::uint64_t falls = 0, messages = 0, penalties = 0, errors = 0;
  std::string first_error;  // what it said of the first of its errors
  double upright_s = 0, played_s = 0;
  double still_max_s = 0;   // in play: the longest time without moving; one that waits for the ball counts, too
  double frozen_max_s = 0;  // of such a time, the most during which it had to move (PlayedMatch::has_to_move)
  double off_median_m = 0, off_most_m = 0, off_median_rad = 0;  // of where it thinks to be, while playing
};

struct MatchResult {
  std::string match;
  std::uint64_t seed = 0;
  std::string ended;  // "by the rules", "by its goals", "by its time", or what went wrong
  std::array<unsigned, 2> score{}, messages_left{};
  std::array<std::uint64_t, 2> over_budget{};  // messages that the budget did not have
  double simulated_s = 0, playing_s = 0;
  std::uint64_t state_hash = 0;
  std::vector<Decision> decisions;
  std::vector<PlayedRobot> robots;
};

class PlayedMatch {
 public:
  // In a simulation. Throws InputError: a team's files, a robot's.
  PlayedMatch(const MatchConfig& match, std::uint64_t seed);
  // In this world. `refereed_elsewhere`: by whose packets come there.
  PlayedMatch(const MatchConfig& match, std::uint64_t seed, std::unique_ptr<MatchWorld> played_in,
              bool refereed_elsewhere);

  // Before the first step, the record first (kadans/app/simulation.h): neither changes a bit of the match. `signals`:
  // "" takes what shows it. `repeat`: the command that plays it again. Throw InputError.
  void record(const std::string& file, const std::string& signals, const std::string& repeat);
  void show(std::uint16_t port) { simulation().show({.port = port}); }
  void end_record();  // after the last step; throws std::runtime_error when it is not complete

  // One referee's step of 20 ms. False: it is over.
  bool step();
  const MatchResult& result();
  // What was decided and said since the last call, each a line.
  std::vector<std::string> take_lines();
  // Where ball and robots were, and where each robot thought it was, five times a second; in the world's frame.
  const std::string& track() const noexcept { return track_; }

 private:
  struct Player {
    PlayedRobot told;
    std::unique_ptr<RobotSenses> senses;
    LinkSet arms;
    bool was_upright = true;
    Pose2 still;
    double still_s = 0, frozen_s = 0, joints_still_s = 0;
    std::vector<double> off_m, off_rad;
    // Since the referee looked last.
    bool touched_ball = false, touched_with_arms = false, touched_robot = false;
  };

  Simulation& simulation() noexcept { return static_cast<SimulatedMatch&>(*played_in_).simulation(); }
  GameState state() const noexcept { return elsewhere_ ? told_.state : referee_.match().state(); }
  bool stopped() const noexcept { return elsewhere_ ? told_.stopped : referee_.match().stopped(); }
  bool plays(RobotId id) const noexcept;
  double sign(Side side) const noexcept;       // Match::sign
  bool others_kick(Side side) const noexcept;  // a kick-off, free kick and so on, from which it keeps away
  bool over() const noexcept;
  std::array<unsigned, 2> scores() const noexcept;
  void note_touches();
  void look();
  void note_contacts();
  void heed(const RefereeReport& report);
  void tell_players(bool at_once);
  void follow();
  void follow(const GameControl& packet);
  void answer_referee();
  void prepare_half();
  bool has_to_move(const Player& player) const noexcept;
  void measure(Player& player);
  void track_places();
  void note_lines();

  MatchConfig match_;
  std::unique_ptr<MatchWorld> played_in_;
  bool elsewhere_;    // who judges
  GameControl told_;  // then the newest packet
  Referee referee_;
  std::vector<Player> players_;
  WorldTruth world_;
  std::size_t ball_;
  double ball_radius_m_;
  MatchResult result_;
  std::vector<std::string> lines_;
  std::string track_;
  std::int64_t track_due_ns_ = 0;
  std::int64_t packet_due_ns_ = 0, answer_due_ns_ = 0;
  GameState state_ = GameState::initial;
  bool stopped_ = false, left_ = true;
};

}  // namespace kadans::football
