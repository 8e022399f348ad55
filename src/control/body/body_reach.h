// Tells before a motion whether its end can be reached: whether there are joint positions within their limits with
// which the feet that stand stay where they are, the centre of mass is over their soles, and the tasks that were asked
// for are fulfilled.
//
// From where the robot is, at most 20 steps of inverse kinematics, each a quadratic program in changes of position:
// what the asked tasks miss counts most, all others hardly. What is still missed at the end is told. It is a descent:
// where there are several ways for a limb, it may miss a pose that another way would reach.
//
// Behavior thread, of the runtime or of the process in which behaviors play. Only the constructor allocates or throws.
#pragma once

#include "body_layout.h"
#include "body_model.h"
#include "quadratic_program.h"

namespace kadans {

class BodyReach final : public Foresight {
 public:
  explicit BodyReach(const BodyLayout& layout);

  void know(const BodySettings& settings) noexcept { settings_ = settings; }
  void set_first(SetpointId first) noexcept { first_ = first; }
  Miss miss(std::span<const Goal> goals, const Snapshot& snapshot) noexcept override;

 private:
  struct Edge {  // of the ground under the soles: normal * point <= distance
    double x = 0, y = 0, distance_m = 0;
  };
  using Setpoints = std::array<SetpointState, body_channels_max>;
  bool place(const Snapshot& snapshot) noexcept;
  void stand_as_told(const Snapshot& snapshot) noexcept;
  void find_edges() noexcept;
  bool improve() noexcept;
  void hold_feet() noexcept;
  void balance() noexcept;
  void limit() noexcept;
  void add_task(std::size_t task) noexcept;
  Eigen::Index missing(std::size_t task, Eigen::Vector<double, 6>& way) noexcept;
  double beyond_edges_m() const noexcept;
  Miss worst() noexcept;
  bool stands(std::size_t foot) const noexcept { return setpoints_[layout_->contact_channel + foot].value > 0.5; }

  const BodyLayout* layout_;
  BodySettings settings_;
  SetpointId first_ = 0;
  BodyModel model_;
  Kinematics kinematics_;
  QuadraticProgram program_;
  BodyModel::Jacobian jacobian_;
  Eigen::VectorXd way_;
  Setpoints setpoints_{};
  std::array<bool, body_tasks_max> asked_{};
  std::array<Pose, body_feet_max> held_{};
  std::array<Edge, 4 * body_feet_max> edges_{};
  std::size_t edge_count_ = 0;
};

}  // namespace kadans
