// Whether two processes mean the same by the numbers of parameters, set-points, control sets and objects: each reads
// the robot's files itself, and somebody may have changed them in between. Ranges and poses count, values do not.
#pragma once

#include <cstdint>

#include "kadans/control/catalog.h"

namespace kadans {

std::uint64_t fingerprint_of(const Catalog& catalog);

}  // namespace kadans
