// Files that are written whole or not at all, even when the program or the machine stops in between.
#pragma once

#include <filesystem>
#include <string_view>

namespace kadans {

// Writes a temporary file beside `file`, forces it to the disk and renames it over `file`, whose mode it keeps. A link
// is followed. A device or a pipe is written to directly. Throws InputError that names the file. When two processes
// write at once, the file of one of them stays.
void write_durably(const std::filesystem::path& file, std::string_view bytes);

// True for a character device or a pipe, such as /dev/stdout: it cannot be replaced by a file.
bool is_device_or_pipe(const std::filesystem::path& file);
// The file that a symbolic link leads to; it need not exist yet. A path that is no link, a device or a pipe is given
// back unchanged. Throws InputError when the link leads nowhere.
std::filesystem::path end_of_link(const std::filesystem::path& file);

}  // namespace kadans
