#include "name_search.h"

#include <stdexcept>

#include "signal/nearest_name.h"

namespace kadans::testing {

std::size_t find_by_ending(std::string_view what, std::string_view wanted, const std::vector<std::string>& names,
                           std::string_view prefix) {
  const std::string ending = "." + std::string(wanted);
  std::vector<std::size_t> found;
  std::vector<std::string> short_names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == wanted) return i;
    if (!names[i].starts_with(prefix)) continue;
    if (names[i].ends_with(ending)) found.push_back(i);
    short_names.push_back(names[i].substr(names[i].rfind('.') + 1));
    short_names.push_back(names[i]);
  }
  if (found.size() == 1) return found[0];
  const std::string quoted = std::string(what) + " '" + std::string(wanted) + "'";
  if (found.empty()) throw std::invalid_argument("unknown " + quoted + did_you_mean(wanted, short_names));
  throw std::invalid_argument(quoted + " is not clear: " + names[found[0]] + " or " + names[found[1]]);
}

}  // namespace kadans::testing
