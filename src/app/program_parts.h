// The exact parts of the running program: its version, and the linker's build id of the program and of each loaded
// shared library. Two programs with the same parts compute the same numbers from the same inputs.
#pragma once

#include "signal/byte_order.h"

namespace kadans {

// The names are "kadans", "version", "machine", "libm.so.6" ...; a part without a build id has "".
TextMap program_parts();

}  // namespace kadans
