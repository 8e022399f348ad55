// Twenty tosses of a real cube that no parameter was fitted to (README.md), replayed from their first frames. The
// parameters are those that `kadans tune` found for the others; docs/performance.md has the errors of all.
#include <numbers>

#include <doctest/doctest.h>

#include "cube.h"

using namespace kadans;
using namespace kadans::truth;

namespace {

const Parameters fitted{{"friction", 0.1776}, {"stiffness_N_per_m", 421000}, {"damping_Ns_per_m", 4.35}};

const std::vector<Toss>& tosses() {
  static const std::vector<Toss> all = read_tosses(KADANS_SOURCE_DIR "/tests/truth/tosses");
  return all;
}

Errors errors_with(Parameters changed) {
  changed.insert(fitted.begin(), fitted.end());
  return mean(replay(*kadans_cube(changed), tosses()));
}

// Until a corner may have touched the board.
std::size_t frames_of_flight(const Toss& toss) {
  const double reach_m = edge_m * std::numbers::sqrt3 / 2;
  std::size_t frames = 1;
  while (toss.frames[frames].position_m[2] > reach_m) ++frames;
  return frames;
}

}  // namespace

TEST_CASE("Until it may touch the board the cube is where it was, but for the noise of the cameras") {
  const auto cube = kadans_cube(fitted);
  std::size_t seen = 0;
  for (Toss toss : tosses()) {
    CAPTURE(toss.name);
    toss.frames.resize(frames_of_flight(toss));
    seen += toss.frames.size() - 1;
    if (toss.frames.size() < 2) continue;
    const Errors errors = errors_of(toss, simulate(*cube, toss));
    CHECK(errors.position_m < 0.004);
    CHECK(errors.rotation_rad < 0.1);
  }
  CHECK(seen > 40);
}

TEST_CASE("Replayed tosses of a real cube end near where they ended") {
  const Errors errors = errors_with({});
  CHECK(tosses().size() == 20);
  CHECK(errors.position_m < 0.02);
  CHECK(errors.position_end_m < 0.045);
  CHECK(errors.rotation_rad < 0.65);
}

TEST_CASE("Another friction, a soft ground, one that gives speed back: each predicts the real cube clearly worse") {
  const double best_m = errors_with({}).corner_m;
  CHECK(errors_with({{"friction", 0.05}}).corner_m > 1.5 * best_m);
  CHECK(errors_with({{"friction", 0.4}}).corner_m > 1.5 * best_m);
  CHECK(errors_with({{"stiffness_N_per_m", 1000}, {"damping_Ns_per_m", 0.1}}).corner_m > 1.5 * best_m);
  CHECK(errors_with({{"stiffness_N_per_m", 0}, {"restitution", 0.6}}).corner_m > 1.3 * best_m);
}

TEST_CASE("Our plant predicts the real cube about as well as Bullet's rigid bodies do") {
  const Parameters theirs{{"friction", 0.1776}, {"restitution", 0.1}};
  CHECK(errors_with({}).corner_m < 1.2 * mean(replay(*bullet_cube(theirs), tosses())).corner_m);
}
