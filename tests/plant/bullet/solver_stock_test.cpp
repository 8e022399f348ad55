// The plant's own solver against Bullet's: iterated to the end, both must find the same motion. Where feet slide the
// two differ on purpose (a cone of friction against a square), so the ground here holds whatever stands on it; sliding
// has its formulas in solver_contact_test.cpp.
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"
#include "kadans/signal/random.h"
#include "solver_pair.h"

using namespace kadans;
using namespace kadans::test;

namespace {

double squat_rad(const std::string& joint, double crouch_rad) {
  if (joint.ends_with("hip_pitch") || joint.ends_with("ankle_pitch")) return -crouch_rad;
  return joint.ends_with("knee") ? 2 * crouch_rad : 0;
}

}  // namespace

TEST_CASE("Standing TULip moves the same with both solvers") {
  for (const Drives kind : {Drives::rigid, Drives::elastic}) {
    CAPTURE(static_cast<int>(kind));
    SolverPair pair(tulip(kind));
    double worst_m = 0, worst_rad = 0;
    for (int i = 0; i < 300; ++i) {
      pair.tick();
      worst_m = std::max(worst_m, pair.apart_m());
      worst_rad = std::max(worst_rad, pair.apart_rad());
    }
    CHECK(worst_m < 1e-7);
    CHECK(worst_rad < 1e-6);
    CHECK(pair.apart_N() < 0.1);
    CHECK(pair.tree.truth().contact_count == 8);
  }
}

TEST_CASE("Squatting TULip moves the same with both solvers") {
  const Robot robot = tulip(Drives::rigid);
  SolverPair pair(robot);
  double worst_m = 0;
  for (int i = 0; i < 600; ++i) {
    const double crouch_rad = 0.3 + 0.05 * (1 - std::cos(i * 2 * M_PI / 600));
    for (std::size_t j = 0; j < robot.model.joints.size(); ++j) {
      pair.aim(j, squat_rad(robot.model.joints[j].name, crouch_rad));
    }
    pair.tick();
    worst_m = std::max(worst_m, pair.apart_m());
  }
  CHECK(worst_m < 2e-5);
}

TEST_CASE("Pushed TULip moves the same with both solvers until it has fallen") {
  SolverPair pair(tulip(Drives::rigid));
  double worst_m = 0;
  int ticks = 0;
  for (; ticks < 1500 && pair.tree.truth().base.position_m[2] > 0.5; ++ticks) {
    if (ticks < 150) pair.push(0, {60, 25, 0});
    pair.tick();
    worst_m = std::max(worst_m, pair.apart_m());
  }
  CHECK(ticks < 1500);
  CHECK(worst_m < 1e-4);
}

TEST_CASE("From 1000 random poses both solvers find the same velocities") {
  Robot robot = tulip(Drives::rigid);
  robot.settings.self_collision = false;  // poses that overlap would be thrown apart
  RandomStream random(1, "poses");
  double worst_smooth_rad_s = 0;
  int rough = 0, rough_apart = 0, touching = 0;
  for (int pose = 0; pose < 1000; ++pose) {
    robot.settings.ground_friction = pose % 2;
    robot.settings.base.orientation = normalized({random.normal(), random.normal(), random.normal(), random.normal()});
    for (std::size_t j = 0; j < robot.model.joints.size(); ++j) {
      const Joint& joint = robot.model.joints[j];
      robot.settings.position_rad[j] = joint.lower_rad + (joint.upper_rad - joint.lower_rad) * random.uniform();
    }
    SolverPair pair(robot);
    for (int i = 0; i < 2; ++i) pair.tick();
    touching += pair.tree.truth().contact_count > 0 ? 1 : 0;
    if (pose % 2 == 0) worst_smooth_rad_s = std::max(worst_smooth_rad_s, pair.apart_rad_s());
    rough += pose % 2;
    rough_apart += pose % 2 == 1 && pair.apart_rad_s() > 1e-5 ? 1 : 0;
  }
  CHECK(touching > 700);
  CHECK(rough == 500);
  CHECK(worst_smooth_rad_s < 1e-6);
  CHECK(rough_apart <= 30);  // a light foot that slides at a steep angle has more than one solution
}
