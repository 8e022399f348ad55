// The quadratic program of one behavior tick: which accelerations of the whole body, and which wrenches at the feet,
// follow the tasks best without breaking a constraint.
//
//   x = (dv, a wrench for each foot that stands)
//
// Constraints  the base's equations of motion (M dv + h = J' w); feet that stand do not move; joints that somebody else
//              drives do not accelerate; torques, speeds and positions of the joints stay within their limits; each
//              wrench stays within its friction pyramid and its centre of pressure within the sole's edges (Caron, Pham
//              and Nakamura 2015, ICRA, for the wrench as a whole); the capture point, over which the body can come to
//              rest, stays over the soles (Pratt et al. 2006, IEEE Humanoids; body_support.h), so that no task topples
//              it: what is asked for too quickly comes later.
// Minimised    the squares of what the tasks miss, by weight, in two levels: the second level gets what the first one
//              leaves (Kanoun, Lamiraux and Wieber 2011, IEEE T-RO 27(4)); the posture, and that joints come to rest;
//              and 1e-5 of the squares of accelerations and 1e-6 of those of wrenches (1e-4 of moments), which make the
//              problem strictly convex.
// Passive      joints follow their springs: what they miss is minimised too, because the foot that bears little tilts
//              before its spring gives way.
//
// A task asks for the acceleration a + 2 g (v - v_now) + g^2 (x - x_now) with its gain g (Del Prete et al. 2016, IEEE
// Humanoids, for this form).
//
// Behavior thread. Only the constructor allocates or throws.
#pragma once

#include "body_layout.h"
#include "body_model.h"
#include "body_support.h"
#include "quadratic_program.h"

namespace kadans {

struct BodyStand {   // of a foot
  double share = 1;  // of the load that it may bear: it goes to 0 before the foot is free
  Pose pose;         // where its frame is held
  bool stands() const noexcept { return share > 0; }
};

struct BodyRank {     // of a task
  double weight = 0;  // 0: left out
  int level = 1;      // 2: gets what those of 1 leave
};
struct BodyPosture {  // how the joints go to their own set-points
  double weight = 0, gain_per_s = 0;
};
using BodyRanks = std::array<BodyRank, body_tasks_max>;

class BodyProblem {
 public:
  explicit BodyProblem(const BodyLayout& layout);

  // True: acceleration(), effort_Nm and wrench are new.
  [[nodiscard]] bool solve(const BodyModel& model, const BodyAim& aim, const BodyRanks& ranks,
                           const BodyPosture& posture, const std::array<BodyStand, body_feet_max>& feet) noexcept;

  const Eigen::VectorXd& acceleration() const noexcept { return acceleration_; }
  double effort_Nm(std::size_t joint) const noexcept { return effort_Nm_[static_cast<Eigen::Index>(joint)]; }
  // Of a foot: force and moment about its frame, in the axes of the task frame; 0 of one that is free.
  const Eigen::Vector<double, 6>& wrench(std::size_t foot) const noexcept { return kept_[foot]; }
  // What stands when a later program has no solution.
  void pass_state(StateBytes& bytes) noexcept;
  QuadraticProgram::Status status() const noexcept { return status_; }
  int iterations() const noexcept { return iterations_; }

 private:
  struct Rows {  // of a task: jacobian * dv = wanted
    Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian;
    Eigen::Vector<double, 6> wanted;
    Eigen::Index count = 0;
    double weight = 0;
    int level = 0;  // 0: left out
  };
  void begin(const BodyModel& model, const BodyAim& aim, const BodyPosture& posture,
             const std::array<BodyStand, body_feet_max>& feet) noexcept;
  void motion_row(const BodyModel& model, Eigen::Index row, double lower, double upper) noexcept;
  void hold(const BodyModel& model, std::size_t foot, const BodyStand& stand) noexcept;
  void bear(const BodyModel& model, std::size_t foot, const BodyStand& stand, const BodySettings& s) noexcept;
  void balance(const BodyModel& model, const BodySettings& s,
               const std::array<BodyStand, body_feet_max>& feet) noexcept;
  void keep_within(Eigen::Index at, double position, double velocity, double lower, double upper,
                   double fastest) noexcept;
  void limit(const BodyModel& model, const BodySettings& s, const std::array<BodyStand, body_feet_max>& feet) noexcept;
  void spring(const BodyModel& model, const BodySettings& s) noexcept;
  void posture(const BodyModel& model, const BodyAim& aim, const BodyPosture& posture) noexcept;
  void find_tasks(const BodyModel& model, const BodyAim& aim, const BodyRanks& ranks,
                  const std::array<BodyStand, body_feet_max>& feet) noexcept;
  void lead_point(const BodyModel& model, const BodyAim& aim, std::size_t task) noexcept;
  void lead_turn(const BodyModel& model, const BodyAim& aim, std::size_t task) noexcept;
  void lead_look(const BodyModel& model, const BodyAim& aim, std::size_t task) noexcept;
  void add_level(int level) noexcept;
  void keep(const BodyModel& model) noexcept;

  const BodyLayout* layout_;
  QuadraticProgram program_;
  std::array<BodyModel::Jacobian, body_feet_max> foot_jacobian_;
  std::array<Eigen::Index, body_feet_max> wrench_{};  // where its wrench begins in x; 0: none
  std::array<Rows, body_tasks_max> tasks_;
  BodyModel::Jacobian jacobian_;
  Eigen::VectorXd acceleration_, effort_Nm_, row_;
  std::array<Eigen::Vector<double, 6>, body_feet_max> kept_{};
  QuadraticProgram::Status status_ = QuadraticProgram::Status::refused;
  int iterations_ = 0;
};

// The orientation that roll, pitch and yaw set-points ask for, and its angular velocity.
struct WantedTurn {
  Quat orientation;
  Eigen::Vector3d velocity_rad_s, acceleration_rad_s2;
};
WantedTurn wanted_turn(const SetpointState* roll_pitch_yaw) noexcept;

}  // namespace kadans
