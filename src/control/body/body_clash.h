// Whether two links of the robot would come too near to each other: by the shapes with which they collide in the model.
// Boxes are tested by separating axes (Gottschalk, Lin and Manocha 1996, SIGGRAPH), cylinders as their boxes, spheres
// as points with a radius; hulls of meshes count as the boxes around them. Neighbours, and links that overlap when all
// joints are at zero, do not count: they always touch, and the plant lets them.
//
// One owner, any thread. Only the constructor allocates.
#pragma once

#include <vector>

#include "body_geometry.h"

namespace kadans {

class BodyClash {
 public:
  struct Pair {
    std::size_t link = 0, other = 0;
    bool found() const noexcept { return link != other; }
  };
  explicit BodyClash(const RobotModel& model);

  // Pairs that are near in this posture do not count until the next begin().
  void begin(const BodyGeometry& posture) noexcept;
  Pair find(const BodyGeometry& posture) noexcept;

 private:
  struct Solid {
    std::size_t link;
    Pose pose;  // in the link's frame
    Eigen::Vector3d half_m;
    double radius_m, reach_m;  // round its edges; from the centre to what is farthest
    Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  };
  struct Candidate {
    std::size_t one, other;  // solids
    bool counts = true;
  };
  void place(const BodyGeometry& posture) noexcept;
  static bool near(const Solid& a, const Solid& b, double margin_m) noexcept;

  std::vector<Solid> solids_;
  std::vector<Candidate> candidates_;
};

}  // namespace kadans
