// True when the pattern fits the name. '*' stands for any number of characters, also none; every other character stands
// for itself.
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

// True when the name has only letters, digits and '_', so that it may be a part of a signal's name.
bool is_word(std::string_view name) noexcept;

}  // namespace kadans
