#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/assembly/assembly.h"
#include "app/program.h"

using namespace kadans;

namespace {

std::uint64_t hash_in_this_process(std::uint64_t seed) {
  const ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  RunLog log;
  Assembly robot(scenario, seed, log);
  Checks checks(robot.catalog().signals);
  const RunParts parts = robot.parts();
  return run_scenario(parts, 2.5, checks, {}).state_hash;
}

std::string hash_in_own_process(const char* options) {
  const auto project = program::project_copy("repeat");
  const auto outcome =
      program::run(std::string("sim config/scenarios/squat.json --json --duration 2.5 ") + options, project);
  return nlohmann::json::parse(outcome.out)["state_hash"];
}

}  // namespace

TEST_CASE("The same seed gives the same state hash twice in one process, another seed another") {
  CHECK(hash_in_this_process(5) == hash_in_this_process(5));
  CHECK(hash_in_this_process(5) != hash_in_this_process(6));
}

TEST_CASE("The same seed gives the same state hash in two processes, recorded or not, and another seed another") {
  const std::string hash = hash_in_own_process("--seed 5 --no-record");
  CHECK(hash_in_own_process("--seed 5") == hash);
  CHECK(hash_in_own_process("--seed 6 --no-record") != hash);
  char here[17];
  std::snprintf(here, sizeof here, "%016llx", static_cast<unsigned long long>(hash_in_this_process(5)));
  CHECK(hash == here);
}
