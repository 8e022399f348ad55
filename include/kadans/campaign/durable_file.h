// Files that are there whole or not at all, whatever ends the program or the machine.
#pragma once

#include <filesystem>
#include <string_view>

namespace kadans {

// Writes under a temporary name beside it, forces it to the disk, renames it over what was there, whose mode it keeps.
// Throws InputError that names the file. Two writers at once leave the file of one of them.
void write_durably(const std::filesystem::path& file, std::string_view bytes);

}  // namespace kadans
