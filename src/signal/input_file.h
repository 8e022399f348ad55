// Files from outside, read whole, and the error that names one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace kadans {

inline constexpr std::size_t input_file_max_bytes = std::size_t{16} << 20U;

// The bytes of a regular file. Devices, pipes and folders are refused, and nothing is read beyond `size_max_bytes`: so
// it never waits for a pipe and never reads without end. Throws InputError: not there, no file, too large, unreadable.
// Any thread but the control thread.
std::string read_input_file(const std::filesystem::path& file, std::size_t size_max_bytes = input_file_max_bytes);

// Throws as read_input_file() does, without reading: for code that reads a file piece by piece.
void check_input_file(const std::filesystem::path& file);

// Throws InputError: "FILE: why", or "why" alone. Also of options: refuse("--seed", ...).
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why);
[[noreturn]] void refuse(const std::string& why);

}  // namespace kadans
