// A limb as a chain of joints from the base to a link. Computes where a point of the link is and how it moves with each
// joint, at a fraction of the cost of the whole robot's kinematics: the tick can afford it. Everything is in the base
// frame.
//
// One owner, the control thread. Only the constructor allocates or throws.
#pragma once

#include <span>
#include <vector>

#include "kadans/model/kinematics.h"
#include "kadans/model/robot_model.h"
#include "kadans/signal/frames.h"

namespace kadans {

class LimbChain {
 public:
  struct Segment {
    std::size_t joint = 0;  // index in the model
    bool prismatic = false;
    Pose origin;              // of the joint, in the frame of the segment before
    Vec3 axis{};              // in the joint's frame
    Vec3 column_m_per_rad{};  // the joint's column of the point's Jacobian, as of the last update
  };

  // Throws std::invalid_argument when no joint moves the link.
  LimbChain(const RobotModel& model, std::size_t link);

  // Returns the position of the point, in m.
  Vec3 update(const JointStates& joints, const Vec3& point_in_link_m) noexcept;
  std::span<const Segment> segments() const noexcept { return segments_; }  // from the base outwards

  // The position of the first joint in the base frame, and the largest distance of the link's frame from it.
  const Vec3& root_m() const noexcept { return segments_.front().origin.position_m; }
  double reach_m() const noexcept { return reach_m_; }

 private:
  struct Place {
    Vec3 position_m, axis;
  };
  std::vector<Segment> segments_;
  std::vector<Place> places_;  // of the joints, in the base frame
  double reach_m_ = 0;
};

}  // namespace kadans
