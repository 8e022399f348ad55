// What viewers are told of a scenario's world: its ground, what is painted there, things and payloads.
#include <cmath>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/assembly/assembly.h"
#include "app/services.h"

namespace drawn_world_test {

using namespace kadans;
using Json = nlohmann::json;

namespace {

// Of a TULip in this world.
ScenarioConfig scenario_with(const std::string& world) {
  const std::string text =
      R"({"name": "drawn", "robot": "config/tulip/robot.json", "duration_s": 5, "world": [)" + world + "]}";
  return read_scenario_config_text(text, KADANS_SOURCE_DIR "/config/scenarios/drawn.json");
}

struct Played {
  explicit Played(const std::string& world) : scenario(scenario_with(world)), robot(scenario, 1, log) {}
  RunResult run(double duration_s) {
    Checks none(robot.catalog().signals, {});
    return run_scenario(robot.parts(), duration_s, none, {});
  }
  Json description() { return Json::parse(robot_texts(robot).description); }
  double value(const std::string& signal) {
    return robot.control().row()[robot.catalog().signals.find(signal).value()];
  }

  RunLog log;
  ScenarioConfig scenario;
  Assembly robot;
};

// Of the ground's plane, from how a viewer is to turn it.
Vec3 normal_of(const Json& ground) {
  const auto q = ground.at("orientation_xyzw").get<std::array<double, 4>>();
  return rotate({q[3], q[0], q[1], q[2]}, {0, 0, 1});
}

const std::string crate =
    R"({"kind": "box", "name": "crate", "size_m": [0.3, 0.2, 0.1], "position_m": [2, 0, 0.2],
        "roll_pitch_yaw_rad": [0.4, 0.1, 0.3], "mass_kg": 1})";
const std::string driven =
    R"({"kind": "ground", "motion": {"profile": [{"time_s": 0, "velocity_m_s": [0.05, 0, 0.02]}]}})";

}  // namespace

TEST_CASE(
    "Viewers are told how the ground slopes, as the plant has it, and that it is level where a scenario says nothing") {
  const Vec3 up =
      normal_of(Played(R"({"kind": "ground", "slope_rad": 0.2, "slope_heading_rad": 0.5})").description().at("ground"));
  const double steep = std::tan(0.2);
  CHECK(-up[0] / up[2] == doctest::Approx(steep * std::cos(0.5)));
  CHECK(-up[1] / up[2] == doctest::Approx(steep * std::sin(0.5)));
  const Json level = Played("").description();
  CHECK(normal_of(level.at("ground")) == Vec3{0, 0, 1});
  CHECK(level.at("ground").at("markings").empty());
  CHECK(level.at("payloads").empty());
}

TEST_CASE("Viewers are told what is painted on the ground, a pendulum's hinge, and what is carried from when to when") {
  Played played(R"(
    {"kind": "markings", "line_m": 0.1, "lines": [{"from_m": [1, 2], "to_m": [3, 4]}],
     "arcs": [{"center_m": [5, 6], "radius_m": 0.7}]},
    {"kind": "pendulum", "name": "hit", "length_m": 1.2, "distance_m": 0.4, "position_m": [0, 3, 1],
     "roll_pitch_yaw_rad": [0.1, 0, 0]},
    {"kind": "payload", "name": "bag", "link": "torso", "point_m": [0, 0, 0.1], "mass_kg": 2, "from_s": 1, "until_s": 3},
    {"kind": "payload", "name": "hat", "link": "torso", "mass_kg": 0.1})");
  const Json told = played.description();
  const Json& painted = told.at("ground").at("markings").at(0);
  CHECK(painted.at("line_m") == 0.1);
  CHECK(painted.at("lines") == Json::parse(R"([{"from_m": [1, 2], "to_m": [3, 4]}])"));
  CHECK(painted.at("arcs").at(0).at("radius_m") == 0.7);
  CHECK(painted.at("arcs").at(0).at("to_rad") == doctest::Approx(2 * std::numbers::pi));
  const Json& hinge_m = told.at("world").at(0).at("hinge_m");
  CHECK(hinge_m.at(1) == doctest::Approx(3 - 1.2 * std::sin(0.1)));
  CHECK(hinge_m.at(2) == doctest::Approx(1 + 1.2 * std::cos(0.1)));
  CHECK(told.at("payloads").at(0).at("until_s") == 3);
  CHECK_FALSE(told.at("payloads").at(1).contains("until_s"));
}

TEST_CASE("Signals tell where a driven ground is and how a free box is turned") {
  Played played(crate + "," + driven);
  CHECK(played.run(1).passed);
  const PlantTruth& truth = played.robot.world()->robot(0).truth();
  CHECK(played.value("world.ground.x_m") == doctest::Approx(0.05).epsilon(0.01));
  CHECK(played.value("world.ground.z_m") == doctest::Approx(0.02).epsilon(0.01));
  const Vec3 angles_rad = roll_pitch_yaw(truth.objects.at(0).pose.orientation);
  CHECK(played.value("world.crate.roll_rad") == doctest::Approx(angles_rad[0]).epsilon(1e-3));
  CHECK(played.value("world.crate.yaw_rad") == doctest::Approx(angles_rad[2]).epsilon(1e-3));
  CHECK(std::abs(angles_rad[0]) < 0.05);  // it came down flat
  CHECK_FALSE(Played(crate).robot.catalog().signals.find("world.ground.x_m").has_value());
}

TEST_CASE("A run's state hash leaves out the signals that only say where the ground is and how a box is turned") {
  Played played(crate + "," + driven);
  const SignalTable& signals = played.robot.catalog().signals;
  std::vector<std::string> left_out;
  for (const SignalId id : played.robot.parts().unhashed) {
    if (signals.info(id).name.starts_with("world.")) left_out.push_back(signals.info(id).name);
  }
  CHECK(left_out == std::vector<std::string>{"world.crate.roll_rad", "world.crate.pitch_rad", "world.crate.yaw_rad",
                                             "world.ground.x_m", "world.ground.y_m", "world.ground.z_m"});
}

}  // namespace drawn_world_test
