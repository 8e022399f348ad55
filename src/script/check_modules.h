// Modules of an author's own: fields that are given to them while they run, files that return nothing, and guards that
// stand in them.
#pragma once

#include <vector>

#include "known_names.h"
#include "source_scopes.h"

namespace kadans {

// A file that was loaded, read.
struct ReadSource {
  const LuaState::Source* source = nullptr;
  SourceScopes scopes;
};

// Which file each name in `require` is.
void name_modules(const std::vector<ReadSource>& read, const LuaState& lua, const KnownNames& known,
                  SourceFacts& facts);

// Whatever a module is given as a field anywhere is its own, and one that is filled by computed names holds what it
// likes.
void widen_modules(const std::vector<ReadSource>& read, const LuaState& lua, const SourceFacts& facts,
                   KnownNames& known);

// Modules whose value somebody uses though they return none.
void check_module_values(const std::vector<ReadSource>& read, const LuaState& lua, std::vector<InputProblem>& problems);

// Functions that guards are and that return no value, in whatever file.
void check_guard_values(const std::vector<ReadSource>& read, const KnownNames& known,
                        std::vector<InputProblem>& problems);

}  // namespace kadans
