// `kadans commission` where two drives move two joints together: the head of 2008 on a board, on virtual time.
#include "commission_project.h"

namespace commission_coupled_test {

using namespace kadans;
using namespace kadans::program;
using namespace kadans::commission_bench;

namespace {

// Two motors turn its lower neck, by their sum and their difference.
void put_head_on_boards(Project& project) {
  project.right = project.folder / "config/head/boards.json";
  std::string drives;
  int i = 0;
  for (const char* name : {"neck_a", "neck_b", "roll", "upper_tilt", "eye_tilt", "left_eye_pan", "right_eye_pan"}) {
    const std::string n = std::to_string(i), pin = std::to_string(42 + i);
    drives += (i++ == 0 ? "\n" : ",\n") + std::string("    \"") + name + R"(": { "encoder": )" + n + R"(, "pwm": )" +
              n + R"(, "enable": ")" + pin +
              R"(", "counts_per_rad": 10430.378, "amplifier_full": 10, "Nm_per_A": 0.03, )" +
              R"("gear": 100, "efficiency": 0.9 })";
  }
  write(project.right, R"({ "based_on": "config/head/robot.json", "name": "head",
  "plant": { "encoders": { "*": { "resolution_rad": 0, "noise_rad": 0 } }, "hm2-eth": {
  "boards": { "io": { "address": "192.168.1.121", "board": "7I96" } }, "drives": {)" +
                           drives + "\n} } } }\n");
  std::filesystem::copy_file(project.right, project.mine, std::filesystem::copy_options::overwrite_existing);
  project.truth.robot = project.right.string();
  project.settings.joints = {"lower_tilt", "pan"};
  project.truth.model = [](PlantSettings& model) { model.gravity_m_s2 = {0, 0, 0}; };  // it is balanced
}

}  // namespace

TEST_CASE("Two drives that move two joints together are named one by one, and their signs found") {
  SUBCASE("right") {
    Project project(boards);
    put_head_on_boards(project);
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("drive 'neck_a' turns as 'neck_a' shall, seen by encoder 'neck_a'"));
    CHECK(all.person.was_told(
        "drive 'neck_b': a positive effort turns joint 'lower_tilt' counter-clockwise, seen from its "
        "left and joint 'pan' counter-clockwise, seen from below"));
    CHECK(read(project.mine) == read(project.right));
  }
  SUBCASE("swapped, and one sign wrong") {
    Project project(boards);
    put_head_on_boards(project);
    project.swap(R"("encoder": 0, "pwm": 0, "enable": "42",)", R"("encoder": 1, "pwm": 1, "enable": "43",)");
    project.change(R"("encoder": 0, "pwm": 0, "enable": "42",)",
                   R"("encoder": 0, "pwm": 0, "enable": "42", "pwm_reversed": true,)");
    const Commissioned& all = project.commissioned();
    check_good(all);
    CHECK(all.person.was_told("joint 'neck_b' is moved by what is written for 'neck_a': corrected"));
    CHECK(all.person.was_told("the sign of the motor of 'neck_b' is wrong: \"pwm_reversed\": false corrects it"));
  }
}

TEST_CASE("Where one of two joints that move together stands at its stop, their drives are not guessed") {
  Project project(boards);
  put_head_on_boards(project);
  project.truth.model = nullptr;  // lower_tilt falls
  const Commissioned& all = project.commissioned();
  REQUIRE(all.report.problems.size() == 2);
  CHECK(has(all.report.problems[0], "drive 'neck_a' turned one of its two joints alone"));
  CHECK(has(all.report.problems[1], "drive 'neck_b' turned one of its two joints alone"));
  CHECK(read(project.mine) == read(project.right));
  check_safe(all.seen);
}

TEST_CASE("The zero of a joint that two drives move is written for both") {
  Project project(boards);
  put_head_on_boards(project);
  project.settings.steps = {"zero"};
  project.settings.joints = {"pan"};
  project.change(R"("enable": "42",)", R"("enable": "42", "home_rad": 0.2,)");
  project.change(R"("enable": "43",)", R"("enable": "43", "home_rad": -0.2,)");
  project.all.person.says = {{"pan", "jig"}};
  const Commissioned& all = project.commissioned();
  for (const std::string& one : all.report.problems) CHECK_MESSAGE(one.empty(), one);
  CHECK(
      all.person.was_told("joint 'pan': its zero was wrong by 11.5 degrees: 'neck_a' \"home_rad\": 0, 'neck_b' "
                          "\"home_rad\": 0 corrects it"));
}

}  // namespace commission_coupled_test
