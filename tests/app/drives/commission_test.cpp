// `kadans commission` on JIWIY, through boards and through servos, on virtual time: each mistake in the wiring is found
// and named, and what is written is what was found.
#include "commission_project.h"

namespace commission_test {

using namespace kadans;
using namespace kadans::program;
using namespace kadans::commission_bench;
namespace fs = std::filesystem;

TEST_CASE("A robot that is wired as its configuration says is left as it is") {
  for (const Bus& bus : {boards, servos}) {
    CAPTURE(bus.type);
    Project project(bus);
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("drive 'pan' moves joint 'pan', seen by encoder 'pan'"));
    CHECK(all.person.was_told("joint 'tilt': a positive effort turns it counter-clockwise, seen from its left"));
    CHECK(read(project.mine) == read(project.right));
  }
}

TEST_CASE("Swapped joints are found by what the person sees, and the configuration says it then") {
  SUBCASE("boards") {
    Project project(boards);
    project.swap("\"encoder\": 0, \"pwm\": 0", "\"encoder\": 1, \"pwm\": 1");
    project.swap("\"enable\": \"20\"", "\"enable\": \"21\"");
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("joint 'tilt' is moved by what is written for 'pan': corrected"));
    CHECK(all.person.was_told("joint 'pan' is moved by what is written for 'tilt': corrected"));
    CHECK(project.is_right());
  }
  SUBCASE("motors of boards") {
    Project project(boards);
    project.swap("\"pwm\": 0", "\"pwm\": 1");
    project.swap("\"enable\": \"20\"", "\"enable\": \"21\"");
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("motors are swapped: joint 'tilt' is moved by that of 'pan': corrected"));
    CHECK(project.is_right());
  }
  SUBCASE("encoders of boards") {
    Project project(boards);
    project.swap("\"encoder\": 0,", "\"encoder\": 1,");
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("encoders are swapped: joint 'pan' is seen by that of 'tilt': corrected"));
    CHECK(project.is_right());
  }
  SUBCASE("servos") {
    Project project(servos);
    project.swap("\"id\": 1", "\"id\": 2");
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("joint 'tilt' is moved by what is written for 'pan': corrected"));
    CHECK(project.is_right());
  }
}

TEST_CASE("Wrong signs are found by what the person sees, each by itself, and corrected") {
  SUBCASE("motor and encoder of a board") {
    Project project(boards);
    project.change(", \"reversed\": true, \"pwm_reversed\": true", "");
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("the sign of the encoder of 'tilt' is wrong: \"reversed\": true corrects it"));
    CHECK(all.person.was_told("the sign of the motor of 'tilt' is wrong: \"pwm_reversed\": true corrects it"));
  }
  SUBCASE("a motor alone, which would run away in any loop") {
    Project project(boards);
    project.change("\"enable\": \"20\"", "\"enable\": \"20\", \"pwm_reversed\": true");
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("the sign of the motor of 'pan' is wrong: \"pwm_reversed\": false corrects it"));
    CHECK(!all.person.was_told("the sign of the encoder"));
    CHECK(has(read(project.mine), "\"enable\": \"20\", \"pwm_reversed\": false"));
  }
  SUBCASE("a servo") {
    Project project(servos);
    project.change(", \"reversed\": true", "");
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("the sign of the servo of 'tilt' is wrong"));
    CHECK(read(project.mine) == read(project.right));
  }
}

TEST_CASE("A dead encoder is found, at any place of the joint, and the other joint goes on") {
  for (const int seed : {1, 2, 3}) {
    CAPTURE(seed);
    Project project(boards);
    project.truth.boards = [](hostmot2::HostMot2Settings& there) { there.drives[0].encoder = 2; };
    project.truth.model = [&](PlantSettings& model) { model.position_rad = {0.7 * seed - 1.5, 0.2 * seed}; };
    const Commissioned& all = project.commissioned();
    REQUIRE(all.report.problems.size() == 1);
    CHECK(has(all.report.problems[0], "joint 'pan' moved, and no encoder did: the encoder of 'pan' is dead"));
    CHECK(all.person.was_told("drive 'tilt' moves joint 'tilt'"));
    CHECK(!all.person.was_told("== direction"));
    check_safe(all.seen);
    CHECK(read(project.mine) == read(project.right));
  }
}

TEST_CASE("A servo whose encoder is dead says so, and nothing is driven") {
  Project project(servos);
  project.truth.servos = [](dynamixel::EmulatedRobot& there) { there.servo(0).break_down(0x08); };
  std::string why;
  try {
    (void)project.commissioned();
  } catch (const InputError& error) {
    why = error.what();
  }
  CHECK_MESSAGE(has(why, "encoder"), why);
  CHECK(project.all.seen.torque_share == 0);
}

TEST_CASE("Servos that stand still for moments have no dead encoder, and are let go where that never ends") {
  for (const int every : {410, 530, 1010}) {
    CAPTURE(every);
    Project project(servos);
    project.truth.stall_ticks = 70;
    project.truth.stall_every = every;
    check_good(project.commissioned());
  }
  Project busy(servos);
  busy.truth.stall_ticks = 70;
  busy.truth.stall_every = 80;
  const Commissioned& all = busy.commissioned();
  REQUIRE(!all.report.problems.empty());
  CHECK_MESSAGE(has(all.report.problems[0],
                    "drive 'pan': its readings come too late to see whether it moves: it was let go at once"),
                all.report.problems[0]);
}

TEST_CASE("A stuck brake is found, at any place of the joint, and the other joint goes on") {
  for (const Bus& bus : {boards, servos}) {
    for (const int seed : {1, 2, 3, 4}) {
      CAPTURE(bus.type);
      CAPTURE(seed);
      const std::size_t stuck = seed == 4 ? 1 : 0;
      const std::string its = stuck == 1 ? "tilt" : "pan", other = stuck == 1 ? "pan" : "tilt";
      Project project(bus);
      project.truth.model = [&](PlantSettings& model) {
        model.drives[stuck].coulomb_Nm = 20;
        model.position_rad = {0.7 * seed - 1.5, 0.2 * seed};
      };
      const Commissioned& all = project.commissioned();
      REQUIRE(all.report.problems.size() == 1);
      const std::string effort = stuck == 1 ? "0.08" : "0.098";
      CHECK_MESSAGE(has(all.report.problems[0], "drive '" + its + "' pushed with " + effort + " Nm, and nothing moved"),
                    all.report.problems[0]);
      CHECK(has(all.report.problems[0], "a brake that is stuck"));
      CHECK(has(all.report.problems[0], "its motor gets its current") == (bus.type == servos.type));
      CHECK(all.person.was_told("drive '" + other + "' moves joint '" + other + "'"));
      check_safe(all.seen);
      CHECK(read(project.mine) == read(project.right));
    }
  }
}

TEST_CASE("A run that is cut off goes on where it was") {
  for (const Bus& bus : {boards, servos}) {
    CAPTURE(bus.type);
    Project project(bus);
    project.all.person.patience = 1;
    CHECK(project.commissioned().report.ended_early);
    CHECK(project.all.person.was_told("drive 'pan' moves joint 'pan'"));
    CHECK(!project.all.person.was_told("drive 'tilt' moves"));
    project.all.person.heard.clear();
    project.all.person.patience = 2;  // names tilt, then the direction of pan
    CHECK(project.commissioned().report.ended_early);
    CHECK(!project.all.person.was_told("Drive 'pan' ("));
    CHECK(project.all.person.was_told("joint 'pan': a positive effort turns it"));
    project.all.person.heard.clear();
    project.all.person.patience = 1000;
    check_good(project.commissioned());
    CHECK(!project.all.person.was_told("Drive '"));
    CHECK(!project.all.person.was_told("joint 'pan': a positive effort"));
    CHECK(project.all.person.was_told("joint 'tilt': a positive effort"));
    project.all.person.heard.clear();
    check_good(project.commissioned());
    CHECK(project.all.person.heard.empty());
  }
}

TEST_CASE("A zero is found at a jig and at a hard stop, and written so that the drives stand there") {
  SUBCASE("boards") {
    Project project(boards);
    project.change("\"enable\": \"20\"", "\"enable\": \"20\", \"home_rad\": 0.25");
    project.all.person.says = {{"pan", "jig"}, {"tilt", "upper-stop"}};
    project.settings.steps = {"zero"};
    const Commissioned& all = project.commissioned();
    for (const std::string& one : all.report.problems) CHECK_MESSAGE(one.empty(), one);
    for (const std::string& one : all.person.heard) INFO(one);
    CHECK(all.person.was_told("joint 'pan': its zero was wrong by 14.3 degrees: \"home_rad\": 0 corrects it"));
    CHECK(all.person.was_told("joint 'tilt': its zero is right"));
    CHECK(all.seen.torque_share < 0.1001);
  }
  SUBCASE("servos") {
    Project project(servos);
    project.change("\"id\": 1", "\"zero_pulse\": 2148, \"id\": 1");
    project.all.person.says = {{"pan", "jig"}, {"tilt", "upper-stop"}};
    project.settings.steps = {"zero"};
    const Commissioned& all = project.commissioned();
    for (const std::string& one : all.report.problems) CHECK_MESSAGE(one.empty(), one);
    CHECK(has(read(project.mine), "\"zero_pulse\": 204"));
    CHECK(all.person.was_told("joint 'pan': its zero was wrong by 8.8 degrees"));
    CHECK(all.seen.torque_share < 0.1001);
  }
}

TEST_CASE("A zero is found by a switch and by an index, which the drive looks for while the key is held") {
  for (const bool by_switch : {false, true}) {
    CAPTURE(by_switch);
    Project project(boards);
    project.change("\"enable\": \"20\"",
                   std::string("\"enable\": \"20\", \"home_rad_s\": 0.1, \"home_rad\": 0.25, ") +
                       (by_switch ? R"("home": "switch", "home_switch": "22")" : R"("home": "index")"));
    project.truth.boards = [&](hostmot2::HostMot2Settings& there) {
      there.drives[0].home = by_switch ? hostmot2::Home::home_switch : hostmot2::Home::index;
      if (by_switch) there.drives[0].home_switch = hostmot2::PinSettings{.number = 22};
      there.drives[0].home_rad = 0.06;
    };
    project.all.person.says = {{"pan", "home"}};
    project.settings.steps = {"zero"};
    project.settings.joints = {"pan"};
    const Commissioned& all = project.commissioned();
    for (const std::string& one : all.report.problems) CHECK_MESSAGE(one.empty(), one);
    CHECK(all.person.was_told(by_switch ? "joint 'pan' has found its \"switch\""
                                        : "joint 'pan' has found its \"index\""));
    CHECK(all.person.was_told("joint 'pan': its zero was wrong by 10."));
    const std::string text = read(project.mine);
    const std::size_t at = text.find("\"home_rad\": ") + 12;
    CHECK(std::abs(std::stod(text.substr(at)) - 0.06) < 0.001);
    check_safe(all.seen);
    project.settings.again = true;
    project.all.person.heard.clear();
    CHECK(project.commissioned().person.was_told("joint 'pan': its zero is right"));
  }
}

TEST_CASE("Soft limits are those to which a joint is moved by hand, and no wider than its URDF's") {
  for (const Bus& bus : {boards, servos}) {
    CAPTURE(bus.type);
    Project project(bus);
    project.settings.steps = {"limits"};
    project.settings.joints = {"pan"};
    const Commissioned& all = project.commissioned();
    for (const std::string& one : all.report.problems) CHECK_MESSAGE(one.empty(), one);
    CHECK(has(read(project.mine), "\"safety\": { \"limits\": { \"pan\": { \"lower_rad\": -2.5"));
    const Robot robot = read_robot(project.mine);
    CHECK(robot.config.safety.joints[0].upper_rad > 2.5);
    CHECK(robot.config.safety.joints[0].upper_rad < 2.6);
  }
}

}  // namespace commission_test
