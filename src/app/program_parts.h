// Of what exactly the running program is made: its version, and the build id that the linker gave it and each shared
// library that is loaded. Two programs with the same parts make the same numbers of the same inputs.
#pragma once

#include "kadans/signal/byte_order.h"

namespace kadans {

// By name: "kadans", "version", "machine", "libm.so.6" ...; a part without a build id has "".
TextMap program_parts();

}  // namespace kadans
