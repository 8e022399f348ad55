#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "control/gaze/gaze_solver.h"
#include "gaze_bench.h"
#include "kadans/testing/allocation_count.h"

namespace gaze_test {

using namespace kadans;
using kadans::test::GazeBench;

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// At an angle to the left, 1 m from between the eyes.
Vec3 aside(double angle_deg) {
  const double angle_rad = angle_deg / 57.29577951308232;
  return {0.08 + std::cos(angle_rad), std::sin(angle_rad), 0.22};
}

std::string refusal(const RobotModel& model, std::vector<std::size_t> joints, ObjectOptions options) {
  try {
    (void)make_gaze({model, std::move(joints), std::move(options)});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("Gaze fixes both eyes on a point 30 degrees aside within 0.35 s") {
  GazeBench bench;
  bench.run(0.1);
  bench.look(aside(30));
  bench.run(0.01);
  CHECK(bench.error_deg() > 20);
  bench.run(0.34);
  CHECK(bench.error_deg() < 0.5);
}

TEST_CASE("Gaze keeps a target that it gets between its start and its first step") {
  GazeBench bench;
  bench.look(aside(30));
  bench.run(0.001);
  CHECK(bench.signal("target_y_m") == aside(30)[1]);
  bench.run(0.35);
  CHECK(bench.error_deg() < 0.5);
}

TEST_CASE("Gaze lets the eyes go first, the neck follow, and the eyes turn back") {
  GazeBench bench;
  bench.run(0.1);
  bench.look(aside(30));
  bench.run(0.15);
  CHECK(bench.joints.joints[5].position_rad > bench.joints.joints[1].position_rad);
  bench.run(2);
  CHECK(bench.joints.joints[1].position_rad > 0.35);
  CHECK(std::abs(bench.joints.joints[5].position_rad + bench.joints.joints[6].position_rad) < 0.2);
  CHECK(bench.error_deg() < 0.05);
}

TEST_CASE("Gaze does not lag behind a target whose velocity it is told") {
  GazeBench bench;
  bench.run(0.1);
  double worst_deg = 0;
  for (int i = 0; i < 400; ++i) {
    const double angle = 3.14159 * 0.01 * i;
    bench.object->set_point(0, 1.08, 0);
    bench.object->set_point(1, 0.3 * std::sin(angle), 0);
    bench.object->set_point(2, 0.22, 0);
    bench.object->set_point(4, 0.3 * 3.14159 * std::cos(angle), 0);
    bench.run(0.01);
    if (i > 50) worst_deg = std::max(worst_deg, bench.error_deg());
  }
  CHECK(worst_deg < 1);
}

TEST_CASE("Gaze keeps within the joints' speeds and limits on the way to any target") {
  GazeBench bench;
  bench.run(0.1);
  for (const Vec3& at : {aside(60), aside(-60), aside(170), Vec3{0.08, 0, 1.2}, Vec3{0.5, 0.2, -1}, aside(0)}) {
    bench.look(at);
    bench.run(1);
  }
  CHECK(bench.fastest_share < 1 + 1e-6);
  CHECK(bench.inside_rad > -1e-9);
}

TEST_CASE("Gaze brakes the neck before its limits no harder than it may accelerate") {
  GazeBench bench;
  for (const char* joint : {"lower_tilt", "pan", "roll", "upper_tilt"}) {
    bench.set(std::string(joint) + ".acceleration_max_rad_s2", 25);
  }
  bench.run(0.1);
  for (const Vec3& at : {Vec3{-0.4, 0, -0.3}, aside(170), Vec3{0.08, 0, 1.2}, Vec3{0.2, 0.1, -0.8}, aside(-170)}) {
    bench.look(at);
    bench.run(1.5);
  }
  bench.look(aside(0));
  bench.run(2);
  bench.look(aside(170));
  while (std::abs(bench.joints.joints[1].position_rad) < 1.78) bench.tick();
  bench.high_level = false;  // so that nobody but the low level is there to brake
  bench.run(0.5);
  CHECK(bench.hardest_rad_s2 > 20);
  CHECK(bench.hardest_rad_s2 < 2 * 25);  // the last tick before a limit may stop what is left
  CHECK(bench.inside_rad > -1e-9);
}

TEST_CASE("Gaze comes as near as it can to a target under the head's back, says so, and finds back") {
  GazeBench bench;
  bench.run(0.1);
  bench.look({-0.4, 0, -0.3});
  bench.run(4);
  CHECK(bench.signal("unreachable") == 1);
  CHECK(bench.error_deg() > 2);
  CHECK(bench.error_deg() < 20);
  CHECK(bench.inside_rad > -1e-9);
  bench.look(aside(0));
  bench.run(2);
  CHECK(bench.signal("unreachable") == 0);
  CHECK(bench.error_deg() < 0.5);
}

TEST_CASE("Gaze turns both eyes and the neck the same way round to a target behind the head") {
  GazeBench bench;
  bench.run(0.1);
  bench.look({-1, 0, 0.22});
  bench.run(3);
  CHECK(std::abs(bench.joints.joints[1].position_rad) > 1.5);
  CHECK(bench.error_deg() < 0.5);
}

TEST_CASE("Gaze goes back to the middle where the way from one target to the next ends at a limit") {
  GazeBench bench;
  bench.run(0.1);
  for (const Vec3& at : {Vec3{-1, 0, 0.22}, aside(0), Vec3{0.08, 0, 1.22}, Vec3{0.08, 1, 0.22}}) {
    bench.look(at);
    bench.run(3);
  }
  CHECK(bench.error_deg() < 0.5);
}

TEST_CASE("Gaze stays finite with a target in an eye, above it, and along the eyes' axis") {
  for (const Vec3& at : {Vec3{0.08, 0.06, 0.22}, Vec3{0.08, 0.06, 1.2}, Vec3{0.08, 2, 0.22}}) {
    GazeBench bench;
    bench.run(0.1);
    bench.look(at);
    bench.run(2);
    CHECK(std::isfinite(bench.joints.joints[1].position_rad));
    CHECK(bench.fastest_share < 1 + 1e-6);
    bench.look(aside(0));
    bench.run(2);
    CHECK(bench.error_deg() < 0.5);
  }
}

// From the middle no joint wants to go back there, so that nothing is added to a velocity that stands at its limit.
TEST_CASE("Gaze stays finite while a joint moves at its speed limit and has no wish of its own") {
  const RobotModel model = kadans::test::head();
  GazeSolver solver(model, {.head = 4, .left_eye = 6, .right_eye = 7}, {0, 1, 2, 3, 4, 5, 6});
  solver.settings() = {.gain_per_s = 18, .damping = 0.05, .damping_singular = 0.3, .null_per_s = 3};
  const std::vector<double> middle_rad(7, 0.0);
  int limited = 0, finite = 0;
  for (int i = 0; i < 200; ++i) {
    GazeSolver::Solution solution;
    REQUIRE(solver.solve(middle_rad, {.point_m = aside(-30 - 0.5 * i)}, solution));
    limited += solution.scaled ? 1 : 0;
    finite += std::ranges::all_of(solution.velocity_rad_s, [](double v) { return std::isfinite(v); }) ? 1 : 0;
  }
  CHECK(limited > 100);
  CHECK(finite == 200);
}

TEST_CASE("Gaze's eyes counter a push on the neck") {
  const auto moved_deg = [](double vor_gain) {
    GazeBench bench;
    bench.set("vor_gain", vor_gain);
    bench.look(aside(0));
    bench.run(2);
    bench.pushed = 1;
    double worst_deg = 0;
    for (int i = 0; i < 60; ++i) {
      bench.joints.joints[1].velocity_rad_s = 2;
      bench.joints.joints[1].position_rad += 0.002;
      bench.tick();
      worst_deg = std::max(worst_deg, bench.error_deg());
    }
    return worst_deg;
  };
  CHECK(moved_deg(0) > 3);
  CHECK(moved_deg(1) < 0.7);
}

TEST_CASE("Gaze starts where the eyes look, and stays there") {
  GazeBench bench;
  bench.run(0.5);
  for (std::size_t i = 0; i < GazeBench::joint_count; ++i) {
    CHECK(std::abs(bench.joints.joints[i].position_rad) < 0.07);  // the eyes were parallel
  }
  CHECK(bench.signal("target_x_m") == doctest::Approx(1.08));
  CHECK(bench.signal("target_z_m") == doctest::Approx(0.22));
}

TEST_CASE("Gaze holds still when the high level goes silent") {
  GazeBench bench;
  bench.run(0.1);
  bench.look(aside(30));
  bench.run(0.05);
  bench.high_level = false;
  bench.run(0.3);
  const double left_rad = bench.joints.joints[5].position_rad;
  bench.run(0.2);
  CHECK(bench.joints.joints[5].position_rad == doctest::Approx(left_rad));
}

TEST_CASE("Gaze gives a joint that is not measured nothing finite, and goes on once it is") {
  GazeBench bench;
  bench.look(aside(10));
  bench.run(1);
  const double pan_rad = bench.joints.joints[1].position_rad;
  bench.joints.joints[1].position_rad = nothing;
  bench.object->step(bench.input(), bench.computed);
  bench.update();
  CHECK(std::isnan(bench.computed.joints[1].position_rad));
  CHECK(std::isfinite(bench.computed.joints[5].position_rad));
  bench.joints.joints[1].position_rad = pan_rad;
  bench.object->step(bench.input(), bench.computed);
  CHECK(bench.computed.joints[1].position_rad == doctest::Approx(pan_rad).epsilon(0.01));
  bench.run(1);
  CHECK(bench.error_deg() < 0.5);
}

TEST_CASE("Gaze's two levels work without allocating") {
  GazeBench bench;
  bench.look(aside(30));
  bench.run(0.05);
  bench.snapshot.joints = bench.joints;
  const testing::AllocationCount heap;
  bench.object->step(bench.input(), bench.computed);
  bench.object->update(bench.snapshot);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

TEST_CASE("Gaze refuses links that it does not know, and joints that move no eye") {
  RobotModel model = kadans::test::head();
  CHECK(refusal(model, {0, 1}, {}) == "it needs the option 'head': the link that carries the eyes");
  CHECK(refusal(model, {0}, {{{"head", "skul"}, {"left_eye", "left"}, {"right_eye", "right"}}}) ==
        "there is no link 'skul', did you mean 'skull'?");
  model.joints.push_back(model.joints[0]);
  model.joints.back().name = "jaw";
  model.joints.back().parent = 4;
  Link jaw;
  jaw.name = "jaw";
  model.links.push_back(jaw);
  CHECK(refusal(model, {0, 7}, kadans::test::eyes()) == "joint jaw moves neither eye");
}

}  // namespace gaze_test
