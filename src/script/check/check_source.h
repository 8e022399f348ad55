// Checks of an author's own modules: fields that are assigned while they run, files that return nothing, and guards in
// them.
#pragma once

#include <vector>

#include "known_names.h"
#include "source_scopes.h"

namespace kadans {

// A loaded file and its parsed text.
struct ReadSource {
  const LuaState::Source* source = nullptr;
  SourceScopes scopes;
};

// Tells the facts which file each name in `require` means.
void name_modules(const std::vector<ReadSource>& read, const LuaState& lua, const KnownNames& known,
                  SourceFacts& facts);

// Adds all fields to a module that are assigned to it anywhere. A module that is filled by computed names may have any
// field.
void widen_modules(const std::vector<ReadSource>& read, const LuaState& lua, const SourceFacts& facts,
                   KnownNames& known);

// Finds modules whose value is used although they return nothing.
void check_module_values(const std::vector<ReadSource>& read, const LuaState& lua, std::vector<InputProblem>& problems);

// Finds guards that return no value, in any file.
void check_guard_values(const std::vector<ReadSource>& read, const KnownNames& known,
                        std::vector<InputProblem>& problems);

// Finds mistakes by reading the text of a behavior, in every branch: unknown names (fields of m and s, control objects,
// set-points, presets, parameters, poses, vars, globals, own modules), values out of range, guards that write or return
// nothing, waits in places that cannot wait, and events that are never emitted.

// Checks the file of a loaded behavior and all files that it requires and calls. Fields that the files assign to
// modules are added to `known`.
void check_sources(const Behavior::Parts& parts, KnownNames& known, std::vector<InputProblem>& problems);

}  // namespace kadans
