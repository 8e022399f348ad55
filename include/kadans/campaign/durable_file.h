// Files that are there whole or not at all, whatever ends the program or the machine.
#pragma once

#include <filesystem>
#include <string_view>

namespace kadans {

// Writes under a temporary name beside it, forces it to the disk, renames it over what was there, whose mode it keeps.
// A link is followed, and a device or pipe is written to as it is. Throws InputError that names the file. Two writers
// at once leave the file of one of them.
void write_durably(const std::filesystem::path& file, std::string_view bytes);

// Something that bytes flow through, /dev/stdout: no file can take its place.
bool is_device_or_pipe(const std::filesystem::path& file);
// Where a file of this name lies: at the end of a link, which need not be there yet, else there; a device or pipe stays
// as it is named. Throws InputError.
std::filesystem::path end_of_link(const std::filesystem::path& file);

}  // namespace kadans
