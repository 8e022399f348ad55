#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"
#include "plant/udp/wire.h"
#include "signal/crc32.h"

using namespace kadans;

namespace {

using Check = PlantWire::Check;

PlantLayout robot(std::size_t joints, std::size_t feet) {
  PlantLayout layout{.robot = "walker", .joints = {}, .feet = {}, .period_ns = 1'000'000};
  for (std::size_t i = 0; i < joints; ++i) layout.joints.push_back("joint_" + std::to_string(i));
  for (std::size_t i = 0; i < feet; ++i) layout.feet.push_back("foot_" + std::to_string(i));
  return layout;
}

// Any number that a double can be.
double number(RandomStream& random) {
  constexpr std::array odd{0.0,
                           -0.0,
                           std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::denorm_min(),
                           std::numeric_limits<double>::max()};
  const std::uint64_t drawn = random.next();
  return drawn % 7 < odd.size() ? odd[drawn % 7] : std::bit_cast<double>(random.next());
}

template <std::size_t size>
void fill(std::array<double, size>& values, RandomStream& random) {
  for (double& value : values) value = number(random);
}

SensorFrame any_sensors(std::uint32_t joints, std::uint32_t feet, RandomStream& random) {
  SensorFrame frame;
  frame.time_ns = static_cast<std::int64_t>(random.next() >> 1U);
  frame.joint_count = joints;
  frame.foot_count = feet;
  for (std::size_t i = 0; i < joints; ++i)
    frame.joints[i] = {number(random),
                       number(random),
                       number(random),
                       static_cast<std::uint32_t>(random.next()),
                       static_cast<std::uint32_t>(random.next()),
                       static_cast<std::int64_t>(random.next()),
                       static_cast<float>(number(random)),
                       static_cast<DriveState>(random.next() % 5),
                       random.next() % 2 == 0,
                       random.next() % 2 == 0};
  frame.supply_V = number(random);
  frame.emergency = random.next() % 2 == 0;
  fill(frame.imu.angular_velocity_rad_s, random);
  fill(frame.imu.acceleration_m_s2, random);
  frame.imu.sequence = static_cast<std::uint32_t>(random.next());
  for (std::size_t i = 0; i < feet; ++i) {
    fill(frame.feet[i].force_N, random);
    frame.feet[i].sequence = static_cast<std::uint32_t>(random.next());
  }
  return frame;
}

bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

template <std::size_t size>
bool same(const std::array<double, size>& a, const std::array<double, size>& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

std::vector<std::byte> copy(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

// Makes the sum right again.
void seal(std::vector<std::byte>& bytes) {
  const std::uint32_t sum = crc32(Bytes(bytes).first(bytes.size() - 4));
  std::memcpy(bytes.data() + bytes.size() - 4, &sum, 4);
}

}  // namespace

TEST_CASE("A sample comes off the wire as it went on, bit for bit") {
  RandomStream random(1, "sample");
  for (const std::size_t joints : {std::size_t{0}, std::size_t{1}, std::size_t{14}, max_joints}) {
    const PlantWire wire(robot(joints, joints % 5 % (max_feet + 1)));
    const std::uint32_t feet = wire.greeting().feet;
    const SensorFrame sent = any_sensors(static_cast<std::uint32_t>(joints), feet, random);
    Datagram datagram{};
    const WireHead head{.kind = WireKind::sensors, .session = 7, .sequence = 1'000'000'000'000, .time_ns = -5};
    const Bytes bytes = wire.sensors(head, {.answered = 99, .released = true}, sent, datagram);
    WireHead got;
    REQUIRE(wire.check(bytes, got) == Check::good);
    CHECK(got.kind == WireKind::sensors);
    CHECK(got.session == 7);
    CHECK(got.sequence == 1'000'000'000'000);
    CHECK(got.time_ns == -5);
    SensorFrame frame;
    const SensorsOnWire more = wire.sensors_in(bytes, frame);
    CHECK(more.answered == 99);
    CHECK(more.released);
    CHECK(frame.joint_count == joints);
    CHECK(frame.foot_count == feet);
    for (std::size_t i = 0; i < joints; ++i) {
      CHECK(same(frame.joints[i].position_rad, sent.joints[i].position_rad));
      CHECK(same(frame.joints[i].motor_position_rad, sent.joints[i].motor_position_rad));
      CHECK(same(frame.joints[i].motor_effort_Nm, sent.joints[i].motor_effort_Nm));
      CHECK(frame.joints[i].sequence == sent.joints[i].sequence);
      CHECK(frame.joints[i].code == sent.joints[i].code);
      CHECK(frame.joints[i].time_ns == sent.joints[i].time_ns);
      CHECK(
          same(static_cast<double>(frame.joints[i].temperature_C), static_cast<double>(sent.joints[i].temperature_C)));
      CHECK(frame.joints[i].drive == sent.joints[i].drive);
      CHECK(frame.joints[i].homed == sent.joints[i].homed);
      CHECK(frame.joints[i].braked == sent.joints[i].braked);
    }
    CHECK(same(frame.imu.angular_velocity_rad_s, sent.imu.angular_velocity_rad_s));
    CHECK(same(frame.imu.acceleration_m_s2, sent.imu.acceleration_m_s2));
    CHECK(frame.imu.sequence == sent.imu.sequence);
    CHECK(same(frame.supply_V, sent.supply_V));
    CHECK(frame.emergency == sent.emergency);
    for (std::size_t i = 0; i < feet; ++i) {
      CHECK(same(frame.feet[i].force_N, sent.feet[i].force_N));
      CHECK(frame.feet[i].sequence == sent.feet[i].sequence);
    }
  }
}

TEST_CASE("An actuation comes off the wire as it went on, and joints that it leaves out are off") {
  RandomStream random(1, "actuation");
  const PlantWire wire(robot(5, 0));
  ActuationFrame sent;
  sent.joint_count = 4;
  for (std::size_t i = 0; i < 4; ++i) sent.drives[i] = {static_cast<DriveOrder>(i + 2), static_cast<std::uint8_t>(i)};
  for (std::size_t i = 0; i < 4; ++i)
    sent.joints[i] = {number(random), number(random), number(random),
                      number(random), number(random), static_cast<ActuationMode>(i + 1)};
  Datagram datagram{};
  const Bytes bytes = wire.actuation({.kind = WireKind::actuation}, sent, datagram);
  WireHead head;
  REQUIRE(wire.check(bytes, head) == Check::good);
  ActuationFrame got;
  wire.actuation_in(bytes, got);
  CHECK(got.joint_count == 5);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(same(got.joints[i].effort_Nm, sent.joints[i].effort_Nm));
    CHECK(same(got.joints[i].position_rad, sent.joints[i].position_rad));
    CHECK(same(got.joints[i].velocity_rad_s, sent.joints[i].velocity_rad_s));
    CHECK(same(got.joints[i].stiffness_Nm_per_rad, sent.joints[i].stiffness_Nm_per_rad));
    CHECK(same(got.joints[i].damping_Nms_per_rad, sent.joints[i].damping_Nms_per_rad));
    CHECK(got.joints[i].mode == sent.joints[i].mode);
    CHECK(got.drives[i].order == sent.drives[i].order);
    CHECK(got.drives[i].number == sent.drives[i].number);
  }
  CHECK(got.joints[4].mode == ActuationMode::off);
}

TEST_CASE("Sensors by name come off the wire, and a robot that names others is another robot") {
  PlantLayout layout = robot(2, 1);
  layout.sensors = {"front", "lid"};
  const PlantWire wire(layout);
  SensorFrame sent;
  sent.joint_count = 2;
  sent.channel_count = 2;
  sent.channels[0] = {1.25, 7};
  sent.channels[1] = {-3, 9};
  Datagram datagram{};
  const Bytes bytes = wire.sensors({.kind = WireKind::sensors}, {}, sent, datagram);
  WireHead head;
  REQUIRE(wire.check(bytes, head) == Check::good);
  SensorFrame got;
  (void)wire.sensors_in(bytes, got);
  CHECK(got.channel_count == 2);
  CHECK(got.channels[0].value == 1.25);
  CHECK(got.channels[1].sequence == 9);
  layout.sensors[1] = "door";
  CHECK(PlantWire(layout).check(bytes, head) == Check::other_layout);
}

TEST_CASE("The bytes on the wire are those of the description") {
  const PlantWire wire(robot(1, 0));
  ActuationFrame frame;
  frame.joint_count = 1;
  frame.joints[0] = {.effort_Nm = 1, .mode = ActuationMode::effort};
  frame.drives[0] = {DriveOrder::reset, 7};
  Datagram datagram{};
  const WireHead head{.kind = WireKind::actuation, .session = 0x0102030405060708, .sequence = 9, .time_ns = 10};
  const Bytes bytes = wire.actuation(head, frame, datagram);
  CHECK(bytes.size() == 40 + 43 + 4);
  const auto at = [&](std::size_t index) { return std::to_integer<int>(bytes[index]); };
  CHECK(std::memcmp(bytes.data(), "KDNP", 4) == 0);
  CHECK(at(4) == wire_version);
  CHECK(at(6) == 4);
  CHECK(at(16) == 8);  // the session's lowest byte first
  CHECK(at(23) == 1);
  CHECK(at(24) == 9);
  CHECK(at(32) == 10);
  CHECK(at(47) == 0x3f);  // 1.0 is 3f f0 00 ...
  CHECK(at(40 + 40) == 1);
  CHECK(at(40 + 41) == 3);
  CHECK(at(40 + 42) == 7);
}

TEST_CASE("No datagram that is cut, longer or changed in a bit passes") {
  RandomStream random(1, "damage");
  const PlantWire wire(robot(3, 1));
  Datagram datagram{};
  ActuationFrame actuation;
  actuation.joint_count = 3;
  const std::vector<std::vector<std::byte>> all{
      copy(wire.sensors({.kind = WireKind::sensors}, {}, any_sensors(3, 1, random), datagram)),
      copy(wire.actuation({.kind = WireKind::actuation}, actuation, datagram)),
      copy(wire.greet({.kind = WireKind::hello}, datagram)), copy(wire.bye({.kind = WireKind::bye}, datagram))};
  WireHead head;
  for (const std::vector<std::byte>& good : all) {
    REQUIRE(wire.check(good, head) == Check::good);
    std::size_t passed = 0;
    for (std::size_t size = 0; size < good.size(); ++size) {
      std::vector<std::byte> cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
      passed += wire.check(cut, head) != Check::garbage;
      if (size < 44) continue;
      seal(cut);  // as if it had been meant to be so short
      passed += wire.check(cut, head) == Check::good;
    }
    std::vector<std::byte> longer = good;
    longer.resize(good.size() + 1);
    passed += wire.check(longer, head) != Check::garbage;
    seal(longer);
    passed += wire.check(longer, head) != Check::garbage;
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
      std::vector<std::byte> changed = good;
      changed[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
      passed += wire.check(changed, head) != Check::garbage;
    }
    CHECK(passed == 0);
  }
}

TEST_CASE("What is whole but not ours is told apart") {
  const PlantWire wire(robot(2, 1));
  Datagram datagram{};
  WireHead head;
  std::vector<std::byte> mode = copy(wire.actuation({.kind = WireKind::actuation}, {}, datagram));
  for (const std::size_t at : {40U + 40U, 40U + 41U}) {  // there is no such mode, no such order to a drive
    std::vector<std::byte> wrong = mode;
    wrong[at] = std::byte{7};
    seal(wrong);
    CHECK(wire.check(wrong, head) == Check::garbage);
  }
  const std::vector<std::byte> sample = copy(wire.sensors({.kind = WireKind::sensors}, {}, {}, datagram));
  struct Wrong {
    std::size_t at;
    int value;
  };
  // No drive has such a state; neither yes nor no: released, emergency, the second joint's homed and braked.
  for (const auto& [at, value] :
       {Wrong{40 + 70 + 44, 5}, {40 + 8, 2}, {40 + 69, 2}, {40 + 70 + 47 + 45, 2}, {40 + 70 + 47 + 46, 2}}) {
    std::vector<std::byte> wrong = sample;
    wrong[at] = static_cast<std::byte>(value);
    seal(wrong);
    CHECK(wire.check(wrong, head) == Check::garbage);
  }
  std::vector<std::byte> kind = copy(wire.bye({.kind = WireKind::bye}, datagram));
  kind[6] = std::byte{77};
  seal(kind);
  CHECK(wire.check(kind, head) == Check::garbage);
  std::vector<std::byte> version = copy(wire.greet({.kind = WireKind::hello}, datagram));
  version[4] = std::byte{200};
  seal(version);
  CHECK(wire.check(version, head) == Check::other_version);
  CHECK(std::string(PlantWire::greeting_in(version).robot.data()) == "walker");
  std::vector<std::byte> name = copy(wire.greet({.kind = WireKind::hello}, datagram));
  name[56] = std::byte{0x1b};  // would command a terminal
  seal(name);
  CHECK(std::string(PlantWire::greeting_in(name).robot.data()) == "?alker");
}

TEST_CASE("Robots whose joints or feet differ in number, name or order have other layouts") {
  const PlantWire wire(robot(4, 2));
  std::vector<PlantLayout> others{robot(5, 2), robot(4, 1), robot(4, 2), robot(4, 2)};
  std::swap(others[2].joints[0], others[2].joints[1]);
  others[3].feet[1] += "x";
  Datagram datagram{};
  WireHead head;
  for (const PlantLayout& other : others) {
    CHECK(PlantWire(other).layout() != wire.layout());
    CHECK(wire.check(PlantWire(other).greet({.kind = WireKind::hello}, datagram), head) == Check::other_layout);
    CHECK(wire.check(PlantWire(other).actuation({.kind = WireKind::actuation}, {}, datagram), head) ==
          Check::other_layout);
  }
  PlantLayout renamed = robot(4, 2);
  renamed.robot = "runner";
  CHECK(PlantWire(renamed).layout() == wire.layout());
  CHECK_THROWS_AS(PlantWire(robot(max_joints + 1, 0)), std::invalid_argument);
}

TEST_CASE("The newest datagram wins, and what became of the others is counted") {
  Arrivals arrivals;
  DatagramCounts s;
  CHECK(arrivals.is_newest(1, s));
  CHECK(arrivals.is_newest(5, s));
  CHECK(s.lost == 3);
  CHECK_FALSE(arrivals.is_newest(3, s));  // after all, but late
  CHECK_FALSE(arrivals.is_newest(3, s));
  CHECK_FALSE(arrivals.is_newest(5, s));
  CHECK(s.lost == 2);
  CHECK(s.reordered == 1);
  CHECK(s.duplicates == 2);
  CHECK(arrivals.is_newest(100, s));
  CHECK_FALSE(arrivals.is_newest(2, s));  // so old that nobody knows whether it came before
  CHECK(s.reordered == 1);
  CHECK(s.received == 4);
  CHECK(s.lost == 2 + 94);
}
