// Plug-ins: types of control objects in a shared library. plugin.h is the interface, plugin_glue.h makes a plug-in.
//
// A library that does not fit is refused with a reason: it is no library, exports no kadans_plugin, was built for
// another version of the seam or with frames of another size, lacks a function, or brings a type whose name is taken.
// The program does not trust a library's objects. An object that throws while the loop runs is not called again: its
// joints get NaN from then on, and the safety layer damps them (signal `failed`). A library shares the program's
// memory; nothing here protects against one that writes where it should not.
//
// Before the loop. A library stays loaded until the program ends.
#pragma once

#include <filesystem>

#include "kadans/control/control_object_types.h"

namespace kadans {

// Adds the library's types. Throws std::invalid_argument: "plug-in FILE: what is wrong".
void load_plugin(const std::filesystem::path& file, ControlObjectTypes& types);

}  // namespace kadans
