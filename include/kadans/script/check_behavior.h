// What is wrong with a behavior, found without running it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/signal/input_error.h"

namespace kadans {

// Loads the file and what it requires and calls, and checks it against the catalog. Empty: nothing is wrong.
std::vector<InputProblem> check_behavior(const std::filesystem::path& root, const std::filesystem::path& file,
                                         const Catalog& catalog);

// What a file of Lua is: tests by its name, *_test.lua, the others by what they return.
enum class ScriptKind : std::uint8_t { behavior, module, test };
struct CheckedScript {
  ScriptKind kind = ScriptKind::module;
  std::vector<InputProblem> problems;
};

// Loads the file, of whatever kind, and checks it. Without a catalog a behavior is not checked any further than that.
CheckedScript check_script(const std::filesystem::path& root, const std::filesystem::path& file,
                           const Catalog* catalog);

// Of several that say the same of the same line one is left; by file and line.
void tell_once(std::vector<InputProblem>& problems);

}  // namespace kadans
