// What one robot of a simulated match perceives, and what it makes of it: where it is on the field, who
// is near, what the game controller and the whistle say. It goes to the robot's world model, which its decisions read.
//
// The camera is mounted a little askew. It sees lines, crossings, posts, marks and the circle of the field late, with
// noise, with misses and with things that are not there; Localisation (localisation.h) makes a place of that and of the
// robot's own odometry. The robot knows that a person carried it from what the game controller says: nothing else tells
// it.
//
// The ball comes from the world's simulated perception, picture by picture; BallFilter makes of that where it is and
// how it rolls, and leaves out what is not it.
//
// When a message to its mates is worth its price is MessagePolicy's to say; what it says is the decisions'.
//
// All random numbers come from streams of the run's seed. One thread, no physics.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "football/ball_filter.h"
#include "football/localisation.h"
#include "football/message_policy.h"
#include "football/positions.h"
#include "match_world.h"

namespace kadans::football {

class RobotSenses {
 public:
  // The robot with this number of the simulation. Keeps references.
  RobotSenses(const MatchConfig& match, MatchWorld& played_in, std::size_t number, RobotId id, std::uint64_t seed);

  // To be called at 50 Hz. `sign`: of the team (Match::sign).
  void step(const WorldTruth& world, double sign);
  // The game controller's packet, as it comes: refused when it is malformed.
  void hear(Bytes packet);
  void hear_whistle();
  // People put it to its place before a half: it knows where that is, in its team's frame.
  void placed(const Pose2& place);

  const Localisation::Estimate& belief() const noexcept { return belief_; }  // in its team's frame
  // Where its ball is, from where it stands, and how old that is; nothing while it knows of none.
  struct BallNow {
    Point at;
    double age_s = 0;
  };
  std::optional<BallNow> ball() const noexcept;

 private:
  struct Late {
    std::int64_t due_ns = 0;
    Observation observation;
  };
  struct LateView {
    std::int64_t due_ns = 0;
    FieldView view;
  };

  void take_picture(const WorldTruth& world, double sign);
  void see_landmark(FieldView& view, const Pose2& camera, LandmarkKind kind, const Point& on_field);
  void see_line(FieldView& view, const Pose2& camera, const Segment& on_field);
  void see_robots(const WorldTruth& world);
  void note_ball(const Observation& seen);
  void tell_place();
  void tell_self();
  void advise(bool upright);
  MessagePolicy::Known message(bool upright) const;
  MessagePolicy::Situation situation() const noexcept;
  std::int64_t now_ns() const noexcept { return played_in_.time_ns() - played_in_.period_ns(); }  // of the last tick
  void tell(std::uint32_t entry, std::initializer_list<double> fields);
  bool sees(const Point& at) const noexcept;
  Point noisy(const Point& at);
  Point nothing();

  const MatchConfig& match_;
  MatchWorld& played_in_;
  std::size_t number_;
  RobotId id_;
  std::uint8_t team_number_;
  Field field_;
  Markings markings_;
  RandomStream random_;
  double camera_scale_, camera_rad_;  // how askew the camera is mounted
  Localisation localisation_;
  Localisation::Estimate belief_;
  BallFilter ball_{{}};
  std::deque<std::pair<std::int64_t, Pose2>> ways_;  // where its odometry had it, for pictures that come late
  std::deque<Late> late_;
  std::deque<LateView> late_views_;
  std::int64_t picture_due_ns_ = 0, self_due_ns_ = 0;
  std::uint32_t ball_entry_, ball_seen_entry_, field_entry_, game_entry_, whistle_entry_, me_entry_, radio_entry_,
      battery_entry_;
  double battery_s_;  // that its battery lasts; 0: it tells nothing
  std::vector<std::uint32_t> robot_entries_;
  std::uint32_t whistles_ = 0;
  Penalty penalty_ = Penalty::none;
  MessagePolicy policy_;
  std::optional<GameControl> game_;  // the newest packet, and when it came
  std::int64_t game_heard_ns_ = 0, radio_due_ns_ = 0, said_ns_ = 0;
  std::uint64_t sent_ = 0, said_ = 0;  // messages so far; how often it was told to say something
  bool owes_ = false;                  // it was told to, and has not yet
};

}  // namespace kadans::football
