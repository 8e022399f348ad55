// A scenario with several robots.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"
#include "app/run/served_world.h"
#include "app/services.h"
#include "telemetry/record/viewer_messages.h"

namespace robots_test {

using namespace kadans;

namespace {

ScenarioConfig squat() { return read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json"); }

NumberEntry at_y(double y_m) { return {.key = "start.y_m", .value = y_m}; }

// The squat, and another TULip that squats `y_m` to the left.
ScenarioConfig with_left(double y_m) {
  ScenarioConfig scenario = squat();
  ScenarioConfig left = scenario;
  left.name = "left";
  left.set = {at_y(y_m)};
  scenario.robots.push_back(left);
  return scenario;
}

double value(Assembly& robot, const std::string& signal) {
  return robot.control().row()[robot.catalog().signals.find(signal).value()];
}

struct Played {
  explicit Played(const ScenarioConfig& scenario) : robot(scenario, 3, log) {}
  RunResult run(double duration_s) {
    Checks none(robot.catalog().signals, {});
    return run_scenario(robot.parts(), duration_s, none, {});
  }
  RunLog log;
  Assembly robot;
};

}  // namespace

TEST_CASE("The ground is the first robot's: a further one has no quantity of it") {
  ScenarioConfig scenario = with_left(20);
  scenario.set = {{.key = "ground.friction", .value = 0.9}};
  const Played played(scenario);
  CHECK(played.robot.quantities().at(0).name == "ground.friction");
  scenario.robots[0].set = {{.key = "ground.friction", .value = 0.1}};
  CHECK_THROWS_WITH_AS(Played{scenario}, doctest::Contains("'ground.friction'"), InputError);
}

TEST_CASE("A value that is set last goes to the robot whose name it begins with") {
  ScenarioConfig scenario = with_left(20);
  set_last(scenario, {.key = "left.start.x_m", .value = 0.5});
  set_last(scenario, {.key = "start.x_m", .value = 0.25});
  const Played played(scenario);
  CHECK(played.robot.others().at(0)->quantities().back().name == "start.x_m");
  CHECK(played.robot.others().at(0)->quantities().back().value == 0.5);
  CHECK(std::ranges::count(played.robot.quantities(), 0.25, &QuantityValue::value) == 1);
  scenario.robots[0].set_last.clear();
  set_last(scenario, {.key = "left.start.z", .value = 0.5});
  CHECK_THROWS_WITH_AS(Played{scenario}, doctest::Contains("--set: unknown quantity 'start.z'"), InputError);
}

TEST_CASE("A robot's signals are the same, bit for bit, when another one plays far away in its world") {
  const ScenarioConfig one = squat(), two = with_left(20);
  Played alone(one), together(two);
  CHECK(alone.run(1.5).passed);
  CHECK(together.run(1.5).passed);
  const SignalTable& signals = alone.robot.catalog().signals;
  std::size_t compared = 0;
  for (const std::string& name : signals.names()) {
    if (name.starts_with("behavior")) continue;  // of the interpreter: memory and the like
    CAPTURE(name);
    const double a = value(alone.robot, name), b = value(together.robot, name);
    CHECK((a == b || (std::isnan(a) && std::isnan(b))));
    ++compared;
  }
  CHECK(compared > 250);
}

TEST_CASE(
    "Each robot plays its own behaviors, and what the others do is among the first one's signals, of the same tick") {
  ScenarioConfig scenario = with_left(1.5);
  scenario.behaviors.clear();
  scenario.robots[0].pushes = {{.link = {"torso", {}}, .at_s = 0.5, .duration_s = 0.1, .impulse_Ns = {0.5, 0, 0}}};
  Played played(scenario);
  CHECK(played.run(2.5).passed);
  Assembly& left = *played.robot.others().at(0);
  for (const char* signal : {"plant.base.height_m", "plant.base.y_m", "joint.l_knee.position_rad", "safety.faults"}) {
    CAPTURE(signal);
    CHECK(value(played.robot, std::string("left.") + signal) == value(left, signal));
  }
  CHECK(value(left, "plant.base.y_m") == doctest::Approx(1.5).epsilon(0.01));
  CHECK(value(left, "plant.base.height_m") < value(played.robot, "plant.base.height_m") - 0.01);
  CHECK_FALSE(played.log.transitions().empty());
  for (const Transition& transition : played.log.transitions()) CHECK(transition.behavior.starts_with("left."));
}

TEST_CASE("A check may look at another robot, and a robot that is pushed falls against it") {
  ScenarioConfig scenario = with_left(0.6);
  scenario.pushes = {{.link = {"torso", {}}, .at_s = 0.5, .duration_s = 0.2, .impulse_Ns = {0, 20, 0}}};
  Played played(scenario);
  Checks checks(played.robot.catalog().signals, {{.name = "left feels it",
                                                  .kind = CheckKind::eventually,
                                                  .signal = "left.plant.contact.robots_force_N",
                                                  .min = 20}});
  const RunResult result = run_scenario(played.robot.parts(), 2, checks, {});
  CHECK(result.checks.at(0).passed);
}

TEST_CASE("A check may ask in which state a behavior of another robot is") {
  ScenarioConfig scenario = with_left(20);
  scenario.behaviors.clear();
  Played played(scenario);
  Checks checks(played.robot.catalog().signals,
                {{.name = "left squats", .kind = CheckKind::eventually, .that = "state('left.squat.squat')"},
                 {.name = "without the behavior", .kind = CheckKind::eventually, .that = "state('left.squat')"},
                 {.name = "at rest before", .kind = CheckKind::always, .that = "not state('left.rest')", .until_s = 1}},
                "scenario.json", played.robot.signal_states());
  const RunResult result = run_scenario(played.robot.parts(), 3, checks, {});
  for (const CheckResult& check : result.checks) CHECK_MESSAGE(check.passed, check.name);
  CHECK_THROWS_WITH_AS(Checks(played.robot.catalog().signals,
                              {{.name = "n", .kind = CheckKind::always, .that = "state('left.squat.squit')"}},
                              "scenario.json", played.robot.signal_states()),
                       doctest::Contains("did you mean 'left.squat.squat'?"), InputError);
}

TEST_CASE("A further robot's faults are its own, told with its name, and the first one goes on as without them") {
  ScenarioConfig sound = with_left(20), faulty = with_left(20);
  using Kind = ScenarioFault::Kind;
  faulty.robots[0].faults = {{.kind = Kind::sensor_silent, .of = {"l_knee", {}}, .from_s = 0.2},
                             {.kind = Kind::behaviors_silent, .from_s = 0.5}};
  Played one(sound), two(faulty);
  CHECK(one.run(1).faults.empty());
  std::vector<std::string> told;
  for (const RunFault& fault : two.run(1).faults) told.push_back(fault_name(fault.told));
  CHECK(told == std::vector<std::string>{"sensor_silent of left.l_knee", "heartbeat_lost of left"});
  for (const char* signal : {"safety.faults", "joint.l_knee.position_rad", "plant.base.height_m"}) {
    CAPTURE(signal);
    CHECK(value(one.robot, signal) == value(two.robot, signal));
  }
}

TEST_CASE("Observers of a run, and so its record and its servers, are told the faults of all robots with their names") {
  struct Hearing final : RunObserver {
    void fault(const Fault& fault) override { heard.push_back(fault); }
    std::vector<Fault> heard;
  } hearing;
  ScenarioConfig scenario = with_left(20);
  scenario.faults = {{.kind = ScenarioFault::Kind::sensor_silent, .of = {"r_knee", {}}, .from_s = 0.1}};
  scenario.robots[0].faults = {{.kind = ScenarioFault::Kind::sensor_silent, .of = {"l_knee", {}}, .from_s = 0.2},
                               {.kind = ScenarioFault::Kind::behaviors_silent, .from_s = 0.5}};
  Played played(scenario);
  Checks none(played.robot.catalog().signals, {});
  (void)run_scenario(played.robot.parts(), 1, none, {&hearing});
  const ViewerSubjects subjects = viewer_subjects(played.robot);
  std::vector<std::string> named;
  for (const Fault& fault : hearing.heard) named.push_back(fault_name(told(fault, subjects, 0)));
  CHECK(named ==
        std::vector<std::string>{"sensor_silent of r_knee", "sensor_silent of left.l_knee", "heartbeat_lost of left"});
}

TEST_CASE("Viewers get joint states, wrenches and the base of each robot, a further one's under its name") {
  const ScenarioConfig scenario = with_left(1.5);
  Played played(scenario);
  CHECK(played.run(0.1).passed);
  ViewerMessages messages(played.robot.catalog().signals, viewer_subjects(played.robot));
  std::vector<std::string> topics;
  std::string bases;
  for (std::size_t i = 0; i < messages.channels().size(); ++i) {
    topics.push_back(messages.channels()[i].topic);
    if (topics.back() != "/tf") continue;
    ByteWriter message;
    messages.write(i, 0, played.robot.control().row(), message);
    bases.assign(reinterpret_cast<const char*>(message.bytes().data()), message.size());
  }
  CHECK(topics == std::vector<std::string>{"/joint_states", "/tf", "/wrench/l_ankle_roll_link",
                                           "/wrench/r_ankle_roll_link", "/left/joint_states",
                                           "/left/wrench/l_ankle_roll_link", "/left/wrench/r_ankle_roll_link"});
  const std::string base = played.robot.robot().model.links.front().name;
  CHECK(bases.find("\"child_frame_id\":\"" + base + "\"") != std::string::npos);
  const std::size_t left = bases.find("\"child_frame_id\":\"left/" + base + "\"");
  REQUIRE(left != std::string::npos);
  const double y_m = std::stod(bases.substr(bases.find("\"y\":", left) + 4));
  CHECK(y_m == doctest::Approx(1.5).epsilon(0.01));
}

TEST_CASE("The hash of a run holds what is under way to the late drives of a further robot") {
  ScenarioConfig scenario = with_left(20);
  scenario.robots[0].set.push_back({.key = "actuation.delay_s", .value = 0.003});
  const auto hash = [&scenario](bool held_back) {
    Played played(scenario);
    RunParts parts = played.robot.parts();
    REQUIRE(parts.others.at(0).faulty != nullptr);
    if (!held_back) parts.others[0].faulty = nullptr;
    Checks none(played.robot.catalog().signals, {});
    return run_scenario(parts, 0.01, none, {}).state_hash;
  };
  CHECK(hash(true) == hash(true));
  CHECK(hash(true) != hash(false));
}

TEST_CASE("What is set for a further robot is among the quantities of the run") {
  const ScenarioConfig scenario = with_left(1.5);
  const Played played(scenario);
  const auto left = std::ranges::find(played.robot.quantities(), "left.start.y_m", &QuantityValue::name);
  REQUIRE(left != played.robot.quantities().end());
  CHECK(left->value == 1.5);
}

TEST_CASE("Robots need a world that they can share, and one clock") {
  RunLog log;
  PlantExchange link;
  const ScenarioConfig two = with_left(1);
  CHECK_THROWS_WITH_AS(Assembly(two, 1, log, &link), doctest::Contains("a run on the wall clock has one robot"),
                       InputError);
}

TEST_CASE("A robot that is carried stands on, and its odometry does not notice, and so are further robots and a ball") {
  ScenarioConfig scenario = with_left(1);
  scenario.behaviors.clear();
  scenario.robots[0].behaviors.clear();
  for (ScenarioConfig* robot : {&scenario, &scenario.robots[0]})
    robot->behaviors =
        read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/side_by_side.json").behaviors;  // stand
  scenario.carried = {{.at_s = 1, .heading_rad = 1.2, .to_m = {3, 4}}};
  scenario.robots[0].carried = {{.at_s = 1.5, .heading_rad = -1, .to_m = {-2, 1}}};
  WorldObject ball{.name = "ball", .shape = WorldBall{.radius_m = 0.1, .mass_kg = 0.4}};
  ball.pose.position_m = {8, 0, 0.1};
  scenario.world.settings.objects = {ball};
  scenario.world.carried = {{.object = 0, .at_s = 0.5, .to_m = {5, 5, 0.1}}};
  Played played(scenario);
  (void)played.run(2.5);
  const auto is = [&](const std::string& signal) { return value(played.robot, signal); };
  CHECK(std::abs(is("plant.base.x_m") - 3) < 0.02);
  CHECK(std::abs(is("plant.base.y_m") - 4) < 0.02);
  CHECK(std::abs(is("left.plant.base.x_m") + 2) < 0.02);
  CHECK(is("plant.base.height_m") > 0.8);
  CHECK(is("left.plant.base.height_m") > 0.8);
  CHECK(std::abs(is("odometry.x_m")) < 0.02);
  CHECK(std::abs(is("odometry.heading_rad")) < 0.02);
  CHECK(is("safety.faults") == 0);
  CHECK(std::abs(is("world.ball.x_m") - 5) < 1e-3);
}

TEST_CASE("What plant serves of a scenario is its world: all robots, what it sets and draws, its pushes") {
  ScenarioConfig scenario = with_left(1);
  scenario.set.push_back({.key = "link.torso.mass_scale", .value = 1.5});
  ServedWorld still(scenario, 3);
  scenario.robots[0].pushes.push_back(
      {.link = {"torso", {}}, .at_s = 0.002, .duration_s = 0.01, .impulse_Ns = {0, 5, 0}});
  ServedWorld pushed(scenario, 3);
  REQUIRE(pushed.robot_count() == 2);
  const std::vector<ServedWorld::Site> sites = pushed.sites();
  CHECK(sites[0].robot.name == "tulip");
  CHECK(sites[1].name == "left");
  for (int i = 0; i < 20; ++i) {
    still.step(1'000'000);
    pushed.step(1'000'000);
  }
  CHECK(pushed.robot(1).truth().com_m[1] - pushed.robot(0).truth().com_m[1] > 0.9);
  CHECK(pushed.robot(0).truth().com_velocity_m_s[1] == still.robot(0).truth().com_velocity_m_s[1]);
  CHECK(pushed.robot(1).truth().com_velocity_m_s[1] - still.robot(1).truth().com_velocity_m_s[1] > 0.1);

  scenario.robots[0].pushes[0].link.name = "tail";
  CHECK_THROWS_WITH_AS(ServedWorld(scenario, 3), doctest::Contains("tail"), InputError);
}

TEST_CASE("plant serves each robot of a scenario to a run of its own, and ends when both have gone") {
  using namespace kadans::program;
  const auto folder = project_copy("served_robots");
  write(folder / "config/scenarios/two.json",
        R"({"name": "two", "doc": "Two heads.", "robot": "config/jiwiy/robot.json", "duration_s": 1,
            "robots": [{"name": "other", "set": {"start.y_m": 1}}], "checks": []})");
  const std::string listen = " --listen 127.0.7.90:7300 --listen 127.0.7.90:7301";
  Running plant(folder, "plant config/scenarios/two.json --soft --once" + listen);
  REQUIRE(plant.says("serves 'other' on 127.0.7.90:7301"));
  const std::string run_of =
      "run config/jiwiy/robot.json --plant udp --soft --no-ctl --duration 0.5 --peer 127.0.7.90:";
  Running first(folder, run_of + "7300"), other(folder, run_of + "7301");
  CHECK(plant.says("jiwiy: driven by 127."));
  CHECK(plant.says("other: driven by 127."));
  // Whether a drive's sample came in time is up to the machine, and a late one fails a run with 1.
  CHECK(first.says("duration over"));
  CHECK(other.says("duration over"));
  CHECK_MESSAGE(first.end() <= 1, first.heard());
  CHECK_MESSAGE(other.end() <= 1, other.heard());
  CHECK(plant.says("no peer is left"));
  CHECK(plant.end() == 0);
  CHECK(has(plant.heard(), "jiwiy: the peer left"));
  CHECK(has(plant.heard(), "other: the peer left"));

  const auto refused = [&](const std::string& options) {
    const Outcome outcome = run("plant config/scenarios/two.json --soft --once " + options, folder);
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  };
  CHECK(has(refused("--listen :7300"), "--listen: once for each robot, in this order: jiwiy, other"));
  CHECK(has(refused(listen + " --plant ideal"), "--plant: does not go with a scenario, which says its plant"));
  CHECK(has(refused(listen + " --in-step"), "--in-step: is for one robot"));
  CHECK(has(refused(listen + " --fault cable_out@1"), "--fault: is for one robot alone"));
  CHECK(has(run("plant config/jiwiy/robot.json --soft" + listen, folder).err, "--listen: one robot is served"));
}

}  // namespace robots_test
