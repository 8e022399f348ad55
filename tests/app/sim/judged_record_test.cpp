// kadans test with a record in place of a simulation: what the robot saw then, judged by checks.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace judged_record_test {

using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

std::string test_of(const std::string& record, const std::string& that, const std::string& more = "") {
  return R"({"$schema": "../schema/scenario.schema.json", "name": "stumble", "record": ")" + record + "\"," + more +
         R"("checks": [{"name": "bent", "kind": "at_end", "that": ")" + that + "\"}]}\n";
}

// A record of a squat lies beside the only scenario, which repeats it.
fs::path project_with_record() {
  const fs::path project = project_copy("judged_record");
  fs::remove_all(project / "config/scenarios");
  fs::create_directories(project / "config/scenarios");
  REQUIRE(run("run config/tulip/robot.json --play squat --duration 2.7 --threads-on-virtual-time --flight 0 --record "
              "config/scenarios/stumble.mcap",
              project)
              .exit_code == 0);
  write(project / "config/scenarios/stumble.json", test_of("stumble.mcap", "joint.l_knee.position_rad > 0.2"));
  return project;
}

}  // namespace

TEST_CASE("A record is a test: repeated, judged by its checks, and held to its golden hash") {
  const fs::path project = project_with_record();
  const fs::path scenario = project / "config/scenarios/stumble.json";
  const Outcome passed = run("test", project);
  CHECK_MESSAGE(passed.exit_code == 0, (passed.out + passed.err));
  CHECK(has(passed.out, "1 runs, all passed"));
  CHECK(run("test --renew-golden", project).exit_code == 0);
  CHECK(run("test --golden", project).exit_code == 0);
  CHECK(has(run("check config/scenarios", project).out, "repeats a record, 1 checks"));

  // Other behaviors act otherwise on what the robot saw.
  REQUIRE(edit(project / "behaviors/tulip/squat.lua", "0.10", "0.11"));
  CHECK(run("test --golden", project).exit_code == 0);  // with the record's own
  write(scenario,
        test_of("stumble.mcap", "joint.l_knee.position_rad > 0.2", R"("with": ["behaviors/tulip/squat.lua"], )"));
  const Outcome other = run("test --golden", project);
  CHECK(other.exit_code == 1);
  CHECK_MESSAGE(has(other.out, "its state parts from the golden run's between 1 s and 2 s"), other.out);

  write(scenario, test_of("stumble.mcap", "state('nowhere')"));
  const Outcome nowhere = run("test", project);
  CHECK(nowhere.exit_code == 1);
  CHECK_MESSAGE(has(nowhere.out, "no behavior has the state 'nowhere'"), nowhere.out);
  write(scenario, test_of("stumble.mcap", "joint.l_knee.position_rad < 0", "\"duration_s\": 1, "));
  const Outcome failed = run("test --json", project);
  CHECK(failed.exit_code == 1);
  const auto ticks = nlohmann::json::parse(failed.out)["control_ticks"].get<int>();
  CHECK(ticks > 990);
  CHECK(ticks <= 1000);
  CHECK(has(run("test", project).out, "config/scenarios/stumble.json"));
}

TEST_CASE("A test of a record that cannot be one is refused with what is wrong") {
  const fs::path project = project_with_record();
  const fs::path scenario = project / "config/scenarios/stumble.json";
  const auto refusal = [&](const std::string& text) {
    write(scenario, text);
    const Outcome outcome = run("sim config/scenarios/stumble.json", project);
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  };
  CHECK(has(refusal(test_of("gone.mcap", "true")), "stumble.json:1:"));
  CHECK(has(refusal(test_of("gone.mcap", "true")), "record: there is no file"));
  CHECK(has(refusal(test_of("stumble.mcap", "true", R"("seed": 3, )")), "seed: comes with the record"));
  CHECK(has(refusal(test_of("stumble.mcap", "true", R"("network": {}, )")), "network: comes with the record"));
  CHECK(has(refusal(test_of("stumble.mcap", "joint.l_kne.position_rad > 0")), "stumble.json:1:"));
  CHECK(has(refusal(test_of("stumble.mcap", "true", R"("with": ["gone.lua"], )")), "gone.lua"));
  CHECK(has(refusal(R"({"name": "nothing", "checks": []})"), "robot"));
  write(scenario, test_of("stumble.mcap", "true"));
  CHECK(has(run("sim config/scenarios/stumble.json --seed 3", project).err, "--seed: is for simulations"));

  const fs::path record = project / "config/scenarios/stumble.mcap";
  REQUIRE(run("log cut config/scenarios/stumble.mcap --to 1 -o plain.mcap", project).exit_code == 0);
  fs::rename(project / "plain.mcap", project / "config/scenarios/plain.mcap");
  CHECK(has(refusal(test_of("plain.mcap", "true")), "plain.mcap: holds no inputs of its ticks"));
  write(project / "config/scenarios/idle.json",
        R"({"name": "idle", "robot": "config/jiwiy/robot.json", "duration_s": 0.1})");
  REQUIRE(run("sim config/scenarios/idle.json --record config/scenarios/idle.mcap", project).exit_code == 0);
  CHECK(has(refusal(test_of("idle.mcap", "true")), "idle.mcap: was simulated, so it is simulated again"));
  write(scenario, test_of("stumble.mcap", "true"));

  const std::string whole = read(record);
  write(record, whole.substr(0, whole.size() / 2));
  const Outcome short_one = run("sim config/scenarios/stumble.json", project);
  CHECK(short_one.exit_code == 1);
  CHECK_MESSAGE(has(short_one.out, "the record is not whole"), short_one.out);
}

TEST_CASE("A record goes on in the world of a scenario, which judges what becomes of the robot") {
  const fs::path project = project_with_record();
  const auto scenario = [&](const std::string& robot, const std::string& more) {
    write(project / "config/scenarios/after.json",
          R"({"$schema": "../schema/scenario.schema.json", "name": "after", "robot": "config/)" + robot +
              R"(/robot.json", "duration_s": 1.5,)" + more +
              R"("checks": [{"name": "stands", "kind": "always", "signal": "plant.base.height_m", "min": 0.5}]})");
  };
  const std::string replay = "replay config/scenarios/stumble.mcap --then-simulate config/scenarios/after.json --at ";
  scenario("tulip", "");
  const Outcome stands = run(replay + "0.8", project);
  CHECK_MESSAGE(stands.exit_code == 0, (stands.out + stands.err));
  CHECK(has(stands.out, "stands"));
  scenario("tulip", R"("set": {"joint.*.torque_scale": 0.05, "joint.*.coulomb_Nm": 0},)");
  CHECK(run(replay + "0.8", project).exit_code != 0);
  scenario("tulip", R"("pushes": [{"link": "torso", "at_s": 0.1, "impulse_Ns": [0, 9, 0]}],)");
  CHECK(has(run(replay + "0.8", project).err, "has events, pushes, faults or a robot"));
  scenario("tulip", R"("supervisor": {"rate_Hz": 10},)");
  CHECK(has(run(replay + "0.8", project).err, "has a supervisor, perception, sight or a joystick"));
  scenario("jiwiy", "");
  CHECK(has(run(replay + "0.8", project).err, "after.json: is of another robot than the record"));
  scenario("tulip", "");
  const Outcome late = run(replay + "800", project);
  CHECK(late.exit_code == 2);
  CHECK_MESSAGE(has(late.err, "before --at"), late.err);
  CHECK(run("replay config/scenarios/stumble.mcap --at 0.8", project).exit_code == 2);
}

}  // namespace judged_record_test
