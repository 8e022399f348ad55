// The whole-body object: an arm that its own dynamics move, and a biped whose joints follow exactly.
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "control/body/body_leader.h"
#include "kadans/testing/allocation_count.h"
#include "kadans/testing/real_time_guard.h"
#include "stand_bench.h"

namespace whole_body_test {

using namespace kadans;
using kadans::test::HandBench;
using kadans::test::leg_robot;
using kadans::test::StandBench;

TEST_CASE("an arm brings its hand to a point that is given in space, and keeps it there against gravity") {
  HandBench bench;
  bench.start();
  bench.run(300);
  const Vec3 before = bench.hand_m();
  bench.set_point("hand_right_x_m", before[0] + 0.1, 0.8);
  bench.set_point("hand_right_z_m", before[2] + 0.15, 0.8);
  bench.run(2500);
  const Vec3 after = bench.hand_m();
  CHECK(after[0] == doctest::Approx(before[0] + 0.1).epsilon(0.005));
  CHECK(after[2] == doctest::Approx(before[2] + 0.15).epsilon(0.005));
  CHECK(bench.signal("failures") == 0);
}

TEST_CASE(
    "a task of the second level gets what the first leaves: two joints bring the hand there, not the link's turn") {
  double missed_m[2] = {};
  for (const int priority : {1, 2}) {
    HandBench bench({{"right_hand", "wheel"}, {"trunk", "fore"}});
    bench.set("trunk.priority", priority);
    bench.start();
    bench.run(300);
    const Vec3 before = bench.hand_m();
    bench.set_point("hand_right_x_m", before[0] + 0.1, 0.8);
    bench.set_point("hand_right_z_m", before[2] + 0.15, 0.8);
    bench.run(3000);
    const Vec3 after = bench.hand_m();
    missed_m[priority - 1] = std::hypot(after[0] - before[0] - 0.1, after[2] - before[2] - 0.15);
    CHECK(bench.signal("failures") == 0);
  }
  CHECK(missed_m[0] > 0.03);
  CHECK(missed_m[1] < 0.003);
}

TEST_CASE("an arm keeps still and carries its weight before any task is asked for") {
  HandBench bench;
  bench.start();
  bench.run(1000);
  CHECK(bench.joints.joints[0].position_rad == doctest::Approx(0.3).epsilon(0.01));
  CHECK(bench.joints.joints[1].position_rad == doctest::Approx(-0.8).epsilon(0.01));
}

TEST_CASE("a biped moves its centre of mass, and its feet bear its weight and stay where they stand") {
  StandBench bench;
  bench.run(300);
  const double x_m = bench.setpoint("com_x_m"), z_m = bench.setpoint("com_z_m");
  const double left_m = bench.setpoint("foot_left.position_x_m");
  const double weight_N = 9.81 * bench.model.mass_kg();
  CHECK(bench.signal("load_left_N") + bench.signal("load_right_N") == doctest::Approx(weight_N).epsilon(0.01));
  bench.move("com_x_m", x_m + 0.03, 1);
  bench.move("com_z_m", z_m - 0.05, 1);
  bench.run(3000);
  CHECK(bench.signal("com_x_m") == doctest::Approx(x_m + 0.03).epsilon(0.002));
  CHECK(bench.signal("com_z_m") == doctest::Approx(z_m - 0.05).epsilon(0.002));
  CHECK(bench.setpoint("foot_left.position_x_m") == doctest::Approx(left_m).epsilon(0.001));
  CHECK(bench.signal("load_left_N") + bench.signal("load_right_N") == doctest::Approx(weight_N).epsilon(0.01));
  CHECK(bench.signal("failures") == 0);
  CHECK(bench.most_Nm < 0.9 * 25 + 0.01);
}

namespace {

// A biped that stands with bent knees, and the program of one tick.
struct Standing {
  Standing() {
    for (std::size_t i = 0; i < 10; ++i) body.position_rad[i] = std::array{0.0, 0.0, -0.3, 0.6, -0.3}[i % 5];
    aim.settings.sole_m = 0;
    body.base = body_start(layout, aim.settings, kinematics, body.position_rad, {1, 0, 0, 0});
    body.update();
    present_setpoints(layout, aim.settings, kinematics, aim.setpoints);
    for (std::size_t i = 0; i < 2; ++i) feet[i].pose = kinematics.link(layout.tasks[layout.feet[i]].link);
    ranks[0].weight = ranks[3].weight = 1;
  }
  bool solve() {
    body.update();
    return problem.solve(body, aim, ranks, {1e-4, 2}, feet);
  }
  std::vector<std::byte> state() {
    StateBytes measured;
    problem.pass_state(measured);
    std::vector<std::byte> bytes(measured.size());
    StateBytes saving = StateBytes::saving(bytes);
    problem.pass_state(saving);
    return bytes;
  }

  const RobotModel model = leg_robot();
  const BodyLayout layout{
      {model, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {{{"left_foot", "l_foot"}, {"right_foot", "r_foot"}}}}};
  BodyModel body{model, Dynamics::Base::floating, layout.rotor_inertia_kg_m2};
  Kinematics kinematics{model};
  BodyAim aim;
  std::array<BodyStand, body_feet_max> feet;
  BodyRanks ranks;
  BodyProblem problem{layout};
};

}  // namespace

TEST_CASE(
    "programs are solved and not solved: what the last solved one found stands, also in one that goes on from it") {
  Standing standing;
  int solved = 0, unsolved = 0;
  std::vector<std::byte> stands;
  // A knee that turns too fast for its limits, while its foot shall not move, can be neither braked nor let go.
  for (const double knee_rad_s : {0.0, 60.0, 0.5, -60.0, 1.0}) {
    standing.body.velocity[standing.body.base_size() + 3] = knee_rad_s;
    const std::vector<std::byte> before = standing.state();
    const bool found = standing.solve();
    CAPTURE(knee_rad_s);
    CHECK(found == (std::abs(knee_rad_s) < 10));
    CHECK(found == (standing.problem.status() == QuadraticProgram::Status::solved));
    CHECK((standing.state() == before) == !found);
    (found ? solved : unsolved) += 1;
    if (!found) stands = before;
  }
  CHECK(solved == 3);
  CHECK(unsolved == 2);
  Standing other;
  StateBytes restoring = StateBytes::restoring(stands);
  other.problem.pass_state(restoring);
  CHECK(restoring.ok());
  other.body.velocity[other.body.base_size() + 3] = 60;
  CHECK_FALSE(other.solve());
  CHECK(other.state() == stands);
  CHECK(std::abs(other.problem.effort_Nm(3)) > 1);  // the knee still bears
  CHECK(other.problem.wrench(0)[2] > 10);
}

TEST_CASE(
    "a wrench stays in its friction pyramid and over the sole, torques in their limits, whatever a task asks for") {
  Standing standing;
  BodyAim& aim = standing.aim;
  const BodyProblem& problem = standing.problem;
  const SetpointState com_x = aim.setpoints[0], com_z = aim.setpoints[2];
  int at_friction = 0, at_edge = 0, at_torque = 0;
  for (const double way_m : {-2.0, -0.3, -0.05, 0.0, 0.05, 0.3, 2.0}) {
    for (const double up_m : {0.0, 0.2, 3.0}) {
      aim.setpoints[0].value = com_x.value + way_m;
      aim.setpoints[2].value = com_z.value + up_m;
      REQUIRE(standing.solve());
      for (std::size_t foot = 0; foot < 2; ++foot) {
        const Eigen::Vector<double, 6> w = problem.wrench(foot);
        const double grip_N = aim.settings.friction / std::sqrt(2.0) * w[2], slack = 1e-6 * (1 + w.norm());
        const double reach_m = 0.1 - aim.settings.edge_m, side_m = aim.settings.side_m - aim.settings.edge_m;
        CHECK(w[2] >= -slack);
        CHECK(std::max(std::abs(w[0]), std::abs(w[1])) <= grip_N + slack);
        CHECK(std::abs(w[4]) <= reach_m * w[2] + slack);
        CHECK(std::abs(w[3]) <= side_m * w[2] + slack);
        at_friction += std::abs(w[0]) > grip_N - slack ? 1 : 0;
        at_edge += std::abs(w[4]) > reach_m * w[2] - slack ? 1 : 0;
      }
      for (std::size_t joint = 0; joint < 10; ++joint) {
        CHECK(std::abs(problem.effort_Nm(joint)) <= 0.9 * 25 + 1e-6);
        at_torque += std::abs(problem.effort_Nm(joint)) > 0.9 * 25 - 1e-6 ? 1 : 0;
      }
    }
  }
  CHECK(at_edge > 4);
  CHECK(at_torque > 3);
  INFO(at_friction);
}

TEST_CASE("a foot in the air is led, and put down it stands where it came to be") {
  StandBench bench;
  bench.run(300);
  bench.move("contact.right", 0, 0);
  bench.move("com_y_m", bench.setpoint("foot_left.position_y_m"), 1);
  bench.run(1500);
  bench.move("foot_right.position_z_m", 0.03, 0.6);
  bench.run(1500);
  INFO(bench.signal("status"));
  CHECK(bench.signal("load_right_N") == 0);
}

TEST_CASE(
    "the whole-body object neither allocates nor locks in the tick, nor allocates in its high level or in advance") {
  StandBench bench;
  long high_level = 0;
  const std::uint32_t com_z = bench.catalog.setpoints[bench.id("com_z_m")].channel;
  {
    const kadans::testing::RealTimeGuard guard;
    bench.object->start(bench.input());
    for (int i = 0; i < 100; ++i) {
      bench.object->follow(com_z, {.value = 0.5, .velocity = 0.01});
      bench.object->step(bench.input(), bench.computed);
      bench.time_ns += 1'000'000;
    }
  }
  {
    const kadans::testing::AllocationCount heap;
    for (int i = 0; i < 10; ++i) {
      bench.time_ns += 10'000'000;
      bench.update();
      const Foresight::Goal goal{com_z, 0.45};
      (void)bench.object->foresight()->miss({{&goal, 1}, 1}, bench.snapshot);
    }
    high_level = heap.count();
  }
  CHECK(high_level == 0);
  CHECK(bench.signal("failures") == 0);
}

TEST_CASE("a joint that is not measured gets a torque that is not finite, and is led on afterwards") {
  HandBench bench;
  bench.start();
  bench.run(100);
  const JointState good = bench.joints.joints[0];
  bench.joints.joints[0].velocity_rad_s = std::numeric_limits<double>::quiet_NaN();
  bench.object->step(bench.input(), bench.computed);
  CHECK_FALSE(is_finite(bench.computed.joints[0]));
  CHECK(is_finite(bench.computed.joints[1]));
  bench.joints.joints[0] = good;
  bench.object->step(bench.input(), bench.computed);
  CHECK(is_finite(bench.computed.joints[0]));
}

}  // namespace whole_body_test
