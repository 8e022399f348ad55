// A match that is played: the simulation of its robots, the automatic referee on simulated time, and the people around
// the field, who place ball and robots as the referee says. What robots know of the game comes to them as the game
// controller's packets, byte by byte; what they tell each other goes over a simulated network, and counts.
//
// The same match file, team folders and seed give the same match, bit for bit. One thread.
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
  double upright_s = 0, played_s = 0, still_max_s = 0;  // in play: the longest time without moving
  double off_median_m = 0, off_most_m = 0;              // of where it thinks to be, while playing
};

struct MatchResult {
  std::string match;
  std::uint64_t seed = 0;
  std::string ended;  // "by the rules", "by its goals", "by its time", or what went wrong
  std::array<unsigned, 2> score{};
  double simulated_s = 0, playing_s = 0;
  std::uint64_t state_hash = 0;
  std::vector<Decision> decisions;
  std::vector<PlayedRobot> robots;
};

class PlayedMatch {
 public:
  // Throws InputError: a team's files, a robot's.
  PlayedMatch(const MatchConfig& match, std::uint64_t seed);

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
    std::optional<SignalId> sent;  // the signal that counts its messages, where it has mates
    bool was_upright = true;
    Pose2 still;
    double still_s = 0, joints_still_s = 0;
    std::vector<double> off_m;
    // Since the referee looked last.
    bool touched_ball = false, touched_with_arms = false, touched_robot = false;
  };

  void note_touches();
  void look();
  void note_contacts();
  void heed(const RefereeReport& report);
  void tell_players(bool at_once);
  void prepare_half();
  void measure(Player& player);
  void track_places();
  void note_lines();

  MatchConfig match_;
  Simulation simulation_;
  Referee referee_;
  std::vector<Player> players_;
  WorldTruth world_;
  std::size_t ball_;
  double ball_radius_m_;
  MatchResult result_;
  std::vector<std::string> lines_;
  std::string track_;
  std::int64_t track_due_ns_ = 0;
  std::int64_t packet_due_ns_ = 0;
  GameState state_ = GameState::initial;
  bool stopped_ = false, left_ = true;
};

}  // namespace kadans::football
