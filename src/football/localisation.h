// Where a robot is on the field: a few Kalman filters side by side, each a hypothesis, from lines, their crossings,
// goal posts, marks, the centre circle and odometry.
//
// Delay: a hypothesis is the place of the odometry's frame on the field, which stands nearly still. A picture that is
// 60 ms old is compared with the odometry of its own time, so nothing has to be rolled back.
//
// Being carried: each hypothesis has a quality, the share of what is seen that it explains, filtered. When none
// explains enough, the robot is lost: what was seen in the last moments, laid together by odometry, is fitted to the
// field as a whole; two landmarks of it and two of the field with the same kinds and distance give a candidate, all
// others judge it.
//
// Symmetry: the field looks the same from its other end, so every candidate has a twin, and what is seen never decides
// between them. What does: robots that are carried are put down in their own half (HSL-Rules game.tex, Standard Removal
// Penalty: "so that the symmetry of the field can be resolved by the robot's localization system"); a robot that was
// not carried is near where it was.
//
// Frame: the team's: origin at the field's centre, x toward the goal that the team attacks. One thread. Memory is
// bounded; not for the control tick.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "field.h"
#include "kadans/signal/random.h"

namespace kadans::football {

enum class LandmarkKind : std::uint8_t { corner, tee, cross, post, mark, circle };  // circle: its centre

struct LandmarkSeen {
  LandmarkKind kind = LandmarkKind::corner;
  Point at;  // in the robot's frame: x forward, y left
};

struct FieldView {
  double time_s = 0;  // of the picture
  std::vector<LandmarkSeen> landmarks;
  std::vector<Segment> lines;  // pieces of lines, in the robot's frame
};

// Symmetric, of x, y and heading.
struct PoseCovariance {
  std::array<std::array<double, 3>, 3> m{};
};

class Localisation {
 public:
  struct Config {
    Field field;
    std::uint64_t seed = 1;  // of the search
    // Of what is seen, one standard deviation: along the line of sight and across it.
    double range_sd_m = 0.05, range_sd_per_m = 0.06;
    double bearing_sd_m = 0.03, bearing_sd_per_m = 0.03;
    double line_sd_m = 0.04, line_sd_per_m = 0.04, line_sd_rad = 0.06;
    // Of odometry, per metre and radian on the way, and per root second at rest.
    double way_sd = 0.15, turn_sd = 0.15, turn_sd_per_m = 0.12, rest_sd_m = 0.01, rest_sd_rad = 0.01;
    double lost_quality = 0.45, found_quality = 0.62;
    double memory_s = 2.5;  // of what was seen
  };
  struct Estimate {
    Pose2 pose;
    PoseCovariance covariance;
    double quality = 0;  // share of what is seen that is explained, 0..1
    bool known = false;  // false: lost, the pose is a guess
  };

  explicit Localisation(const Config& config);

  // It stands at one of these poses, as before a kick-off or at the touchline after a penalty. All else is forgotten.
  void place(std::span<const Pose2> poses, double sd_m, double sd_rad);
  // It was lifted and put down somewhere in its own half.
  void carried();

  // The robot's pose in the odometry's frame, at 20 Hz or faster; times grow.
  void odometry(double time_s, const Pose2& pose);
  // False: not taken, its time is not within the last second of odometry.
  bool view(const FieldView& view);

  Estimate estimate() const;  // at the time of the newest odometry

 private:
  struct Hypothesis {
    Pose2 frame;                // of the odometry, on the field
    PoseCovariance covariance;  // of the robot's pose
    double quality = 0.5;
    double settled_s = 0;    // from then on it is trusted
    bool right_end = false;  // it was compared with its twin then
  };
  struct Remembered {
    LandmarkKind kind;
    Point at;  // in the odometry's frame
    double time_s, range_m;
  };
  struct TimedPose {
    double time_s;
    Pose2 pose;
  };
  struct Candidate {
    Pose2 frame;
    double quality;
  };

  std::optional<Pose2> odometry_at(double time_s) const;
  void predict(Hypothesis& hypothesis, const Pose2& from, const Pose2& to, double passed_s) const;
  double update(Hypothesis& hypothesis, const FieldView& view, const Pose2& odometry) const;
  bool update_landmark(Pose2& pose, PoseCovariance& covariance, const LandmarkSeen& seen) const;
  bool update_line(Pose2& pose, PoseCovariance& covariance, const Segment& seen) const;
  void remember(const FieldView& view, const Pose2& odometry);
  void search(double time_s);
  double judge(const Pose2& frame) const;
  Pose2 with_right_end(const Pose2& frame) const;
  void drop_the_poor();
  const Hypothesis* best() const;

  Config config_;
  Markings markings_;
  std::array<std::vector<Point>, 6> landmarks_;  // by kind
  RandomStream random_;
  std::deque<TimedPose> past_;
  std::vector<Hypothesis> hypotheses_;
  std::deque<Remembered> memory_;
  std::optional<Pose2> last_known_;  // where it was when it last knew; none: it was carried
  Pose2 then_;                       // odometry of that time, or when it was put down
  double quality_was_good_s_ = 0, searched_s_ = -1e9;
};

}  // namespace kadans::football
