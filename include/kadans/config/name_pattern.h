// Names chosen by a pattern: '*' stands for any characters, none included; everything else for itself.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kadans {

bool matches(std::string_view pattern, std::string_view name) noexcept;

// Indices of the names that match, in their order.
std::vector<std::size_t> matching(std::string_view pattern, std::span<const std::string> names);

// Letters, digits and '_': what may become a part of signals' names.
bool is_word(std::string_view name) noexcept;

}  // namespace kadans
