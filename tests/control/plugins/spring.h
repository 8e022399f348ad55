// A control object for plug-ins in tests: a spring and a damper on one joint.
#pragma once

#include <memory>

#include "kadans/control/control_object.h"

std::unique_ptr<kadans::ControlObject> make_spring(const kadans::ObjectSetup& setup);
