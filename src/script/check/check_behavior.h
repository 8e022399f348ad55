// Finds mistakes in a behavior without running it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/signal/input_error.h"

namespace kadans {

// Loads the file and all files that it requires and calls, and checks them against the catalog. Empty: no mistakes.
std::vector<InputProblem> check_behavior(const std::filesystem::path& root, const std::filesystem::path& file,
                                         const Catalog& catalog);

// The kind of a Lua file. Tests have names *_test.lua; the other kinds are told by the value that the file returns.
enum class ScriptKind : std::uint8_t { behavior, module, test };
struct CheckedScript {
  ScriptKind kind = ScriptKind::module;
  std::vector<InputProblem> problems;
};

// Loads a file of any kind and checks it. Without a catalog a behavior is only loaded.
CheckedScript check_script(const std::filesystem::path& root, const std::filesystem::path& file,
                           const Catalog* catalog);

// Sorts the problems by file and line, and removes duplicates on the same line.
void tell_once(std::vector<InputProblem>& problems);

}  // namespace kadans
