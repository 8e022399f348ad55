// Tells before a motion whether its end can be reached: whether there are joint positions within their limits with
// which the feet that stand stay where they are, the centre of mass is over their soles, and the tasks that were asked
// for are fulfilled. And whether the time is long enough for the way there (body_way.h).
//
// From where the robot is, steps of inverse kinematics along the motion, each a quadratic program in changes of
// position, lead to its end: what the asked tasks miss counts most, all others little. So the way is about that of the
// body as the tasks lead it (body_leader.h). Links that would hit each other on it are told (body_clash.h). What is
// still missed after some more steps at the end is told. It is a descent: where there are several ways for a limb, it
// may miss a pose that another way would reach.
//
// Behavior thread, of the runtime or of the process in which behaviors play; know() is called in the control thread.
// Only the constructor allocates or throws.
#pragma once

#include "body_clash.h"
#include "body_geometry.h"
#include "body_way.h"
#include "kadans/control/hand_over.h"
#include "quadratic_program.h"

namespace kadans {

class BodyReach final : public Foresight {
 public:
  explicit BodyReach(const BodyLayout& layout);

  void know(const BodySettings& settings) noexcept {
    static_cast<BodySettings&>(told_) = settings;
    known_.publish(told_, decltype(known_)::out_of_tick);
  }
  UpStorage& known() noexcept { return known_; }
  void set_first(SetpointId first) noexcept { first_ = first; }
  Miss miss(const Asked& asked, const Snapshot& snapshot) noexcept override;

 private:
  using Setpoints = std::array<SetpointState, body_channels_max>;
  bool place(const Snapshot& snapshot) noexcept;
  void stand_as_told(const Snapshot& snapshot) noexcept;
  bool ask(std::span<const Goal> goals) noexcept;
  Miss bearing() const noexcept;
  bool improve(double other_weight) noexcept;
  void go(const Setpoints& from, const Setpoints& to, double time_s) noexcept;
  double time_of(double asked_s) const noexcept;
  void hold_feet() noexcept;
  void balance() noexcept;
  void limit() noexcept;
  void add_task(std::size_t task, double other_weight) noexcept;
  Eigen::Index missing(std::size_t task, Eigen::Vector<double, 6>& way) noexcept;
  double beyond_edges_m() const noexcept;
  Miss worst() noexcept;
  bool stands(std::size_t foot) const noexcept { return setpoints_[layout_->contact_channel + foot].value > 0.5; }

  const BodyLayout* layout_;
  BodySettings settings_;
  SetpointId first_ = 0;
  HandUp<BodySettings> known_;
  Handed<BodySettings> told_;  // control thread
  BodyGeometry model_;
  Kinematics kinematics_;
  QuadraticProgram program_;
  BodyModel::Jacobian jacobian_;
  Eigen::VectorXd way_;
  Setpoints setpoints_{};
  std::array<bool, body_tasks_max> asked_{};
  std::array<Pose, body_feet_max> held_{};
  BodySupport support_;
  BodyWay gone_;
  BodyClash clash_;
  BodyClash::Pair clashing_;
  double tilt_rad_ = 0;     // the largest of the trunk on the way
  double clear_share_ = 0;  // of the way, until they are too near
};

}  // namespace kadans
