#include "config/scenario/world_config.h"

#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "config/scenario/scenario_config.h"
#include "kadans/model/kinematics.h"
#include "kadans/signal/input_error.h"

namespace kadans::world_config_test {
namespace {

WorldConfig read(const std::string& entries) {
  WorldConfig world;
  Problems problems("file");
  const std::string text = "{\"world\": [" + entries + "]}";
  read_fields(parse_json(text, "file"), problems, [&](Fields& f) { world_fields(f, world); });
  problems.throw_if_any();
  return world;
}

std::string refusal(const std::string& entries) {
  try {
    read(entries);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

struct Wrong {
  std::string entries, message;
};

const std::string box = R"({"kind": "box", "name": "a", "size_m": [1, 1, 1], "position_m": [0, 0, 0])";

}  // namespace

TEST_CASE("A world of every kind is read as it is written") {
  const WorldConfig config = read(R"(
    {"kind": "ground", "slope_rad": 0.1, "slope_heading_rad": 1,
     "motion": {"profile": [{"time_s": 0, "velocity_m_s": [1, 0, 0]}], "repeat": true}},
    {"kind": "markings", "line_m": 0.1, "lines": [{"from_m": [1, 2], "to_m": [3, 4]}],
     "arcs": [{"center_m": [5, 6], "radius_m": 0.7, "from_rad": 1, "to_rad": 2}]},
    {"kind": "markings", "arcs": [{"center_m": [0, 0], "radius_m": 1}]},
    {"kind": "box", "name": "crate", "size_m": [1, 2, 3], "position_m": [4, 5, 6], "roll_pitch_yaw_rad": [0, 0, 1.5],
     "friction": 0.3, "mass_kg": 7, "velocity_m_s": [1, 0, 0]},
    {"kind": "ramp", "name": "ramp", "length_m": 2, "width_m": 1, "incline_rad": 0.2, "position_m": [0, 0, 0]},
    {"kind": "stairs", "name": "stairs", "count": 4, "rise_m": 0.1, "run_m": 0.3, "width_m": 1, "position_m": [0, 0, 0],
     "motion": {"profile": [{"time_s": 0, "velocity_m_s": [0, 0, 0]}, {"time_s": 2, "velocity_m_s": [0, 1, 0]}],
                "conveyor": true}},
    {"kind": "wall", "name": "wall", "width_m": 2, "height_m": 1, "position_m": [0, 0, 0]},
    {"kind": "ball", "name": "ball", "radius_m": 0.07, "mass_kg": 0.4, "rolling_friction_m": 0.001,
     "restitution": 0.5, "position_m": [0, 0, 0]},
    {"kind": "pendulum", "name": "hit", "distance_m": 0.4, "release_s": 2, "position_m": [0, 0, 1]},
    {"kind": "payload", "name": "bag", "link": "torso", "point_m": [0, 0, 0.1], "mass_kg": 2, "from_s": 1, "until_s": 3})");
  const WorldSettings& world = config.settings;
  CHECK(world.slope_rad == 0.1);
  CHECK(world.slope_heading_rad == 1);
  CHECK(world.ground_motion.repeat);
  REQUIRE(world.markings.size() == 2);
  CHECK(world.markings[0].line_m == 0.1);
  CHECK(world.markings[0].lines.at(0).to_m == std::array<double, 2>{3, 4});
  CHECK(world.markings[0].arcs.at(0).center_m == std::array<double, 2>{5, 6});
  CHECK(world.markings[0].arcs.at(0).from_rad == 1);
  CHECK(world.markings[0].arcs.at(0).to_rad == 2);
  CHECK(world.markings[1].arcs.at(0).to_rad > 6.28);
  REQUIRE(world.objects.size() == 6);
  CHECK(world.objects[3].name == "wall");
  const auto& crate = std::get<WorldBox>(world.objects[0].shape);
  CHECK(crate.size_m == Vec3{1, 2, 3});
  CHECK(crate.mass_kg == 7);
  CHECK(crate.velocity_m_s == Vec3{1, 0, 0});
  CHECK(world.objects[0].friction == 0.3);
  CHECK(roll_pitch_yaw(world.objects[0].pose.orientation)[2] == doctest::Approx(1.5));
  CHECK(std::get<WorldRamp>(world.objects[1].shape).incline_rad == 0.2);
  CHECK(std::get<WorldStairs>(world.objects[2].shape).count == 4);
  CHECK(world.objects[2].motion.conveyor);
  CHECK(world.objects[2].motion.knots[1].velocity_m_s == Vec3{0, 1, 0});
  CHECK(std::get<WorldWall>(world.objects[3].shape).thickness_m == 0.1);
  CHECK(std::get<WorldBall>(world.objects[4].shape).restitution == 0.5);
  const auto& pendulum = std::get<WorldPendulum>(world.objects[5].shape);
  CHECK(pendulum.length_m == 1.5);
  CHECK(pendulum.mass_kg == 2);
  CHECK(pendulum.release_s == 2);
  CHECK(world.payloads[0].mass_kg == 2);
  CHECK(world.payloads[0].until_s == 3);
}

TEST_CASE("Every wrong entry of a world is refused with its place and what was meant") {
  const Wrong table[] = {
      {R"({"kind": "boxx", "name": "a"})", "file:1:21: world[0].kind: unknown value 'boxx', did you mean 'box'?"},
      {R"({"name": "a"})", "file:1:12: key 'kind' is missing in world[0]: kind of object"},
      {box + R"(, "radius_m": 1})",
       "file:1:87: unknown key 'radius_m' in world[0] (known: kind, name, position_m, roll_pitch_yaw_rad, friction, "
       "size_m, "
       "mass_kg, velocity_m_s, carried, motion)"},
      {R"({"kind": "ball", "name": "a", "mass_kg": 1, "position_m": [0, 0, 0]})",
       "file:1:12: key 'radius_m' is missing in world[0]: radius of the ball or bob"},
      {box + R"(, "friction": -1})",
       "file:1:99: world[0].friction is -1, must be 0..10: coefficient of friction of its surface; a contact's "
       "coefficient is the product of those of both surfaces"},
      {box + R"(, "mass_kg": 1, "motion": {"profile": [{"time_s": 0, "velocity_m_s": [0, 0, 0]}]}})",
       "file:1:111: world[0].motion: a box with a mass moves freely and cannot be driven"},
      {box + R"(, "velocity_m_s": [1, 0, 0]})",
       "file:1:103: world[0].velocity_m_s means nothing: a box without mass_kg is fixed"},
      {box + "}, " + box + "}", "file:1:112: world[1]: another entry is named 'a'"},
      {R"({"kind": "wall", "name": "a b", "width_m": 1, "height_m": 1, "position_m": [0, 0, 0]})",
       "file:1:37: world[0].name: 'a b' must be a word of letters, digits and '_', it becomes part of signals' names"},
      {R"({"kind": "pendulum", "name": "a", "distance_m": 2, "position_m": [0, 0, 0]})",
       "file:1:60: world[0].distance_m is 2, must be less than length_m, 1.5 m"},
      {R"({"kind": "payload", "name": "a", "link": "b", "mass_kg": 1, "from_s": 2, "until_s": 1})",
       "file:1:96: world[0].until_s is 1, must be later than from_s, 2 s"},
      {R"({"kind": "ground", "motion": {"profile": [{"time_s": 1, "velocity_m_s": [0, 0, 0]},)"
       R"({"time_s": 1, "velocity_m_s": [0, 0, 0]}]}})",
       "file:1:106: world[0].motion.profile[1].time_s is 1, must be later than the one before, 1 s"},
      {R"({"kind": "markings", "lines": [{"from_m": [0, 0, 0], "to_m": [1, 1]}]})",
       "file:1:54: world[0].lines[0].from_m must be an array of 2 numbers in m, it has 3: x and y of its beginning, in "
       "the "
       "ground's plane"},
      {R"({"kind": "markings", "arcs": [{"center_m": [0, 0], "radius_m": 1, "from_rad": 3, "to_rad": 2}]})",
       "file:1:103: world[0].arcs[0].to_rad is 2, must be more than from_rad, 3 rad"},
      {R"({"kind": "ground"}, {"kind": "ground"})", "file:1:32: world[1]: another entry is named 'ground'"},
      {R"({"kind": "stairs", "name": "a", "count": 0, "rise_m": 1, "run_m": 1, "width_m": 1, "position_m": [0, 0, 0]})",
       "file:1:53: world[0].count is 0, must be 1..32: number of steps"},
  };
  for (const Wrong& wrong : table) CHECK(refusal(wrong.entries) == wrong.message);
}

TEST_CASE("A payload's link must be one of the robot's") {
  const WorldConfig world = read(R"({"kind": "payload", "name": "bag", "link": "torzo", "mass_kg": 1})");
  RobotModel model;
  model.links.resize(1);
  model.links[0].name = "torso";
  CHECK_THROWS_WITH_AS(world_for(world, model, "file"), "file:1:55: unknown link 'torzo', did you mean 'torso'?",
                       InputError);
  model.links[0].name = "torzo";
  CHECK(world_for(world, model, "file").payloads.size() == 1);
}

TEST_CASE("Further robots of a scenario have names of their own, and take the first one's configuration") {
  const std::string file = KADANS_SOURCE_DIR "/config/scenarios/none.json";
  const auto text = [](const std::string& robots, const std::string& plant = "bullet") {
    return R"({"name": "a", "robot": "config/tulip/robot.json", "duration_s": 1, "plant": ")" + plant +
           R"(", "robots": [)" + robots + "]}";
  };
  const ScenarioConfig read =
      read_scenario_config_text(text(R"({"name": "left", "set": {"start.y_m": 0.6}, "behaviors": ["squat"],
               "faults": [{"kind": "drive_dead", "of": "l_knee"}]}, {"name": "b"})"),
                                file);
  REQUIRE(read.robots.size() == 2);
  CHECK(read.robots[0].name == "left");
  CHECK(read.robots[0].robot == read.robot);
  CHECK(read.robots[0].set.at(0).value == 0.6);
  CHECK(read.robots[0].behaviors.size() == 1);
  CHECK(read.robots[0].faults.at(0).of.name == "l_knee");
  const auto refused = [&](const std::string& wrong, const std::string& message) {
    CHECK_THROWS_WITH_AS(read_scenario_config_text(wrong, file), (file + message).c_str(), InputError);
  };
  refused(text(R"({"name": "b"}, {"name": "b"})"), ":1:122: another robot has the name 'b'");
  refused(text(R"({"name": "B 1"})"), ":1:107: name 'B 1' must consist of small letters, digits and underscores");
  refused(text(R"({"name": "b"}], "robot_name": "b", "pushes": [)"), ":1:107: another robot has the name 'b'");
  refused(text(R"({"name": "last"})"),
          ":1:107: name 'last': checks read last.SIGNAL as the signal's value one tick before");
  refused(text(R"({"name": "joint"})"),
          ":1:107: name 'joint': `set` and --set read joint.KEY as a quantity of the first robot");
  refused(text(R"({"name": "b", "faults": [{"kind": "clock_missed", "size": 2}]})"),
          ":1:122: robots[0].faults: clock_missed is a fault of all robots: it belongs to the scenario's own faults");
  refused(text("{}"),
          ":1:98: key 'name' is missing in robots[0]: the robot's name: its signals are "
          "NAME.plant.base.height_m and the like");
  refused(text(R"({"name": "b"})", "ideal"),
          ":1:96: robots: only the bullet plant has one, this scenario's plant is ideal");
}

TEST_CASE("A scenario on the ideal plant has no world, and what nobody could see there") {
  const std::string file = KADANS_SOURCE_DIR "/config/scenarios/none.json";
  const auto text = [](const std::string& plant) {
    return R"({"name": "a", "robot": "config/tulip/robot.json", "duration_s": 1, "plant": ")" + plant +
           R"(", "world": [{"kind": "ground", "slope_rad": 0.1}]})";
  };
  CHECK(read_scenario_config_text(text("bullet"), file).world.settings.slope_rad == 0.1);
  CHECK_THROWS_WITH_AS(read_scenario_config_text(text("ideal"), file),
                       (file + ":1:95: world: only the bullet plant has one, this scenario's plant is ideal").c_str(),
                       InputError);
  const auto refused = [&](const std::string& key, const std::string& what) {
    const std::string more =
        R"({"name": "a", "robot": "config/tulip/robot.json", "duration_s": 1, "plant": "ideal", ")";
    CHECK_THROWS_WITH_AS(read_scenario_config_text(more + key + "\": []}", file),
                         (file + ":1:" + std::to_string(more.size() + key.size() + 4) + ": " + key +
                          ": only the bullet plant can be " + what + ", this scenario's plant is ideal")
                             .c_str(),
                         InputError);
  };
  refused("pushes", "pushed");
  refused("carried", "carried");
}

}  // namespace kadans::world_config_test
