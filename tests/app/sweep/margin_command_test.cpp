// kadans margin as a person runs it, on the ideal plant, where the bounds are known: the knee starts at 0.3 rad, and
// the check takes it up to 0.353, and no lower than 0.247.
#include <algorithm>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace margin_command_test {

using namespace kadans::program;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

fs::path project(const std::string& more = "", const std::string& tags = "[]") {
  const auto folder = project_copy("margin_command");
  fs::remove_all(folder / "config/scenarios");
  fs::create_directories(folder / "config/scenarios");
  write(folder / "config/scenarios/short.json",
        R"({"$schema": "../schema/scenario.schema.json", "name": "short", "robot": "config/tulip/robot.json",
            "plant": "ideal", "duration_s": 0.05, "tags": )" +
            tags + R"(, "randomise": {"joint.r_knee.start_rad": {"uniform": [-0.04, 0.04]}},
            "checks": [{"name": "the end", "kind": "at_end", "that": "joint.l_knee.position_rad < 5"},
                       {"name": "bent", "kind": "always", "that": "joint.l_knee.position_rad > 0.247"},
                       {"name": "low", "kind": "always", "that": "joint.l_knee.position_rad < 0.353"}])" +
            more + "}");
  return folder;
}

const std::string margin = "margin config/tulip/robot.json ";

}  // namespace

TEST_CASE("Both directions of a quantity end at the bound of the check, and say which seed and check failed there") {
  const auto folder = project();
  const Outcome text = run(margin + "short --quantity joint.l_knee.start_rad=0.01 --seeds 3", folder);
  CHECK(text.exit_code == 0);
  CHECK(has(text.out, "short (config/scenarios/short.json), 3 seeds"));
  const Outcome outcome = run(margin + "short --quantity joint.l_knee.start_rad=0.01 --seeds 3 --json", folder);
  const Json margins = Json::parse(outcome.out).at("scenarios").at(0).at("margins");
  REQUIRE(margins.size() == 2);
  const Json &down = margins[0], &up = margins[1];
  CHECK(down.at("direction") == "down");
  CHECK(down.at("held") == -0.05);
  CHECK(down.at("failed") == -0.06);
  CHECK(down.at("failure").at("check") == "bent");
  CHECK(up.at("nominal") == 0);
  CHECK(up.at("held") == 0.05);
  CHECK(up.at("failed") == 0.06);
  CHECK(up.at("failure").at("check") == "low");
  // The line that repeats what failed fails, and by this check.
  const std::string repeat = up.at("failure").at("repeat");
  REQUIRE(repeat.starts_with("kadans "));
  CHECK(has(repeat, "joint.l_knee.start_rad=0.06"));
  const Outcome again = run(repeat.substr(7) + " --no-record", folder);
  CHECK(again.exit_code == 1);
  CHECK(has(again.out, "low"));
}

TEST_CASE(
    "What is measured once is not run again, and the first seed that fails is the same however many run at once") {
  const auto folder = project(R"(, "set": {"joint.l_knee.start_rad": 0.01})");
  // The right knee's start is drawn: at 0.0 to 0.05 rad more some seeds are over the bound and others not.
  REQUIRE(edit(folder / "config/scenarios/short.json", "joint.l_knee.position_rad < 0.353",
               "joint.l_knee.position_rad + joint.r_knee.position_rad < 0.68"));
  const std::string command = margin + "short --quantity joint.l_knee.start_rad=0.01 --seeds 12 --json ";
  const Outcome one = run(command + "--jobs 1 --out one", folder);
  const std::size_t runs = results_in(folder / "one");
  const Outcome again = run(command + "--jobs 1 --out one", folder);
  CHECK(again.out == one.out);
  CHECK(results_in(folder / "one") == runs);
  const Outcome many = run(command + "--jobs 5 --out many", folder);
  CHECK(many.out == one.out);
  const Json up = Json::parse(one.out).at("scenarios").at(0).at("margins").at(1);
  CHECK(up.at("nominal") == 0.01);
  CHECK(up.at("failed").is_number());
}

TEST_CASE("A range whose end holds is said to hold, and no failure is named") {
  const auto folder = project();
  const Outcome outcome = run(margin + "short --quantity friction=0.5 --quantity torque=0.5 --seeds 1", folder);
  CHECK(outcome.exit_code == 0);
  CHECK(has(outcome.out, "the end of the range holds"));
  CHECK(has(outcome.out, "the margin is at least that"));
  const Outcome json = run(margin + "short --quantity friction=0.5 --seeds 1 --json", folder);
  const Json all = Json::parse(json.out);
  CHECK(all.at("scenarios").at(0).at("margins").size() == 2);
  for (const Json& one : all.at("scenarios").at(0).at("margins")) {
    CHECK(one.at("failed").is_null());
    CHECK(one.at("held") == one.at("end"));
    CHECK(one.at("failure").is_null());
  }
}

TEST_CASE("Without a quantity the usual ones are measured, in the scenarios that are tagged for it") {
  const auto folder = project("", R"(["margin"])");
  const Outcome outcome = run(margin + "--seeds 1 --json", folder);
  CHECK(outcome.exit_code == 0);
  std::vector<std::string> names;
  const Json all = Json::parse(outcome.out);
  for (const Json& one : all.at("scenarios").at(0).at("margins")) {
    const std::string name = one.at("margin");
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  CHECK(names == std::vector<std::string>{"delay", "gain", "mass", "torque", "friction", "dry_friction"});
}

TEST_CASE("A scenario that fails as it is configured has no margin, and says so") {
  const auto folder = project(R"(, "set": {"joint.l_knee.start_rad": 0.1})");
  const Outcome outcome = run(margin + "short --quantity delay", folder);
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "fails as it is configured: a margin is measured from a case that holds"));
  CHECK(has(outcome.out, ": low\n"));
  CHECK(has(outcome.out, "again: kadans sim"));
  const Json json = Json::parse(run(margin + "short --quantity delay --json", folder).out).at("scenarios").at(0);
  CHECK(json.at("margins").empty());
  CHECK(json.at("failure").at("check") == "low");
}

TEST_CASE("Wrong names are refused before anything runs, with what was meant") {
  const auto folder = project();
  const auto refused = [&](const std::string& words, const std::string& what) {
    const Outcome outcome = run(words, folder);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK_MESSAGE(has(outcome.err, what), outcome.err);
  };
  refused(margin + "short --quantity dely", "--quantity: unknown quantity 'dely', did you mean 'delay'?");
  refused(margin + "short --quantity joint.l_kne.torque_scale", "did you mean 'joint.l_knee.torque_scale'?");
  refused(margin + "short --quantity ground.friction=0", "the step behind '='");
  refused(margin + "short --quantity ground.friction=x", "the step behind '='");
  refused(margin + "short --quantity joint.l_knee.start_rad", "say in which steps it shall grow");
  refused(margin + "short --quantity 'control.posture.*.kp_Nm_per_rad'", "chooses quantities of different values");
  refused(margin + "shorter", "did you mean 'short'?");
  refused(margin, "no scenario of this robot in ");
  refused("margin config/tulip/soft.json short", "none of the scenarios is of this robot: short is of ");
  refused("margin nowhere.json short", "nowhere.json: there is no such file");
  CHECK_FALSE(fs::exists(folder / "margins"));
}

}  // namespace margin_command_test
