// Each fault that an emulated bus and its drives can have, from the command line: what is counted, what is told, and
// what follows. On virtual time, with the true bytes on the wire.
#include <doctest/doctest.h>

#include "app/program.h"

namespace bus_faults_test {

using namespace kadans::program;

namespace {

constexpr const char* boards = R"("config/jiwiy/anything_io.json", "bus": { "type": "hm2-eth")";
constexpr const char* servos = R"("config/jiwiy/servos.json", "bus": { "type": "dynamixel")";
constexpr const char* tulip = R"("config/tulip/anything_io.json", "bus": { "type": "hm2-eth")";

struct Row {
  const char* robot;
  const char* fault;
  const char* that;   // holds in the end
  const char* first;  // the first fault that is told; "": none is
};

// JIWIY follows a sine, TULip stands; the faults begin after 2 s of 5.
constexpr Row rows[] = {
    // The wire: within its bounds it is only counted.
    {boards, "datagrams_lost@2+1=0.05", "plant.bus.lost > 50 and plant.bus.unheard > 20", ""},
    {boards, "datagrams_lost@2+1=0.5", "safety.faults > 0", "sensor_silent of pan"},
    {boards, "datagrams_twice@2+1=0.3", "plant.bus.duplicates > 100", ""},
    {boards, "datagrams_late@2+1=0.2", "plant.bus.reordered + plant.bus.lost > 100", ""},
    {boards, "datagrams_corrupt@2+0.2=0.05", "plant.bus.refused > 0", ""},
    {boards, "cable_out@2+0.004", "plant.bus.lost >= 4 and plant.bus.bites == 0", ""},
    {servos, "bytes_lost@2+1=0.0005", "plant.bus.lost > 10", ""},
    {servos, "bytes_corrupt@2+1=0.0005", "plant.bus.lost > 10 and plant.bus.corrupt > 0", ""},
    {servos, "bytes_lost:bus@2+1=0.05", "safety.faults > 0", "sensor_silent of pan"},
    {tulip, "bytes_lost:imu@2+1=0.002", "plant.bus.imu_lost > 10", ""},
    {tulip, "bytes_corrupt:imu@2+1=0.002", "plant.bus.imu_corrupt > 10", ""},
    // Cables that are pulled, and put back.
    {boards, "cable_out@2+0.5", "plant.bus.bites == 1 and plant.bus.age_ms < 2", "sensor_silent of pan"},
    {tulip, "cable_out:left@2+0.5", "plant.bus.bites == 1", "sensor_silent of l_hip_yaw"},
    {servos, "cable_out@2+0.5", "plant.bus.lost > 10", "sensor_silent of pan"},
    {tulip, "cable_out:imu@2+0.5", "plant.bus.imu_lost > 90 and plant.bus.imu_age_ms < 15", "imu_silent"},
    // What stands on the bus.
    {boards, "watchdog_bites@2", "plant.bus.bites == 1 and plant.bus.lost == 0", "its board's watchdog let go"},
    {boards, "board_reboots@2", "plant.bus.strange == 0", "its board lost its settings"},
    {boards, "drive_tripped:pan@2+0.1", "plant.bus.lost == 0", "drive_fault of pan"},
    {tulip, "emergency_button@2+0.5", "safety.level >= 3", "emergency_input"},
    {servos, "drive_tripped:tilt@2=32", "plant.bus.lost == 0", "code 32: overload"},
    {servos, "drive_hot:tilt@2=85", "plant.bus.lost == 0", "code 4: overheating"},
    {servos, "drive_reboots:pan@2", "plant.bus.lost > 10", "sensor_silent of pan"},
    {servos, "drive_gone:pan@2+1", "plant.bus.lost > 10", "sensor_silent of pan"},
    {servos, "drive_zero:pan@2=0.3", "plant.bus.lost == 0", "sensor_jump of pan"},
};

}  // namespace

TEST_CASE("Each fault of an emulated bus and its drives is counted or told, and no more follows than is said of it") {
  const auto folder = project_copy("bus_faults_table");
  REQUIRE(edit(folder / "config/jiwiy/anything_io.json", R"("enable": "20")", R"("enable": "20", "fault": "!30")"));
  for (const Row& row : rows) {
    const bool stands = row.robot == tulip, told = row.first[0] != '\0';
    write(
        folder / "config/scenarios/day.json",
        std::string(R"({ "name": "day", "duration_s": 5, "behaviors": [")") + (stands ? "stand" : "sine") +
            R"("], "robot": )" + row.robot + R"(, "faults": [")" + row.fault +
            R"("] }, "checks": [{ "name": "so it ends", "kind": "at_end", "that": ")" + row.that +
            R"(" }, { "name": "within its limits", "kind": "always", "that": "plant.limits.motor_torque_share <= 1" }] })");
    const Outcome day = run("sim config/scenarios/day.json --no-record", folder);
    CAPTURE(row.fault);
    CAPTURE(day.out);
    CAPTURE(day.err);
    CHECK(has(day.out, "✓ so it ends"));
    CHECK(has(day.out, "✓ within its limits"));
    const std::size_t first = day.out.find("fault: ");
    CHECK((first != std::string::npos) == told);
    if (told && first != std::string::npos) CHECK(has(day.out.substr(first), row.first));
  }
}

TEST_CASE(
    "The same seed gives the same bytes on a bus and the same record, faults among them, and another seed others") {
  const auto folder = project_copy("bus_twice");
  const auto day = [&](const char* robot, const char* fault, int seed, const char* record) {
    write(folder / "config/scenarios/day.json",
          std::string(R"({ "name": "day", "duration_s": 4, "behaviors": ["sine"], "robot": )") + robot +
              R"(, "faults": [")" + fault + R"("] } })");
    const Outcome run_once = run("sim config/scenarios/day.json --json --seed " + std::to_string(seed) +
                                     (record == nullptr ? " --no-record" : std::string(" --record ") + record),
                                 folder);
    const std::size_t at = run_once.out.find("\"state_hash\":");
    REQUIRE_MESSAGE(at != std::string::npos, run_once.err);
    return run_once.out.substr(at, 30);
  };
  const auto same = [&](const char* robot, const char* fault) {
    CAPTURE(fault);
    const std::string first = day(robot, fault, 1, "a.mcap");
    CHECK(day(robot, fault, 1, "b.mcap") == first);  // with all bytes on the wire, and their times
    CHECK(run("log diff a.mcap b.mcap", folder).exit_code == 0);
    CHECK(day(robot, fault, 2, nullptr) != first);
  };
  same(boards, "datagrams_lost@1+2=0.05\", \"datagrams_late@1+2=0.05\", \"cable_out@3+0.5");
  same(servos, "bytes_corrupt@1+2=0.0005\", \"drive_reboots:pan@3");
}

TEST_CASE("A bus in a scenario that cannot be is refused, with what can") {
  const auto folder = project_copy("bus_refused");
  const auto refused = [&](const std::string& robot, const std::string& rest) {
    write(folder / "config/scenarios/day.json",
          R"({ "name": "day", "duration_s": 1, "robot": )" + robot + rest + " } }");
    const Outcome outcome = run("sim config/scenarios/day.json --no-record", folder);
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  };
  CHECK(has(refused(R"("config/jiwiy/robot.json", "bus": { "type": "bullet")", ""),
            "config/scenarios/day.json:1:88: unknown type of plant 'bullet' (known: dynamixel, hm2-eth, udp)"));
  CHECK(has(refused(R"("config/jiwiy/robot.json", "bus": { "type": "hm2-eth")", ""), "says no plant.hm2-eth.drives"));
  CHECK(has(refused(servos, R"(, "faults": ["drive_hot:tlt@1=90"])"), "no drive 'tlt', did you mean 'tilt'?"));
  CHECK(has(refused(servos, R"(, "faults": ["cable_out"])"), "bus.faults: cable_out: says no time: @ and seconds"));
}

}  // namespace bus_faults_test
