// From what drives measure to what the joints do, for plants that read drives.
//
// Control thread; neither allocates nor throws.
#pragma once

#include <span>

#include "kadans/model/transmission.h"

namespace kadans {

// The samples of the drives in their joints' places become those of the joints. A coupled joint's reading is new when
// both of its drives were read, and as old as the older of both.
void drives_to_joints(std::span<const Transmission> transmissions, SensorFrame& sensors) noexcept;

}  // namespace kadans
