#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

struct Wrong {
  void (*spoil)(Robot&);
  std::string message;
};

std::string refusal(const Robot& robot) {
  try {
    BulletPlant plant(robot.model, robot.settings, 1);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("Settings that do not fit the model are refused by name and value") {
  const std::vector<Wrong> table = {
      {[](Robot& r) { r.settings.drives.clear(); }, "drives entries = 0 must be one a joint, 1"},
      {[](Robot& r) { r.settings.encoders.resize(3); }, "encoders entries = 3 must be one a joint, 1"},
      {[](Robot& r) { r.settings.position_rad.clear(); }, "position_rad entries = 0 must be one a joint, 1"},
      {[](Robot& r) { r.settings.position_rad[0] = NAN; }, "position_rad of 'swing' = nan must be finite"},
      {[](Robot& r) { r.drive().torque_max_Nm = -1; }, "drive of joint 'swing': torque_max_Nm = -1 must be at least 0"},
      {[](Robot& r) { r.drive().spring_Nm_per_rad = 100; },
       "drive of joint 'swing': rotor_inertia_kg_m2 = 0 must be above 0 with a series spring"},
      {[](Robot& r) { r.settings.encoders[0].noise_rad = -2; },
       "encoder of joint 'swing': noise_rad = -2 must be at least 0"},
      {[](Robot& r) { r.settings.feet.push_back({.link = "toe"}); }, "foot: the robot has no link 'toe'"},
      {[](Robot& r) {
         r.settings.surfaces.push_back({"sole", 1});
       },
       "surface: the robot has no link 'sole'"},
      {[](Robot& r) {
         r.settings.surfaces.push_back({"arm", -1});
       },
       "friction of 'arm' = -1 must be at least 0"},
      {[](Robot& r) { r.settings.solver_iterations = 0; }, "solver_iterations = 0 must be at least 1"},
      {[](Robot& r) { r.settings.gravity_m_s2[2] = NAN; }, "gravity_m_s2 must be finite"},
      {[](Robot& r) { r.model.joints[0].mimic = Mimic{}; }, "joint 'swing': mimic joints cannot be simulated"},
  };
  for (const Wrong& wrong : table) {
    Robot robot = pendulum(1, 0.1, 0.02);
    wrong.spoil(robot);
    CHECK(refusal(robot) == wrong.message);
  }
}
