// JIWIY and TULip on HostMot2 boards: their whole control systems, the driver, the datagrams and the boards, on virtual
// time.
#include <cstdlib>
#include <fstream>

#include <doctest/doctest.h>

#include "app/assembly.h"
#include "plant/dynamixel_world.h"
#include "plant/hostmot2_world.h"
#include "plant/json_plant_fields.h"
#include "plant/udp_world.h"
#include "program.h"

namespace hostmot2_test {

using namespace kadans;
using namespace kadans::program;

namespace {

const std::string source = KADANS_SOURCE_DIR "/";
std::string robot_on_boards;  // the configuration of the robot that stands there
test::HostMot2World* newest_machine = nullptr;
test::DynamixelWorld* newest_servos = nullptr;
test::UdpWorld* newest_udp = nullptr;

// With what the files say on which it is based.
nlohmann::ordered_json read_whole(const std::string& file) {
  std::ifstream in(file);
  const nlohmann::ordered_json own = nlohmann::ordered_json::parse(in);
  if (!own.contains("based_on")) return own;
  nlohmann::ordered_json all = read_whole(source + own.at("based_on").get<std::string>());
  all.merge_patch(own);
  return all;
}

// A model for scenarios: Bullet's, driven through the boards that the robot's configuration names.
class BoardsType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "boards"; }
  std::string_view doc() const noexcept override { return "of the test"; }
  bool is_model() const noexcept override { return true; }
  std::unique_ptr<World> make_world(const WorldSite& world) const override {
    const nlohmann::ordered_json robot = read_whole(robot_on_boards);
    hostmot2::HostMot2Settings settings;
    test::JsonPlantFields fields(robot.at("plant").at("hm2-eth"));
    settings.fields(fields);
    PlantSite site{.file = robot_on_boards, .layout = {.robot = robot.at("name")}};
    for (const auto& joint : world.model.joints) site.layout.joints.push_back(joint.name);
    for (const FootSettings& foot : world.settings.feet) site.layout.feet.push_back(foot.link);
    const PlantTypes types = plant_types();
    auto made =
        std::make_unique<test::HostMot2World>(plant_type(types, "bullet").make_world(world), settings, settings, site);
    if (robot.at("plant").contains("serial_imu")) {
      imu::SerialImuSettings beside;
      test::JsonPlantFields its(robot.at("plant").at("serial_imu"));
      beside.fields(its);
      made->stand_beside(beside, world.settings.imu.pose.orientation);
    }
    newest_machine = made.get();
    return made;
  }
};
// The same robot on servos as strong as its motors, a port for each leg.
class LegServosType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "leg_servos"; }
  std::string_view doc() const noexcept override { return "of the test"; }
  bool is_model() const noexcept override { return true; }
  std::unique_ptr<World> make_world(const WorldSite& world) const override {
    dynamixel::DynamixelSettings settings;
    settings.ports = {{.name = "l", .device = "left", .baud = 4'000'000},
                      {.name = "r", .device = "right", .baud = 4'000'000}};
    settings.usb_latency_s = 0.0005;
    std::uint32_t id = 0;
    PlantSite site{.file = robot_on_boards, .layout = {.robot = "tulip"}};
    for (const auto& joint : world.model.joints) {
      site.layout.joints.push_back(joint.name);
      if (joint.passive()) continue;
      settings.servos.push_back({.drive = joint.name,
                                 .port = joint.name.substr(0, 1),
                                 .id = ++id,
                                 .model = dynamixel::find_model("XM430-W350"),
                                 .Nm_per_A = 12});
    }
    const PlantTypes types = plant_types();
    auto made = std::make_unique<test::DynamixelWorld>(plant_type(types, "bullet").make_world(world), settings, site);
    newest_servos = made.get();
    return made;
  }
};

class UdpWorldType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "udp_in_step"; }
  std::string_view doc() const noexcept override { return "of the test"; }
  bool is_model() const noexcept override { return true; }
  std::unique_ptr<World> make_world(const WorldSite& world) const override {
    PlantLayout layout{.robot = "tulip"};
    for (const auto& joint : world.model.joints) layout.joints.push_back(joint.name);
    for (const FootSettings& foot : world.settings.feet) layout.feet.push_back(foot.link);
    const PlantTypes types = plant_types();
    auto made = std::make_unique<test::UdpWorld>(plant_type(types, "bullet").make_world(world), layout);
    newest_udp = made.get();
    return made;
  }
};
std::unique_ptr<PlantType> make_leg_servos_type() { return std::make_unique<LegServosType>(); }
KADANS_REGISTER_PLANT_TYPE(make_leg_servos_type);
std::unique_ptr<PlantType> make_udp_world_type() { return std::make_unique<UdpWorldType>(); }
KADANS_REGISTER_PLANT_TYPE(make_udp_world_type);
std::unique_ptr<PlantType> make_boards_type() { return std::make_unique<BoardsType>(); }
KADANS_REGISTER_PLANT_TYPE(make_boards_type);

struct Through {
  bool passed = false;
  std::string why;
  std::uint64_t hash = 0;
  std::vector<PlantCount> counts;
  double delay_ticks = 0;  // mean age of a joint's reading
  std::vector<CheckResult> checks;
};

// Over the 20 ticks behind the end of a run.
double delay_ticks_of(OneRobotWorld& world) {
  SensorFrame sensors;
  double sum = 0;
  for (int i = 0; i < 20; ++i) {
    world.read(sensors);
    const std::int64_t time_ns = sensors.joints[0].time_ns != 0 ? sensors.joints[0].time_ns : sensors.time_ns;
    sum += 1e3 * seconds_between(time_ns, sensors.time_ns);
    world.write({});
    world.step(1'000'000);
  }
  return sum / 20;
}

// `stick`: a recording in the place of the scenario's.
Through run_through(const char* plant, const std::string& file, const char* scenario_name, std::uint64_t seed,
                    const std::string& stick = "") {
  robot_on_boards = source + file;
  ScenarioConfig scenario = read_scenario_config(source + "config/scenarios/" + scenario_name + ".json");
  scenario.robot = robot_on_boards;
  scenario.plant = plant;
  if (!stick.empty()) scenario.joystick.recording = stick;
  RunLog log;
  Assembly robot(scenario, seed, log);
  Checks checks(robot.catalog().signals, scenario.checks);
  const RunResult result = run_scenario(robot.parts(), scenario.duration_s, checks, {});
  Through is{.passed = result.passed};
  for (const CheckResult& check : result.checks) {
    if (!check.passed) is.why += check.name + " (" + std::to_string(check.value) + "); ";
  }
  for (const RunFault& one : result.faults) is.why += std::string(name(one.code)) + "; ";
  is.hash = result.state_hash;
  is.why += result.error;
  const std::string_view through = plant;
  if (through == "boards") is.counts = newest_machine->driver().link_counts();
  if (through == "leg_servos") is.counts = newest_servos->driver().link_counts();
  if (through == "udp_in_step") is.counts = newest_udp->driver().link_counts();
  if (through == "boards") is.delay_ticks = delay_ticks_of(*newest_machine);
  if (through == "leg_servos") is.delay_ticks = delay_ticks_of(*newest_servos);
  if (through == "udp_in_step") is.delay_ticks = newest_udp->driver().round_trip_ticks();
  is.checks = result.checks;
  return is;
}

std::uint64_t count_of(const Through& run, std::string_view name) {
  for (const PlantCount& one : run.counts) {
    if (one.name == name) return one.value;
  }
  return ~std::uint64_t{0};
}

}  // namespace

TEST_CASE("JIWIY follows its sine through a HostMot2 board, with the behavior that drives the model, on every seed") {
  constexpr const char* file = "config/jiwiy/anything_io.json";
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    const Through model = run_through("bullet", file, "jiwiy_sine", seed);
    const Through board = run_through("boards", file, "jiwiy_sine", seed);
    CAPTURE(board.why);
    CHECK(model.passed);
    CHECK(board.passed);
    CHECK(board.hash != model.hash);
    CHECK(count_of(board, "sent") == 7500);  // one in each tick
    CHECK(count_of(board, "lost") == 0);
    CHECK(count_of(board, "bites") == 0);
  }
  CHECK(run_through("boards", file, "jiwiy_sine", 1).hash == run_through("boards", file, "jiwiy_sine", 1).hash);
}

TEST_CASE("JIWIY as in 2008: its joystick at 10 Hz turns it through a board that is asked at 100 Hz") {
  // The shipped recording tells of the stick every 100 ms. In 2008 there was one control, and no button that switched.
  const std::string stick = (fresh_folder("stick_2008") / "stick.evemu").string();
  std::ifstream in(source + "config/joystick/jiwiy_round.evemu");
  std::ofstream out(stick);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("E:") || line.find(" 0001 ") == std::string::npos) out << line << '\n';
  }
  out.close();
  const Through board = run_through("boards", "config/jiwiy/anything_io_2008.json", "jiwiy_unplugged", 1, stick);
  CAPTURE(board.why);
  CHECK(board.passed);
  CHECK(count_of(board, "sent") == 351);  // in 3.5 s
  CHECK(count_of(board, "lost") == 0);
  CHECK(count_of(board, "bites") == 0);
}

TEST_CASE(
    "TULip squats, gets up and catches pushes through two HostMot2 boards and a serial IMU, with the same behaviors") {
  constexpr const char* file = "config/tulip/anything_io.json";
  for (const std::string scenario : {"squat", "get_up_prone", "get_up_supine", "push_forward", "push_left"}) {
    CAPTURE(scenario);
    const Through boards = run_through("boards", file, scenario.c_str(), 1);
    CAPTURE(boards.why);
    CHECK(boards.passed);
    CHECK(count_of(boards, "lost") == 0);
    CHECK(count_of(boards, "strange") == 0);
    CHECK(count_of(boards, "imu_readings") > 200);
    CHECK(count_of(boards, "imu_lost") == 0);
  }
  CHECK(run_through("boards", file, "squat", 1).hash == run_through("boards", file, "squat", 1).hash);
}

TEST_CASE("The same squat goes through every bus, and the table says how well") {
  const auto worst = [](const Through& run, std::string_view name) {
    for (const CheckResult& check : run.checks) {
      if (check.name.starts_with(name)) return check.value;
    }
    return 1e9;
  };
  std::string table = "through, height error mm, tilt rad, delay ticks, lost\n";
  for (const std::string plant : {"bullet", "udp_in_step", "boards", "leg_servos"}) {
    const std::string file = plant == "boards" ? "config/tulip/anything_io.json" : "config/tulip/robot.json";
    const Through run = run_through(plant.c_str(), file, "squat", 1);
    CAPTURE(plant);
    CAPTURE(run.why);
    // Servos on a serial line are read and driven anew every other tick: it squats, and sways.
    if (plant == "leg_servos") {
      for (const char* what : {"stays up", "crouches", "stands at the end"}) CHECK_FALSE(has(run.why, what));
    } else {
      CHECK(run.passed);
    }
    std::array<char, 200> row{};
    std::snprintf(row.data(), row.size(), "%s, %.3f, %.4f, %.2f, %llu\n", plant.c_str(),
                  1e3 * worst(run, "height follows"), worst(run, "torso upright"), run.delay_ticks,
                  static_cast<unsigned long long>(run.counts.empty() ? 0 : count_of(run, "lost")));
    table += row.data();
  }
  MESSAGE(table);
}

// The robot of a file as one that waits for drives and readings as long as a busy machine may take.
std::string patient(const std::filesystem::path& project, const std::string& file) {
  const std::string boards = has(file, "anything_io") ? R"("plant": { "hm2-eth": { "watchdog_s": 1 } }, )" : "";
  write(project / "config/jiwiy/patient.json", R"({ "based_on": ")" + file + R"(", "name": "jiwiy", )" + boards +
                                                   R"("safety": { "silent_ticks_max": 10000,
                                                                "drives": { "sample_age_max_s": 10 } } })");
  return (project / "config/jiwiy/patient.json").string();
}

TEST_CASE("mesaflash reads the emulated board as it reads a real one") {
  const auto folder = fresh_folder("mesaflash");
  if (std::system("command -v mesaflash > /dev/null") != 0) {
    MESSAGE("mesaflash is not installed");
    return;
  }
  Running plant(folder, "plant " + source + "config/jiwiy/anything_io.json --as hm2-eth --listen 127.0.7.96 --soft");
  REQUIRE(plant.says("serves 'jiwiy'"));
  const auto read_out = folder / "read.txt";
  const std::string command = "timeout 60 mesaflash --device 7I96 --addr 127.0.7.96 --readhmid > " + read_out.string();
  CHECK(std::system(command.c_str()) == 0);
  const std::string out = read(read_out);
  for (const char* part : {"BoardName : MESA7I96", "There are 1 of WatchDog", "There are 3 of IOPort",
                           "There are 2 of QCount", "There are 2 of PWM", "Clock High frequency: 200.0000 MHz"})
    CHECK_MESSAGE(has(out, part), out);
  CHECK(plant.end(SIGTERM) == 0);
}

TEST_CASE("TULip is driven over the wire: two boards on the network and an IMU on a serial port, in two processes") {
  const auto folder = fresh_folder("tulip_wire");
  const std::string robot = source + "config/tulip/anything_io.json", line = (folder / "imu").string();
  Running plant(folder, "plant " + robot + " --as hm2-eth --listen 127.0.7.110 --imu " + line + " --soft --once");
  REQUIRE(plant.says("serves 'tulip'"));
  const std::string command = "run " + robot + " --plant hm2-eth --peer 127.0.7.110 --soft --no-ctl --duration 2 ";
  const Outcome there = run(command + "--play squat --imu " + line, folder);
  CHECK_MESSAGE(has(there.out, " imu_readings"), there.out, there.err);
  CHECK_FALSE(has(there.out, " 0 imu_readings"));
  CHECK(plant.end() == 0);
  const Outcome nowhere = run(command + "--imu /dev/null", folder);
  CHECK(nowhere.exit_code == 2);
  CHECK(has(nowhere.err, "--imu: the serial port /dev/null: is no serial port"));
  const Outcome none =
      run("run " + source + "config/jiwiy/anything_io.json --plant hm2-eth --soft --no-ctl --imu " + line, folder);
  CHECK(none.exit_code == 2);
  CHECK(has(none.err, "says no plant.serial_imu (docs/imu.md)"));
}

TEST_CASE("After kill -9 of a run its boards have released their outputs by themselves, and its servos have stopped") {
  const auto folder = project_copy("killed_bus");
  const auto killed = [&](const std::string& file, const std::string& as, const std::string& where) {
    const std::string robot = patient(folder, file);
    Running plant(folder, "plant " + robot + " --as " + as + " --listen " + where + " --soft --once");
    REQUIRE(plant.says("serves 'jiwiy'"));
    Running driver(folder, "run " + robot + " --plant " + as + " --peer " + where + " --soft --no-ctl --play sine -v");
    REQUIRE(driver.says("ahead -> "));  // to follow, or, on a machine that stood still for long, to failed
    CHECK(driver.end(SIGKILL) == 128 + SIGKILL);
    CHECK(plant.says("the watchdog released the joints "));
    CHECK_FALSE(has(plant.heard(), "released the joints 0 times"));
    CHECK(plant.end() == 0);
  };
  killed("config/jiwiy/anything_io.json", "hm2-eth", "127.0.7.98");
  killed("config/jiwiy/servos.json", "dynamixel", (folder / "bus").string());
}

TEST_CASE(
    "Faults of a bus and its drives that kadans plant is asked for befall a run, and others are refused with those "
    "there are") {
  const auto folder = project_copy("bus_faults");
  const auto befallen = [&](const std::string& file, const std::string& as, const std::string& where,
                            const std::string& fault) {
    const std::string robot = patient(folder, file);
    Running plant(folder, "plant " + robot + " --as " + as + " --listen " + where + " --soft --once " + fault);
    REQUIRE(plant.says("serves 'jiwiy'"));
    Running driver(folder, "run " + robot + " --plant " + as + " --peer " + where + " --soft --no-ctl --play sine -v");
    return driver.says("drive_fault");
  };
  CHECK(befallen("config/jiwiy/anything_io.json", "hm2-eth", "127.0.7.99", "--fault watchdog_bites@0.5"));
  CHECK(befallen("config/jiwiy/anything_io.json", "hm2-eth", "127.0.7.100", "--fault cable_out:io@0.5"));
  CHECK(befallen("config/jiwiy/servos.json", "dynamixel", (folder / "a").string(), "--fault drive_hot:tilt@0.5=99"));
  CHECK(befallen("config/jiwiy/servos.json", "dynamixel", (folder / "b").string(), "--fault drive_reboots:pan@0.5"));

  const auto refused = [&](const std::string& fault) {
    const Outcome outcome = run("plant " + source + "config/jiwiy/servos.json --as dynamixel --soft --listen " +
                                    (folder / "c").string() + " --fault " + fault,
                                folder);
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  };
  CHECK(has(refused("watchdog_bites@1"), "no fault 'watchdog_bites' of this bus; there are bytes_lost, bytes_corrupt"));
  CHECK(has(refused("drive_hot:tlt@1=90"), "no drive 'tlt', did you mean 'tilt'?"));
  CHECK(has(refused("drive_hot:tilt@1"), "drive_hot needs a size: its temperature, C"));
  CHECK(has(refused("bytes_lost@1+2=7"), "a share is 0..1"));
  CHECK(has(refused("cable_out@soon"), "'soon' is no number"));
}

TEST_CASE("A robot on boards that are not there is refused, with what to do") {
  const auto folder = project_copy("boards");
  const std::string command = "run config/jiwiy/anything_io.json --plant hm2-eth --soft --no-ctl ";
  Outcome outcome = run(command + "--peer 127.0.7.97", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "config/jiwiy/anything_io.json:"));
  CHECK(has(outcome.err, "board 'io' at 127.0.7.97 does not answer: is it powered, is its cable in"));
  outcome = run(command + "--peer nowhere", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "--peer: 'nowhere' must be an address such as 192.168.1.121"));
  outcome = run("run config/tulip/robot.json --plant hm2-eth --soft --no-ctl", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "says no plant.hm2-eth.drives"));
}

}  // namespace hostmot2_test
