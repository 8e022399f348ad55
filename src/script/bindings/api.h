// The table of everything that behaviors can call and read. Editor stubs and the reference are made from it, and a test
// compares it with what the sandbox really binds.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kadans/control/catalog.h"

namespace kadans {

struct ApiEntry {
  const char* owner;  // "kadans", "m", "object", "motion", "s", "joint", "base", "rate", "foot", ...
  const char* name;   // a function's name has its arguments: "move(pose, options)"
  const char* type;   // type of a field, or of what a function returns
  const char* doc;    // one sentence, with the unit
};
std::span<const ApiEntry> script_api();
// "decider.play" and so on: the words that m has in a k.decisions alone.
std::vector<std::string> decider_words();

// A ---@meta file for lua-language-server with the table and this robot's objects, set-points, presets, poses and
// joints.
std::string lua_stubs(const Catalog& catalog);
// The skills that the modules of <root>/behaviors/lib return, as Markdown; "" when there are none. Throws InputError
// when a module does not load.
std::string skill_reference(const std::filesystem::path& root);
// The table as Markdown for people, and the skills of the project's library.
std::string api_reference(const std::filesystem::path& root);
// The names that a loaded behavior really has: "kadans.pose", "m.wait", "object.move", "joint.position_rad". Throws
// InputError.
std::vector<std::string> bound_names(const std::filesystem::path& root, const std::filesystem::path& behavior,
                                     const Catalog& catalog);

}  // namespace kadans
