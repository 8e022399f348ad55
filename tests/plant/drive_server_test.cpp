// The server of emulated drives: its first answers, and in step with its peer, where the model's time is that of the
// peer's bus, whatever the clock does.
#include <filesystem>

#include <doctest/doctest.h>
#include <unistd.h>

#include "plant/dynamixel/emulator/servo_server.h"
#include "plant/hostmot2/emulator/board_server.h"
#include "plant/hostmot2/hostmot2_bench.h"
#include "plant/serial/serial_port.h"
#include "plant/socket_address.h"

namespace kadans::hostmot2::drive_server_test {

using namespace bench;

namespace {

HostMot2Settings at(const char* address) {
  HostMot2Settings settings = two_axes();
  settings.boards.front().address = address;
  settings.watchdog_s = 0.02;
  return settings;
}

struct Ends {
  explicit Ends(const HostMot2Settings& settings)
      : server(settings, site()), model(test::two_joints(), PlantSettings{.position_rad = {0.1, -0.2}}) {
    const BoardSettings& board = settings.boards.front();
    UdpPort(board).send(std::array<std::uint8_t, 1>{});  // somebody is there
    std::vector<std::unique_ptr<BoardLink>> links;
    links.push_back(std::make_unique<LbpLink>(std::make_unique<UdpPort>(board), 5'000'000'000, 0));
    plant = std::make_unique<HostMot2Plant>(settings, site(), std::move(links));
  }
  void tick() {
    plant->read(sensors);
    ActuationFrame actuation;
    actuation.joint_count = 2;
    actuation.joints[0] = effort(0.4);
    plant->write(actuation);
  }
  std::int64_t time_ns() {
    SensorFrame of_model;
    model.read(of_model);
    return of_model.time_ns;
  }

  BoardServer server;
  IdealWorld model;
  std::unique_ptr<HostMot2Plant> plant;
  SensorFrame sensors;
};

}  // namespace

TEST_CASE("Boards answer who speaks first before a beat, and say where their drives stand") {
  Ends ends(at("127.0.7.123"));
  ends.server.look(ends.model);
  REQUIRE(ends.server.await(10'000));
  REQUIRE(ends.plant->open());
  ends.plant->read(ends.sensors);
  CHECK(ends.sensors.joints[0].position_rad == doctest::Approx(0.1).epsilon(0.01));
  CHECK(ends.sensors.joints[1].position_rad == doctest::Approx(-0.2).epsilon(0.01));
}

TEST_CASE("Servos answer who speaks first before a beat, as soon as they know where they stand") {
  const dynamixel::ServoModel* const model = dynamixel::find_model("XM430-W210");
  dynamixel::DynamixelSettings settings;
  settings.ports = {{.name = "bus", .device = "", .baud = 1'000'000}};
  settings.servos = {{.drive = "hip", .port = "bus", .id = 1, .model = model, .zero_pulse = 1000},
                     {.drive = "knee", .port = "bus", .id = 2, .model = model}};
  const std::string bus = std::filesystem::temp_directory_path() / ("kadans-first-" + std::to_string(getpid()));
  dynamixel::ServoServer server(settings, site(), bus);
  IdealWorld world(test::two_joints(), PlantSettings{.position_rad = {0.1, -0.2}});
  TerminalPort port(bus, 1'000'000);
  // Where does servo 1 stand (Present Position, 4 bytes)?
  REQUIRE(port.send(std::array<std::uint8_t, 14>{0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 0x02, 0x84, 0, 4, 0, 0x1D, 0x15}));
  CHECK_FALSE(server.await(50));  // what came waits until they know it
  server.look(world);
  REQUIRE(server.await(10'000));
  std::array<std::uint8_t, 15> answer{};
  for (std::size_t got = 0; got < answer.size();) {
    const std::size_t more = port.receive(std::span(answer).subspan(got), monotonic_ns() + 5'000'000'000);
    REQUIRE(more > 0);
    got += more;
  }
  CHECK(answer[9] + 256 * answer[10] == 1000 + std::lround(0.1 * 4096 / 6.28318530718));
}

TEST_CASE("In step with its peer a server of drives lets time pass with the peer's ticks alone") {
  Ends ends(at("127.0.7.120"));
  REQUIRE(ends.server.step_with_peer());
  ends.server.look(ends.model);
  REQUIRE(ends.server.await(10'000));
  REQUIRE(ends.server.beat(ends.model, 1));
  REQUIRE(ends.plant->open());
  constexpr int setting_up = 20, ticks = 70;
  for (int i = 0; i < ticks; ++i) {
    const std::int64_t before_ns = ends.time_ns();
    ends.tick();
    // The first enable the amplifiers: from then on there is torque, and the model's time runs.
    while (i >= setting_up && ends.time_ns() == before_ns) REQUIRE(ends.server.beat(ends.model, 1));
    if (i < setting_up) (void)ends.server.beat(ends.model, 1);
  }
  const std::int64_t then_ns = ends.time_ns();
  CHECK(then_ns >= (ticks - setting_up) * ms);
  CHECK(then_ns <= ticks * ms);
  // A second without a tick of the peer: by the clock its watchdog would have bitten, and the session would be over.
  for (int i = 0; i < 1100; ++i) REQUIRE(ends.server.beat(ends.model, 1));
  CHECK(ends.time_ns() == then_ns);
  CHECK(ends.server.session().releases == 0);
  ends.tick();
  while (ends.time_ns() == then_ns) REQUIRE(ends.server.beat(ends.model, 1));
  CHECK(ends.time_ns() == then_ns + ms);
}

}  // namespace kadans::hostmot2::drive_server_test
