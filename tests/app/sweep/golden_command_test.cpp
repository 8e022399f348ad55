// kadans test --golden: runs of a suite against the state hashes in the tree, whatever runs beside them.
#include <map>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace golden_command_test {

using namespace kadans::program;

namespace {

namespace fs = std::filesystem;

// Two short scenarios in Bullet, three runs of one of them.
fs::path project(const std::string& name) {
  const fs::path folder = project_copy(name);
  fs::remove_all(folder / "config/scenarios");
  fs::remove(folder / "config/scenarios.golden.json");
  fs::create_directories(folder / "config/scenarios");
  const std::string head = R"({"$schema": "../schema/scenario.schema.json", "robot": "config/tulip/robot.json", )";
  for (const auto& [scenario, more] :
       {std::pair{"still", R"("name": "still", )"},
        std::pair{"varied",
                  R"("name": "varied", "repeat": 3, "randomise": {"link.*.mass_scale": {"uniform": [0.9, 1.1]}}, )"}}) {
    write(
        folder / "config/scenarios" / (scenario + std::string(".json")),
        head + more +
            R"("duration_s": 1.3, "behaviors": ["stand"], "checks": [{"name": "up", "kind": "always", "that": "plant.base.height_m > 0.7"}]})");
  }
  return folder;
}

std::map<std::string, std::string> hashes(const Outcome& outcome) {
  std::map<std::string, std::string> all;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::json::parse(line);
    all[json["scenario"].get<std::string>() + " " + json["seed"].dump()] = json["state_hash"];
  }
  return all;
}

}  // namespace

TEST_CASE("The same seeds give the same hashes one after the other and side by side") {
  const fs::path folder = project("golden_jobs");
  const auto alone = hashes(run("test --json --jobs 1", folder));
  CHECK(alone.size() == 4);
  CHECK(alone.at("varied 1") != alone.at("varied 2"));
  CHECK(hashes(run("test --json --jobs 4", folder)) == alone);
}

TEST_CASE("Golden hashes are renewed, hold, and break with the state, until they are renewed again") {
  const fs::path folder = project("golden_renew");
  const Outcome without = run("test --golden still", folder);
  CHECK(without.exit_code == 1);
  CHECK(has(without.out, "no golden hash is known of this run"));
  const Outcome made = run("test --renew-golden", folder);
  CHECK(made.exit_code == 0);
  CHECK(has(made.out, "golden.json: 4 runs, 4 changes"));
  CHECK(run("test --golden --jobs 3", folder).exit_code == 0);
  // A push in the second second.
  REQUIRE(edit(folder / "config/scenarios/still.json", "\"duration_s\"",
               R"("pushes": [{"link": "torso", "at_s": 1.1, "impulse_Ns": [0, 0.1, 0]}], "duration_s")"));
  const Outcome broken = run("test --golden", folder);
  CHECK(broken.exit_code == 1);
  CHECK(has(broken.out, "4 runs, 1 failed"));
  CHECK(has(broken.out, "parts from the golden run's after 1 s"));
  fs::remove(folder / "config/scenarios/varied.json");
  const Outcome renewed = run("test --renew-golden", folder);
  CHECK(has(renewed.out, "golden.json: 1 runs, 4 changes"));
  CHECK(has(renewed.out, "changed still (seed 1): after 1 s"));
  CHECK(has(renewed.out, "gone    varied (seed 3)"));
  CHECK(run("test --golden", folder).exit_code == 0);
}

}  // namespace golden_command_test
