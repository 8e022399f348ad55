// Forward kinematics of one foot, along the joints from the base to it. It costs a fraction of the whole robot's
// kinematics, so that the estimator can afford it in every tick. Rotations are carried as three axes, and a joint about
// x, y or z turns just two of them.
//
// One owner, the control thread. update neither allocates nor throws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "axes.h"
#include "kadans/model/robot_model.h"

namespace kadans {

class LegChain {
 public:
  // Throws std::invalid_argument when the model has no such link.
  LegChain(const RobotModel& model, std::size_t link);

  // base: the base's axes in the world. Afterwards axes() are the link's in the world, and point() is relative to the
  // base frame's origin, along the world's axes.
  void update(const JointStates& joints, const Axes& base) noexcept;

  const Axes& axes() const noexcept { return axes_; }
  Vec3 point(const Vec3& in_link_m) const noexcept {
    const Vec3 arm = along(axes_, in_link_m);
    return {position_m_[0] + arm[0], position_m_[1] + arm[1], position_m_[2] + arm[2]};
  }

 private:
  struct Segment {
    std::size_t joint = 0;
    bool prismatic = false;
    bool origin_turned = false;
    Vec3 origin_m{};
    Axes origin_axes;
    Vec3 axis{};
    int main_axis = 0;  // 0, 1, 2: along x, y, z; -1: any
    double sign = 1;    // along or against the main axis
  };

  std::vector<Segment> segments_;  // from the base outwards
  Axes axes_;
  Vec3 position_m_{};
};

}  // namespace kadans
