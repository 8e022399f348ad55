// The types of control objects that come with Kadans.
#pragma once

#include "kadans/control/control_object_types.h"

namespace kadans {

void add_shipped_types(ControlObjectTypes& types);

}  // namespace kadans
