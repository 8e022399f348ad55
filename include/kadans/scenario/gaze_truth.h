// How far the eyes of a control object of type "gaze" really are from its target, as signals:
//
//   plant.<object>.left_error_rad, right_error_rad, error_rad    angle between an eye's x axis and the target; the
//   larger
//
// From the model's joint angles, not the measured ones, so that checks see what the control side cannot.
#pragma once

#include <array>
#include <span>
#include <string>

#include "kadans/control/catalog.h"
#include "kadans/model/kinematics.h"
#include "kadans/plant/world.h"

namespace kadans {

class GazeTruth {
 public:
  struct Eyes {
    std::string object, left, right;  // the control object, the eyes' links
  };
  // Finds the object's target among the catalog's signals.
  GazeTruth(const TruthSource& plant, const Catalog& catalog, const Eyes& eyes);

  // This must stay where it is from then on.
  void declare(SignalTable& table);
  void update(std::span<const double> row) noexcept;

 private:
  const TruthSource& plant_;
  std::string object_;
  std::size_t joints_;
  Kinematics kinematics_;
  std::array<std::size_t, 2> links_;
  std::array<SignalId, 3> target_;
  std::array<double, 2> error_rad_{};
  double worst_rad_ = 0;
};

}  // namespace kadans
