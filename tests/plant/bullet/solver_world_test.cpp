// The plant's own solver against Bullet's where the robot meets what moves freely: balls and boxes.
#include <doctest/doctest.h>

#include "solver_pair.h"

namespace solver_world_test {

using namespace kadans;
using namespace kadans::test;

namespace {

WorldObject object(const char* name, const WorldShape& shape, const Vec3& position_m) {
  return {.name = name, .shape = shape, .pose = {.position_m = position_m}};
}

struct Apart {
  double robot_m = 0, objects_m = 0;
};

Apart most_apart(SolverPair& pair, int ticks) {
  Apart apart;
  for (int i = 0; i < ticks; ++i) {
    pair.tick();
    apart.robot_m = std::max(apart.robot_m, pair.apart_m());
    apart.objects_m = std::max(apart.objects_m, pair.objects_apart_m());
  }
  return apart;
}

}  // namespace

TEST_CASE("A ball rolls against TULip's foot and away again the same with both solvers") {
  Robot robot = tulip(Drives::rigid);
  WorldBall ball{.radius_m = 0.1, .mass_kg = 0.4, .rolling_friction_m = 0.002};
  ball.velocity_m_s = {-0.8, 0, 0};
  robot.settings.world.objects = {object("ball", ball, {0.4, 0.1, 0.1})};
  SolverPair pair(robot);
  const Apart apart = most_apart(pair, 600);
  CHECK(pair.tree.truth().objects[0].velocity_m_s[0] > -0.05);  // it has hit
  CHECK(apart.robot_m < 1e-6);
  CHECK(apart.objects_m < 1e-3);  // after a way of half a metre
}

TEST_CASE("A box slides against another and both come to rest the same with both solvers") {
  Robot robot = tulip(Drives::rigid);
  const Vec3 size_m{0.2, 0.2, 0.1};
  robot.settings.world.objects = {object("still", WorldBox{size_m, 2}, {0.6, 0, 0.05}),
                                  object("thrown", WorldBox{size_m, 1, {-1.5, 0, 0}}, {0.85, 0.02, 0.05})};
  SolverPair pair(robot);
  const Apart apart = most_apart(pair, 500);
  CHECK(pair.tree.truth().objects[0].pose.position_m[0] < 0.595);
  CHECK(apart.robot_m < 1e-6);
  CHECK(apart.objects_m < 2e-4);
}

}  // namespace solver_world_test
