#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "plant/small_robots.h"
#include "plant/tulip_robot.h"

using namespace kadans;
using namespace kadans::test;

namespace {

struct Wrong {
  void (*spoil)(Robot&);
  std::string message;
};

// The settings' world gets one object.
template <typename Shape>
void put(Robot& robot, const Shape& shape) {
  robot.settings.world.objects.push_back({"thing", shape, {}, 1, {}});
}

std::string refusal(const Robot& robot) {
  try {
    BulletWorld plant(robot.model, robot.settings, 1);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

void check_all(const std::vector<Wrong>& table) {
  for (const Wrong& wrong : table) {
    Robot robot = pendulum(1, 0.1, 0.02);
    wrong.spoil(robot);
    CHECK(refusal(robot) == wrong.message);
  }
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
  };
  check_all(table);
}

TEST_CASE("A world that cannot be built is refused by name and value") {
  const std::vector<Wrong> table = {
      {[](Robot& r) {
         put(r, WorldBox{{1, 0, 1}});
       },
       "object 'thing': size_m = 0 must be above 0"},
      {[](Robot& r) {
         put(r, WorldBox{{1, 1, 1}, -2});
       },
       "object 'thing': mass_kg = -2 must be at least 0"},
      {[](Robot& r) {
         put(r, WorldRamp{1, 1, 1.5});
       },
       "object 'thing': incline_rad = 1.5 must be at most 1.2 rad either way"},
      {[](Robot& r) {
         put(r, WorldStairs{0, 1, 1, 1});
       },
       "object 'thing': count = 0 must be 1..32"},
      {[](Robot& r) {
         put(r, WorldWall{1, NAN, 1});
       },
       "object 'thing': height_m = nan must be above 0"},
      {[](Robot& r) {
         put(r, WorldBall{0.1, 0});
       },
       "object 'thing': mass_kg = 0 must be above 0"},
      {[](Robot& r) {
         put(r, WorldBall{0.1, 1, 0, 1.1});
       },
       "object 'thing': restitution = 1.1 must be 0..1"},
      {[](Robot& r) {
         put(r, WorldPendulum{1, 0.1, 2, 1});
       },
       "object 'thing': distance_m = 1 must be at least 0 and less than length_m"},
      {[](Robot& r) {
         put(r, WorldBall{0.1, 1});
         r.settings.world.objects[0].motion.knots = {{0, {1, 0, 0}}};
       },
       "object 'thing': what moves freely cannot be driven: it has a mass and a motion"},
      {[](Robot& r) {
         r.settings.world.ground_motion.knots = {{1, {}}, {1, {}}};
       },
       "ground: motion: time_s = 1 must be at least 0 and later than the one before"},
      {[](Robot& r) {
         put(r, WorldBall{0.1, 1});
         put(r, WorldBall{0.1, 1});
       },
       "two objects are named 'thing'"},
      {[](Robot& r) {
         put(r, WorldBall{0.1, 1});
         r.settings.world.objects[0].pose.orientation = {2, 0, 0, 0};
       },
       "object 'thing': orientation must be a unit quaternion"},
      {[](Robot& r) { r.settings.world.slope_rad = NAN; }, "slope_rad = nan must be at most 1.2 rad either way"},
      {[](Robot& r) {
         r.settings.world.payloads.push_back({"bag", "hand", {}, 1});
       },
       "payload 'bag': the robot has no link 'hand'"},
      {[](Robot& r) {
         r.settings.world.payloads.push_back({"bag", "arm", {}, 0});
       },
       "payload 'bag': mass_kg = 0 must be above 0"},
      {[](Robot& r) {
         r.settings.world.payloads.push_back({"bag", "arm", {}, 1, 2, 1});
       },
       "payload 'bag': until_s = 1 must be later than from_s"},
  };
  check_all(table);
}

TEST_CASE("A robot that starts in the ground or in itself is refused, with the pair, the depth and the pose") {
  Robot low = tulip(Drives::rigid);
  CHECK(refusal(low) == "accepted");
  low.settings.stand_on_ground = false;
  low.settings.base.position_m = {0, 0, 0.4};
  CHECK(refusal(low).starts_with("start: link 'l_ankle_roll_link' is "));
  CHECK(refusal(low).find(" mm deep in the ground with '") != std::string::npos);
  CHECK(refusal(low).ends_with(" and the base at a height of 0.4 m; start higher, or with stand_on_ground"));
  low.settings.base.position_m = {0, 0, 2};
  CHECK(refusal(low) == "accepted");

  Robot bolted = tulip(Drives::rigid);
  bolted.settings.fixed_base = true;  // it stays where it is put
  CHECK(refusal(bolted).ends_with("a fixed base stays where it is put: start higher (start.position_m)"));
  bolted.settings.base.position_m = {0, 0, 2};
  CHECK(refusal(bolted) == "accepted");

  Robot crossed = tulip(Drives::rigid);
  for (const char* joint : {"l_hip_roll", "r_hip_roll"})
    crossed.settings.position_rad[*crossed.model.find_joint(joint)] = joint[0] == 'l' ? -0.3 : 0.3;
  CHECK(refusal(crossed).find(" deep in link '") != std::string::npos);
  CHECK(refusal(crossed).find("'l_hip_roll' at -0.3") != std::string::npos);
  crossed.settings.self_collision = false;
  CHECK(refusal(crossed) == "accepted");
}
