// Both ends of a plant over the network on one thread, step by step.
#include <chrono>
#include <cmath>

#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/un.h>

#include "kadans/plant/ideal_world.h"
#include "kadans/signal/input_error.h"
#include "kadans/testing/allocation_count.h"
#include "lossy_wire.h"
#include "plant/udp/plant_server.h"
#include "plant/udp/udp_plant.h"
#include "two_joints.h"

namespace udp_link_test {

using namespace kadans;
using kadans::test::LossyWire;
using kadans::test::two_joints;

namespace {

constexpr std::int64_t ms = 1'000'000;

PlantLayout layout() { return {.robot = "walker", .joints = {"hip", "knee"}, .feet = {}, .period_ns = ms}; }

ActuationFrame effort(double effort_Nm) {
  ActuationFrame frame;
  frame.joint_count = 2;
  for (std::size_t i = 0; i < 2; ++i) frame.joints[i] = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
  return frame;
}

struct Ends {
  LossyWire wire{1};
  UdpSettings settings{.peer = "the test"};
  IdealWorld model{two_joints(), {.position_rad = {0.1, 0.2}}};
  PlantServer server{settings, layout(), wire.plant_end()};
  UdpPlant plant{settings, layout(), wire.control_end(), 42};
  SensorFrame sensors;
  bool session = true;

  void connect() {
    CHECK(plant.greet());
    wire.step();
    REQUIRE(server.await(0));
    REQUIRE(server.beat(model, 1));
    wire.step();
    REQUIRE(plant.welcomed());
  }
  void tick(double effort_Nm) {
    plant.read(sensors);
    plant.write(effort(effort_Nm));
    wire.step();
    session = session && server.beat(model, 1);
    wire.step();
  }
  double velocity_rad_s() const { return model.truth().velocity_rad_s[0]; }
};

std::string refusal(PlantLayout other) {
  LossyWire wire(1);
  PlantServer server({}, layout(), wire.plant_end());
  UdpPlant plant({.peer = "the test"}, other, wire.control_end(), 1);
  (void)plant.greet();
  wire.step();
  (void)server.await(0);
  wire.step();
  try {
    (void)plant.welcomed();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// A socket with an address of its own that delivers at once.
int named(const char* name, const char* peer) {
  const auto address = [](const char* text) {
    sockaddr_un un{};
    un.sun_family = AF_UNIX;
    std::snprintf(un.sun_path + 1, sizeof un.sun_path - 1, "kadans-%d-%s", getpid(), text);
    return un;
  };
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_un own = address(name);
  REQUIRE(bind(descriptor, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0);
  if (peer == nullptr) return descriptor;
  const sockaddr_un other = address(peer);
  REQUIRE(connect(descriptor, reinterpret_cast<const sockaddr*>(&other), sizeof other) == 0);
  return descriptor;
}

// A port that is taken and refuses what is sent to it: its socket hears one other port only.
struct Deaf {
  int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  int port = 0;
  Deaf() {
    sockaddr_in own{.sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(INADDR_LOOPBACK)}, .sin_zero = {}};
    sockaddr_in other = own;
    other.sin_port = htons(1);
    socklen_t size = sizeof own;
    REQUIRE(bind(descriptor, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0);
    REQUIRE(connect(descriptor, reinterpret_cast<const sockaddr*>(&other), sizeof other) == 0);
    REQUIRE(getsockname(descriptor, reinterpret_cast<sockaddr*>(&own), &size) == 0);
    port = ntohs(own.sin_port);
  }
  ~Deaf() { close(descriptor); }
  Deaf(const Deaf&) = delete;
  Deaf& operator=(const Deaf&) = delete;
};

}  // namespace

TEST_CASE("Over the network a plant is read and driven, a round trip a tick") {
  Ends ends;
  ends.connect();
  for (int i = 0; i < 10; ++i) ends.tick(3);
  CHECK(ends.sensors.joint_count == 2);
  CHECK(ends.sensors.joints[1].position_rad > 0.2);
  CHECK(ends.velocity_rad_s() == doctest::Approx(10 * 0.001 * 3));
  CHECK(ends.sensors.time_ns == 9 * ms);
  CHECK(ends.plant.round_trip_ticks() == 0);
  CHECK(ends.plant.statistics().received == 10);
  CHECK(ends.plant.statistics().lost == 0);
  CHECK(ends.server.link().received == 10);
}

TEST_CASE("Time begins for the plant with the first actuation") {
  Ends ends;
  ends.connect();
  for (int i = 0; i < 100; ++i) {
    CHECK(ends.server.beat(ends.model, 1));
    ends.wire.step();
    ends.plant.read(ends.sensors);
  }
  CHECK(ends.sensors.time_ns == 0);
  ends.tick(1);
  ends.tick(1);
  CHECK(ends.sensors.time_ns == ms);
}

TEST_CASE("Without actuation the plant damps its joints, follows again when there is one, and lets go after a while") {
  Ends ends;
  ends.connect();
  for (int i = 0; i < 100; ++i) ends.tick(10);
  const double driven_rad_s = ends.velocity_rad_s();
  CHECK(driven_rad_s == doctest::Approx(1));
  int beats = 0;
  while (!ends.server.released() && beats < 100) ++beats, (void)ends.server.beat(ends.model, 1);
  CHECK(beats == 21);  // 20 ms: the last actuation holds so long
  CHECK(ends.velocity_rad_s() < driven_rad_s + 21 * 0.01);
  for (int i = 0; i < 500; ++i) CHECK(ends.server.beat(ends.model, 1));
  CHECK(std::abs(ends.velocity_rad_s()) < 0.5);  // damping of 2 Nms/rad on 1 kg m2
  ends.wire.step();
  ends.tick(10);
  CHECK_FALSE(ends.server.released());
  CHECK(ends.server.session().releases == 1);
  beats = 0;
  while (beats < 5000 && ends.server.beat(ends.model, 1)) ++beats;
  CHECK(beats == 1000 - 1);
  CHECK_FALSE(ends.server.session().left);
}

TEST_CASE("In step with its peer the plant lets time pass with the peer's ticks, and waits for them") {
  Ends ends;
  CHECK(ends.server.step_with_peer());
  ends.connect();
  ends.tick(10);
  for (int i = 0; i < 50; ++i) ends.tick(10);
  CHECK(ends.sensors.time_ns == 50 * ms);
  for (int i = 0; i < 3000; ++i) CHECK(ends.server.beat(ends.model, 1));  // a peer that stands still for 3 s
  CHECK_FALSE(ends.server.released());
  ends.wire.step();
  ends.plant.read(ends.sensors);
  const std::int64_t before_ns = ends.sensors.time_ns;
  CHECK(before_ns <= 51 * ms);
  ends.tick(10);
  ends.tick(10);
  CHECK(ends.sensors.time_ns - before_ns <= 2 * ms);
  CHECK(ends.server.session().releases == 0);
  int beats = 0;
  while (beats < 100'000 && ends.server.beat(ends.model, 1)) ++beats;
  CHECK(beats == 60'000 - 1);
}

TEST_CASE("A plant that is told goodbye ends the session and takes the next peer") {
  Ends ends;
  ends.connect();
  ends.tick(1);
  ends.plant.close();
  ends.wire.step();
  CHECK_FALSE(ends.server.beat(ends.model, 1));
  CHECK(ends.server.session().left);
  CHECK_FALSE(ends.server.await(0));
  CHECK(ends.plant.greet());
  ends.wire.step();
  CHECK(ends.server.await(0));
  CHECK_FALSE(ends.server.session().left);
}

TEST_CASE("Samples that answer an actuation too old are held back, and count as late") {
  Ends ends;
  ends.connect();
  for (int i = 0; i < 5; ++i) ends.tick(1);
  ends.wire.to_plant.loss = 1;  // the plant hears nothing, but goes on to tell
  const std::uint32_t sequence = ends.model.truth().joint_count == 2 ? ends.sensors.joints[0].sequence : 0;
  for (int i = 0; i < 10; ++i) ends.tick(1);
  CHECK(ends.sensors.joints[0].sequence == sequence + 10);
  CHECK(ends.plant.statistics().late == 0);
  for (int i = 0; i < 10; ++i) ends.tick(1);
  CHECK(ends.plant.round_trip_ticks() > 10);
  CHECK(ends.plant.statistics().late > 0);
  const std::uint32_t held = ends.sensors.joints[0].sequence;
  for (int i = 0; i < 10; ++i) ends.tick(1);
  CHECK(ends.sensors.joints[0].sequence == held);
  CHECK(ends.plant.released());  // what it says of itself is still heard
}

TEST_CASE("What piled up while nobody read is not taken for new") {
  Ends ends;
  ends.connect();
  for (int i = 0; i < 5; ++i) ends.tick(1);
  const std::int64_t time_ns = ends.sensors.time_ns;
  for (int i = 0; i < 30; ++i) {  // more than the wire holds
    CHECK(ends.server.beat(ends.model, 1));
    ends.wire.step();
  }
  ends.plant.read(ends.sensors);
  CHECK(ends.sensors.time_ns == time_ns);
  CHECK(ends.plant.statistics().late == 1);
  ends.tick(1);
  ends.plant.read(ends.sensors);
  CHECK(ends.sensors.time_ns == time_ns + (1 + 30 + 1) * ms);
}

TEST_CASE("Other robots refuse each other and say what is different") {
  PlantLayout other = layout();
  other.robot = "crawler";
  other.joints.push_back("ankle");
  const std::string message = refusal(other);
  CHECK(message.find("'walker' with 2 joints and 0 feet; this one is 'crawler' with 3 joints") != std::string::npos);
  other = layout();
  std::swap(other.joints[0], other.joints[1]);
  CHECK(refusal(other).find("other names or another order") != std::string::npos);
  other = layout();
  other.period_ns = 2 * ms;
  CHECK(refusal(other).find("control period of 1000000 ns, this robot of 2000000 ns") != std::string::npos);
  CHECK(refusal(layout()).empty());
}

TEST_CASE("Garbage and strangers change nothing and are counted") {
  PlantServer server({}, layout(), DatagramSocket(named("server", nullptr)));
  IdealWorld model(two_joints(), {.position_rad = {0, 0}});
  UdpPlant plant({.peer = "the test"}, layout(), DatagramSocket(named("control", "server")), 1);
  UdpPlant stranger({.peer = "the test", .connect_timeout_s = 0.02}, layout(),
                    DatagramSocket(named("stranger", "server")), 1);
  const DatagramSocket hostile(named("hostile", "server"));
  (void)plant.greet();
  REQUIRE(server.await(0));
  plant.write(effort(1));
  CHECK(server.beat(model, 1));
  CHECK(plant.welcomed());
  const double velocity_rad_s = model.truth().velocity_rad_s[0];
  CHECK(velocity_rad_s > 0);
  RandomStream random(1, "garbage");
  for (int i = 0; i < 40; ++i) {
    stranger.write(effort(-1000));  // the same robot, even the same session, but not the peer
    std::vector<std::byte> garbage(static_cast<std::size_t>(random.uniform(0, 4000)));
    for (std::byte& byte : garbage) byte = static_cast<std::byte>(random.next());
    (void)hostile.send(garbage);
    (void)stranger.greet();
    CHECK(server.beat(model, 1));
  }
  CHECK(model.truth().velocity_rad_s[0] >= velocity_rad_s);
  CHECK(server.link().refused >= 100);
  CHECK(server.link().received == 1);
  CHECK_THROWS_WITH_AS(stranger.open(), "the plant at the test is driven by somebody else", InputError);
}

TEST_CASE("An actuation that answers a time which the plant never had is applied, and counts for no age") {
  PlantServer server({}, layout(), DatagramSocket(named("server", nullptr)));
  IdealWorld model(two_joints(), {.position_rad = {0, 0}});
  const DatagramSocket peer(named("peer", "server"));
  const PlantWire wire(layout());
  Datagram out{};
  (void)peer.send(wire.greet({.kind = WireKind::hello, .session = 1}, out));
  REQUIRE(server.await(0));
  std::uint64_t sequence = 0;
  for (const std::int64_t time_ns : {std::int64_t{0}, INT64_MIN, INT64_MIN, INT64_MAX}) {
    const WireHead head{.kind = WireKind::actuation, .session = 1, .sequence = ++sequence, .time_ns = time_ns};
    (void)peer.send(wire.actuation(head, effort(1), out));
    CHECK(server.beat(model, 1));
  }
  CHECK(server.session().answers == 1);
  CHECK(server.session().answer_mean_ns() == 0);
  CHECK(model.truth().velocity_rad_s[0] == doctest::Approx(0.004));
}

TEST_CASE("Nobody there is told so") {
  LossyWire wire(1);
  UdpPlant plant({.peer = "10.9.8.7:6", .connect_timeout_s = 0.02}, layout(), wire.control_end(), 1);
  CHECK_THROWS_WITH_AS(plant.open(),
                       "the plant at 10.9.8.7:6 does not answer within 0.02 s: is `kadans plant` running there, and "
                       "does the network let UDP pass?",
                       InputError);
  for (const char* wrong : {"", "host", "host:", "host:port", "host:70000", "host:-1"})
    CHECK_THROWS_AS(DatagramSocket(connected_socket(wrong)), InputError);
}

TEST_CASE("A plant that does not listen yet is waited for as long as one that does not answer") {
  static int asked = 0;
  asked = 0;
  const Deaf deaf;
  const std::string place = "127.0.0.1:" + std::to_string(deaf.port);
  UdpPlant plant({.peer = place, .connect_timeout_s = 0.2}, layout(), DatagramSocket(connected_socket(place)), 1);
  const auto begin = std::chrono::steady_clock::now();
  CHECK_THROWS_AS(plant.open([]() noexcept { return ++asked < 0; }), InputError);
  CHECK(std::chrono::steady_clock::now() - begin >= std::chrono::milliseconds(200));
  CHECK(asked <= 11);  // once in 20 ms: it sleeps between
}

TEST_CASE("Waiting for the plant ends when it is told to") {
  static int asked = 0;
  asked = 0;
  LossyWire wire(1);
  UdpPlant plant({.peer = "the test", .connect_timeout_s = 1000}, layout(), wire.control_end(), 1);
  CHECK_FALSE(plant.open([]() noexcept { return ++asked == 2; }));
  CHECK(asked == 2);
}

TEST_CASE("Real sockets carry a session") {
  std::string place;
  const auto listen = [&place] {
    for (int port = 20'000 + getpid() % 20'000;; ++port) {  // the first that nobody else has
      place = "127.0.0.1:" + std::to_string(port);
      try {
        return DatagramSocket(listening_socket(place));
      } catch (const InputError&) {
        REQUIRE(port < 50'000);
      }
    }
  };
  PlantServer server({}, layout(), listen());
  UdpPlant plant({}, layout(), DatagramSocket(connected_socket(place)), 1);
  CHECK(plant.greet());
  REQUIRE(server.await(2000));  // at most: it wakes when something came
  CHECK(server.peer().text().starts_with("127.0.0.1:"));
}

TEST_CASE("A tick over the network does not allocate, on either side") {
  Ends ends;
  ends.connect();
  ends.tick(1);
  const ActuationFrame actuation = effort(1);
  const testing::AllocationCount heap;
  ends.plant.read(ends.sensors);
  ends.plant.write(actuation);
  (void)ends.server.beat(ends.model, 1);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

}  // namespace udp_link_test
