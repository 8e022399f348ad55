// What rights the trunk of a robot that balances: a moment about its centre of mass, by the attitude that is measured
// (SIMBICON, Yin et al. 2007, ACM Trans. Graph. 26(3)).
//
// One owner, the control thread; only declare() allocates or throws.
#pragma once

#include <array>

#include "kadans/control/control_object.h"

namespace kadans {

struct TrunkRighting {
  double pitch_rad = 0, roll_rad = 0;  // how far the trunk leans forward, and to the right
  double upright_Nm_per_rad = 0, upright_Nms_per_rad = 0;
  double level_Nm_per_rad = 0, level_Nms_per_rad = 0;

  // Largest values of the parameters.
  struct Most {
    double Nm_per_rad, Nms_per_rad;
  };
  enum class Leans : bool { forward_only, anyhow };

  // The numbers above as parameters of an object; without roll_rad where it leans forward only.
  void declare(Declaration& d, Leans leans, const Most& most) {
    d.tunable("pitch_rad", "rad", -1, 1, pitch_rad, "How far the trunk leans forward.");
    if (leans == Leans::anyhow) d.tunable("roll_rad", "rad", -1, 1, roll_rad, "How far the trunk leans to the right.");
    d.tunable("upright_Nm_per_rad", "Nm/rad", 0, most.Nm_per_rad, upright_Nm_per_rad, "Turns the trunk back, forward.");
    d.tunable("upright_Nms_per_rad", "Nms/rad", 0, most.Nms_per_rad, upright_Nms_per_rad, "Damps the trunk, forward.");
    d.tunable("level_Nm_per_rad", "Nm/rad", 0, most.Nm_per_rad, level_Nm_per_rad, "Turns the trunk back, to the side.");
    d.tunable("level_Nms_per_rad", "Nms/rad", 0, most.Nms_per_rad, level_Nms_per_rad, "Damps the trunk, to the side.");
  }

  // To the right and forward.
  std::array<double, 2> moment_Nm(const BaseStatus& base) const noexcept {
    const Vec3& rate_rad_s = base.angular_velocity_rad_s;
    return {-level_Nm_per_rad * (base.roll_rad - roll_rad) - level_Nms_per_rad * rate_rad_s[0],
            -upright_Nm_per_rad * (base.pitch_rad - pitch_rad) - upright_Nms_per_rad * rate_rad_s[1]};
  }
};

}  // namespace kadans
