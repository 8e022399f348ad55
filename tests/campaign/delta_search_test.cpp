// The searches of `kadans shrink`, on failures that are known.
#include "campaign/shrink/delta_search.h"

#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"

namespace delta_search_test {

using namespace kadans;

namespace {

// Counts what would be run, one after the other.
template <typename Candidate, typename Fails>
FirstFailing<Candidate> counted(Fails fails, std::size_t& runs) {
  return [fails, &runs](const std::vector<Candidate>& candidates) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      ++runs;
      if (fails(candidates[i])) return i;
    }
    return std::nullopt;
  };
}

std::int64_t least(std::int64_t passes, std::int64_t fails_at, double share, std::int64_t bound, std::size_t& runs) {
  return least_number(
      passes, fails_at, share,
      counted<std::int64_t>([&](std::int64_t x) { return passes < fails_at ? x >= bound : x <= bound; }, runs));
}

}  // namespace

TEST_CASE("Of parts of which some subset is needed, exactly this subset is left, whatever it is") {
  RandomStream random(1, "delta_search");
  for (int trial = 0; trial < 300; ++trial) {
    const auto count = static_cast<std::size_t>(1 + 30 * random.uniform());
    Parts needed(count);
    for (std::size_t i = 0; i < count; ++i) needed[i] = random.uniform() < 2.0 / static_cast<double>(count);
    std::size_t runs = 0;
    const auto fails = [&](const Parts& parts) {
      for (std::size_t i = 0; i < count; ++i) {
        if (needed[i] && !parts[i]) return false;
      }
      return true;
    };
    CHECK(fewest_parts(Parts(count, true), counted<Parts>(fails, runs)) == needed);
    CHECK(runs <= count * count + 3 * count);  // Zeller and Hildebrandt's bound
  }
}

TEST_CASE("No single part of what is left can be left out, also where several subsets fail") {
  const auto fails = [](const Parts& p) { return (p[0] && p[5]) || (p[2] && p[3] && p[7]) || (p[1] && !p[4] && p[6]); };
  std::size_t runs = 0;
  const Parts left = fewest_parts(Parts(8, true), counted<Parts>(fails, runs));
  CHECK(fails(left));
  for (std::size_t i = 0; i < left.size(); ++i) {
    Parts without = left;
    without[i] = false;
    CHECK((!left[i] || !fails(without)));
  }
}

TEST_CASE("What fails without any part leaves none, in one run, and parts that are out already stay out") {
  std::size_t runs = 0;
  const auto always = [](const Parts&) { return true; };
  CHECK(fewest_parts(Parts(9, true), counted<Parts>(always, runs)) == Parts(9, false));
  CHECK(runs == 1);
  CHECK(fewest_parts({}, counted<Parts>(always, runs)).empty());
  const auto second = [](const Parts& parts) {
    CHECK_FALSE(parts[0]);
    return bool(parts[2]);
  };
  CHECK(fewest_parts({false, true, true}, counted<Parts>(second, runs)) == Parts{false, false, true});
}

TEST_CASE("The least number that fails is found, upward and downward") {
  for (std::int64_t bound = 1; bound <= 200; ++bound) {
    std::size_t runs = 0;
    CHECK(least(0, 200, 0, bound, runs) == bound);
    CHECK(runs <= 14);
    CHECK(least(200, 0, 0, 200 - bound, runs) == 200 - bound);
  }
}

TEST_CASE("With a share, the least number is at most that share above the bound") {
  for (const std::int64_t bound : {3, 77, 512, 4000, 9999}) {
    std::size_t runs = 0;
    const std::int64_t found = least(0, 10'000, 0.01, bound, runs);
    CHECK(found >= bound);
    CHECK(static_cast<double>(found) <= 1.011 * static_cast<double>(bound) + 1);
    CHECK(runs <= 20);
  }
}

TEST_CASE("Numbers that fail again far below the first bound are found, too") {
  std::size_t runs = 0;
  const auto islands = [](std::int64_t x) { return x >= 600 || (x >= 120 && x < 350); };
  CHECK(least_number(0, 1000, 0, counted<std::int64_t>(islands, runs)) == 120);
}

}  // namespace delta_search_test
