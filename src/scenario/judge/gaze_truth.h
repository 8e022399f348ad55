// The true error of the eyes of a control object of type "gaze", as signals:
//
//   plant.<object>.left_error_rad, right_error_rad   angle between an eye's x axis and the direction to the target
//   plant.<object>.error_rad                         the larger of the two
//
// The error is computed from the model's joint angles, not from the measured ones, so checks see what the control side
// cannot.
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
  // Looks the object's target up in the catalog's signals.
  GazeTruth(const TruthSource& plant, const Catalog& catalog, const Eyes& eyes);

  // Declares the signals. This object must not move from then on.
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
