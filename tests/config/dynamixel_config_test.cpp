// What is said to wrong servos under plant.dynamixel, before anything moves.
#include <fstream>
#include <iterator>

#include <doctest/doctest.h>

#include "broken.h"
#include "config/robot/robot_config.h"

namespace kadans {
namespace {

const std::string servos_file = KADANS_SOURCE_DIR "/config/jiwiy/servos.json";

std::string servos_text() {
  std::ifstream in(servos_file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string servos_refusal(const std::string& text) {
  static const std::vector<std::string> types{"profile_position", "joint_velocity", "computed_torque"};
  return refusal(servos_file, KADANS_SOURCE_DIR, [&] { (void)read_robot_config_text(text, servos_file, types); });
}

// The message without its line and column, which are there.
std::string said(const char* find, const char* replace) {
  const std::string text = replaced(servos_text(), find, replace);
  CHECK(text != servos_text());
  const std::string whole = servos_refusal(text);
  const std::size_t line = whole.find(':'), column = whole.find(": ", line + 1);
  CHECK(line > 0);
  CHECK(column != std::string::npos);
  return whole.substr(column == std::string::npos ? 0 : column + 2);
}

}  // namespace

TEST_CASE("Servos that do not fit the robot, each other or their port are refused at their place") {
  REQUIRE(servos_refusal(servos_text()).empty());
  CHECK(said("\"pan\": { \"id\"", "\"pam\": { \"id\"") ==
        "plant.dynamixel.servos: drive 'pan' has no servo\n12:9: plant.dynamixel.servos.pam: no drive 'pam', did you "
        "mean 'pan'?");
  CHECK(said("\"id\": 2", "\"id\": 1") == "plant.dynamixel.servos.tilt.id: servo 1 of port 'bus' already moves 'pan'");
  CHECK(said("\"id\": 2", "\"id\": 253") ==
        "plant.dynamixel.servos.tilt.id is 253, must be 0..252: its id on that port\n13:25: "
        "plant.dynamixel.servos.tilt.id: needs an id of 0..252");
  CHECK(said("\"id\": 2, ", "") == "plant.dynamixel.servos.tilt: needs an id of 0..252");
  CHECK(said("XM430-W210", "XM430-W21O") ==
        "plant.dynamixel.servos.pan.model: unknown servo model 'XM430-W21O', did you mean 'XM430-W210'?");
  CHECK(said("\"id\": 2", "\"port\": \"arm\", \"id\": 2") ==
        "plant.dynamixel.servos.tilt.port: no port 'arm' in plant.dynamixel.ports");
  CHECK(said("3000000", "2500000") ==
        "plant.dynamixel.ports.bus.baud: no servo knows 2500000 baud: 9600, 57600, 115200, 1000000, 2000000, "
        "3000000, 4000000 or 4500000");
  CHECK(said("\"device\": \"/dev/ttyUSB0\", ", "") == "plant.dynamixel.ports.bus: port 'bus' names no device");
  CHECK(said("\"bus\": {", "\"other\": { \"device\": \"/dev/ttyUSB1\" }, \"bus\": {").find("names no port") !=
        std::string::npos);
  CHECK(said("XM430-W210\", \"reversed", "XL330-M288\", \"reversed") ==
        "plant.dynamixel.servos.tilt.model: XL330-M288 and XM430-W210 have their indirect data at different "
        "addresses: they need two ports");
  CHECK(said("\"reversed\": true", "\"revesed\": true").find("did you mean 'reversed'?") != std::string::npos);
}

TEST_CASE("A period that a port cannot hold is refused, with what it needs") {
  CHECK(said("\"ports\"", "\"period_s\": 0.001, \"ports\"") ==
        "plant.dynamixel.period_s: port 'bus' cannot hold 1.00 ms: its 2 servos need 1.35 ms (104 bytes at 3000000 "
        "baud are 0.35 ms, the USB adapter keeps them back for up to 1.00 ms)");
  CHECK(servos_refusal(replaced(servos_text(), "\"ports\"", "\"period_s\": 0.002, \"ports\"")).empty());
}

}  // namespace kadans
