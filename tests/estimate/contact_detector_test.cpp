#include "estimate/contact_detector.h"

#include <cmath>
#include <stdexcept>

#include <doctest/doctest.h>

using kadans::ContactDetector;

namespace {

ContactDetector::Config sole() {
  return {.on_N = 8,
          .off_N = 4,
          .sensors_m = {{{-0.08, -0.05, -0.06}, {-0.08, 0.05, -0.06}, {0.14, -0.05, -0.06}, {0.14, 0.05, -0.06}}}};
}

}  // namespace

TEST_CASE("Contact begins at the upper force and ends below the lower one") {
  ContactDetector foot(sole());
  const double steps_N[] = {0, 3, 7.9, 8, 5, 4, 3.9, 6, 7.9, 20, 0};
  const bool expected[] = {false, false, false, true, true, true, false, false, false, true, false};
  for (std::size_t i = 0; i < std::size(steps_N); ++i) {
    foot.update({steps_N[i] / 4, steps_N[i] / 4, steps_N[i] / 4, steps_N[i] / 4});
    CAPTURE(i);
    CHECK(foot.state().contact == expected[i]);
    CHECK(foot.state().force_N == doctest::Approx(steps_N[i]));
  }
}

TEST_CASE("The centre of pressure is where the forces are, and holds without contact") {
  ContactDetector foot(sole());
  CHECK(foot.state().cop_m[0] == doctest::Approx(0.03));
  foot.update({0, 0, 10, 30});
  CHECK(foot.state().cop_m[0] == doctest::Approx(0.14));
  CHECK(foot.state().cop_m[1] == doctest::Approx(0.025));
  CHECK(foot.state().cop_m[2] == doctest::Approx(-0.06));
  foot.update({1, 0, 0, 0});
  CHECK_FALSE(foot.state().contact);
  CHECK(foot.state().cop_m[0] == doctest::Approx(0.14));
  foot.update({10, 10, 10, 10});
  CHECK(foot.state().cop_m[0] == doctest::Approx(0.03));
  CHECK(foot.state().cop_m[1] == doctest::Approx(0));
}

TEST_CASE("A force that is not finite leaves the contact as it was") {
  ContactDetector foot(sole());
  foot.update({5, 5, 5, 5});
  foot.update({5, std::nan(""), 5, 5});
  CHECK(foot.state().contact);
  CHECK(foot.state().force_N == 20);
  CHECK(foot.state().cop_m[0] == doctest::Approx(0.03));
}

TEST_CASE("Thresholds without hysteresis room, or the wrong way round, are refused") {
  ContactDetector::Config config = sole();
  config.on_N = 3;
  CHECK_THROWS_WITH_AS(ContactDetector{config},
                       "contact_on_N = 3.000000, contact_off_N = 4.000000: must be 0 < contact_off_N <= contact_on_N",
                       std::invalid_argument);
  config.off_N = 0;
  CHECK_THROWS_AS(ContactDetector{config}, std::invalid_argument);
  config.off_N = std::nan("");
  CHECK_THROWS_AS(ContactDetector{config}, std::invalid_argument);
  config = sole();
  config.sensors_m[2][1] = std::nan("");
  CHECK_THROWS_AS(ContactDetector{config}, std::invalid_argument);
}
