#include "football/ball_filter.h"

#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"

using namespace kadans::football;

namespace {

// A ball that is seen at 15 Hz with noise; some sightings are of something else.
class RollingBall {
 public:
  explicit RollingBall(std::uint64_t seed, double false_share = 0.05)
      : random_(seed, "football.rolling_ball"), false_share_(false_share) {}

  BallBelief truth;
  double time_s = 0;

  void run(BallFilter& filter, double seconds, bool visible = true) {
    for (const double until_s = time_s + seconds; time_s < until_s;) {
      constexpr double picture_s = 1.0 / 15;
      time_s += picture_s;
      truth = rolled_on(truth, picture_s);
      if (!visible) continue;
      if (random_.uniform() < 0.2) {
        filter.missed(time_s);
      } else if (random_.uniform() < false_share_) {
        filter.saw({time_s, {random_.uniform(-7, 7), random_.uniform(-4, 4)}, sd_m});
      } else {
        filter.saw({time_s, truth.at + Point{random_.normal() * sd_m, random_.normal() * sd_m}, sd_m});
      }
    }
  }
  void kick(double speed_m_s) { truth.velocity_m_s = turned({speed_m_s, 0}, random_.uniform(-3, 3)); }
  double error_m(const BallFilter& filter) const { return distance(filter.estimate(time_s).at, truth.at); }
  kadans::RandomStream& random() { return random_; }

  static constexpr double sd_m = 0.08;

 private:
  kadans::RandomStream random_;
  double false_share_;
};

}  // namespace

TEST_CASE("a ball at rest is known better than it is seen, also among false sightings") {
  std::vector<double> errors_m, speeds_m_s;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    RollingBall ball(seed);
    ball.truth.at = {2, -1};
    BallFilter filter({});
    ball.run(filter, 4);
    errors_m.push_back(ball.error_m(filter));
    speeds_m_s.push_back(norm(filter.estimate(ball.time_s).velocity_m_s));
    CHECK(filter.estimate(ball.time_s).known);
  }
  std::ranges::sort(errors_m);
  std::ranges::sort(speeds_m_s);
  CAPTURE(errors_m[25]);
  CAPTURE(speeds_m_s[25]);
  CHECK(errors_m[25] < 0.06);
  CHECK(errors_m[47] < 0.15);
  CHECK(speeds_m_s[25] < 0.2);
}

TEST_CASE("a kicked ball is followed within half a second, and where it will stop is told") {
  std::vector<double> errors_m, stop_errors_m;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    RollingBall ball(seed);
    BallFilter filter({});
    ball.run(filter, 3);
    ball.kick(2.5);
    ball.run(filter, 0.5);
    errors_m.push_back(ball.error_m(filter));
    ball.run(filter, 0.5);
    const BallBelief end = rolled_on(ball.truth, 20);
    stop_errors_m.push_back(distance(filter.estimate(ball.time_s + 20).at, end.at));
  }
  std::ranges::sort(errors_m);
  std::ranges::sort(stop_errors_m);
  CAPTURE(errors_m[25]);
  CAPTURE(errors_m[45]);
  CAPTURE(stop_errors_m[25]);
  CHECK(errors_m[25] < 0.15);
  CHECK(errors_m[45] < 0.4);
  CHECK(stop_errors_m[25] < 1);  // of the 6.25 m that it rolls
}

TEST_CASE("one false sighting moves nothing") {
  RollingBall ball(7, 0);
  BallFilter filter({});
  ball.run(filter, 2);
  const Point before = filter.estimate(ball.time_s).at;
  const auto begun = filter.beginnings();
  CHECK(filter.saw({ball.time_s + 0.05, {5, 3}, 0.08}));
  CHECK(distance(filter.estimate(ball.time_s + 0.05).at, before) < 0.05);
  ball.time_s += 0.06;
  ball.run(filter, 1);
  CHECK(filter.beginnings() == begun);
}

TEST_CASE("a ball that is not where it should be is lost, and two sightings bring it back") {
  RollingBall ball(3, 0);
  BallFilter filter({});
  ball.run(filter, 2);
  double time_s = ball.time_s;
  int looks = 0;
  for (; filter.estimate(time_s).known && looks < 100; ++looks) filter.missed(time_s += 0.1);
  CHECK(looks >= 4);
  CHECK(looks <= 10);
  CHECK(filter.saw({time_s + 0.1, {-3, 2}, 0.1}));
  CHECK_FALSE(filter.estimate(time_s + 0.1).known);  // it may be anything
  CHECK(filter.saw({time_s + 0.2, {-3.02, 2.05}, 0.1}));
  const BallFilter::Estimate back = filter.estimate(time_s + 0.2);
  CHECK(back.known);
  CHECK(distance(back.at, {-3, 2}) < 0.1);
  CHECK(norm(back.velocity_m_s) < 0.3);
}

TEST_CASE("a ball that nobody looks at is forgotten by age, and its error grows until then") {
  RollingBall ball(4, 0);
  BallFilter filter({});
  ball.run(filter, 2);
  CHECK(filter.estimate(ball.time_s + 3).known);
  CHECK(filter.estimate(ball.time_s + 3).sd_m > 2 * filter.estimate(ball.time_s).sd_m);
  CHECK(filter.estimate(ball.time_s + 3).age_s >= 3);
  CHECK_FALSE(filter.estimate(ball.time_s + 8).known);
  filter.forget();
  CHECK_FALSE(filter.estimate(ball.time_s).known);
}

TEST_CASE("sightings that are old, not finite or without an error are refused") {
  BallFilter filter({});
  CHECK(filter.saw({1, {0, 0}, 0.1}));
  CHECK_FALSE(filter.saw({1, {0, 0}, 0.1}));
  CHECK_FALSE(filter.saw({0.5, {0, 0}, 0.1}));
  CHECK_FALSE(filter.saw({2, {std::nan(""), 0}, 0.1}));
  CHECK_FALSE(filter.saw({2, {0, 0}, 0}));
  CHECK_FALSE(filter.saw({std::nan(""), {0, 0}, 0.1}));
  CHECK_FALSE(filter.estimate(2).known);
}
