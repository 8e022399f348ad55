// The driver of the low level: what becomes of states that are wrong, and what is commanded when.
#include <cmath>
#include <deque>
#include <limits>
#include <memory>

#include <doctest/doctest.h>

#include "kadans/plant/ideal_world.h"
#include "kadans/signal/input_error.h"
#include "kadans/testing/allocation_count.h"
#include "unitree_world.h"

using namespace unitree;
using kadans::ActuationFrame;
using kadans::ActuationMode;
using kadans::DriveOrder;
using kadans::DriveState;

namespace {

// The names of two of its motors are those of joints, the third is told.
kadans::PlantSite site(const Settings& settings) {
  kadans::PlantSite site{.file = "robot.json", .layout = {.robot = "leg", .joints = {}, .feet = {}, .sensors = {}}};
  site.layout.joints = settings.kind->family == Family::go
                           ? std::vector<std::string>{"FL_hip_joint", "FR_calf_joint", "tail"}
                           : std::vector<std::string>{"left_knee_joint", "waist_yaw_joint", "tail"};
  return site;
}

Settings settings_of(const char* kind) {
  Settings settings;
  settings.kind = find_kind(kind);
  settings.damping_s = 0.01;
  settings.motors = {{.drive = "tail", .number = 15, .stiffness_Nm_per_rad = 33, .damping_Nms_per_rad = 3}};
  return settings;
}

// What comes and goes, by hand.
struct Wire final : DriverLink {
  explicit Wire(Family its_family) : family(its_family) {}
  bool send(const Packet& command) noexcept override {
    ++sent;
    return takes && decode(family, command, last) == Verdict::good;
  }
  bool take(Packet& state) noexcept override {
    if (waiting.empty()) return false;
    state = waiting.front();
    waiting.pop_front();
    return true;
  }
  std::uint32_t foreign_commands() noexcept override { return std::exchange(foreign, 0); }
  void wait(std::int64_t until_ns) noexcept override { time_ns = until_ns; }
  std::int64_t now_ns() const noexcept override { return time_ns; }

  void put(const State& state) {
    Packet packet;
    encode(family, state, packet);
    waiting.push_back(packet);
  }

  Family family;
  std::deque<Packet> waiting;
  Command last;
  int sent = 0;
  bool takes = true;
  std::uint32_t foreign = 0;
  std::int64_t time_ns = 0;
};

struct Rig {
  explicit Rig(const char* kind = "go2") : settings(settings_of(kind)), wire(settings.kind->family) {
    state.mode_machine = 4;
    tick();
  }
  // A state that is newer by 2 ms, and a period.
  bool tick() {
    state.tick += 2;
    wire.put(state);
    const bool news = driver.take();
    driver.run(asked);
    wire.time_ns += settings.period_ns();
    return news;
  }
  void ask(std::size_t joint, const kadans::JointActuation& actuation) {
    asked.joint_count = 3;
    asked.joints[joint] = actuation;
  }
  void order(std::size_t joint, DriveOrder order) {
    asked.drives[joint] = {.order = order, .number = static_cast<std::uint8_t>(asked.drives[joint].number + 1)};
  }
  const kadans::JointSample& joint(std::size_t number) const { return driver.sample().joints[number]; }
  const Counts& counts() const { return driver.sample().counts; }

  Settings settings;
  Wire wire;
  State state;
  ActuationFrame asked;
  LowDriver driver{wire, settings, motors_of(settings, site(settings))};
};

}  // namespace

TEST_CASE("Joints are found by the names of the public URDF, in the robots' own orders, or by number") {
  CHECK(find_kind("go2")->joints[0] == "FR_hip_joint");
  CHECK(find_kind("go2")->joints[11] == "RL_calf_joint");
  CHECK(find_kind("g1")->joints.size() == 29);
  CHECK(find_kind("g1")->joints[0] == "left_hip_pitch_joint");
  CHECK(find_kind("g1")->joints[12] == "waist_yaw_joint");
  CHECK(find_kind("h1_2")->joints.size() == 27);
  CHECK(find_kind("h1_2")->joints[0] == "left_hip_yaw_joint");  // not as a G1
  CHECK(find_kind("spot") == nullptr);
  const Settings settings = settings_of("go2");
  const std::vector<MotorSettings> motors = motors_of(settings, site(settings));
  CHECK(motors[0].number == 3);
  CHECK(motors[1].number == 2);
  CHECK(motors[2].number == 15);
  CHECK(motors[2].stiffness_Nm_per_rad == 33);
}

TEST_CASE("Joints without a motor, or with one that there is not or that is taken, are refused by name") {
  Settings settings = settings_of("go2");
  const kadans::PlantSite joints = site(settings);
  const auto why = [&] {
    try {
      (void)motors_of(settings, joints);
    } catch (const kadans::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(why().empty());
  settings.motors[0].number = 20;
  CHECK(why().find("plant.unitree.motors.tail: a go2 has motors 0..19") != std::string::npos);
  settings.motors[0].number = 3;
  CHECK(why().find("motor 3 moves another drive already") != std::string::npos);
  settings.motors.clear();
  CHECK(why().find("robot.json: drive 'tail' is no motor of a go2, such as FR_hip_joint") != std::string::npos);
  settings.kind = nullptr;
  CHECK(why().find("says no plant.unitree.robot") != std::string::npos);
}

TEST_CASE("A place names a network card, a domain, or both") {
  Settings settings;
  settings.take_place("eth0:3", "--peer");
  CHECK(settings.interface == "eth0");
  CHECK(settings.domain == 3);
  settings.take_place(":7", "--peer");
  CHECK(settings.interface == "eth0");
  CHECK(settings.domain == 7);
  settings.take_place("lo", "--peer");
  CHECK(settings.place() == "DDS domain 7 on lo");
  for (const char* wrong : {"lo:", "lo:x", "lo:231", "lo:1 ", "lo:-1"})
    CHECK_THROWS_AS(settings.take_place(wrong, "--peer"), kadans::InputError);
}

TEST_CASE("Each mode is what the motor's own loop makes of it") {
  for (const char* kind : {"go2", "g1"}) {
    Rig rig(kind);
    const std::size_t number = motors_of(rig.settings, site(rig.settings))[0].number;
    const auto sent = [&](const kadans::JointActuation& asked) {
      rig.ask(0, asked);
      rig.tick();
      return rig.wire.last.motors[number];
    };
    const kadans::JointActuation all{.effort_Nm = 5,
                                     .position_rad = 0.5,
                                     .velocity_rad_s = 2,
                                     .stiffness_Nm_per_rad = 80,
                                     .damping_Nms_per_rad = 3,
                                     .mode = ActuationMode::impedance};
    auto asked = all;
    MotorCommand is = sent(asked);
    CHECK(is.mode == motor_on);
    CHECK(is.tau == 5);
    CHECK(is.q == 0.5F);
    CHECK(is.dq == 2);
    CHECK(is.kp == 80);
    CHECK(is.kd == 3);
    asked.mode = ActuationMode::effort;
    is = sent(asked);
    CHECK(is.tau == 5);
    CHECK(is.kp == 0);
    CHECK(is.kd == 0);
    asked.mode = ActuationMode::position;
    is = sent(asked);
    CHECK(is.tau == 5);
    CHECK(is.q == 0.5F);
    CHECK(is.kp == 60);
    CHECK(is.kd == 2);
    asked.mode = ActuationMode::velocity;
    is = sent(asked);
    CHECK(is.dq == 2);
    CHECK(is.kp == 0);
    CHECK(is.kd == 2);
    asked.mode = ActuationMode::off;
    is = sent(asked);
    CHECK(is.mode == motor_on);
    CHECK(is.kp + is.kd + is.tau == 0);
    rig.ask(2, {.position_rad = 1, .mode = ActuationMode::position});
    rig.tick();
    CHECK(rig.wire.last.motors[15].kp == 33);
    CHECK(rig.wire.last.motors[19].mode == 0);  // nobody's
    CHECK(rig.wire.last.mode_machine == (rig.settings.kind->family == Family::hg ? 4 : 0));
    CHECK(rig.wire.last.mode_pr == 0);
  }
}

TEST_CASE("Nothing is commanded before a joint is asked for something") {
  Rig rig;
  for (int i = 0; i < 10; ++i) rig.tick();
  CHECK(rig.wire.sent == 0);
  rig.driver.release();
  CHECK(rig.wire.sent == 0);
  rig.ask(1, {.effort_Nm = 1, .mode = ActuationMode::effort});
  rig.tick();
  CHECK(rig.wire.sent == 1);
}

TEST_CASE("An actuation that no message can hold damps that joint, and is counted") {
  Rig rig;
  rig.ask(0, {.effort_Nm = 1e60, .mode = ActuationMode::effort});
  rig.ask(1, {.effort_Nm = 1, .mode = ActuationMode::effort});
  rig.tick();
  CHECK(rig.counts().refused == 1);
  CHECK(rig.wire.last.motors[3].tau == 0);
  CHECK(rig.wire.last.motors[3].kd == 2);
  CHECK(rig.wire.last.motors[2].tau == 1);
}

TEST_CASE("States that are corrupt, again or old are not used, each counted for itself") {
  Rig rig;
  rig.state.motors[3].q = 0.25;
  REQUIRE(rig.tick());
  const std::uint32_t sequence = rig.joint(0).sequence;
  State wrong = rig.state;
  wrong.motors[3].q = 9;
  rig.wire.put(wrong);  // the same tick
  wrong.tick -= 100;
  rig.wire.put(wrong);
  wrong.tick += 200;
  rig.wire.put(wrong);
  rig.wire.waiting.back().words[100] ^= 1;
  CHECK_FALSE(rig.driver.take());
  CHECK(rig.joint(0).position_rad == 0.25);
  CHECK(rig.joint(0).sequence == sequence);
  CHECK(rig.counts().stale == 2);
  CHECK(rig.counts().corrupt == 1);
  CHECK(rig.tick());
  CHECK(rig.joint(0).sequence == sequence + 1);
}

TEST_CASE("The robot's clock may wrap around") {
  Rig rig;
  for (const std::uint32_t tick : {0x70000000U, 0xE0000000U, 0xFFFFFFFEU, 1U, 5U}) {
    rig.state.tick = tick - 2;
    CHECK(rig.tick());
  }
  CHECK(rig.counts().stale == 0);
  CHECK(rig.counts().restarts == 0);
}

TEST_CASE("A number that is none reaches its joint, where safety looks, and is counted") {
  Rig rig;
  rig.state.motors[3].q = std::numeric_limits<float>::quiet_NaN();
  rig.tick();
  CHECK(rig.counts().not_finite == 1);
  CHECK(std::isnan(rig.joint(0).position_rad));
  CHECK(rig.joint(1).position_rad == 0);
}

TEST_CASE(
    "When somebody else writes commands this driver stops, all drives are in fault, and reset is refused meanwhile") {
  Rig rig;
  rig.ask(0, {.effort_Nm = 1, .mode = ActuationMode::effort});
  rig.tick();
  const int sent = rig.wire.sent;
  rig.wire.foreign = 1;
  rig.tick();
  CHECK(rig.wire.sent == sent);
  CHECK(rig.counts().foreign == 1);
  for (const std::size_t joint : {0U, 1U, 2U}) {
    CHECK(rig.joint(joint).drive == DriveState::fault);
    CHECK(drive_code_words(rig.joint(joint).code) == "others write rt/lowcmd");
  }
  rig.order(0, DriveOrder::reset);
  rig.tick();
  CHECK(rig.joint(0).drive == DriveState::fault);
  for (int i = 0; i < 260; ++i) rig.tick();
  CHECK(rig.joint(0).drive == DriveState::fault);  // until somebody says so
  rig.order(0, DriveOrder::reset);
  rig.tick();
  rig.tick();
  CHECK(rig.joint(0).drive == DriveState::enabled);
  CHECK(rig.wire.sent > sent);
}

TEST_CASE("Somebody else is only counted while this driver commands nothing") {
  Rig rig;
  rig.wire.foreign = 3;
  rig.tick();
  CHECK(rig.counts().foreign == 3);
  CHECK(rig.joint(0).drive == DriveState::enabled);
  rig.ask(0, {.effort_Nm = 1, .mode = ActuationMode::effort});
  rig.tick();
  CHECK(rig.joint(0).code == second_writer_code);
  CHECK(rig.wire.sent == 0);
}

TEST_CASE("A robot that restarts is in fault until it is reset") {
  Rig rig;
  rig.state.tick = 100'000;
  rig.ask(0, {.effort_Nm = 1, .mode = ActuationMode::effort});
  rig.tick();
  const int sent = rig.wire.sent;
  rig.state.tick = 0;
  CHECK(rig.tick());
  CHECK(rig.counts().restarts == 1);
  CHECK(drive_code_words(rig.joint(1).code) == "the robot restarted");
  CHECK(rig.wire.sent == sent);
  rig.order(1, DriveOrder::reset);
  rig.tick();
  rig.tick();
  CHECK(rig.joint(1).drive == DriveState::enabled);
}

TEST_CASE("A motor's own code is a drive's fault, of that joint alone, and a disabled drive has no torque") {
  Rig rig("g1");
  rig.state.motors[3].code = 0x10;
  rig.ask(0, {.effort_Nm = 1, .mode = ActuationMode::effort});
  rig.ask(1, {.effort_Nm = 1, .mode = ActuationMode::effort});
  rig.order(1, DriveOrder::disable);
  rig.tick();
  CHECK(rig.joint(0).drive == DriveState::fault);
  CHECK(rig.joint(0).code == 0x10);
  CHECK(rig.joint(1).drive == DriveState::ready);
  CHECK(rig.joint(2).drive == DriveState::enabled);
  CHECK(rig.wire.last.motors[12].mode == 0);
  rig.order(1, DriveOrder::enable);
  rig.tick();
  CHECK(rig.wire.last.motors[12].mode == motor_on);
}

TEST_CASE("At the end the motors damp, then have no torque") {
  Rig rig;
  rig.ask(0, {.effort_Nm = 1, .mode = ActuationMode::effort});
  rig.tick();
  const int before = rig.wire.sent;
  rig.settings.damping_s = 0.01;
  rig.driver.release();
  CHECK(rig.wire.sent == before + 5 + 5);
  CHECK(rig.wire.last.motors[3].mode == 0);
}

TEST_CASE("Neither the driver nor the tick's side of the plant allocates") {
  const Settings settings = settings_of("go2");
  auto wire = std::make_unique<Wire>(Family::go);
  Wire& link = *wire;
  link.put({.tick = 1});
  UnitreePlant plant(settings, site(settings), std::move(wire));
  REQUIRE(plant.open());
  ActuationFrame asked;
  asked.joint_count = 3;
  asked.joints[0] = {.effort_Nm = 1, .mode = ActuationMode::effort};
  kadans::SensorFrame sensors;
  link.put({.tick = 2});
  const kadans::testing::AllocationCount heap;
  plant.read(sensors);
  plant.write(asked);
  plant.run_cycle();
  plant.read(sensors);
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(link.sent == 1);
  CHECK(sensors.joints[0].sequence == 2);
}
