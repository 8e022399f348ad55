// Finds names: the known name that is nearest to a mistyped one, and names that fit a pattern.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kadans {

// "unknown joint 'l_kne', did you mean 'l_knee'?": the known name that is nearest to a mistyped one.
inline constexpr std::size_t nearest_name_longest = 200;  // nobody mistypes a longer one; hostile input may send it

// The candidate with the smallest edit distance (insertions, deletions, substitutions, swaps of neighbours; a letter
// of the other case counts a quarter), or "" when none is near enough to be what was meant.
std::string nearest_name(std::string_view wrong, std::span<const std::string> candidates);

// ", did you mean 'NAME'?" or "" when nothing is near: to be appended to a message.
std::string did_you_mean(std::string_view wrong, std::span<const std::string> candidates);

// The names of all elements, as candidates.
template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

// True when the pattern fits the name. '*' stands for any number of characters, also none; every other character stands
// for itself.
bool matches(std::string_view pattern, std::string_view name) noexcept;

// Indices of the names that match, in their order.
std::vector<std::size_t> matching(std::string_view pattern, std::span<const std::string> names);

// True when the name has only letters, digits and '_', so that it may be a part of a signal's name.
bool is_word(std::string_view name) noexcept;

}  // namespace kadans
