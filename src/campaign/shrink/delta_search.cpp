#include "delta_search.h"

#include <algorithm>
#include <cstdlib>

namespace kadans {
namespace {

Parts with(const std::vector<std::size_t>& chosen, std::size_t count) {
  Parts parts(count, false);
  for (const std::size_t index : chosen) parts[index] = true;
  return parts;
}

// The n-th of `of` stretches of the parts, or all others.
std::vector<std::size_t> stretch(const std::vector<std::size_t>& parts, std::size_t n, std::size_t of, bool others) {
  const std::size_t begin = parts.size() * n / of, end = parts.size() * (n + 1) / of;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if ((i >= begin && i < end) != others) chosen.push_back(parts[i]);
  }
  return chosen;
}

}  // namespace

Parts fewest_parts(const Parts& all, const FirstFailing<Parts>& first_failing) {
  std::vector<std::size_t> parts;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i]) parts.push_back(i);
  }
  if (parts.empty()) return all;
  if (first_failing({Parts(all.size(), false)})) return Parts(all.size(), false);
  std::size_t stretches = 2;
  while (parts.size() > 1) {
    std::vector<std::vector<std::size_t>> tried;
    for (std::size_t i = 0; i < stretches; ++i) tried.push_back(stretch(parts, i, stretches, false));
    for (std::size_t i = 0; i < stretches && stretches > 2; ++i) tried.push_back(stretch(parts, i, stretches, true));
    std::vector<Parts> candidates;
    for (const auto& chosen : tried) candidates.push_back(with(chosen, all.size()));
    const auto found = first_failing(candidates);
    if (!found && stretches == parts.size()) break;
    if (!found) {
      stretches = std::min(2 * stretches, parts.size());
      continue;
    }
    parts = tried[*found];
    stretches = *found < stretches ? 2 : std::max<std::size_t>(stretches - 1, 2);
    stretches = std::min(stretches, std::max<std::size_t>(parts.size(), 1));
  }
  return with(parts, all.size());
}

std::int64_t least_number(std::int64_t passes, std::int64_t fails, double share,
                          const FirstFailing<std::int64_t>& first_failing) {
  const std::int64_t origin = passes;
  const auto between = [](std::int64_t a, std::int64_t b, int parts) {
    std::vector<std::int64_t> inner;
    for (int i = 1; i < parts; ++i) {
      const std::int64_t at = a + (b - a) * i / parts;
      if (at != a && at != b && (inner.empty() || inner.back() != at)) inner.push_back(at);
    }
    return inner;
  };
  const auto near = [&] {
    const std::int64_t gap = std::abs(fails - passes);
    return gap <= 1 || static_cast<double>(gap) <= share * static_cast<double>(std::abs(fails - origin));
  };
  const auto take = [&](const std::vector<std::int64_t>& tried, std::optional<std::size_t> found) {
    if (found) fails = tried[*found];
    if (!found || *found > 0) passes = tried[found ? *found - 1 : tried.size() - 1];
  };
  for (;;) {
    while (!near()) {
      const auto tried = between(passes, fails, 3);
      take(tried, first_failing(tried));
    }
    const auto before = between(origin, passes, 4);
    const auto found = before.empty() ? std::nullopt : first_failing(before);
    if (!found) return fails;
    passes = origin;
    take(before, found);
  }
}

}  // namespace kadans
