// The IMU on a serial line: messages as the manufacturer's own software wrote them, the driver against the emulated
// device on virtual time, and bytes from anybody.
#include <cmath>
#include <cstdlib>

#include <doctest/doctest.h>

#include "json_plant_fields.h"
#include "kadans/model/kinematics.h"
#include "kadans/plant/ideal_world.h"
#include "kadans/signal/input_error.h"
#include "kadans/testing/allocation_count.h"
#include "plant/imu/emulator/imu_world.h"
#include "plant/imu/imu_plant.h"
#include "two_joints.h"

namespace kadans::imu {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t ms = 1'000'000;

// A message of an MTi-300 with firmware 1.8.2, but for the items that nobody asks for here.
const Bytes recorded{0xFA, 0xFF, 0x36, 0x23, 0x10, 0x20, 0x02, 0xA6, 0x55, 0x40, 0x20, 0x0C, 0xBD,
                     0xA2, 0x1A, 0xF8, 0xBE, 0x2A, 0x8E, 0x96, 0x41, 0x1D, 0x27, 0xA2, 0x80, 0x20,
                     0x0C, 0xBB, 0xB1, 0x7D, 0x81, 0xBB, 0x96, 0x32, 0x00, 0x3C, 0x01, 0xE8, 0x41};

Bytes sealed(Bytes bytes) {
  unsigned sum = 0;
  for (std::size_t i = 1; i < bytes.size(); ++i) sum += bytes[i];
  bytes.push_back(static_cast<std::uint8_t>(0U - sum));
  return bytes;
}

std::vector<Reading> readings_in(const Bytes& bytes, Protocol protocol, MessageScanner& scanner) {
  std::vector<Reading> found;
  for (std::size_t at = 0; at < bytes.size();) {
    const auto room = scanner.room();
    const std::size_t size = std::min(room.size(), bytes.size() - at);
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), size, room.begin());
    scanner.filled(size);
    at += size;
    ReceivedMessage message;
    while (scanner.next(message)) {
      Reading reading;
      if (decode(protocol, message, reading) == Decoded::reading) found.push_back(reading);
    }
  }
  return found;
}

SerialImuSettings mti(Protocol protocol = Protocol::mtdata2) {
  return {.device = "/dev/imu", .protocol = protocol, .rate_Hz = 200, .delay_s = 0.002, .patience_s = 0.1};
}

// A robot of two joints, whose IMU is the emulated one.
struct Rig {
  explicit Rig(const SerialImuSettings& settings = mti(), EmulatedImu::Settings there = {})
      : device(there, 1),
        line(new ImuLine(device)),
        world(test::two_joints(), PlantSettings{.position_rad = {0, 0}}),
        plant(std::make_unique<Bus>(world, *this), settings, from_roll_pitch_yaw(0, 0, std::acos(0.0)),
              std::unique_ptr<SerialPort>(line), ImuPlant::Threads::none) {}

  class Bus final : public Plant {
   public:
    Bus(IdealWorld& world, Rig& rig) : world_(world), rig_(rig) {}
    void read(SensorFrame& sensors) noexcept override {
      world_.read(sensors);
      sensors.time_ns = rig_.now_ns;
    }
    void write(const ActuationFrame& actuation) noexcept override { world_.write(actuation); }

   private:
    IdealWorld& world_;
    Rig& rig_;
  };

  std::string why_not() {
    try {
      (void)plant.open(nullptr);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  void open() {
    REQUIRE(why_not() == "");
    now_ns = line->now_ns();
  }
  void run(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      now_ns += ms;
      line->set(now_ns);
      plant.read(sensors);
    }
  }
  std::uint64_t count(std::string_view name) const {
    for (const PlantCount& one : plant.link_counts()) {
      if (one.name == name) return one.value;
    }
    return ~std::uint64_t{0};
  }

  EmulatedImu device;
  ImuLine* line;
  IdealWorld world;
  std::int64_t now_ns = 0;
  ImuPlant plant;
  SensorFrame sensors;
};

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("A message of a real MTi is read to the digits that its maker's software printed") {
  MessageScanner scanner;
  const std::vector<Reading> found = readings_in(sealed(recorded), Protocol::mtdata2, scanner);
  REQUIRE(found.size() == 1);
  CHECK(found[0].counter == 42581);
  CHECK(found[0].acceleration_m_s2[0] == doctest::Approx(-0.07915300).epsilon(1e-7));
  CHECK(found[0].acceleration_m_s2[1] == doctest::Approx(-0.16655955).epsilon(1e-7));
  CHECK(found[0].acceleration_m_s2[2] == doctest::Approx(9.82217598).epsilon(1e-7));
  CHECK(found[0].angular_velocity_rad_s[0] == doctest::Approx(-0.00541657).epsilon(1e-5));
  CHECK(found[0].angular_velocity_rad_s[2] == doctest::Approx(0.00792891).epsilon(1e-5));
  // What that software sent to the device, and what the device answered.
  std::array<std::uint8_t, 16> bytes{};
  CHECK(write_message(Message::go_to_config, {}, bytes) == 5);
  CHECK(Bytes(bytes.begin(), bytes.begin() + 5) == Bytes{0xFA, 0xFF, 0x30, 0x00, 0xD1});
  CHECK(write_message(Message::go_to_measurement, {}, bytes) == 5);
  CHECK(bytes[4] == 0xF1);
  EmulatedImu device({}, 1);
  device.receive(Bytes{0xFA, 0xFF, 0x30, 0x00, 0xD1}, 0, 115'200);
  CHECK(device.take(bytes, ms) == 5);
  CHECK(Bytes(bytes.begin(), bytes.begin() + 5) == Bytes{0xFA, 0xFF, 0x31, 0x00, 0xD0});
}

TEST_CASE(
    "Items that are missing, doubled, of another size or out of all range are no reading, and one bent byte is found") {
  MessageScanner scanner;
  Bytes doubled = recorded;
  doubled[24] = 0x40;  // two accelerations
  CHECK(readings_in(sealed(doubled), Protocol::mtdata2, scanner).empty());
  Bytes big = recorded;
  big[12] = 0x7F;
  CHECK(readings_in(sealed(big), Protocol::mtdata2, scanner).empty());
  Bytes nan = recorded;
  nan[27] = 0x7F, nan[28] = 0xC0;
  CHECK(readings_in(sealed(nan), Protocol::mtdata2, scanner).empty());
  Bytes brief = recorded;
  brief.resize(24), brief[3] = 20;
  CHECK(readings_in(sealed(brief), Protocol::mtdata2, scanner).empty());
  CHECK(readings_in(sealed(recorded), Protocol::mtdata, scanner).empty());
  const Bytes right = sealed(recorded);
  for (std::size_t at = 0; at < right.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes bent = right;
      bent[at] = static_cast<std::uint8_t>(bent[at] ^ (1U << bit));
      MessageScanner fresh;
      CHECK(readings_in(bent, Protocol::mtdata2, fresh).empty());
    }
  }
}

TEST_CASE(
    "A device of either generation is found and set up, and its readings come in the base's axes with their own "
    "times") {
  for (const Protocol protocol : {Protocol::mtdata2, Protocol::mtdata}) {
    Rig rig(mti(protocol), {.old = protocol == Protocol::mtdata});
    rig.device.feels({0.1, 0.2, 0.3}, {1, 2, 9});
    rig.open();
    rig.run(1000);
    CHECK(rig.count("imu_readings") >= 199);
    CHECK(rig.count("imu_lost") == 0);
    CHECK(rig.count("imu_strange") == 0);
    const ImuSample& imu = rig.sensors.imu;
    CHECK(imu.angular_velocity_rad_s[0] == doctest::Approx(-0.2));  // turned by a quarter about z
    CHECK(imu.angular_velocity_rad_s[1] == doctest::Approx(0.1));
    CHECK(imu.acceleration_m_s2[1] == doctest::Approx(1));
    // It measures every 5 ms. Its message is complete 2 ms and its bytes' time later.
    std::int64_t last_ns = 0;
    std::uint32_t sequence = imu.sequence;
    for (int i = 0; i < 100; ++i) {
      rig.run(1);
      const std::int64_t age_ns = rig.now_ns - rig.sensors.imu.time_ns;
      CHECK(age_ns >= 2 * ms);
      CHECK(age_ns <= 12 * ms);
      if (rig.sensors.imu.sequence == sequence) continue;
      sequence = rig.sensors.imu.sequence;
      if (last_ns != 0) CHECK(std::abs(rig.sensors.imu.time_ns - last_ns - 5 * ms) < 50'000);
      last_ns = rig.sensors.imu.time_ns;
    }
  }
}

TEST_CASE("A line without an IMU, or with another one than was meant, is refused before anything moves") {
  Rig nobody;
  nobody.device.silent = true;
  CHECK(has(nobody.why_not(), "the IMU on /dev/imu does not answer: is it powered, and is its baud rate 115200?"));
  Rig older(mti(), {.old = true});
  CHECK(has(older.why_not(), "refuses a message that it does not know, or not now (error 04, message C0)"));
  Rig slow(mti(), {.rate_max_Hz = 100});
  CHECK(has(slow.why_not(), "gives accelerations at 100 Hz: plant.serial_imu.rate_Hz is 200"));
  SerialImuSettings other = mti();
  other.id = "0123abcd";
  Rig wrong(other);
  CHECK(has(wrong.why_not(), "has the id 037003F8, the configuration says 0123ABCD"));
  other.id = "037003f8";
  CHECK(Rig(other).why_not() == "");
}

TEST_CASE("Fields of a serial IMU that do not fit are refused at their places") {
  const auto refusals = [](const char* text) {
    SerialImuSettings settings;
    const auto json = nlohmann::ordered_json::parse(text);
    test::JsonPlantFields fields(json);
    try {
      settings.fields(fields);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusals(R"({"device": "/dev/imu"})").empty());
  CHECK(has(refusals("{}"), "names no device"));
  CHECK(has(refusals(R"({"device": "a", "protocol": "mtdata3"})"), "'mtdata3' must be mtdata2 or mtdata"));
  CHECK(has(refusals(R"({"device": "a", "rate_Hz": 400})"),
            "400 readings of 40 bytes are 160000 bits in a second, the line has 115200"));
  CHECK(has(refusals(R"({"device": "a", "protocol": "mtdata", "rate_Hz": 70})"), "must divide 115200"));
  CHECK(has(refusals(R"({"device": "a", "id": "12"})"), "'12' must be 8 hexadecimal digits"));
}

TEST_CASE("Bytes that are lost or bent cost readings and are counted, and when the cable is out no reading is new") {
  Rig rig;
  rig.open();
  rig.device.faults = {.corrupt = 0.002, .lost = 0.002};
  rig.run(10'000);
  CHECK(rig.count("imu_lost") > 100);
  CHECK(rig.count("imu_corrupt") > 50);
  CHECK(rig.count("imu_readings") > 1500);
  CHECK(rig.sensors.imu.acceleration_m_s2[2] == doctest::Approx(9.81));
  rig.device.faults = {};
  rig.run(100);
  rig.device.silent = true;
  rig.run(20);
  const std::uint32_t sequence = rig.sensors.imu.sequence;
  rig.run(1000);
  CHECK(rig.sensors.imu.sequence == sequence);
  rig.device.silent = false;
  rig.run(20);
  CHECK(rig.sensors.imu.sequence > sequence);
  CHECK(rig.now_ns - rig.sensors.imu.time_ns < 12 * ms);
}

TEST_CASE("A tick with a serial IMU allocates nothing") {
  Rig rig;
  rig.open();
  rig.run(20);
  rig.now_ns += 100 * ms;
  rig.line->set(rig.now_ns);
  rig.line->fetch();
  const testing::AllocationCount heap;
  rig.plant.read(rig.sensors);
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(rig.count("imu_readings") > 20);
}

TEST_CASE("Whatever bytes arrive, readings are those of an IMU") {
  RandomStream random(7, "hostile");
  MessageScanner scanner;
  const int count = std::getenv("KADANS_SOAK") != nullptr ? 1'000'000 : 20'000;  // NOLINT(concurrency-mt-unsafe)
  const Bytes right = sealed(recorded);
  int taken = 0;
  for (int i = 0; i < count; ++i) {
    Bytes bytes = right;
    const int bent = 1 + static_cast<int>(random.uniform(0, 4));
    for (int k = 0; k < bent; ++k)
      bytes[static_cast<std::size_t>(random.uniform(0, 39.99))] = static_cast<std::uint8_t>(random.next());
    if (random.uniform() < 0.2) bytes.resize(static_cast<std::size_t>(random.uniform(0, 39.99)));
    if (random.uniform() < 0.2) bytes = sealed(Bytes(bytes.begin(), bytes.end() - (bytes.empty() ? 0 : 1)));
    for (const Reading& reading : readings_in(bytes, Protocol::mtdata2, scanner)) {
      ++taken;
      for (std::size_t k = 0; k < 3; ++k) {
        CHECK_UNARY(std::abs(reading.acceleration_m_s2[k]) <= acceleration_max_m_s2);
        CHECK_UNARY(std::abs(reading.angular_velocity_rad_s[k]) <= gyro_max_rad_s);
      }
    }
  }
  CHECK(taken < count / 3);
  CHECK(scanner.counts().corrupt > static_cast<std::uint64_t>(count / 3));
}

}  // namespace kadans::imu
