// Offences that need a memory of the last seconds: pushing, holding the ball, arms, robots that are incapable.
//
// Source: HSL-Rules game.tex 3079e99 (and, where that was not read whole, 011a8f8): "Pushing", "Ball Holding", "Playing
// with Arms or Hands", "Incapable Robot". The official automatic referee does not judge these, so what a person sees is
// put in numbers here:
// - Pushing is contact of opponents after which one falls within 1 s, or that lasts for more than 5 s. The robot that
//   came nearer faster is the one that pushes; below 0.05 m/s it stands and cannot push. Front to front it must be
//   faster than the other by 0.2 m/s.
// - The time of holding runs back while the ball is free, as fast as it ran.
// - An attempt to get up has failed when it ends on the ground, or after 20 s.
#pragma once

#include <string>
#include <vector>

#include "positions.h"

namespace kadans::football {

struct Foul {
  RobotId robot;
  Penalty penalty = Penalty::none;
  bool gives_free_kick = false;  // to the others, when it happens near the ball
  std::string what;              // "holds the ball for more than 5 s"
};

class FoulJudge {
 public:
  explicit FoulJudge(const Field& field) : field_(field) {}

  // To be called in each step; the fouls of this step, each told once.
  const std::vector<Foul>& step(double step_s, const Match& match, const WorldTruth& world);
  // The robot was placed: what it did before is past.
  void forget(RobotId id);

 private:
  struct Track {
    bool known = false, was_upright = true, was_getting_up = false, used_arms = false, disturbed = false;
    Point at, velocity_m_s;
    double fallen_s = 0, attempt_s = 0, inactive_s = 0, hold_s = 0;
    int attempts = 0;  // that failed
  };
  struct Touching {
    RobotId a, b;
    double lasts_s = 0, gap_s = 0;
    double approach_a_m_s = 0, approach_b_m_s = 0;  // most, each toward the other
    bool front_to_front = false;
  };

  Track& track(RobotId id) { return tracks_.at(index_of(id.side)).at(id.index()); }
  void follow(double step_s, RobotId id, const RobotTruth& robot);
  void judge_pushing(double step_s, const Match& match, const WorldTruth& world);
  void note_contact(double step_s, const RobotContact& contact, const WorldTruth& world);
  void judge_fallen(double step_s, RobotId id, const RobotTruth& robot);
  void judge_ball(double step_s, const Match& match, RobotId id, const RobotTruth& robot);
  static std::optional<RobotId> pusher(const Touching& touching) noexcept;

  Field field_;
  std::array<std::array<Track, players_max>, 2> tracks_{};
  std::vector<Touching> touching_;
  std::vector<Foul> fouls_;
};

}  // namespace kadans::football
