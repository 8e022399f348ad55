// Matches that robots play: what a file says, what is wrong in one, and short ones by their seed.
#include <cmath>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "football/program/match_report.h"
#include "kadans/signal/input_error.h"
#include "temporary_folder.h"

namespace match_test {

namespace fs = std::filesystem;
using namespace kadans::football;

namespace {

const fs::path matches = KADANS_SOURCE_DIR "/config/matches";
const kadans::test::TemporaryFolder own(KADANS_BINARY_DIR);  // a match belongs to the project around it

fs::path match_of(const std::string& text) { return own.write("match.json", text); }

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

TEST_CASE(
    "The lines of the field are painted on the ground of a match: areas, circle, marks, and corner arcs where there "
    "are any") {
  MatchConfig match = read_match(matches / "two_against_two.json");
  const std::string small = scenario_of(match, 1);
  CHECK(has(small, R"({ "from_m": [2.525, -1.975], "to_m": [2.525, 1.975] })"));    // the left penalty area's front
  CHECK(has(small, R"({ "from_m": [-3.525, -1.475], "to_m": [-3.525, 1.475] })"));  // the right goal area's
  CHECK(has(small, R"({ "from_m": [0, -2.975], "to_m": [0, 2.975] })"));
  CHECK(has(small, R"({ "from_m": [-3.025, 0], "to_m": [-2.975, 0] })"));  // of the right penalty mark's cross
  CHECK(has(small, R"("arcs": [{ "center_m": [0, 0], "radius_m": 0.725 }])"));
  match.field_size = FieldSize::middle;
  CHECK(has(scenario_of(match, 1),
            R"({ "center_m": [-6.975, -4.475], "radius_m": 0.475, "from_rad": 0, "to_rad": 1.57)"));
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
  MatchConfig crowd = read_match(matches / "drill_messages.json");
  crowd.begins->ball_scatter_m = crowd.begins->robots_scatter_m = 0.3;
  for (TeamSetup& team : crowd.teams) {
    for (auto& place : team.places) place = Pose2{};
  }
  for (std::uint64_t seed = 1; seed <= 10; ++seed) CHECK_NOTHROW(PlayedMatch(crowd, seed));  // none is in another one
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

TEST_CASE(
    "A match with its record is the match without it, and the record holds the robots, the ball and what is believed") {
  const MatchConfig match = read_match(matches / "striker_drill.json");
  const fs::path record = KADANS_BINARY_DIR "/football_match/match.mcap";
  fs::create_directories(record.parent_path());
  PlayedMatch recorded(match, 4);
  recorded.record(record.string(), "", "kadans-football match");
  while (recorded.step() && recorded.result().simulated_s < 6) (void)recorded.take_lines();
  recorded.end_record();
  CHECK(json_of(recorded.result(), match) == json_of(played("striker_drill.json", 4, 6), match));
  std::ifstream stream(record, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  for (const char* held : {"/seen", "/world", "/joint_states", "home_goals", "kadans-football match"})
    CHECK_MESSAGE(has(bytes, held), std::string(held));
  PlayedMatch nowhere(match, 4);
  CHECK_THROWS_AS(nowhere.record("/dev/null/match.mcap", "", ""), kadans::InputError);
  CHECK_THROWS_AS(nowhere.record(record.string(), "no.such.signal", ""), kadans::InputError);
}

TEST_CASE("A robot's ball is what its pictures agree on: those that show it where it is not do not move it") {
  const MatchConfig match = read_match(matches / "striker_drill.json", {"senses.imagined=0.25", "senses.missed=0"});
  auto world = std::make_unique<SimulatedMatch>(match, 2);
  SimulatedMatch& stage = *world;
  const auto& signals = stage.catalog(0).signals;
  const auto off_m = [&](const char* x, const char* y) {
    const Point at{stage.simulation().signal(0, *signals.find(x)), stage.simulation().signal(0, *signals.find(y))};
    const kadans::PlantTruth& truth = stage.robot(0).truth();
    const kadans::Vec3& ball = truth.objects.at(stage.object("ball")).pose.position_m;
    return distance(at, in_frame(ground_pose(truth.base), Point{ball[0], ball[1]}));
  };
  PlayedMatch played(match, 2, std::move(world), false);
  double seen_m = 0, filtered_m = 0;
  while (played.step() && stage.time_ns() < 9'000'000'000) {
    (void)played.take_lines();
    if (stage.time_ns() < 1'000'000'000) continue;
    seen_m = std::max(seen_m, off_m("seen.ball_seen.x_m", "seen.ball_seen.y_m"));
    filtered_m = std::max(filtered_m, off_m("seen.ball.x_m", "seen.ball.y_m"));
  }
  CHECK(seen_m > 1);
  CHECK(filtered_m < 0.5);
}

TEST_CASE("Who is told that its battery is empty stands, and others play on") {
  const MatchConfig match =
      read_match(matches / "two_against_two.json", {"home.battery_s=12", "rules.hidden_playing_s=0", "start=field"});
  auto world = std::make_unique<SimulatedMatch>(match, 2);
  SimulatedMatch& stage = *world;
  const auto charge = [&](std::size_t robot) {
    return stage.simulation().signal(robot, *stage.catalog(robot).signals.find("seen.battery.charge"));
  };
  PlayedMatch played(match, 2, std::move(world), false);
  double home_2_m = 0, away_2_m = 0;
  Point home_2, away_2;
  while (played.step() && stage.time_ns() < 40'000'000'000) {
    (void)played.take_lines();
    const Point home = ground_pose(stage.robot(1).truth().base).at(),
                away = ground_pose(stage.robot(3).truth().base).at();
    if (stage.time_ns() > 14'000'000'000) {
      home_2_m += distance(home, home_2);
      away_2_m += distance(away, away_2);
    }
    home_2 = home, away_2 = away;
  }
  CHECK(charge(0) == 0);
  CHECK(charge(1) == 0);
  CHECK(std::isnan(charge(2)));
  CHECK(home_2_m < 0.2);
  CHECK(away_2_m > 1);
}

// Nobody hears that play is on: all stand.
TEST_CASE("Who stands still is frozen when the ball is its own to play, and waits when a mate or a striker is nearer") {
  const MatchConfig match = read_match(match_of(R"({
    "name": "nobody_hears",
    "rules": { "hidden_playing_s": 20 },
    "begins": { "ball_x_m": 1.5 },
    "home": { "team": "behaviors/football", "players": 2,
              "places": { "1": { "x_m": 0.8, "y_m": 0.2 }, "2": { "x_m": -1, "y_m": 0 } } },
    "away": { "team": "behaviors/football", "players": 1, "keeper": 1, "places": { "1": { "x_m": -4.2, "y_m": 0 } } }
  })"));
  PlayedMatch played(match, 1);
  while (played.step() && played.result().simulated_s < 5) (void)played.take_lines();
  const MatchResult& result = played.result();
  for (const PlayedRobot& robot : result.robots) {
    CAPTURE(robot.name);
    CHECK(robot.still_max_s > 3);
    CHECK(robot.frozen_max_s == doctest::Approx(robot.name == "home_1" ? robot.still_max_s : 0));
  }
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
