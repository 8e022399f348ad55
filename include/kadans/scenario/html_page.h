// A page that needs nothing but itself: styles and pictures inside, no request to anybody, light or dark as its reader
// has it. For reports.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "kadans/signal/utf8.h"

namespace kadans {

std::string base64(std::string_view bytes);
// A whole document. `style` follows that of all pages.
std::string html_page(const std::string& title, const std::string& body, const std::string& style = {});

}  // namespace kadans
