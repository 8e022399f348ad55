// Reads small files of /proc and /sys, which state no size and hold one value.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace kadans {

std::string text_of(const std::filesystem::path& file);        // "" when it cannot be read
std::string first_line_of(const std::filesystem::path& file);  // without the blanks at its ends
std::uint64_t number_in(const std::string& text);              // at its beginning; 0 when there is none

}  // namespace kadans
