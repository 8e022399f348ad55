#include "control/walk/kick_swing.h"

#include <cmath>

#include <doctest/doctest.h>

namespace kick_swing_test {

using namespace kadans;

namespace {

const KickSwing::Config config;
const Kick straight{{0.28, 0.175}, 0, 1.5};  // the left foot's, over the right one

Vec3 at(const KickSwing& swing, double time_s, const GroundPoint& foothold = {0.1, 0.18}) {
  return swing.at(config, {0.01, 0.17, 0}, foothold, time_s, config.step_s);
}

}  // namespace

TEST_CASE("KickSwing meets the ball with the tip of the foot, in the direction and at the speed that are asked for") {
  for (const double rad : {0.0, 0.4, -0.3}) {
    KickSwing swing;
    swing.begin(config, {straight.ball, rad, straight.m_s});
    constexpr double moment_s = 1e-4;
    const Vec3 before_m = at(swing, config.strike_s - moment_s), here_m = at(swing, config.strike_s);
    const double behind_m = config.ball_radius_m + config.tip_m;
    CHECK(here_m[0] == doctest::Approx(straight.ball.x_m - behind_m * std::cos(rad)));
    CHECK(here_m[1] == doctest::Approx(straight.ball.y_m - behind_m * std::sin(rad)));
    CHECK(here_m[2] == doctest::Approx(config.height_m));
    const double x_m_s = (here_m[0] - before_m[0]) / moment_s, y_m_s = (here_m[1] - before_m[1]) / moment_s;
    CHECK(std::hypot(x_m_s, y_m_s) == doctest::Approx(straight.m_s).epsilon(0.01));
    CHECK(std::atan2(y_m_s, x_m_s) == doctest::Approx(rad).epsilon(0.01).scale(1));
    CHECK(swing.yaw_rad(config, config.strike_s) == doctest::Approx(rad));
  }
}

TEST_CASE("KickSwing leaves from where the foot is and comes to its foothold without a jump in place or velocity") {
  KickSwing swing;
  swing.begin(config, straight);
  CHECK(at(swing, 0) == Vec3{0.01, 0.17, 0});
  CHECK(at(swing, config.step_s)[0] == doctest::Approx(0.1));
  CHECK(at(swing, config.step_s)[1] == doctest::Approx(0.18));
  CHECK(at(swing, config.step_s)[2] == doctest::Approx(0).scale(1));
  Vec3 last_m = at(swing, 0), last_m_s{};
  constexpr double dt_s = 0.001;
  for (double time_s = dt_s; time_s < config.step_s; time_s += dt_s) {
    const Vec3 now_m = at(swing, time_s);
    for (std::size_t i = 0; i < 3; ++i) {
      const double velocity_m_s = (now_m[i] - last_m[i]) / dt_s;
      REQUIRE(std::abs(velocity_m_s - last_m_s[i]) < 0.06);  // 60 m/s2
      last_m_s[i] = velocity_m_s;
    }
    last_m = now_m;
  }
}

TEST_CASE("KickSwing draws the foot back before a hard kick of a near ball") {
  KickSwing swing;
  swing.begin(config, straight);
  double least_m = 1;
  for (double time_s = 0; time_s < config.strike_s; time_s += 0.001) least_m = std::min(least_m, at(swing, time_s)[0]);
  CHECK(least_m < -0.01);
}

TEST_CASE("KickSwing reaches a ball before its foot, and none that is elsewhere or shall go elsewhere") {
  CHECK(KickSwing::reaches(config, straight, 1));
  CHECK_FALSE(KickSwing::reaches(config, straight, -1));  // the right foot, over the left one
  CHECK(KickSwing::reaches(config, {{0.28, -0.175}, 0, 1.5}, -1));
  CHECK_FALSE(KickSwing::reaches(config, {{0.28, 0.175}, 0, 0}, 1));  // nothing is asked for
  CHECK_FALSE(KickSwing::reaches(config, {{0.45, 0.175}, 0, 1.5}, 1));
  CHECK_FALSE(KickSwing::reaches(config, {{0.28, 0.05}, 0, 1.5}, 1));  // the stance foot is in the way
  CHECK_FALSE(KickSwing::reaches(config, {{0.28, 0.175}, 1.2, 1.5}, 1));
  CHECK_FALSE(KickSwing::reaches(config, {{std::nan(""), 0.175}, 0, 1.5}, 1));
}

}  // namespace kick_swing_test
