// Matches that robots play: what a file says, what is wrong in one, and short ones by their seed.
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "config/broken.h"
#include "football/program/match_report.h"

namespace match_test {

namespace fs = std::filesystem;
using namespace kadans::football;
using kadans::InputError;

namespace {

const fs::path matches = KADANS_SOURCE_DIR "/config/matches";

fs::path match_of(const std::string& text) {
  const fs::path folder = KADANS_BINARY_DIR "/football_match";
  fs::create_directories(folder);
  const fs::path file = folder / "match.json";
  std::ofstream(file) << text;
  return file;
}

// What is said about a file with these lines after its name.
std::string refusal(const std::string& rest, const std::string& name = "drawn") {
  const fs::path file = match_of("{ \"name\": \"" + name + "\",\n" + rest + "\n}\n");
  return kadans::refusal(file.string(), KADANS_SOURCE_DIR, [&] { (void)read_match(file); });
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string one_team = R"("home": { "team": "behaviors/football", "players": 1 })";

MatchResult played(const std::string& file, std::uint64_t seed, double until_s) {
  PlayedMatch match(read_match(matches / file), seed);
  while (match.step() && match.result().simulated_s < until_s) (void)match.take_lines();
  return match.result();
}

}  // namespace

TEST_CASE("A match file with nothing but a team has the rules of 2026 and an empty goal on the other side") {
  const MatchConfig match = read_match(match_of("{ \"name\": \"drawn\",\n" + one_team + "\n}\n"));
  CHECK(match.rules.half_s == 600);
  CHECK(match.rules.removal_s == 45);
  CHECK(match.robots().size() == 1);
  CHECK(match.field().length_m == 9);
  CHECK(has(scenario_of(match, 1), "\"left_post_1\""));
}

TEST_CASE("What is wrong in a match file is told with its place, what is wrong and what was meant") {
  CHECK(refusal(one_team).empty());
  CHECK(has(refusal("\"field\": \"small\""), "1:1: key 'home' is missing"));
  CHECK(has(refusal(one_team + ",\n\"halfs\": 3"), "3:1: unknown key 'halfs' (known: name, "));
  CHECK(has(refusal(one_team + ",\n\"field\": \"smal\""), "3:10: "));
  CHECK(has(refusal(one_team + ",\n\"field\": \"smal\""), "did you mean 'small'?"));
  CHECK(has(refusal(one_team + ",\n\"field\": \"large\""), "3:10: "));
  CHECK(has(refusal(one_team + ",\n\"rules\": { \"half_s\": -3 }"), "rules.half_s is -3"));
  CHECK(has(refusal(one_team + ",\n\"rules\": { \"half_s\": \"long\" }"), "3:22: rules.half_s must be a number in s"));
  CHECK(has(refusal(one_team + ",\n\"rules\": { \"hal_s\": 3 }"), "did you mean 'half_s'"));
  CHECK(has(refusal(one_team + ",\n\"seed\": 1.5"), "3:9: seed"));
  CHECK(has(refusal(one_team + ",\n\"ends\": { \"goals\": 0 }"), "ends.goals"));
  CHECK(has(refusal(one_team + ",\n\"network\": { \"lost\": 2 }"), "network.lost is 2"));
  CHECK(has(refusal(one_team + ",\n\"senses\": { \"rate_Hz\": 0 }"), "senses.rate_Hz"));
  CHECK(has(refusal(one_team + ",\n\"start\": \"bench\""), "touchline, field"));
  CHECK(has(refusal(one_team + ",\n\"away\": { \"players\": 9, \"team\": \"behaviors/football\" }"),
            "away.players is 9"));
  CHECK(has(refusal(one_team, "Two teams"), "1:11: name must be small letters"));
  CHECK(has(refusal(R"("home": { "team": "behaviors/footbal", "players": 1 })"), "2:19: home.team: there is no "));
  CHECK(has(refusal(R"("home": { "team": "behaviors/footbal", "players": 1 })"), "did you mean 'football'?"));
  CHECK(
      has(refusal("\"home\": { \"team\": \"" + std::string(5000, 'a') + "\", \"players\": 1 }"), "2:19: home.team: "));
  CHECK(has(refusal(R"("home": { "team": "behaviors/football\u0000x", "players": 1 })"), "is no path"));
  CHECK(has(refusal(R"("home": { "team": "behaviors/tulip", "players": 1 })"), "has no team.lua, a k.decisions"));
  CHECK(has(refusal(R"("home": { "team": "behaviors/football" })"), "2:9: key 'players' is missing in home"));
  CHECK(has(refusal(R"("home": { "team": "behaviors/football", "players": 1, "keeper": 2 })"),
            "keeper is number 2, but the team has 1 players"));
  CHECK(has(refusal(R"("home": { "team": "behaviors/football", "players": 1, "robot": "config/tulp/robot.json" })"),
            "home.robot: there is no "));
  CHECK(has(refusal("\"home\": 3"), "home must be an object"));
  CHECK(has(refusal(one_team + " \"away\": {}"), "2:56: a comma or } is needed here"));
  CHECK(has(refusal(one_team + ",\n\"away\": {}"), "3:9: key 'team' is missing in away"));
  CHECK(
      has(refusal(one_team + ",\n\"division\": \"small\", \"field\": \"large\""), "the small division does not play"));
  CHECK(has(refusal(one_team + ",\n\"begins\": { \"with\": \"corners\" }"), "did you mean 'corner'?"));
  CHECK(has(refusal(one_team + ",\n\"begins\": { \"ball_x\": 1 }"), "did you mean 'ball_x_m'?"));
  CHECK(has(refusal(one_team + ",\n\"robots_differ\": 2"), "robots_differ is 2"));
  CHECK(has(refusal(R"("home": { "team": "behaviors/football", "players": 1, "parameters": "passes=0}" })"),
            "parameters are NAME=NUMBER"));
  CHECK(has(refusal(R"("home": { "team": "behaviors/football", "players": 1, "places": { "1": { "x_m": 2 } } })"),
            "'y_m' is missing in home.places.1"));
  CHECK_THROWS_AS(read_match(matches / "nothing.json"), InputError);
}

TEST_CASE("Robots stand before a half in their own half, beside the field or on it, and none in another's place") {
  MatchConfig match = read_match(matches / "two_against_two.json");
  for (const bool on_field : {false, true}) {
    match.start_on_field = on_field;
    const double half_m = match.field().width_m / 2;
    for (const RobotId a : match.robots()) {
      const Pose2 pose = place_before(match, a);
      CHECK(pose.x_m < -0.2);
      CHECK((std::abs(pose.y_m) < half_m) == on_field);
      for (const RobotId b : match.robots()) {
        const Pose2 there = world_pose(place_before(match, b), b.side == Side::home ? -1 : 1);
        const Pose2 here = world_pose(pose, a.side == Side::home ? -1 : 1);
        CHECK((a == b || distance(here.at(), there.at()) > 0.5));
      }
    }
  }
}

TEST_CASE("A striker alone scores within 90 s from the kick-off, and the goal counts by its second touch") {
  const MatchResult result = played("striker_drill.json", 1, 1000);
  CHECK(result.ended == "by its goals");
  CHECK(result.score[0] == 1);
  CHECK(result.playing_s < 90);
  CHECK(result.robots.at(0).errors == 0);
  for (const Decision& decision : result.decisions) CHECK_FALSE(decision.rule.empty());
  CHECK(result.decisions.back().text == "goal for home: home 1, away 0");
}

TEST_CASE("A drill begins in the middle of a match, and its seed scatters ball and robots") {
  const MatchConfig match = read_match(matches / "drill_localisation.json");
  PlayedMatch one(match, 1), other(match, 2);
  CHECK(drill_ball(match, 1).x_m != drill_ball(match, 2).x_m);
  CHECK(drill_ball(match, 1).x_m < -0.1);  // in front of home, which plays toward -x in the world
  CHECK(scenario_of(match, 1) != scenario_of(match, 2));
  for (int i = 0; i < 5; ++i) one.step(), other.step();
  CHECK(one.result().playing_s > 0.05);
  CHECK(one.result().robots.at(0).errors == 0);
  CHECK(one.result().state_hash != other.result().state_hash);
}

TEST_CASE("Robots that differ are drawn by the seed, and without that they are as configured") {
  MatchConfig match = read_match(matches / "striker_drill.json");
  CHECK_FALSE(has(scenario_of(match, 1), "randomise"));
  match.robots_differ = 1;
  CHECK(has(scenario_of(match, 1), "\"link.*.mass_scale\": { \"uniform\": [0.85, 1.15] }"));
  match.teams[0].parameters = "passes=0";
  CHECK(has(scenario_of(match, 1), "behaviors/football/team.lua{passes=0}"));
  PlayedMatch played(match, 3);
  CHECK(played.step());
}

TEST_CASE("The same seed plays the same match, bit for bit, and another one another match") {
  const MatchConfig match = read_match(matches / "striker_drill.json");
  const MatchResult first = played("striker_drill.json", 4, 18), again = played("striker_drill.json", 4, 18);
  CHECK(json_of(first, match) == json_of(again, match));
  CHECK(first.state_hash == again.state_hash);
  CHECK(played("striker_drill.json", 5, 18).state_hash != first.state_hash);
}

TEST_CASE("Two teams of two walk to their places before the kick-off, the same way by the same seed") {
  const MatchConfig match = read_match(matches / "two_against_two.json");
  const MatchResult first = played("two_against_two.json", 2, 8), again = played("two_against_two.json", 2, 8);
  CHECK(json_of(first, match) == json_of(again, match));
  REQUIRE(first.robots.size() == 4);
  for (const PlayedRobot& robot : first.robots) {
    CHECK(robot.errors == 0);
    CHECK(robot.falls == 0);
    CHECK(robot.upright_s > 7.9);
  }
  CHECK(first.decisions.front().text == "ready: kick-off for home");
}

}  // namespace match_test
