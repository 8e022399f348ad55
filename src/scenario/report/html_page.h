// A self-contained HTML page for reports: it holds its styles and pictures, makes no requests, and follows the reader's
// light or dark setting.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "signal/utf8.h"

namespace kadans {

std::string base64(std::string_view bytes);
// A whole document. `style` is CSS that is added after the style of all pages.
std::string html_page(const std::string& title, const std::string& body, const std::string& style = {});

}  // namespace kadans
