// kadans tune finds an optimum that is known, goes on where it was, shares its work, and never overwrites unasked.
#include <cmath>
#include <thread>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

// A knee on the ideal plant, a double integrator, under PD control, whose set-point jumps by 0.1 rad.
fs::path project() {
  const auto folder = project_copy("tune_command");
  write(folder / "behaviors/tulip/step.lua", R"(local k = require "kadans"
return k.behavior "step" {
  controls = "posture", initial = "step",
  k.state "step" { endless = true, enter = function(m) m.posture:set("l_knee.position_rad", 0.4) end },
}
)");
  write(folder / "config/scenarios/step.json",
        R"({"name": "step", "robot": "config/tulip/robot.json", "plant": "ideal", "duration_s": 0.4,
            "behaviors": ["step"],
            "set": {"control.posture.*.ki_Nm_per_rads": 0, "control.posture.l_knee.kp_Nm_per_rad": 10},
            "checks": [{"name": "moves", "kind": "eventually", "that": "joint.l_knee.position_rad > 0.32"}]})");
  write(folder / "config/tuning/plan.json",
        R"({"$schema": "../schema/tune.schema.json", "name": "knee", "scenarios": ["config/scenarios/step.json"],
            "vary": {"joint.l_knee.start_rad": {"uniform": [-0.01, 0.01]}},
            "tune": {"control.posture.l_knee.kd_Nms_per_rad": {"min": 0.05, "max": 5, "log": true}},
            "runs": 2, "check_runs": 4, "population": 5, "generations": 6,
            "metrics": {"error_rad": {"kind": "rms", "signal": "control.posture.l_knee.error_rad"}},
            "score": "error_rad", "failed_score": 1})");
  return folder;
}

const std::string plan = "tune config/tuning/plan.json ";

}  // namespace

TEST_CASE("The damping with the least squared error after a step is found where theory has it") {
  const auto folder = project();
  const Outcome outcome = run(plan + "--out t --json", folder);
  REQUIRE(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(outcome.out);
  // The integral of the squared error of inertia J under stiffness k is least at half the critical damping, sqrt(k J);
  // the rotor has 0.02 kg m2. Sampling and the filter of the velocity move it by a few hundredths.
  const double kd = json["parameters"]["control.posture.l_knee.kd_Nms_per_rad"];
  CHECK(kd == doctest::Approx(std::sqrt(10 * 0.02)).epsilon(0.1));
  CHECK(json["change"]["high"] < 0.0);
  CHECK(json["after"]["score"] < json["before"]["score"]);
  const std::string before = read(folder / "config/tulip/robot.json"), after = read(folder / "t/robot.json");
  CHECK(has(after, "\"l_knee.kd_Nms_per_rad\": "));
  CHECK(after.size() < before.size() + 60);  // one entry more
  CHECK(run("check t/robot.json", folder).exit_code == 0);
  const std::size_t evaluated = results_in(folder / "t");
  CHECK(evaluated == 2 + 6 * 5 * 2 + 2 * 4);
  const Outcome again = run(plan + "--out t --json", folder);  // nothing is left to run
  CHECK(again.out == outcome.out);
  CHECK(results_in(folder / "t") == evaluated);
}

TEST_CASE("Parts in a shared folder make the same search as one process, also when one of them was missing at first") {
  const auto folder = project();
  const std::string few = plan + "--generations 2 --out ";
  const Outcome one = run(few + "whole", folder);
  CHECK(one.exit_code == 0);
  const Outcome alone = run(few + "shared --shard 0/2 --wait 0", folder);
  CHECK(alone.exit_code == 1);
  CHECK(has(alone.err, "the other parts of the generation did not come"));
  CHECK(fs::exists(folder / "shared/generation-000/candidates.json"));
  // Outcome files of two programs at once need folders of their own.
  fs::create_directories(folder / "other");
  for (const char* part : {"config", "models", "behaviors"})
    fs::create_directory_symlink(folder / part, folder / "other" / part);
  std::thread second([&] { (void)run(few + "../shared --shard 1/2", folder / "other"); });
  const Outcome first = run(few + "shared --shard 0/2", folder);
  second.join();
  CHECK(first.exit_code == 0);
  CHECK(read(folder / "shared/robot.json") == read(folder / "whole/robot.json"));
}

TEST_CASE("A configuration that is there is not overwritten unasked, a wrong plan is refused") {
  const auto folder = project();
  const std::string before = read(folder / "config/tulip/robot.json");
  const Outcome kept = run(plan + "--generations 1 --out t --write config/tulip/robot.json", folder);
  CHECK(kept.exit_code == 2);
  CHECK(has(kept.err, "--overwrite"));
  CHECK(read(folder / "config/tulip/robot.json") == before);
  REQUIRE(edit(folder / "config/tuning/plan.json", "\"max\": 5", "\"max\": 50000"));
  CHECK(has(run(plan, folder).err, "can be 0..5000, not 0.05..50000"));
  REQUIRE(edit(folder / "config/tuning/plan.json", "l_knee.kd_Nms", "l_kne.kd_Nms"));
  const Outcome wrong = run("check config/tuning/plan.json", folder);
  CHECK(wrong.exit_code == 2);
  CHECK(has(wrong.err, "did you mean 'control.posture.l_knee.kd_Nms_per_rad'?"));
}

namespace {

// A program that scores: a bowl whose bottom is at x = 3, y = 10, and what it was asked last.
fs::path bowl_project() {
  const auto folder = project_copy("tune_program");
  write(folder / "bowl.sh", R"(#!/bin/sh
echo "$2 $3" >last_$1
[ "${2#x=}" = 7 ] && exit 3
echo "a line before"
awk -v x="${2#x=}" -v y="${3#y=}" 'BEGIN { printf "{\"off\": %.9f}\n", (x - 3) ^ 2 + (log(y / 10)) ^ 2 }'
)");
  fs::permissions(folder / "bowl.sh", fs::perms::owner_all);
  write(folder / "config/tuning/plan.json",
        R"({"name": "bowl", "program": ["bowl.sh", "search"], "check_program": ["bowl.sh", "check"],
            "tune": {"x": {"min": -10, "max": 10, "start": 0}, "y": {"min": 1, "max": 1000, "log": true, "start": 100}},
            "population": 8, "generations": 25, "score": "off", "failed_score": 1000})");
  return folder;
}

}  // namespace

TEST_CASE("What a program scores is tuned to its optimum, and another program judges it") {
  const auto folder = bowl_project();
  const Outcome outcome = run(plan + "--json --write found.json", folder);
  REQUIRE(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(outcome.out);
  CHECK(json["parameters"]["x"].get<double>() == doctest::Approx(3).epsilon(0.02));
  CHECK(json["parameters"]["y"].get<double>() == doctest::Approx(10).epsilon(0.05));
  CHECK(json["before"]["off"].get<double>() > 10);
  CHECK(json["after"]["off"].get<double>() < 0.01);
  CHECK(nlohmann::json::parse(read(folder / "found.json")) == json["parameters"]);
  CHECK(fs::exists(folder / "last_check"));
  CHECK(run(plan + "--json", folder).out == outcome.out);
  const Outcome kept = run(plan + "--generations 1 --write found.json", folder);
  CHECK(kept.exit_code == 2);
  CHECK(has(kept.err, "--overwrite"));
}

TEST_CASE("A program that fails at the start ends the tuning, and a plan that mixes it with scenarios is refused") {
  const auto folder = bowl_project();
  const fs::path file = folder / "config/tuning/plan.json";
  CHECK(has(run("check config/tuning/plan.json", folder).out, "2 parameters, 25 generations of 8 candidates"));
  REQUIRE(edit(file, "\"start\": 0", "\"start\": 7"));
  const Outcome fails = run(plan, folder);
  CHECK(fails.exit_code == 2);
  CHECK(has(fails.err, "ended with exit code 3"));
  REQUIRE(edit(file, "\"score\": \"off\"", "\"score\": \"on\""));
  REQUIRE(edit(file, "\"start\": 7", "\"start\": 1"));
  CHECK(has(run(plan, folder).err, "gave no number on"));
  CHECK(has(run(plan + "--shard 0/2", folder).err, "--shard is for tunings of scenarios"));
  REQUIRE(edit(file, "\"program\"", "\"runs\": 3, \"scenarios\": [\"config/scenarios/squat.json\"], \"program\""));
  REQUIRE(edit(file, ", \"start\": 100", ""));
  const Outcome wrong = run("check config/tuning/plan.json", folder);
  CHECK(wrong.exit_code == 2);
  CHECK(has(wrong.err, "scenarios means nothing beside program"));
  CHECK(has(wrong.err, "runs means nothing beside program"));
  CHECK(has(wrong.err, "start is missing: a program has no configuration"));
}
