// What is wrong in the files of a match: each mistake is told with file, line and column, what is wrong and what was
// meant. Match files, team folders and what a team's decisions say when they play.
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "config/broken.h"
#include "config/json/schema.h"
#include "config/json/schema_checks.h"
#include "football/program/match_report.h"
#include "kadans/config/input_object.h"
#include "temporary_folder.h"

namespace match_input_test {

namespace fs = std::filesystem;
using namespace kadans::football;
using kadans::InputError;

namespace {

const kadans::test::TemporaryFolder own(KADANS_BINARY_DIR);  // a team is in a folder of the project
const fs::path folder = own.path() / "football_input";

fs::path written(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

// What is said about a match file with this text.
std::string refusal_of(const std::string& text) {
  const fs::path file = written(folder / "match.json", text);
  return kadans::refusal(file.string(), KADANS_SOURCE_DIR, [&] { (void)read_match(file); });
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string one_team = R"("home": { "team": "behaviors/football", "players": 1 })";

// The lines after {"name": "drawn", and what is told of them.
struct Wrong {
  const char* rest;
  const char* message;
};

const Wrong wrong_with_team[] = {
    // keys
    {R"("halfs": 3)", "3:1: unknown key 'halfs' (known: "},
    {R"("rules": { "hal_s": 3 })", "3:12: unknown key 'hal_s' in rules, did you mean 'half_s'?"},
    {R"("senses": { "far": 3 })", "3:13: unknown key 'far' in senses"},
    {R"("network": { "loss": 0.1 })", "3:14: unknown key 'loss' in network"},
    {R"("seed": 1, "seed": 2)", "3:12: key 'seed' stands twice"},
    {R"("rules": { "set_s": 3, "set_s": 4 })", "3:24: key 'set_s' stands twice"},
    {R"("begins": { "ball_x": 1 })", "did you mean 'ball_x_m'?"},
    {R"("begins": { "ball_x_m": 4.45 })", "begins.ball_x_m is 4.45"},
    {R"("begins": { "ball_y_m": -3.5 })", "begins.ball_y_m is -3.5"},
    // types
    {R"("rules": { "half_s": "long" })", "3:22: rules.half_s must be a number in s, not"},
    {R"("rules": [60])", "3:10: rules must be an object"},
    {R"("seed": 1.5)", "3:9: seed"},
    {R"("seed": -1)", "3:9: seed"},
    {R"("begins": { "with": "corners" })", "did you mean 'corner'?"},
    {R"("robots_differ": 2)", "robots_differ is 2"},
    {R"("field": 3)", "3:10: field must be a string"},
    {R"("ends": 1)", "3:9: ends must be an object"},
    {R"("doc": ["a"])", "3:8: doc must be a string"},
    {R"("start": true)", "3:10: start must be a string"},
    {R"("rolling_friction_m": null)", "3:23: rolling_friction_m must be a number in m"},
    // ranges
    {R"("rules": { "half_s": -3 })", "3:22: rules.half_s is -3, must be 5..3600 s"},
    {R"("rules": { "mercy_difference": 0 })", "rules.mercy_difference"},
    {R"("rules": { "messages": 70000 })", "rules.messages is 70000"},
    {R"("rules": { "hidden_playing_s": 61 })", "rules.hidden_playing_s is 61"},
    {R"("ends": { "goals": 0 })", "ends.goals"},
    {R"("ends": { "playing_s": 0.5 })", "ends.playing_s is 0.5"},
    {R"("network": { "lost": 2 })", "network.lost is 2"},
    {R"("network": { "delay_s": -0.1 })", "network.delay_s is -0.1"},
    {R"("senses": { "rate_Hz": 0 })", "senses.rate_Hz is 0"},
    {R"("senses": { "view_rad": 7 })", "senses.view_rad is 7"},
    {R"("senses": { "missed": 1.01 })", "senses.missed is 1.01"},
    {R"("rolling_friction_m": 1)", "rolling_friction_m is 1"},
    // choices, and what does not fit together
    {R"("field": "smal")", "3:10: field: unknown value 'smal', did you mean 'small'?"},
    {R"("start": "bench")", "touchline, field"},
    {R"("division": "tiny")", "small, middle, large"},
    {R"("field": "large")", "3:10: "},
    {R"("division": "small", "field": "large")", "the small division does not play"},
    // the other team
    {R"("away": {})", "3:9: key 'team' is missing in away"},
    {R"("away": { "players": 9, "team": "behaviors/football" })", "away.players is 9"},
    {R"("away": { "players": 0, "team": "behaviors/football" })", "away.players is 0"},
    {R"("away": { "players": 2, "keeper": 9, "team": "behaviors/football" })", "away.keeper is 9"},
    {R"("away": { "players": 2, "team": "behaviors/none" })", "away.team: there is no file or folder"},
    // bases
    {R"("based_on": "config/matches/nothing.json")", "3:13: based_on: there is no file"},
    {R"("based_on": 3)", "based_on must be a string"},
};

const Wrong wrong_homes[] = {
    {R"("field": "small")", "1:1: key 'home' is missing"},
    {R"("home": 3)", "2:9: home must be an object"},
    {R"("home": { "team": "behaviors/footbal", "players": 1 })", "2:19: home.team: there is no "},
    {R"("home": { "team": "behaviors/footbal", "players": 1 })", "did you mean 'football'?"},
    {R"("home": { "team": "behaviors/football\u0000x", "players": 1 })", "is no path"},
    {R"("home": { "team": "behaviors/tulip", "players": 1 })", "has no team.lua, a k.decisions"},
    {R"("home": { "team": "", "players": 1 })", "home.team must not be empty"},
    {R"("home": { "team": "behaviors/football" })", "2:9: key 'players' is missing in home"},
    {R"("home": { "team": "behaviors/football", "players": 1, "parameters": "passes=0}" })",
     "parameters are NAME=NUMBER"},
    {R"("home": { "team": "behaviors/football", "players": 1, "places": { "1": { "x_m": 2 } } })",
     "'y_m' is missing in home.places.1"},
    {R"("home": { "team": "behaviors/football", "players": 1, "keeper": 2 })",
     "keeper is number 2, but the team has 1 players"},
    {R"("home": { "team": "behaviors/football", "players": 1, "robot": "config/tulp/robot.json" })",
     "home.robot: there is no "},
    {R"("home": { "team": "behaviors/football", "players": 1 } "away": {})", "2:56: a comma or } is needed here"},
};

// A team of one that stands, whose decisions have these lines for their state.
std::string team_lua(const std::string& head, const std::string& during) {
  return "local k = require \"kadans\"\nk.events(require \"foot_orders\")\n" + head +
         "\nreturn k.decisions \"team\" {\n  initial = \"play\",\n  k.state \"play\" {\n    endless = true,\n    "
         "during = "
         "function(m, s)\n" +
         during + "\n    end,\n  },\n}\n";
}

// What is said of a match with this team.lua: what is refused, or the first errors that are told within half a second.
std::string said_of_team(const std::string& lua) {
  written(folder / "team" / "team.lua", lua);
  const std::string team = fs::relative(folder / "team", KADANS_SOURCE_DIR).generic_string();
  const fs::path file = written(folder / "match.json",
                                "{ \"name\": \"drawn\", \"home\": { \"team\": \"" + team + "\", \"players\": 1 } }");
  try {
    PlayedMatch match(read_match(file), 1);
    std::string said;
    for (int i = 0; i < 25 && match.step(); ++i) {
      for (const std::string& line : match.take_lines()) said += has(line, "error: ") ? line + "\n" : "";
    }
    return said;
  } catch (const InputError& error) {
    return error.what();
  }
}

struct WrongTeam {
  std::string lua;
  const char* message;
};

const WrongTeam wrong_teams[] = {
    {"local k = require \"kadans\"\nreturn k.decisions \"team\" {\n  initial == 3,\n}\n", "team.lua:3:"},
    {"return 3\n", "team.lua"},
    {"local k = require \"kadans\"\nreturn k.behavior \"team\" {\n  initial = \"a\", k.final \"a\" {}\n}\n",
     "k.decisions"},
    {"local k = require \"kadnas\"\n", "team.lua:1:"},
    {"local k = require \"kadans\"\nreturn k.decisions \"team\" { initial = \"none\", k.state \"a\" { endless = true } "
     "}\n",
     "none"},
    {team_lua("k.events { [\"robot.pass\"] = { x_m = { \"m\", min = 3, max = 1 } } }", ""), "team.lua:3:"},
    {team_lua("k.events { [\"robot.pass\"] = { x_m = { 5 } } }", ""), "team.lua:3:"},
    {team_lua("", "m:emit(\"foot.fly\", {}, { to = \"footwork\" })"), "team.lua:9:"},
    {team_lua("", "m:emit(\"foot.go\", { x_m = 1e6, y_m = 0, heading_rad = 0 }, { to = \"footwork\" })"),
     "team.lua:9:"},
    {team_lua("", "m:send(\"robot.pass\", { x_m = 1 })"), "team.lua:9:"},
    {team_lua("", "m:send(\"foot.stand\", {})"), "team.lua:9:"},
    {team_lua("", "local x = s.seen.ball.x_m + s.seen.bal.x_m"), "team.lua:9:"},
    {team_lua("", "m:replace(\"no_such_behavior\")"), "team.lua:9:"},
    {team_lua("", "while true do end"), "team.lua"},
};

}  // namespace

TEST_CASE("What is wrong in a match file is told with its place, what is wrong and what was meant") {
  CHECK(refusal_of("{ \"name\": \"drawn\",\n" + one_team + "\n}\n").empty());
  for (const Wrong& wrong : wrong_with_team) {
    const std::string text = refusal_of("{ \"name\": \"drawn\",\n" + one_team + ",\n" + wrong.rest + "\n}\n");
    CHECK_MESSAGE(has(text, wrong.message), std::string(wrong.rest)
                                                << " told:\n"
                                                << text << "\nwanted: " << std::string(wrong.message));
  }
  for (const Wrong& wrong : wrong_homes) {
    const std::string text = refusal_of("{ \"name\": \"drawn\",\n" + std::string(wrong.rest) + "\n}\n");
    CHECK_MESSAGE(has(text, wrong.message), std::string(wrong.rest)
                                                << " told:\n"
                                                << text << "\nwanted: " << std::string(wrong.message));
  }
}

TEST_CASE("A match file that is no JSON, no text, too large or no file is refused") {
  CHECK(has(refusal_of("{ \"name\": \"Two teams\",\n" + one_team + "\n}\n"), "1:11: name must be small letters"));
  CHECK(has(refusal_of("{ \"name\": \"\",\n" + one_team + "\n}\n"), "1:11: name must not be empty"));
  CHECK(has(refusal_of("[]"), "1:1: the file must hold one JSON object"));
  CHECK(has(refusal_of(""), "1:1: "));
  CHECK(has(refusal_of("{ \"name\": \"drawn\",\n  'home': 3 }"), "2:3: "));
  CHECK(has(refusal_of("{ \"name\": \"drawn\",\n" + one_team + ",\n}"), "2:55: a key must follow this comma"));
  CHECK(has(refusal_of("{ \"name\": \"drawn\" } x"), "1:21: "));
  CHECK(has(refusal_of("{ \"name\": \"drawn\",\n \"doc\": \"\xff\" }"), "2:10: "));
  CHECK(has(refusal_of("{ \"name\": \"drawn\",\n" + std::string(200'000, '[')), "2:"));
  CHECK(has(refusal_of("{ \"name\": \"drawn\",\n \"seed\": 1e999,\n" + one_team + "}"), "2:10: "));
  CHECK(has(refusal_of("{ \"name\": \"drawn\",\n\"home\": { \"team\": \"" + std::string(5000, 'a') +
                       "\", \"players\": 1 } }"),
            "2:19: home.team: "));
  CHECK(has(refusal_of("{ \"name\": \"drawn\", \"doc\": \"" + std::string(17 << 20, 'a') + "\" }"), "large"));
  CHECK_THROWS_WITH_AS(read_match(folder / "nothing.json"), doctest::Contains("nothing.json"), InputError);
  CHECK_THROWS_WITH_AS(read_match(folder), doctest::Contains("football_input"), InputError);
}

TEST_CASE("What is wrong in a team is told with its file and line, before the match or as it happens") {
  CHECK(said_of_team(team_lua("", "m:emit(\"foot.stand\", {}, { to = \"all\" })")).empty());
  for (const WrongTeam& wrong : wrong_teams) {
    const std::string said = said_of_team(wrong.lua);
    CHECK_MESSAGE(has(said, wrong.message), wrong.lua << "\ntold:\n"
                                                      << said << "\nwanted: " << std::string(wrong.message));
  }
}

TEST_CASE(
    "What --set says stands in place of the file's, and what is wrong in it is told with the setting that it is in") {
  const fs::path file = KADANS_SOURCE_DIR "/config/matches/two_against_two.json";
  const auto refused = [&](const std::vector<std::string>& settings) {
    return kadans::refusal("", "", [&] { (void)read_match(file, settings); });
  };
  const MatchConfig match = read_match(file, {"network.lost=0.3", "network.delay_s=0.05", "seed=7", "away.name=them"});
  CHECK(match.lost == 0.3);
  CHECK(match.delay_s == 0.05);
  CHECK(match.seed == 7);
  CHECK(match.team(Side::away).name == "them");
  CHECK(match.team(Side::away).players == 2);
  CHECK(match.rules.half_s == read_match(file).rules.half_s);
  const std::string several = refused({"network.delay_s=0.05", "network.lost=3", "seed=7", "network.jitter_s=-1"});
  CHECK(has(several, "--set network.lost=3: network.lost is 3"));
  CHECK(has(several, "--set network.jitter_s=-1: network.jitter_s is -1"));
  CHECK(has(refused({"network.lots=0.3"}), "--set network.lots=0.3: unknown key 'lots'"));
  CHECK(has(refused({"home.team=behaviors/footbal"}), "did you mean 'football'?"));
  CHECK(has(refused({"division=large", "seed=7"}), "--set division=large --set seed=7: "));
  CHECK(read_match(file, {"seed=7", "home.parameters=passes=0"}).team(Side::home).parameters_place.file ==
        "--set home.parameters=passes=0");
  CHECK(has(refused({"network.lost"}), "must be KEY=VALUE"));
  CHECK(has(refused({"seed=1", "seed=2"}), "twice"));
}

TEST_CASE("The shipped schema of match files is what their reader says, and the shipped matches keep to it") {
  using namespace kadans::schema_checks;
  MatchConfig match;
  const std::string schema = kadans::json_schema(kadans::describe_fields([&](kadans::Fields& f) {
                                                   kadans::InputObject object(f);
                                                   match_fields(object, match);
                                                 }),
                                                 "Match");
  check_shipped(schema, "match.schema.json");
  for (const auto& entry : fs::directory_iterator(source / "config/matches")) {
    if (entry.path().extension() == ".json") check_file(schema, entry.path());
  }
}

TEST_CASE("A mistake in a team's parameters is told at their place in the match file, once for all its robots") {
  const fs::path file = written(folder / "parameters.json", R"({ "name": "drawn",
  "home": { "team": "behaviors/football", "players": 2,
            "parameters": "pases=0" } })");
  try {
    PlayedMatch match(read_match(file), 1);
    FAIL("it was taken");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 1);
    CHECK(error.problems()[0].text() ==
          file.string() + ":3:27: behavior 'team' takes no argument 'pases', did you mean 'passes'?");
  }
}

}  // namespace match_input_test
