// WalkPlan against a point mass on legs without mass: the linear inverted pendulum that its law assumes.
#include "control/walk/walk_plan.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

namespace walk_plan_test {

using namespace kadans;

namespace {

constexpr double dt_s = 0.001, rate_per_s = 4;
using Phase = WalkPlan::Phase;

struct Pendulum {
  WalkPlan plan;
  WalkPlan::Config config{.step_s = 0.32,
                          .step_min_s = 0.24,
                          .width_m = 0.18,
                          .lift_m = 0.04,
                          .place_share = 0.9,
                          .place_weight = 0.05,
                          .time_weight = 0.05,
                          .side_rate_share = 1,
                          .trust_per_s = 30,
                          .edge_share = 0,
                          .ankle_gain = 1,
                          .shift_x_m = 0,
                          .trim_per_s = 0.3,
                          .trim_max_m_s = 0.1,
                          .sole = {.heel_m = 0.06, .toe_m = 0.1, .half_width_m = 0.03}};
  WalkPlan::Wanted wanted{.go = true};
  std::array<GroundPoint, 2> foot{{{0, 0.09}, {0, -0.09}}};
  GroundPoint com, velocity_m_s;
  bool lands = false;  // the swing foot is on the ground in this tick
  double sunk_m = 0;
  double beside_m = 0;  // of the pressure, to the left of the foot's middle
  double in_air_N = 0;  // that the sensors of the swing foot tell in the air

  explicit Pendulum(double forward_m_s = 0, double left_m_s = 0) {
    wanted.velocity = {.forward_m_s = forward_m_s, .left_m_s = left_m_s};
    plan.begin(config, sight());
  }
  const WalkPlan::State& state() const { return plan.state(); }
  WalkPlan::Sight sight() const {
    WalkPlan::Sight seen{.rate_per_s = rate_per_s, .sunk_m = sunk_m};
    for (std::size_t i = 0; i < 2; ++i) {
      DcmMeasure::OverFoot& over = seen.over[i];
      over.foot_m = {foot[i].x_m - com.x_m, foot[i].y_m - com.y_m, -0.6};
      over.com_m = {com.x_m - foot[i].x_m, com.y_m - foot[i].y_m, 0.6};
      over.dcm_x_m = over.com_m[0] + velocity_m_s.x_m / rate_per_s;
      over.dcm_y_m = over.com_m[1] + velocity_m_s.y_m / rate_per_s;
      const bool bears = state().phase != Phase::steps || i == state().stance || lands;
      seen.force_N[i] = bears ? (lands ? 20 : 70) : in_air_N;
    }
    seen.cop_x_m[state().stance] = state().in_sole_x_m;
    seen.cop_y_m[state().stance] = beside_m;
    return seen;
  }
  GroundPoint pressure() const {
    const GroundPoint &a = foot[state().stance], &b = foot[1 - state().stance];
    if (state().phase == Phase::steps) return {a.x_m + state().in_sole_x_m, a.y_m + beside_m};
    const GroundPoint goal = plan.goal(config, sight());
    const double x_m = a.x_m + 2 * state().dcm.x_m - goal.x_m, y_m = a.y_m + 2 * state().dcm.y_m - goal.y_m;
    return {std::clamp(x_m, std::min(a.x_m, b.x_m) - config.sole.heel_m, std::max(a.x_m, b.x_m) + config.sole.toe_m),
            std::clamp(y_m, std::min(a.y_m, b.y_m), std::max(a.y_m, b.y_m))};
  }
  void tick() {
    const GroundPoint at = pressure();
    velocity_m_s.x_m += dt_s * rate_per_s * rate_per_s * (com.x_m - at.x_m);
    velocity_m_s.y_m += dt_s * rate_per_s * rate_per_s * (com.y_m - at.y_m);
    com.x_m += dt_s * velocity_m_s.x_m;
    com.y_m += dt_s * velocity_m_s.y_m;
    const std::size_t stance = state().stance;
    if (state().phase == Phase::steps) {
      foot[1 - stance] = {foot[stance].x_m + state().feet.at_m[0], foot[stance].y_m + state().feet.at_m[1]};
      lands = state().time_s >= state().step_s;
    }
    (void)plan.advance(config, wanted, sight(), dt_s);
    lands = false;
  }
  void run(double time_s) {
    for (int i = 0; i < static_cast<int>(time_s / dt_s); ++i) tick();
  }
  void next_step() {
    const std::uint32_t steps = state().steps;
    while (state().steps == steps && std::abs(com.y_m) < 5) tick();
  }
};

}  // namespace

TEST_CASE("WalkPlan sways first, then lifts the foot that bears less") {
  Pendulum robot;
  CHECK(robot.state().phase == Phase::sways);
  CHECK(robot.state().stance == 0);
  robot.run(0.35);
  CHECK(robot.state().phase == Phase::steps);
  CHECK(std::abs(robot.state().dcm.y_m) < 0.1);
}

TEST_CASE("WalkPlan stands on the foot that xi is near, and on the other one when xi goes there while it sways") {
  for (const double side : {1, -1}) {
    Pendulum robot;
    robot.com.y_m = 0.03 * side;
    robot.plan.begin(robot.config, robot.sight());
    CHECK(robot.state().stance == (side > 0 ? 0 : 1));
    robot.config.sway_s = 1;
    for (int i = 0; i < 150; ++i) {
      robot.com.y_m = -0.035 * side;
      robot.velocity_m_s = {};
      robot.tick();
    }
    CHECK(robot.state().phase == Phase::sways);
    CHECK(robot.state().stance == (side > 0 ? 1 : 0));
  }
}

TEST_CASE("WalkPlan foresees where xi will be from a pressure that is beside the foot's middle") {
  for (const double beside_m : {0.02, -0.02}) {
    std::array<double, 2> missed_m{};
    for (const std::size_t foresees : {0U, 1U}) {
      Pendulum robot;
      robot.config.edge_share = static_cast<double>(foresees);
      robot.run(3);
      robot.next_step();
      robot.beside_m = beside_m;
      robot.run(0.15);
      const WalkPlan::State then = robot.state();
      const double foreseen_m = then.feet.foothold.y_m + then.meant.offset.y_m;
      robot.run(then.step_s - then.time_s - 2 * dt_s);
      missed_m[foresees] = std::abs(robot.sight().over[then.stance].dcm_y_m - foreseen_m);
    }
    CHECK(missed_m[1] < 0.7 * missed_m[0]);
  }
}

TEST_CASE("WalkPlan believes a foot's measured xi as far as that foot bears") {
  Pendulum robot;
  robot.run(3);
  robot.next_step();
  WalkPlan::Sight sight = robot.sight();
  WalkPlan told = robot.plan, wrong = robot.plan;
  const std::size_t stance = robot.state().stance;
  sight.force_N[stance] = 10;
  sight.force_N[1 - stance] = 90;
  (void)told.advance(robot.config, robot.wanted, sight, dt_s);
  sight.over[stance].dcm_y_m += 0.3;
  (void)wrong.advance(robot.config, robot.wanted, sight, dt_s);
  CHECK(wrong.state().dcm.y_m - told.state().dcm.y_m == doctest::Approx(0.1 * 0.3 * robot.config.trust_per_s * dt_s));
}

TEST_CASE("WalkPlan walks at the velocity that is meant, in any direction") {
  for (const auto& [ahead, aside] : {std::pair{0.0, 0.0}, {0.3, 0.0}, {-0.15, 0.0}, {0.0, 0.1}, {0.2, -0.08}}) {
    const double forward_m_s = ahead, left_m_s = aside;
    Pendulum robot(forward_m_s, left_m_s);
    robot.run(6);
    const GroundPoint before = robot.com;
    const std::uint32_t steps = robot.state().steps;
    robot.run(8);
    CAPTURE(forward_m_s);
    CAPTURE(left_m_s);
    CHECK((robot.com.x_m - before.x_m) / 8 == doctest::Approx(forward_m_s).epsilon(0.1).scale(0.1));
    CHECK((robot.com.y_m - before.y_m) / 8 == doctest::Approx(left_m_s).epsilon(0.15).scale(0.1));
    CHECK(8.0 / (robot.state().steps - steps) == doctest::Approx(robot.config.step_s).epsilon(0.1));
  }
}

TEST_CASE("WalkPlan takes no single reading of force for a landing, but one that lasts touch_s") {
  Pendulum robot(0.4);
  for (int i = 0; i < 4; ++i) robot.next_step();
  while (robot.state().time_s < 0.8 * robot.state().step_s) robot.tick();
  const std::uint32_t steps = robot.state().steps;
  for (int i = 0; i < 10; ++i) {  // every second reading
    robot.in_air_N = i % 2 == 0 ? 40 : 0;
    robot.tick();
  }
  CHECK(robot.state().steps == steps);
  robot.in_air_N = 40;
  for (double held_s = 0; held_s < robot.config.touch_s - dt_s / 2; held_s += dt_s) {
    REQUIRE(robot.state().steps == steps);
    robot.tick();
  }
  CHECK(robot.state().steps == steps + 1);
}

TEST_CASE("WalkPlan answers a push to the side by a wider step that comes earlier, and goes on") {
  Pendulum robot(0.2);
  robot.run(5);
  robot.next_step();
  if (robot.state().stance == 0) robot.next_step();  // the left foot swings
  robot.run(0.05);
  const double width_m = robot.state().feet.foothold.y_m, time_s = robot.state().step_s;
  robot.velocity_m_s.y_m += 0.25;
  robot.run(0.06);
  CHECK(robot.state().feet.foothold.y_m > width_m + 0.05);
  CHECK(robot.state().step_s < time_s - 0.02);
  robot.run(4);
  CHECK(std::abs(robot.state().feet.foothold.y_m) < 0.25);
}

TEST_CASE("WalkPlan keeps its footholds within reach and its feet apart, whatever pushes") {
  Pendulum robot(0.2);
  robot.run(3);
  for (const double push_m_s : {2.0, -2.0}) {
    robot.velocity_m_s.x_m += push_m_s;
    robot.velocity_m_s.y_m += push_m_s;
    for (int i = 0; i < 200; ++i) {
      robot.tick();
      if (robot.state().time_s == 0) continue;  // landed: the next foothold comes with the next tick
      const double side = robot.state().stance == 0 ? -1 : 1;
      REQUIRE(std::abs(robot.state().feet.foothold.x_m) <= robot.config.reach_m + 1e-12);
      REQUIRE(side * robot.state().feet.foothold.y_m >= robot.config.apart_min_m - 1e-12);
      REQUIRE(side * robot.state().feet.foothold.y_m <= robot.config.apart_max_m + 1e-12);
    }
  }
}

TEST_CASE("WalkPlan stops beside its own foot, within a few steps, and xi comes to rest") {
  Pendulum robot(0.1);
  robot.run(5);
  const std::uint32_t steps = robot.state().steps;
  robot.wanted.go = false;
  robot.run(1.2);
  CHECK(robot.state().phase == Phase::bears);
  CHECK(robot.state().steps - steps <= 3);
}

TEST_CASE("WalkPlan slows down at its own rate once it shall stand") {
  Pendulum robot(0.3);
  robot.run(3);
  robot.wanted.go = false;
  robot.run(0.1);
  CHECK(robot.state().meant.velocity.forward_m_s == doctest::Approx(0.3 - 0.1 * robot.config.brake_m_s2));
}

TEST_CASE("WalkPlan steps again when a push takes xi beyond the feet that stand, and stands again") {
  for (const double push_m_s : {0.8, -0.7}) {
    Pendulum robot;
    robot.wanted.velocity.turn_rad_s = 0.4;
    robot.run(2);
    robot.wanted.go = false;
    robot.run(2);
    REQUIRE(robot.state().phase == Phase::bears);
    robot.velocity_m_s = {push_m_s, 0};
    robot.run(0.1);
    CHECK(robot.state().phase == Phase::steps);
    CHECK(robot.state().meant.turn_rad == 0);
    robot.run(3);
    CHECK(robot.state().phase == Phase::bears);
    CHECK(std::hypot(robot.velocity_m_s.x_m, robot.velocity_m_s.y_m) < 0.05);
  }
}

TEST_CASE("WalkPlan trusts a measured xi more while both feet bear") {
  const auto left_over = [](bool goes) {
    Pendulum robot;
    robot.config.trust_per_s = 5;
    robot.run(2);
    robot.wanted.go = goes;
    robot.run(2);
    REQUIRE((robot.state().phase == Phase::steps) == goes);
    while (goes && robot.state().time_s > 0.05) robot.tick();
    robot.velocity_m_s.x_m += 0.1;
    robot.run(0.03);
    return (robot.sight().over[robot.state().stance].dcm_x_m - robot.state().dcm.x_m) / (0.1 / rate_per_s);
  };
  CHECK(left_over(true) > 0.8);
  CHECK(left_over(false) < 0.3);
}

TEST_CASE("WalkPlan keeps what it knows of xi when a step begins out of standing") {
  Pendulum robot;
  robot.config.both_trust_per_s = 8;
  robot.run(2);
  robot.wanted.go = false;
  robot.run(2);
  const auto known_m = [&] { return robot.foot[robot.state().stance].x_m + robot.state().dcm.x_m; };
  robot.velocity_m_s.x_m += 1;  // is measured at once, and known late
  double before_m = 0;
  while (robot.state().phase == Phase::bears) {
    before_m = known_m();
    robot.tick();
  }
  CHECK(std::abs(known_m() - before_m) < 0.01);
  CHECK(robot.com.x_m + robot.velocity_m_s.x_m / rate_per_s > known_m() + 0.03);
}

TEST_CASE("WalkPlan does not end its steps with xi beyond its feet") {
  Pendulum robot;
  robot.run(2);
  robot.wanted.go = false;
  robot.velocity_m_s.x_m += 1;
  robot.next_step();
  robot.next_step();
  while (robot.state().phase == Phase::steps) robot.tick();
  const GroundPoint &a = robot.foot[0], &b = robot.foot[1];
  const double xi_x_m = robot.com.x_m + robot.velocity_m_s.x_m / rate_per_s;
  CHECK(xi_x_m < std::max(a.x_m, b.x_m) + robot.config.sole.toe_m);
}

TEST_CASE("WalkPlan rests on both feet when the robot has sunk, and steps on when it is up") {
  Pendulum robot;
  robot.run(4);
  robot.sunk_m = robot.config.sunk_m + 0.01;
  robot.next_step();
  CHECK(robot.state().phase == Phase::rests);
  robot.run(0.3);
  CHECK(robot.state().phase == Phase::rests);
  const std::uint32_t steps = robot.state().steps;
  robot.sunk_m = 0;
  robot.run(2);
  CHECK(robot.state().phase == Phase::steps);
  CHECK(robot.state().steps > steps + 2);  // and counts on
}

TEST_CASE("WalkPlan does not rest longer than rest_s, nor when xi leaves the feet") {
  Pendulum robot;
  robot.run(4);
  robot.sunk_m = 0.2;
  robot.next_step();
  REQUIRE(robot.state().phase == Phase::rests);
  robot.run(robot.config.rest_s + robot.config.sway_s + 0.01);
  CHECK(robot.state().phase == Phase::steps);
  robot.next_step();
  REQUIRE(robot.state().phase == Phase::rests);
  robot.velocity_m_s.x_m -= 1;
  robot.run(0.1);
  CHECK(robot.state().phase != Phase::rests);
  robot.velocity_m_s.x_m = -1;
  robot.next_step();
  CHECK(robot.state().phase == Phase::steps);  // it has sunk, but would fall over its heels
}

TEST_CASE("WalkPlan says by how much the heading turns at a landing: by the rate and the time that a step takes") {
  Pendulum robot;
  robot.wanted.velocity.turn_rad_s = 0.5;
  robot.run(4);
  robot.next_step();
  int ticks = 0;
  for (const std::uint32_t steps = robot.state().steps; robot.state().steps == steps; ++ticks) robot.tick();
  const double step_s = ticks * dt_s;
  CHECK(std::abs(step_s - robot.config.step_s) > 0.003);  // it is not what was meant that counts
  CHECK(robot.state().meant.turn_rad == doctest::Approx(0.5 * step_s));
  WalkPlan& plan = robot.plan;
  const GroundPoint before = plan.state().dcm;
  plan.turned(0.3);
  CHECK(plan.state().dcm.x_m == doctest::Approx(std::cos(0.3) * before.x_m + std::sin(0.3) * before.y_m));
}

}  // namespace walk_plan_test
