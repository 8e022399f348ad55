// The web page of web/, built, compressed and embedded in the program. Empty when the program was built without it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace kadans {

struct PageFile {
  std::string_view path;  // "/index.html"
  std::span<const unsigned char> gzip;
};

const std::vector<PageFile>& page_files() noexcept;

// The text that a browser gets instead of the missing page.
inline constexpr std::string_view page_is_missing =
    "This program was built without its page. To get it: install nodejs and npm, run scripts/page, and build kadans "
    "again.";

}  // namespace kadans
