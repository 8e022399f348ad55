// Datagrams between a control engine and a plant elsewhere, in both directions: what comes off the wire goes on it
// again as it was, and neither end is brought out of step by anybody else's.
//
// An input is datagrams: how, length, bytes. `how`: to whom, whether a right head and sum are put around it, and what
// the two ends do next.
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <sys/socket.h>

#include "fuzz_input.h"
#include "kadans/plant/ideal_world.h"
#include "plant/two_joints.h"
#include "plant/udp/plant_server.h"
#include "plant/udp/udp_plant.h"
#include "signal/crc32.h"

namespace {

using namespace kadans;
using fuzz::require;
using test::two_joints;

constexpr std::int64_t ms = 1'000'000;
constexpr std::uint64_t session = 42;
enum How : std::uint8_t { to_control = 1, sealed = 2, headed = 4, beat = 8, passed_on = 16 };

PlantLayout layout() { return {.robot = "walker", .joints = {"hip", "knee"}, .feet = {"foot"}, .period_ns = ms}; }

const PlantWire& wire() {
  static const PlantWire one(layout());
  return one;
}

// Magic, version, layout and session as they should be.
void put_head(std::string& datagram) {
  Datagram right{};
  const Bytes bye = wire().bye({.kind = WireKind::bye, .session = session}, right);
  if (datagram.size() < wire_head_bytes) return;
  std::memcpy(datagram.data(), bye.data(), 6);
  std::memcpy(datagram.data() + 8, bye.data() + 8, 16);
}

void put_sum(std::string& datagram) {
  if (datagram.size() < 4) return;
  const std::uint32_t sum = crc32(fuzz::bytes_in(datagram).first(datagram.size() - 4));
  std::memcpy(datagram.data() + datagram.size() - 4, &sum, 4);
}

void require_same_again(Bytes datagram) {
  WireHead head;
  if (wire().check(datagram, head) != PlantWire::Check::good) return;
  Datagram into{};
  Bytes again = datagram;
  if (head.kind == WireKind::sensors) {
    SensorFrame frame;
    const SensorsOnWire more = wire().sensors_in(datagram, frame);
    require(frame.joint_count == 2 && frame.foot_count == 1, "a sample is this robot's");
    again = wire().sensors(head, more, frame, into);
  } else if (head.kind == WireKind::actuation) {
    ActuationFrame frame;
    wire().actuation_in(datagram, frame);
    for (std::size_t i = 0; i < frame.joint_count; ++i)
      require(frame.joints[i].mode <= last_actuation_mode, "an actuation has a mode");
    again = wire().actuation(head, frame, into);
  } else if (head.kind == WireKind::bye) {
    again = wire().bye(head, into);
  } else {
    const WireGreeting greeting = PlantWire::greeting_in(datagram);
    require(greeting.robot.back() == 0, "a name ends");
    for (const char c : greeting.robot) require(c == 0 || (c >= ' ' && c <= '~'), "a name can be shown");
  }
  require(again.size() == datagram.size() && std::memcmp(again.data(), datagram.data(), again.size()) == 0,
          "a datagram comes off the wire as it went on");
}

struct Line {
  std::array<int, 2> ends{};
  Line() { require(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0, ends.data()) == 0, "there are sockets"); }
  ~Line() { close(ends[1]); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  void put(std::string_view datagram) const { (void)!send(ends[1], datagram.data(), datagram.size(), MSG_DONTWAIT); }
  // What the end said goes to the other one, or nowhere.
  void empty_into(const Line* other) const {
    std::array<char, 4096> bytes;
    for (ssize_t size = 0; (size = recv(ends[1], bytes.data(), bytes.size(), MSG_DONTWAIT)) >= 0;) {
      if (other != nullptr) other->put({bytes.data(), static_cast<std::size_t>(size)});
    }
  }
};

struct Ends {
  Line control, plant;
  UdpSettings settings{.peer = "the input"};
  IdealWorld model{two_joints(), {.position_rad = {0.1, 0.2}}};
  PlantServer server{settings, layout(), DatagramSocket(plant.ends[0])};
  UdpPlant seen{settings, layout(), DatagramSocket(control.ends[0]), session};
  SensorFrame sensors;
  bool connected = false, in_session = false;

  void step(bool pass_on) {
    if (!connected) {
      (void)seen.greet();
      try {
        connected = seen.welcomed();
      } catch (const InputError&) {  // the plant refuses: told
      }
    } else {
      seen.read(sensors);
      ActuationFrame actuation;
      actuation.joint_count = 2;
      seen.write(actuation);
    }
    control.empty_into(pass_on ? &plant : nullptr);
    try {
      in_session = in_session ? server.beat(model, 1) : server.await(0);
    } catch (const std::runtime_error&) {  // the model says what it was driven to
      in_session = false;
    }
    plant.empty_into(pass_on ? &control : nullptr);
    require(server.session().answers == 0 || server.session().answer_mean_ns() <= 1e18, "ages are sums of ages");
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::FuzzInput input(data, size);
  Ends ends;
  while (!input.empty()) {
    const std::uint8_t how = input.byte();
    std::string datagram(input.take(input.byte()));
    if ((how & headed) != 0) put_head(datagram);
    if ((how & sealed) != 0) put_sum(datagram);
    require_same_again(fuzz::bytes_in(datagram));
    ((how & to_control) != 0 ? ends.control : ends.plant).put(datagram);
    if ((how & beat) != 0) ends.step((how & passed_on) != 0);
  }
  ends.step(true);
  return 0;
}
