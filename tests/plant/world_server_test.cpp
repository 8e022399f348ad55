// Several robots of one world behind the ends of as many links, step by step.
#include "plant/world_server.h"

#include <array>
#include <stdexcept>

#include <doctest/doctest.h>

#include "kadans/plant/ideal_world.h"
#include "lossy_wire.h"
#include "plant/udp/plant_server.h"
#include "plant/udp/udp_plant.h"
#include "two_joints.h"

namespace world_server_test {

using namespace kadans;
using kadans::test::LossyWire;
using kadans::test::two_joints;

namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr std::size_t robots = 3;

PlantLayout layout() { return {.robot = "walker", .joints = {"hip", "knee"}, .feet = {}, .period_ns = ms}; }

// Each robot for itself, in one time.
struct Together final : World {
  std::array<IdealWorld, robots> all{IdealWorld{two_joints(), {.position_rad = {0.1, 0.2}}},
                                     IdealWorld{two_joints(), {.position_rad = {0.3, 0.4}}},
                                     IdealWorld{two_joints(), {.position_rad = {0.5, 0.6}}}};
  int steps = 0;
  bool breaks = false;

  std::size_t robot_count() const noexcept override { return robots; }
  WorldRobot& robot(std::size_t number) noexcept override { return all[number]; }
  void step(std::int64_t dt_ns) override {
    if (breaks) throw std::runtime_error("not finite");
    for (IdealWorld& one : all) one.step(dt_ns);
    ++steps;
  }
  void hash(StateHash&) const noexcept override {}
  double velocity_rad_s(std::size_t robot) { return all[robot].truth().velocity_rad_s[0]; }
};

// A program that drives one of the robots.
struct Peer {
  LossyWire wire{1};
  UdpSettings settings{.peer = "the test"};
  std::unique_ptr<UdpPlant> plant = std::make_unique<UdpPlant>(settings, layout(), wire.control_end(), 42);
  SensorFrame sensors;

  std::unique_ptr<PlantEmulator> served() {
    return std::make_unique<PlantServer>(settings, layout(), wire.plant_end());
  }
  void greet() {
    REQUIRE(plant->greet());
    wire.step();
  }
  bool welcomed() {
    wire.step();
    return plant->welcomed();
  }
  void write(double effort_Nm) {
    ActuationFrame frame;
    frame.joint_count = 2;
    for (std::size_t i = 0; i < 2; ++i) frame.joints[i] = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
    plant->write(frame);
    wire.step();
  }
  void read() {
    wire.step();
    plant->read(sensors);
  }
};

struct Served {
  std::array<Peer, robots> peers;
  Together world;
  WorldServer server{emulators()};

  std::vector<std::unique_ptr<PlantEmulator>> emulators() {
    std::vector<std::unique_ptr<PlantEmulator>> all;
    for (Peer& peer : peers) all.push_back(peer.served());
    return all;
  }
  void connect() {
    for (Peer& peer : peers) peer.greet();
    REQUIRE(server.await(0));
    REQUIRE(server.beat(world, 1, ms));
    for (Peer& peer : peers) REQUIRE(peer.welcomed());
  }
};

}  // namespace

TEST_CASE(
    "In a beat the actuations of all robots count, the world steps once, and each is answered with what came of it") {
  Served served;
  served.connect();
  CHECK(served.world.steps == 0);
  for (int beat = 1; beat <= 3; ++beat) {
    for (std::size_t i = 0; i < robots; ++i) served.peers[i].write(static_cast<double>(i + 1));
    REQUIRE(served.server.beat(served.world, 1, ms));
    CHECK(served.world.steps == beat);
    for (std::size_t i = 0; i < robots; ++i) {
      CAPTURE(i);
      CHECK(served.world.velocity_rad_s(i) == doctest::Approx(1e-3 * beat * static_cast<double>(i + 1)));
      served.peers[i].read();
      CHECK(served.peers[i].sensors.time_ns == beat * ms);
    }
  }
}

TEST_CASE("A world of several robots begins when each has its peer, and its time with the first that is driven") {
  Served served;
  for (std::size_t i = 0; i < robots; ++i) {
    CHECK_FALSE(served.server.await(0));
    served.peers[i].greet();
  }
  REQUIRE(served.server.await(0));
  for (int i = 0; i < 5; ++i) REQUIRE(served.server.beat(served.world, 1, ms));
  CHECK(served.world.steps == 0);
  for (Peer& peer : served.peers) REQUIRE(peer.welcomed());
  served.peers[1].write(1);
  for (int i = 0; i < 5; ++i) REQUIRE(served.server.beat(served.world, 1, ms));
  CHECK(served.world.steps == 5);
  // The others hold where they stood.
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}})
    CHECK(served.world.all[i].truth().position_rad[0] == doctest::Approx(i == 0 ? 0.1 : 0.5));
  served.peers[0].write(1);
  REQUIRE(served.server.beat(served.world, 1, ms));
  CHECK(served.world.velocity_rad_s(0) == doctest::Approx(1e-3));
}

TEST_CASE("The periods that passed are made up for all robots alike") {
  Served served;
  served.connect();
  for (Peer& peer : served.peers) peer.write(1);
  REQUIRE(served.server.beat(served.world, 4, ms));
  CHECK(served.world.steps == 4);
  for (std::size_t i = 0; i < robots; ++i) CHECK(served.world.velocity_rad_s(i) == doctest::Approx(4e-3));
}

TEST_CASE("When the peer of one robot goes, the world goes on, and another peer may take this robot over") {
  Served served;
  served.connect();
  for (Peer& peer : served.peers) peer.write(1);
  REQUIRE(served.server.beat(served.world, 1, ms));
  served.peers[0].plant->close();
  served.peers[0].wire.step();
  for (int i = 0; i < 3; ++i) {
    for (const std::size_t on : {1U, 2U}) served.peers[on].write(1);
    REQUIRE(served.server.beat(served.world, 1, ms));
  }
  CHECK(served.world.steps == 4);
  const std::vector<WorldServer::Ended> ended = served.server.take_ended();
  REQUIRE(ended.size() == 1);
  CHECK(ended[0].robot == 0);
  CHECK(ended[0].session.left);
  CHECK_FALSE(ended[0].abandoned);
  CHECK(served.server.take_ended().empty());

  served.peers[0].greet();
  REQUIRE(served.server.beat(served.world, 1, ms));
  REQUIRE(served.server.beat(served.world, 1, ms));
  CHECK(served.peers[0].welcomed());
  const double before_rad_s = served.world.velocity_rad_s(0);
  served.peers[0].write(5);
  REQUIRE(served.server.beat(served.world, 1, ms));
  CHECK(served.world.velocity_rad_s(0) == doctest::Approx(before_rad_s + 5e-3));
}

TEST_CASE("The world is over when its last peer has gone") {
  Served served;
  served.connect();
  for (Peer& peer : served.peers) peer.write(1);
  REQUIRE(served.server.beat(served.world, 1, ms));
  for (std::size_t i = 0; i < robots; ++i) {
    served.peers[i].plant->close();
    served.peers[i].wire.step();
    CHECK(served.server.beat(served.world, 1, ms) == (i + 1 < robots));
  }
  CHECK(served.server.take_ended().size() == robots);
  CHECK_FALSE(served.server.await(0));
}

TEST_CASE("A world that breaks while an emulator waits for its step says so, and its sessions are given up") {
  Served served;
  served.connect();
  for (Peer& peer : served.peers) peer.write(1);
  served.world.breaks = true;
  CHECK_THROWS_WITH(served.server.beat(served.world, 1, ms), "not finite");
  served.server.abandon();
  const std::vector<WorldServer::Ended> ended = served.server.take_ended();
  REQUIRE(ended.size() == robots);
  for (const WorldServer::Ended& one : ended) CHECK(one.abandoned);
  CHECK_FALSE(served.server.await(0));
}

}  // namespace world_server_test
