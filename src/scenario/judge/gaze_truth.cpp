#include "gaze_truth.h"

#include <algorithm>
#include <cmath>

namespace kadans {

GazeTruth::GazeTruth(const TruthSource& plant, const Catalog& catalog, const Eyes& eyes)
    : plant_(plant),
      object_(eyes.object),
      joints_(catalog.model->joints.size()),
      kinematics_(*catalog.model),
      links_{catalog.model->find_link(eyes.left).value(), catalog.model->find_link(eyes.right).value()} {
  const char* const names[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    target_[i] = catalog.signals.find("control." + object_ + ".target_" + names[i] + "_m").value();
  }
}

void GazeTruth::declare(SignalTable& table) {
  const std::string prefix = "plant." + object_ + ".";
  table.add({prefix + "left_error_rad", "rad", "True angle between the left eye and the target."}, &error_rad_[0]);
  table.add({prefix + "right_error_rad", "rad", "True angle between the right eye and the target."}, &error_rad_[1]);
  table.add({prefix + "error_rad", "rad", "The larger of the two."}, &worst_rad_);
}

// In the base frame, where the target is given.
void GazeTruth::update(std::span<const double> row) noexcept {
  kinematics_.update({plant_.truth().position_rad.data(), joints_});
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const Pose& pose = kinematics_.link(links_[eye]);
    Vec3 way{};
    for (std::size_t i = 0; i < 3; ++i) way[i] = row[target_[i]] - pose.position_m[i];
    const Vec3 seen = rotate_inverse(pose.orientation, way);
    error_rad_[eye] = std::atan2(std::hypot(seen[1], seen[2]), seen[0]);
  }
  worst_rad_ = std::max(error_rad_[0], error_rad_[1]);
}

}  // namespace kadans
