// A fingerprint by which two processes check that they use the same numbers for parameters, set-points, control sets
// and objects. Each process reads the robot's files itself, and the files may have changed in between. Ranges and poses
// are part of it, values of parameters are not.
#pragma once

#include <cstdint>

#include "kadans/control/catalog.h"

namespace kadans {

std::uint64_t fingerprint_of(const Catalog& catalog);

}  // namespace kadans
