// The server of emulated drives in step with its peer: the model's time is that of the peer's bus, whatever the clock
// does.
#include <thread>

#include <doctest/doctest.h>

#include "hostmot2_bench.h"
#include "plant/hostmot2/emulator/board_server.h"
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

TEST_CASE("In step with its peer a server of drives lets time pass with the peer's ticks alone") {
  Ends ends(at("127.0.7.120"));
  REQUIRE(ends.server.step_with_peer());
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
