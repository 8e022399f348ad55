// JIWIY and TULip on HostMot2 boards: their whole control systems, the driver, the datagrams and the boards, on virtual
// time.
#include <cstdlib>
#include <fstream>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"

namespace hostmot2_test {

using namespace kadans;
using namespace kadans::program;

namespace {

const std::string source = KADANS_SOURCE_DIR "/";
struct Through {
  bool passed = false;
  std::string why;
  std::uint64_t hash = 0;
  std::vector<PlantCount> counts;
  std::uint64_t lost = 0;
  double delay_ticks = 0;  // mean age of a joint's reading
  std::vector<CheckResult> checks;
};

// Over the 20 ticks behind the end of a run.
double delay_ticks_of(World& world) {
  SensorFrame sensors;
  double sum = 0;
  for (int i = 0; i < 20; ++i) {
    world.robot(0).read(sensors);
    const std::int64_t time_ns = sensors.joints[0].time_ns != 0 ? sensors.joints[0].time_ns : sensors.time_ns;
    sum += 1e3 * seconds_between(time_ns, sensors.time_ns);
    world.robot(0).write({});
    world.step(1'000'000);
  }
  return sum / 20;
}

// `bus`: "" for the model itself. `stick`: a recording in the place of the scenario's.
Through run_through(const char* bus, const std::string& file, const char* scenario_name, std::uint64_t seed,
                    const std::string& stick = "") {
  ScenarioConfig scenario = read_scenario_config(source + "config/scenarios/" + scenario_name + ".json");
  scenario.robot = source + file;
  scenario.bus.type.name = bus;
  if (!stick.empty()) scenario.joystick.recording = stick;
  RunLog log;
  Assembly robot(scenario, seed, log);
  Checks checks(robot.catalog().signals, scenario.checks);
  const RunResult result = run_scenario(robot.parts(), scenario.duration_s, checks, {});
  Through is{.passed = result.passed, .why = result.error, .hash = result.state_hash, .checks = result.checks};
  for (const CheckResult& check : result.checks) {
    if (!check.passed) is.why += check.name + " (" + std::to_string(check.value) + "); ";
  }
  for (const RunFault& one : result.faults) is.why += std::string(name(one.code)) + "; ";
  is.counts = robot.plant().link_counts();
  for (const PlantCount& one : is.counts) is.lost += std::string_view(one.name) == "lost" ? one.value : 0;
  is.delay_ticks = delay_ticks_of(*robot.world());
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
    const Through model = run_through("", file, "jiwiy_sine", seed);
    const Through board = run_through("hm2-eth", file, "jiwiy_sine", seed);
    CAPTURE(board.why);
    CHECK(model.passed);
    CHECK(board.passed);
    CHECK(board.hash != model.hash);
    CHECK(count_of(board, "sent") == 7500);  // one in each tick
    CHECK(count_of(board, "lost") == 0);
    CHECK(count_of(board, "bites") == 0);
  }
  CHECK(run_through("hm2-eth", file, "jiwiy_sine", 1).hash == run_through("hm2-eth", file, "jiwiy_sine", 1).hash);
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
  const Through board = run_through("hm2-eth", "config/jiwiy/anything_io_2008.json", "jiwiy_unplugged", 1, stick);
  CAPTURE(board.why);
  CHECK(board.passed);
  CHECK(count_of(board, "sent") == 351);  // in 3.5 s
  CHECK(count_of(board, "lost") == 0);
  CHECK(count_of(board, "bites") == 0);
}

TEST_CASE(
    "JIWIY as in 2008 rests and follows in effort mode, too: its gains fit the delay of a board that is asked at 100 "
    "Hz") {
  constexpr const char* file = "config/jiwiy/anything_io_2008.json";
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    // Its recording's button hands over to effort mode before the joystick is pulled out.
    const Through stick = run_through("hm2-eth", file, "jiwiy_unplugged", seed);
    CAPTURE(stick.why);
    CHECK(stick.passed);
    const Through sine = run_through("hm2-eth", file, "jiwiy_sine", seed);
    CAPTURE(sine.why);
    CHECK(sine.passed);
  }
}

TEST_CASE(
    "TULip squats, gets up and catches pushes through two HostMot2 boards and a serial IMU, with the same behaviors") {
  constexpr const char* file = "config/tulip/anything_io.json";
  for (const std::string scenario : {"squat", "get_up_prone", "get_up_supine", "push_forward", "push_left"}) {
    CAPTURE(scenario);
    const Through boards = run_through("hm2-eth", file, scenario.c_str(), 1);
    CAPTURE(boards.why);
    CHECK(boards.passed);
    CHECK(count_of(boards, "lost") == 0);
    CHECK(count_of(boards, "strange") == 0);
    CHECK(count_of(boards, "imu_readings") > 200);
    CHECK(count_of(boards, "imu_lost") == 0);
  }
  CHECK(run_through("hm2-eth", file, "squat", 1).hash == run_through("hm2-eth", file, "squat", 1).hash);
}

TEST_CASE("The same squat goes through every bus, and the table says how well") {
  const auto worst = [](const Through& run, std::string_view name) {
    for (const CheckResult& check : run.checks) {
      if (check.name.starts_with(name)) return check.value;
    }
    return 1e9;
  };
  std::string table = "through, height error mm, tilt rad, delay ticks, lost\n";
  for (const std::string bus : {"", "udp", "hm2-eth", "dynamixel"}) {
    const char* const file = bus == "hm2-eth"     ? "config/tulip/anything_io.json"
                             : bus == "dynamixel" ? "config/tulip/servos.json"
                                                  : "config/tulip/robot.json";
    const Through run = run_through(bus.c_str(), file, "squat", 1);
    CAPTURE(bus);
    CAPTURE(run.why);
    // Servos on a serial line are read and driven anew every other tick: it squats, and sways.
    if (bus == "dynamixel") {
      for (const char* what : {"stays up", "crouches", "stands at the end"}) CHECK_FALSE(has(run.why, what));
    } else {
      CHECK(run.passed);
    }
    std::array<char, 200> row{};
    std::snprintf(row.data(), row.size(), "%s, %.3f, %.4f, %.2f, %llu\n", bus.c_str(),
                  1e3 * worst(run, "height follows"), worst(run, "torso upright"), run.delay_ticks,
                  static_cast<unsigned long long>(run.lost));
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
  CHECK(has(outcome.err, "board 'io' at 127.0.7.97 does not answer: is it powered, and is its cable in?"));
  outcome = run(command + "--peer nowhere", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "--peer: 'nowhere' must be an address such as 192.168.1.121"));
  outcome = run("run config/tulip/robot.json --plant hm2-eth --soft --no-ctl", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "says no plant.hm2-eth.drives"));
}

}  // namespace hostmot2_test
