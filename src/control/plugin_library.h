// Loads plug-ins (plugin.h).
//
// A library that does not fit is refused with a reason: it is none, was cut off, exports no kadans_plugin, was built
// otherwise than this program, names a type in a way that no type has, or one that there is already. Its constructors
// of static objects have run by then: to load a library is to run it, so who only looks at files does not call this.
//
// What it brings shares the program's memory and threads, and is bound by what ControlObject and PlantType promise, as
// all that is built in: an exception that leaves a noexcept function ends the process.
//
// Before the loop. A library stays loaded until the program ends, one that was refused too.
#pragma once

#include <filesystem>
#include <vector>

#include "kadans/control/control_object_types.h"
#include "kadans/plant/plant_type.h"

namespace kadans {

// Adds the library's types. Throws std::invalid_argument: "plug-in FILE: what is wrong", and what a type of plant
// throws when it is made.
void load_plugin(const std::filesystem::path& file, ControlObjectTypes& types, std::vector<MakePlantType>& plants);

}  // namespace kadans
