// Arithmetic of inertias: welds bodies together, as fixed joints need it, and finds inertias that no body can have.
#pragma once

#include <optional>
#include <string>

#include "kadans/model/robot_model.h"

namespace kadans {

// The same inertia, given in another frame. `pose` is the old frame in the new one; the tensor turns with it.
Inertia moved(const Inertia& inertia, const Pose& pose) noexcept;

// Two bodies welded together, both given in one frame (parallel axis theorem). A body without mass adds nothing.
Inertia combined(const Inertia& a, const Inertia& b) noexcept;

// The same body of another density: mass and tensor times `factor`.
Inertia scaled(const Inertia& inertia, double factor) noexcept;

// Why no real body can have this inertia, as a sentence: the tensor is not positive definite, or one principal moment
// is larger than the other two together (by more than `rounding` of it). Nothing when it is possible. Looks at the
// tensor only.
std::optional<std::string> inertia_defect(const Inertia& inertia, double rounding = 1e-4);

}  // namespace kadans
