// What may be set and drawn for a run: names, patterns, ranges, and that draws repeat and do not disturb each other.
#include "scenario/disturb/quantities.h"

#include <cmath>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

struct Robot {
  PlantVariant variant;
  Catalog catalog;
  double kp = 100;
  std::vector<QuantityValue> done;
  Problems problems{"s.json"};

  Robot() {
    for (const char* name : {"torso", "l_shin", "r_shin"})
      variant.model.links.push_back({.name = name, .inertia = {.mass_kg = 2, .xx = 0.1, .yy = 0.1, .zz = 0.1}});
    for (const char* name : {"l_knee", "r_knee"}) variant.model.joints.push_back({.name = name});
    variant.plant.drives.resize(2, DriveSettings{.torque_max_Nm = 60});
    variant.plant.encoders.resize(2);
    catalog.parameters.add({.name = "posture.l_knee.kp", .min = 0, .max = 500, .initial = 100}, &kp);
  }
  void set(const char* pattern, double value) {
    Quantities(variant, catalog).set({pattern, value, {3, 5}, {3, 20}}, done, problems);
  }
  void draw(const char* pattern, std::uint64_t seed, Distribution distribution) {
    Quantities(variant, catalog).draw({{pattern, {4, 5}}, std::move(distribution)}, seed, done, problems);
  }
  std::string refusal() const {
    try {
      problems.throw_if_any();
    } catch (const InputError& error) {
      return error.problems().front().text();
    }
    return "";
  }
};

}  // namespace

TEST_CASE("A joint without a motor has no drive that rubs") {
  Robot robot;
  robot.variant.plant.drives[1].torque_max_Nm = 0;
  robot.set("joint.*.coulomb_Nm", 1.5);
  CHECK(robot.variant.plant.drives[0].coulomb_Nm == 1.5);
  CHECK(robot.variant.plant.drives[1].coulomb_Nm == 0);
}

TEST_CASE("Quantities change the plant and the control objects' parameters, by name and by pattern") {
  Robot robot;
  robot.set("ground.friction", 0.3);
  robot.set("joint.*_knee.torque_scale", 0.5);
  robot.set("link.torso.mass_scale", 1.5);
  robot.set("control.posture.l_knee.kp_scale", 1.2);
  robot.set("joint.*.coulomb_Nm", 1.5);
  CHECK(robot.refusal().empty());
  CHECK(robot.variant.plant.drives[0].coulomb_Nm == 1.5);
  CHECK(robot.variant.plant.ground_friction == 0.3);
  CHECK(robot.variant.plant.drives[1].torque_max_Nm == 30);
  CHECK(robot.variant.model.links[0].inertia.mass_kg == 3);
  CHECK(robot.variant.model.links[0].inertia.xx == doctest::Approx(0.15));
  CHECK(robot.variant.model.links[1].inertia.mass_kg == 2);
  CHECK(robot.kp == doctest::Approx(120));
  CHECK(robot.done.size() == 7);
  CHECK(robot.done[1].name == "joint.l_knee.torque_scale");
}

TEST_CASE("Quantities change the ground, and where a ball lies and how it rolls") {
  Robot robot;
  robot.variant.plant.world.objects.push_back({.name = "ball", .shape = WorldBall{.radius_m = 0.1, .mass_kg = 0.4}});
  robot.variant.sees = true;
  robot.set("ground.stiffness_N_per_m", 5000);
  robot.set("ground.damping_Ns_per_m", 40);
  robot.set("ground.restitution", 0.2);
  robot.set("world.ball.x_m", 1.5);
  robot.set("world.ball.rolling_friction_m", 0.004);
  robot.set("sight.latency_s", 0.2);
  CHECK(robot.refusal().empty());
  CHECK(robot.variant.plant.ground_stiffness_N_per_m == 5000);
  CHECK(robot.variant.plant.ground_damping_Ns_per_m == 40);
  CHECK(robot.variant.plant.ground_restitution == 0.2);
  const WorldObject& ball = robot.variant.plant.world.objects[0];
  CHECK(ball.pose.position_m[0] == 1.5);
  CHECK(std::get<WorldBall>(ball.shape).rolling_friction_m == 0.004);
  CHECK(robot.variant.sight.latency_s == 0.2);
}

TEST_CASE("An unknown quantity and a value out of range are refused at their places") {
  Robot unknown;
  unknown.set("ground.fricton", 0.3);
  CHECK(unknown.refusal() == "s.json:3:5: unknown quantity 'ground.fricton', did you mean 'ground.friction'?");
  Robot range;
  range.set("ground.friction", -1);
  CHECK(range.refusal() == "s.json:3:20: ground.friction is -1, must be 0..10");
  CHECK(range.variant.plant.ground_friction == 1.0);
}

TEST_CASE("Draws repeat with the seed, differ between joints, and are alike when told so") {
  const Distribution spread{.kind = Distribution::Kind::uniform, .of = {0.5, 1}};
  Robot first, again, other;
  first.draw("joint.*.torque_scale", 5, spread);
  again.draw("link.*.mass_scale", 5, spread);  // what else is drawn makes no difference
  again.draw("joint.*.torque_scale", 5, spread);
  other.draw("joint.*.torque_scale", 6, spread);
  CHECK(first.variant.plant.drives[0].torque_max_Nm == again.variant.plant.drives[0].torque_max_Nm);
  CHECK(first.variant.plant.drives[0].torque_max_Nm != first.variant.plant.drives[1].torque_max_Nm);
  CHECK(first.variant.plant.drives[0].torque_max_Nm != other.variant.plant.drives[0].torque_max_Nm);
  Distribution together = spread;
  together.together = true;
  Robot alike;
  alike.draw("joint.*.torque_scale", 5, together);
  CHECK(alike.variant.plant.drives[0].torque_max_Nm == alike.variant.plant.drives[1].torque_max_Nm);
}

TEST_CASE("A distribution's quantiles are those of its kind") {
  using Kind = Distribution::Kind;
  CHECK(Distribution{.kind = Kind::uniform, .of = {2, 4}}.at(0.25) == 2.5);
  CHECK(Distribution{.kind = Kind::log_uniform, .of = {1, 100}}.at(0.5) == doctest::Approx(10));
  CHECK(Distribution{.kind = Kind::normal, .of = {10, 2}}.at(0.8413447) == doctest::Approx(12).epsilon(1e-6));
  CHECK(Distribution{.kind = Kind::normal, .of = {10, 2}}.at(0) == doctest::Approx(2));  // four deviations
  CHECK(Distribution{.kind = Kind::values, .values = {1, 5, 9}}.at(0.5) == 5);
  CHECK(Distribution{.kind = Kind::values, .values = {1, 5, 9}}.at(0.999) == 9);
}

TEST_CASE("What is set again replaces what was set before, a scale is of the robot as its files have it") {
  Robot robot;
  Quantities quantities(robot.variant, robot.catalog);
  const auto set = [&](const char* pattern, double value) {
    quantities.set({pattern, value, {3, 5}, {3, 20}}, robot.done, robot.problems);
  };
  for (const double factor : {0.5, 0.9}) {
    set("joint.*.torque_scale", factor);
    set("link.torso.mass_scale", factor);
    set("joint.l_knee.start_rad", factor);
    set("control.posture.l_knee.kp_scale", factor);
    set("start.roll_rad", factor);
  }
  CHECK(robot.variant.plant.drives[0].torque_max_Nm == doctest::Approx(54));
  CHECK(robot.variant.model.links[0].inertia.mass_kg == doctest::Approx(1.8));
  CHECK(robot.variant.plant.position_rad[0] == doctest::Approx(0.9));
  CHECK(robot.kp == doctest::Approx(90));
  CHECK(robot.variant.plant.base.orientation[1] == doctest::Approx(std::sin(0.45)));
  set("control.posture.l_knee.kp", 200);
  CHECK(robot.kp == doctest::Approx(180));  // value and scale stand side by side
  REQUIRE(robot.done.size() == 7);          // each once, with its last value
  CHECK(robot.done[0].value == 0.9);
}

TEST_CASE("The scale of a parameter is of its presets too, its value is not") {
  Robot robot;
  robot.catalog.objects.push_back(
      {.name = "posture", .presets = {{"stiff", {{0, 150.0}}}, {"stiffest", {{0, 480.0}}}}});
  robot.set("control.posture.l_knee.kp", 90);
  CHECK(robot.catalog.objects[0].presets[0].values[0].second == 150);
  robot.set("control.posture.l_knee.kp_scale", 1.2);
  CHECK(robot.catalog.objects[0].presets[0].values[0].second == doctest::Approx(180));
  CHECK(robot.catalog.objects[0].presets[1].values[0].second == 500);  // the parameter's own limit
  CHECK(robot.kp == doctest::Approx(108));
}
