// The skills of a project's library as Markdown: a chapter of the reference of behaviors.
#pragma once

#include <filesystem>
#include <string>

namespace kadans {

// Loads the modules of <root>/behaviors/lib and lists the skills that they return. "" when there are none. Throws
// InputError when a module does not load.
std::string skill_reference(const std::filesystem::path& root);

}  // namespace kadans
