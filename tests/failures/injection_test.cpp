// Random faults, seeded: a sample always, ten thousand with KADANS_SOAK in the environment.
#include "injection.h"

#include <cstdlib>

#include <doctest/doctest.h>

namespace injection_test {

using namespace kadans::failures;

namespace {

constexpr int categories = 5;

int runs_of_each() { return std::getenv("KADANS_SOAK") != nullptr ? 10000 / categories : 400 / categories; }

void inject_all(Category category) {
  int broken = 0;
  for (int i = 0; i < runs_of_each(); ++i) {
    const auto seed = static_cast<std::uint64_t>(i) + 1;
    const Outcome outcome = inject(category, seed);
    if (outcome.problem.empty()) continue;
    ++broken;
    if (broken <= 10) MESSAGE("seed " << seed << ": " << outcome.injected << ": " << outcome.problem);
  }
  CHECK(broken == 0);
}

}  // namespace

TEST_CASE("Random faults of sensors are found in time, limit what is written and end on their rung") {
  inject_all(Category::sensor);
}
TEST_CASE("Random wrong, old and too many commands change nothing and are counted") { inject_all(Category::command); }
TEST_CASE("Random nonsense from a control object is never written and ends on its rung") {
  inject_all(Category::actuation);
}
TEST_CASE("Random late ticks, jitter and silence of the behavior engine end on their rung") {
  inject_all(Category::timing);
}
TEST_CASE("Random mistakes in a script stop its behavior and nothing else") { inject_all(Category::script); }

}  // namespace injection_test
