// Where two eyes on a neck shall turn so that both look at a point: one step of inverse kinematics, in joint
// velocities.
//
// The task is e, what is missing of each eye's pitch and yaw until its x axis points at the target, so four numbers;
// the joints' effect J on them comes from the geometry. Near the axis they are the image coordinates of visual servoing
// (Hutchinson, Hager and Corke 1996, IEEE Trans. Robotics and Automation 12(5)), but they also lead round from targets
// behind the head. The eyes share a tilt, so J has rank 3 at most and the solution is damped (Nakamura and Hanafusa
// 1986, J. Dyn. Sys. Meas. Control 108):
//
//   qd = W^-1 J^T (J W^-1 J^T + lambda^2 I)^-1 (K e + feed-forward of the target's velocity)  +  N (-k c q)
//
// W is small for the eyes: they go first. The null space N = I - J# J brings the joints back to 0, each with its own
// weight c: the neck follows and the eyes turn back into the middle, the gaze stays. It is not weighted by W, else the
// neck would follow too slowly. lambda rises where the eyes alone lose a direction.
//
// Limits: a joint that would pass its position limit is held at what brings it there, never faster than it can brake,
// and the others are solved for again (saturation in the null space; Flacco, De Luca and Khatib 2012, ICRA). Speed
// limits scale the task as a whole, so its direction stays; what is left of speed is for the null space. What cannot be
// reached ends at the least squares' nearest.
//
// Behavior thread; solve() does not allocate.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "kadans/model/kinematics.h"
#include "kadans/model/robot_model.h"

namespace kadans {

inline constexpr std::size_t gaze_joints_max = 12;

struct GazeLinks {
  std::size_t head = 0, left_eye = 0, right_eye = 0;  // joints that move the head are the neck's
};

class GazeSolver {
 public:
  struct JointLimits {
    double lower_rad = 0, upper_rad = 0, velocity_max_rad_s = 0;
  };
  struct JointLaw {
    double weight = 1;              // W: how dear its motion is
    double centring = 1;            // c
    double velocity_max_rad_s = 0;  // within the joint's
    double acceleration_max_rad_s2 = 100;
  };
  struct Settings {
    double gain_per_s = 0;                     // K
    double damping = 0, damping_singular = 0;  // lambda
    double null_per_s = 0;                     // k
  };
  struct Target {
    Vec3 point_m{}, velocity_m_s{};  // in the base frame
  };
  struct Solution {
    std::array<double, gaze_joints_max> velocity_rad_s{};
    // What each joint of the eyes must do for a neck joint that moves by 1, so that the gaze stays.
    std::array<std::array<double, gaze_joints_max>, gaze_joints_max> counter{};
    double left_rad = 0, right_rad = 0;  // angle between eye and target
    double progress = 1;                 // share of K e that the solution brings; about 0 where it cannot be reached
    bool scaled = false;                 // speed limits hold the task back
    bool at_limit = false;               // some joint stands at its position limit
  };

  // Keeps a reference to the model. Throws std::invalid_argument for a joint that moves neither eye or slides, and
  // for too many.
  GazeSolver(const RobotModel& model, const GazeLinks& links, const std::vector<std::size_t>& joints);

  std::size_t size() const noexcept { return joints_.size(); }
  std::size_t joint(std::size_t i) const noexcept { return joints_[i].joint; }  // in the model
  bool of_eye(std::size_t i) const noexcept { return joints_[i].of_eye; }
  JointLaw& law(std::size_t i) noexcept { return joints_[i].law; }
  Settings& settings() noexcept { return settings_; }
  const JointLimits& limits(std::size_t i) const noexcept { return joints_[i].limits; }

  // position_rad: of all joints of the model. False, and nothing changes, when something is not finite.
  [[nodiscard]] bool solve(const std::vector<double>& position_rad, const Target& target, Solution& solution) noexcept;
  // A point as far away as given, between the eyes' axes.
  Vec3 point_ahead(const std::vector<double>& position_rad, double distance_m) noexcept;

 private:
  using Task = Eigen::Matrix<double, 4, 1>;
  using Jacobian = Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::ColMajor, 4, static_cast<int>(gaze_joints_max)>;
  struct Part {
    std::size_t joint = 0;
    bool moves[2] = {false, false};  // the left and the right eye
    bool of_eye = false;
    JointLimits limits{};
    JointLaw law{};
  };
  struct Bounds {  // of a joint's velocity, so that it comes to its position limits softly
    double lowest_rad_s, highest_rad_s;
  };
  Bounds bounds(const Part& part, double position_rad) const noexcept;
  static double most_rad_s(const Part& part, double position_rad, double velocity_rad_s) noexcept;
  void see(const Target& target) noexcept;
  void go_round() noexcept;
  double damping2() const noexcept;
  void lead(const std::vector<double>& position_rad, double damping2, Solution& solution) const noexcept;
  void centre(const std::vector<double>& position_rad, double damping2, Solution& solution) const noexcept;
  void counter(double damping2, Solution& solution) const noexcept;

  const RobotModel* model_;
  Kinematics kinematics_;
  std::array<std::size_t, 2> eyes_;
  std::vector<Part> joints_;
  Settings settings_;
  Jacobian jacobian_;
  Task error_ = Task::Zero(), drift_ = Task::Zero();  // drift: what the target's velocity adds to it
  std::array<double, 2> angle_rad_{};
};

}  // namespace kadans
