// One step of inverse kinematics, in joint velocities: how two eyes on a neck turn so that both look at a point.
//
// The error e has four components: the pitch and the yaw by which each eye misses the target with its x axis. Its
// Jacobian J comes from the geometry. Near the axis the components are the image coordinates of visual servoing
// (Hutchinson, Hager and Corke 1996, IEEE Trans. Robotics and Automation 12(5)), but they also lead the eyes round to
// targets behind the head. The eyes share a tilt, so J has rank 3 at most and the solution is damped (Nakamura and
// Hanafusa 1986, J. Dyn. Sys. Meas. Control 108):
//
//   qd = W^-1 J^T (J W^-1 J^T + lambda^2 I)^-1 (K e + feed-forward of the target's velocity)  +  N (-k c q)
//
// W is small for the eyes, so they move first. The null space N = I - J# J brings the joints back to 0, each with its
// own weight c: the neck follows and the eyes turn back to their middle while the gaze stays. N is not weighted by W,
// because the neck would then follow too slowly. lambda rises where the eyes alone lose a direction.
//
// Limits: a joint that would pass its position limit is held at the velocity that brings it there, and the other joints
// are solved for again (saturation in the null space; Flacco, De Luca and Khatib 2012, ICRA). Speed limits, and the
// speed from which a joint can still brake before its position limit, scale the task as a whole, so that its direction
// stays. The null space gets the speed that is left. For a target that cannot be reached the eyes end at the nearest
// point in the sense of least squares.
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
  std::size_t head = 0, left_eye = 0, right_eye = 0;  // the neck is the joints that move the head
};

class GazeSolver {
 public:
  struct JointLimits {
    double lower_rad = 0, upper_rad = 0, velocity_max_rad_s = 0;
  };
  struct JointLaw {
    double weight = 1;              // W: the cost of its motion
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
    // C of gaze.cpp, [eye joint][neck joint]: the velocity of the eye joint that keeps the gaze while the neck joint
    // moves with 1 rad/s.
    std::array<std::array<double, gaze_joints_max>, gaze_joints_max> counter{};
    double left_rad = 0, right_rad = 0;  // angle between eye and target
    double progress = 1;                 // share of K e that the solution brings; about 0 when out of reach
    bool scaled = false;                 // speed limits hold the task back
    bool at_limit = false;               // some joint stands at its position limit
  };

  // Keeps a reference to the model. Throws std::invalid_argument for a joint that moves neither eye, for a prismatic
  // joint, and for more than gaze_joints_max joints.
  GazeSolver(const RobotModel& model, const GazeLinks& links, const std::vector<std::size_t>& joints);

  std::size_t size() const noexcept { return joints_.size(); }
  std::size_t joint(std::size_t i) const noexcept { return joints_[i].joint; }  // in the model
  bool of_eye(std::size_t i) const noexcept { return joints_[i].of_eye; }
  JointLaw& law(std::size_t i) noexcept { return joints_[i].law; }
  Settings& settings() noexcept { return settings_; }
  const JointLimits& limits(std::size_t i) const noexcept { return joints_[i].limits; }

  // position_rad: of all joints of the model. False, and nothing changes, when a value is not finite.
  [[nodiscard]] bool solve(const std::vector<double>& position_rad, const Target& target, Solution& solution) noexcept;
  // A point distance_m ahead of the eyes, in the middle between their axes.
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
  struct Bounds {  // of a joint's velocity, so that it approaches its position limits softly
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
  Task error_ = Task::Zero(), drift_ = Task::Zero();  // drift: the change of the error by the target's velocity
  std::array<double, 2> angle_rad_{};
};

}  // namespace kadans
