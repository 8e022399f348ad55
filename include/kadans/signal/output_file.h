// Files that a program of one's own writes: whole or not at all, even when it or the machine stops in between.
#pragma once

#include <filesystem>
#include <string_view>

namespace kadans {

// Makes the folders above it, too. Throws InputError that names the file and what is wrong.
void write_output_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace kadans
