// Plug-ins: types of control objects that come in a shared library (plugin.h says how, plugin_glue.h makes one).
//
// A library that does not fit is refused with a reason: it is no library, exports no kadans_plugin, was built for
// another version of the seam or with frames of another size, lacks a function, or brings a type whose name is taken.
// Its objects are kept at arm's length: an exception that comes out of one while the loop runs ends its work, its
// joints are given NaN from then on and the safety layer damps them (signal `failed`). A library shares the program's
// memory; against one that writes where it should not there is no help here.
//
// Before the loop. A library stays loaded until the program ends.
#pragma once

#include <filesystem>

#include "kadans/control/control_object_types.h"

namespace kadans {

// Adds the library's types. Throws std::invalid_argument: "plug-in FILE: what is wrong".
void load_plugin(const std::filesystem::path& file, ControlObjectTypes& types);

}  // namespace kadans
