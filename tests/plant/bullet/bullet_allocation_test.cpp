// What the plant's step asks of the heap once its first second is over, Bullet's own memory included: nothing,
// also in a fall, where Bullet makes and drops what it knows of two bodies that come near each other. The count sees
// every malloc of the thread.
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"
#include "plant/tulip_robot.h"

using namespace kadans;
using namespace kadans::test;

TEST_CASE("A squatting TULip's plant allocates nothing after its first second") {
  const Robot robot = tulip(Drives::rigid);
  BulletWorld plant(robot.model, robot.settings, 1);
  JointHold hold(robot);
  long allocations = 0;
  for (int i = 0; i < 3000; ++i) {
    const double crouch_rad = 0.3 + 0.2 * (1 - std::cos(i * 2 * M_PI / 1000));
    for (std::size_t j = 0; j < robot.model.joints.size(); ++j) {
      const std::string& name = robot.model.joints[j].name;
      if (name.ends_with("hip_pitch") || name.ends_with("ankle_pitch")) hold.aim(j, -crouch_rad);
      if (name.ends_with("knee")) hold.aim(j, 2 * crouch_rad);
    }
    const testing::AllocationCount heap;
    hold.tick(plant);
    if (i >= 1000) allocations += heap.count();
  }
  CHECK(allocations == 0);
  CHECK(plant.truth().base.position_m[2] > 0.5);
}

#ifdef KADANS_SANITIZED
constexpr bool system_memory = true;  // sanitizers look into every block, so none is kept
#else
constexpr bool system_memory = false;
#endif

TEST_CASE("A TULip that falls beside a ball allocates nothing after its first second" * doctest::skip(system_memory)) {
  for (const Vec3& push_N : {Vec3{60, 25, 0}, Vec3{-70, 0, 0}, Vec3{0, 80, 0}}) {
    CAPTURE(push_N[0]);
    Robot robot = tulip(Drives::rigid);
    robot.settings.world.objects = {
        {.name = "ball", .shape = WorldBall{.radius_m = 0.1, .mass_kg = 0.4}, .pose = {.position_m = {0.4, 0.5, 0.1}}}};
    BulletWorld plant(robot.model, robot.settings, 1);
    JointHold hold(robot);
    long allocations = 0;
    for (int i = 0; i < 3500; ++i) {
      const testing::AllocationCount heap;
      if (i >= 1000 && i < 1300) plant.push(0, push_N, {});
      hold.tick(plant);
      if (i >= 1000) allocations += heap.count();
    }
    CHECK(allocations == 0);
    CHECK(plant.truth().base.position_m[2] < 0.5);
  }
}
