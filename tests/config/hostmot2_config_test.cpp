// What is said to wrong wiring under plant.hm2-eth, before anything moves.
#include <fstream>
#include <iterator>

#include <doctest/doctest.h>

#include "broken.h"
#include "config/robot/robot_config.h"

namespace kadans {
namespace {

const std::string wired_file = KADANS_SOURCE_DIR "/config/jiwiy/anything_io.json";

std::string wired_text() {
  std::ifstream in(wired_file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string wiring_refusal(const std::string& text) {
  static const std::vector<std::string> types{"profile_position", "joint_velocity", "computed_torque"};
  return refusal(wired_file, KADANS_SOURCE_DIR, [&] { (void)read_robot_config_text(text, wired_file, types); });
}

// The message without its line and column, which are there.
std::string wrongly(const char* find, const char* replace) {
  const std::string text = replaced(wired_text(), find, replace);
  CHECK(text != wired_text());
  const std::string whole = wiring_refusal(text);
  const std::size_t line = whole.find(':'), column = whole.find(": ", line + 1);
  CHECK(line > 0);
  CHECK(column != std::string::npos);
  return whole.substr(column == std::string::npos ? 0 : column + 2);
}

}  // namespace

TEST_CASE("Wiring that does not fit the robot or itself is refused at its place") {
  REQUIRE(wiring_refusal(wired_text()).empty());
  CHECK(wrongly("\"pan\": {", "\"pam\": {").find("plant['hm2-eth'].drives: drive 'pan' has no encoder and no pwm") !=
        std::string::npos);
  CHECK(wrongly("\"pan\": {", "\"pam\": {").find("no drive 'pam', did you mean 'pan'?") != std::string::npos);
  CHECK(wrongly("\"encoder\": 1", "\"encoder\": 0") ==
        "plant['hm2-eth'].drives.tilt.encoder: encoder 0 of board 'io' is already that of drive 'pan'");
  CHECK(wrongly("\"pwm\": 1", "\"pwm\": 0") ==
        "plant['hm2-eth'].drives.tilt.pwm: pwm 0 of board 'io' is already that of drive 'pan'");
  CHECK(wrongly("\"enable\": \"21\"", "\"enable\": \"20\"") ==
        "plant['hm2-eth'].drives.tilt.enable: pin 20 of board 'io' is already an output of drive 'pan'");
  CHECK(wrongly("\"enable\": \"21\"", "\"enable\": \"x21\"").find("'x21' is no pin: a number of 0..143") !=
        std::string::npos);
  CHECK(wrongly("\"counts_per_rad\": 3183.0989, \"reversed\"", "\"counts_per_rad\": -3183, \"reversed\"") ==
        "plant['hm2-eth'].drives.tilt.counts_per_rad: must be above 0; an encoder that counts in the opposite "
        "direction is "
        "\"reversed\": true");
  CHECK(wrongly("\"counts_per_rad\": 3183.0989, \"reversed\"", "\"reversed\"") ==
        "plant['hm2-eth'].drives.tilt: drive 'tilt' does not say how its encoder counts");
  CHECK(wrongly("\"encoder\": 1, ", "") == "plant['hm2-eth'].drives.tilt: drive 'tilt' names no encoder");
  CHECK(wrongly("192.168.1.121", "robot.local").find("'robot.local' must be an address such as 192.168.1.121") !=
        std::string::npos);
  CHECK(wrongly("\"board\": \"7I96\"", "\"pwm_Hz\": 20000").find("does not say what it is") != std::string::npos);
  CHECK(wrongly("\"io\": {", "\"other\": { \"address\": \"192.168.1.121\", \"board\": \"7I96\" }, \"io\": {")
            .find("board 'other' already has the address 192.168.1.121") != std::string::npos);
  CHECK(wrongly("\"enable\": \"21\"", "\"output\": \"pwn\"").find("'pwn' must be pwm_dir, dir_pwm, up_down or pdm") !=
        std::string::npos);
  CHECK(wrongly("\"enable\": \"21\"", "\"home\": \"switch\"").find("needs the pin of a home_switch") !=
        std::string::npos);
  CHECK(wrongly("\"reversed\": true", "\"revesed\": true").find("did you mean 'reversed'?") != std::string::npos);
}

}  // namespace kadans
