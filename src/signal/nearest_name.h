// "unknown joint 'l_kne', did you mean 'l_knee'?": the known name that is nearest to a mistyped one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kadans {

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

}  // namespace kadans
