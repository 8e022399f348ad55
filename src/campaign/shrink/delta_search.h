// Searches for the least of a run that still fails. Both searches ask which is the first of some smaller runs that
// fails in the same way; so several can be made at once, and the answer does not depend on how many are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace kadans {

// The index of the first candidate that fails; nothing when all pass.
template <typename Candidate>
using FirstFailing = std::function<std::optional<std::size_t>(const std::vector<Candidate>&)>;

// Delta debugging (Zeller and Hildebrandt, 2002, ddmin): parts with which the run fails, and of which none can be left
// out alone. `all` is known to fail. A candidate says of each part whether it is there.
using Parts = std::vector<bool>;
Parts fewest_parts(const Parts& all, const FirstFailing<Parts>& first_failing);

// The least number that fails, between `passes` and `fails`, whichever is greater; both are taken for granted. The
// interval is cut into three until its neighbour passes, or lies nearer than this share of its distance to `passes`.
// Then three numbers before it are tried, too, and the search goes on where one of them fails.
std::int64_t least_number(std::int64_t passes, std::int64_t fails, double share,
                          const FirstFailing<std::int64_t>& first_failing);

}  // namespace kadans
