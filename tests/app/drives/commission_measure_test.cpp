// `kadans commission` measures on JIWIY, through boards and through servos, on virtual time: how strong an amplifier
// is, what a joint's inertia, friction and delay are, and which gains follow.
#include <random>

#include "commission_project.h"

namespace commission_measure_test {

using namespace kadans;
using namespace kadans::program;
using namespace kadans::commission_bench;

namespace {

double factor_of(int seed, double least, double most) {
  std::mt19937 random(static_cast<unsigned>(seed));
  return std::uniform_real_distribution<>(least, most)(random);
}

// The number behind these words, in what the person was told; NaN where they were not.
double told(const Commissioned& all, const std::string& words) {
  for (const std::string& one : all.person.heard) {
    const std::size_t at = one.find(words);
    if (at != std::string::npos) return std::stod(one.substr(at + words.size()));
  }
  return std::nan("");
}

DriveConstants constants(const Project& project, const char* drive) {
  const Robot robot = read_robot(project.mine);
  return plant_type(robot.config.plant_types, project.truth.type).constants_of(drive);
}

void check_well(const Commissioned& all) {
  for (const std::string& one : all.person.heard) INFO(one);
  check_good(all);
}

}  // namespace

TEST_CASE("The scale of an amplifier that is off by any share is found by a known mass, and written when agreed") {
  for (const Bus& bus : {boards, servos}) {
    for (const int seed : {1, 2, 3}) {
      CAPTURE(bus.type);
      CAPTURE(seed);
      const double gain = factor_of(seed, 0.6, 1.6);
      Project project(bus);
      project.truth.boards = [&](hostmot2::HostMot2Settings& there) { there.drives[1].amplifier.full *= gain; };
      project.truth.servo_settings = [&](dynamixel::DynamixelSettings& there) {
        there.servos[1].Nm_per_A = gain * there.servos[1].torque_constant_Nm_per_A();
      };
      project.truth.load_kg = 0.025;
      project.truth.model = [&](PlantSettings& model) { model.position_rad = {0, 0}; };
      project.all.person.hand_at = HandAt{.joint = 1, .place_rad = 0, .share = 1};
      project.all.person.replies = {
          {"With what", "mass"}, {"How heavy", "0.025"}, {"How far", "0.1"}, {"to be written", "yes"}};
      project.settings.steps = {"scale"};
      project.settings.joints = {"tilt"};
      const double right = gain * constants(project, "tilt").scale.value;
      check_well(project.commissioned());
      CHECK(project.all.person.was_told("joint 'tilt' carries") == false);  // it is in the question
      CHECK(project.all.person.was_told(" is written"));
      CHECK(constants(project, "tilt").scale.value == doctest::Approx(right).epsilon(0.04));
      CHECK(constants(project, "pan").scale.value == doctest::Approx(right / gain));
      CHECK(read(project.mine).find("\"doc\": \"JIWIY on ") < read(project.mine).find("\"based_on\""));
      project.all.person.heard.clear();
      project.settings.again = true;
      check_well(project.commissioned());
      CHECK(project.all.person.was_told("the scale of its amplifier is right"));
    }
  }
}

TEST_CASE(
    "Inertia, friction and delay of a joint are measured, and gains are proposed, tried by a small step, and written") {
  for (const Bus& bus : {boards, servos}) {
    for (const int seed : {1, 2, 3}) {
      CAPTURE(bus.type);
      CAPTURE(seed);
      const double heavier = factor_of(seed, 0.7, 2);
      const bool is_board = std::string(bus.type) == boards.type;
      Project project(bus);
      project.truth.model = [&](PlantSettings& model) { model.drives[0].rotor_inertia_kg_m2 *= heavier; };
      project.truth.delay_ticks = static_cast<std::size_t>(seed - 1);
      project.all.person.replies = {{"Gains of joint", "take"}};
      project.settings.steps = {"gains"};
      project.settings.joints = {"pan"};
      const Commissioned& all = project.commissioned();
      check_well(all);
      // The link's own, with the camera before it, and the rotor's.
      const double inertia_kg_m2 = told(all, "joint 'pan': inertia ");
      CHECK(inertia_kg_m2 == doctest::Approx(0.00242 + 0.0025 * heavier).epsilon(0.1));
      CHECK(told(all, "friction ") == doctest::Approx(0.01).epsilon(0.25));
      const double bus_ms = is_board ? 1.5 : 2, tick_ms = is_board ? 1 : 2;
      CHECK(std::abs(told(all, "delay ") - bus_ms - tick_ms * (seed - 1)) < 0.75 * tick_ms);
      CHECK(told(all, "came to ") > 60);
      CHECK(told(all, "and went ") < 20);
      const double stiffness = told(all, "joint 'pan' with ");
      CHECK(stiffness > 1.5);
      CHECK(stiffness < 3.5);
      const std::string kp = R"("objects": [{ "name": "torque", "parameters": { "pan.kp_per_s2": )";
      const std::string text = read(project.mine);
      REQUIRE(has(text, kp));
      CHECK(std::stod(text.substr(text.find(kp) + kp.size())) ==
            doctest::Approx(stiffness / inertia_kg_m2).epsilon(0.01));
      CHECK(constants(project, "pan").stiffness.value == doctest::Approx(is_board ? stiffness : 0));
    }
  }
}

TEST_CASE("Gains with which a joint oscillates are let go at once, and not written") {
  for (const Bus& bus : {boards, servos}) {
    for (const auto& gains : {std::pair("400", "2"), std::pair("5", "0"), std::pair("1", "3")}) {
      const char *const stiffness = gains.first, *const damping = gains.second;
      CAPTURE(bus.type);
      CAPTURE(stiffness);
      Project project(bus);
      project.truth.delay_ticks = 3;
      project.all.person.replies = {{"Gains of joint", "others"}, {"Stiffness", stiffness}, {"Damping", damping}};
      project.settings.steps = {"gains"};
      project.settings.joints = {"pan"};
      const Commissioned& all = project.commissioned();
      REQUIRE(all.report.problems.size() == 1);
      CHECK_MESSAGE(has(all.report.problems[0], "it was let go at once"), all.report.problems[0]);
      check_safe(all.seen);
      CHECK(read(project.mine) == read(project.right));
    }
  }
}

}  // namespace commission_measure_test
