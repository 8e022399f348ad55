// Arithmetic of inertias: what fixed joints need to weld bodies together, and what makes an inertia possible at all.
#pragma once

#include <optional>
#include <string>

#include "kadans/model/robot_model.h"

namespace kadans {

// The same body seen from outside: `pose` is the body's frame in the new one; the tensor turns with it.
Inertia moved(const Inertia& inertia, const Pose& pose) noexcept;

// Two bodies welded together, both given in one frame (parallel axis theorem). A body without mass adds nothing.
Inertia combined(const Inertia& a, const Inertia& b) noexcept;

// What no real body can have, as a sentence: a tensor that is not positive definite, or one principal moment larger
// than the other two together (by more than rounding, 1e-4 of it). Nothing when all is well. Looks at the tensor only.
std::optional<std::string> inertia_defect(const Inertia& inertia);

}  // namespace kadans
