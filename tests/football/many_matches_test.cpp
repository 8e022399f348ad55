// Many matches: what they come to, in parts and whole, and what is told of those without a result.
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "football/program/match_report.h"
#include "football/program/match_summary.h"
#include "kadans/signal/input_error.h"
#include "temporary_folder.h"

namespace many_matches_test {

namespace fs = std::filesystem;
using namespace kadans::football;

namespace {

const kadans::test::TemporaryFolder own;
const fs::path folder = own.path() / "many";
const std::string program = KADANS_BINARY_DIR "/kadans-football";
const std::string drill = KADANS_SOURCE_DIR "/config/matches/striker_drill.json";

bool never() { return false; }

// Two variants of two matches that end after a moment.
const ManyMatches short_ones{.files = {drill},
                             .settings = {"ends.playing_s=1", "rules.ready_s=5", "rules.set_s=1"},
                             .varied = {"senses.missed=0.2,0.9"},
                             .seed = 11,
                             .cases = 2};

MatchResult result_of(std::uint64_t seed, unsigned home, unsigned away, std::uint64_t falls, double still_s) {
  MatchResult result;
  result.seed = seed;
  result.ended = "by the rules";
  result.score = {home, away};
  result.simulated_s = 120;
  result.robots.resize(2);
  result.robots[0] = {.id = {Side::home, 1}, .name = "home_1", .falls = falls, .messages = 30};
  result.robots[1] = {
      .id = {Side::away, 1}, .name = "away_1", .messages = 10, .still_max_s = still_s, .frozen_max_s = still_s - 1};
  result.robots[1].off_median_m = 0.1;
  return result;
}

std::vector<VariantResults> part(const std::string& out, kadans::Shard shard) {
  return play_many(short_ones, {.out = out, .shard = shard, .jobs = 2, .program = program}, never);
}

}  // namespace

TEST_CASE("A summary counts who wins, falls by robot and minute, and who stands still, with Wilson's interval") {
  VariantResults all;
  all.results = {result_of(1, 2, 0, 4, 3), result_of(2, 1, 1, 0, 25), result_of(3, 0, 3, 0, 1),
                 result_of(4, 1, 0, 0, 0)};
  all.results[2].over_budget[1] = 1;
  const MatchSummary s = summary_of(all);
  CHECK(s.home_won.hits == 2);
  CHECK(s.drawn.hits == 1);
  CHECK(s.away_won.hits == 1);
  CHECK(s.with_goals.hits == 4);
  CHECK(s.home_won.interval().low == doctest::Approx(0.1500).epsilon(0.001));  // 2 of 4, by hand
  CHECK(s.home_won.interval().high == doctest::Approx(0.8500).epsilon(0.001));
  CHECK(s.goals.mean == doctest::Approx(2));
  CHECK(s.falls_per_minute.greatest == doctest::Approx(1));  // 4 falls of 2 robots in 2 minutes
  CHECK(s.falls_per_minute.mean == doctest::Approx(0.25));
  CHECK(s.still_below_limit.hits == 3);
  CHECK(s.still_max_s.greatest == 25);
  CHECK(s.frozen_below_limit.hits == 3);
  CHECK(s.frozen_max_s.greatest == 24);
  CHECK(s.messages.mean == 30);
  CHECK(s.off_m.median == doctest::Approx(0.1));
  CHECK(s.within_budget.hits == 3);
  CHECK_FALSE(all_well(summaries_of({all})));
  all.results.erase(all.results.begin() + 2);
  CHECK(all_well(summaries_of({all})));
  all.missing = {"a match: crashed by signal 11"};
  CHECK_FALSE(all_well(summaries_of({all})));
  CHECK(summary_text(summaries_of({all})).find("crashed by signal 11") != std::string::npos);
}

TEST_CASE("A match that broke off counts in no share or mean, and it and the first error are told with their command") {
  VariantResults all;
  all.variant = {drill, {"home.parameters=passes=0, dives=0"}};
  all.results = {result_of(1, 2, 0, 0, 3), result_of(2, 1, 1, 40, 30)};
  all.results[1].ended = "the model diverges at 1 s";
  all.results[1].robots[0].errors = 2;
  all.results[1].robots[0].first_error = "1.00 s  home_1.team: a.lua:3: boom";
  const MatchSummary s = summary_of(all);
  CHECK(s.matches == 2);
  CHECK(s.drawn.of == 1);
  CHECK(s.drawn.hits == 0);
  CHECK(s.falls_per_minute.mean == 0);
  CHECK(s.ended_by_itself.of == 2);
  const std::string text = summary_text({s}), command = drill + " --seed 2 --set 'home.parameters=passes=0, dives=0': ";
  CHECK(text.find(command + "the model diverges at 1 s\n") != std::string::npos);
  CHECK(text.find("2 errors of decisions or behaviors, the first:") != std::string::npos);
  CHECK(text.find(command + "1.00 s  home_1.team: a.lua:3: boom\n") != std::string::npos);
  CHECK_FALSE(all_well({s}));
}

TEST_CASE("Results of a team that has changed since are those of another one, wherever its folder is") {
  const fs::path team = folder / "teams" / "one", out = team / "results";  // which are no part of the team
  fs::remove_all(folder);
  fs::create_directories(team);
  fs::copy_file(KADANS_SOURCE_DIR "/behaviors/football/team.lua", team / "team.lua");
  const ManyMatches plan{
      .files = {drill}, .settings = {"home.team=" + team.string()}, .varied = {}, .seed = 5, .cases = 1};
  const ManyChoices choices{.out = out.string(), .shard = {}, .jobs = 1, .program = "/bin/false"};
  (void)play_many(plan, choices, never);
  (void)play_many(plan, choices, never);
  std::ofstream(team / "team.lua", std::ios::app) << "-- another one\n";
  CHECK_THROWS_WITH_AS(play_many(plan, choices, never), doctest::Contains("another version of the teams"),
                       kadans::InputError);
}

TEST_CASE("A result that is written is read again as it was") {
  const MatchConfig match = read_match(drill);
  MatchResult result = result_of(9, 2, 1, 3, 4.25);
  result.match = match.name;
  result.state_hash = 0xfedcba9876543210U;
  result.over_budget = {0, 7};
  result.messages_left = {11, 12};
  result.robots[0].errors = 2;
  result.robots[0].first_error = "1.00 s  home_1.team: a.lua:3: \"boom\"";
  const fs::path file = folder / "result.json";
  fs::create_directories(folder);
  std::ofstream(file) << json_of(result, match);
  CHECK(json_of(read_result(file), match) == json_of(result, match));
  std::ofstream(file) << "{ \"match\": 3 }";
  CHECK_THROWS_WITH_AS(read_result(file), doctest::Contains("1:12: match must be a string"), kadans::InputError);
}

TEST_CASE("Matches in two parts come to what they come to as a whole, and what has a result is not played again") {
  fs::remove_all(folder);
  const std::vector<VariantResults> whole = part(folder / "whole", {});
  REQUIRE(whole.size() == 2);
  REQUIRE(whole[0].results.size() == 2);
  CHECK(whole[0].results[0].seed == 11);
  CHECK(whole[0].results[1].ended == "by its time");
  CHECK(whole[0].results[0].state_hash != whole[1].results[0].state_hash);
  CHECK(part(folder / "a", {0, 2})[0].results.size() == 1);
  const std::vector<std::string> parts{(folder / "a").string(), (folder / "b").string()};
  fs::create_directories(folder / "b");
  fs::copy_file(folder / "a" / "plan.json", folder / "b" / "plan.json");
  CHECK(merge_many(parts)[0].missing.size() == 1);
  (void)part(folder / "b", {1, 2});
  CHECK(summary_json(summaries_of(merge_many(parts))) == summary_json(summaries_of(whole)));
  const auto written = fs::last_write_time(folder / "whole" / "0-11.json");
  CHECK(summary_json(summaries_of(part(folder / "whole", {}))) == summary_json(summaries_of(whole)));
  CHECK(fs::last_write_time(folder / "whole" / "0-11.json") == written);
  ManyMatches other = short_ones;
  other.seed = 12;
  CHECK_THROWS_WITH_AS(play_many(other, {.out = folder / "whole", .program = program}, never),
                       doctest::Contains("other matches"), kadans::InputError);
}

TEST_CASE("A match that crashes is told with its command, and a variant that is wrong before any is played") {
  const std::vector<VariantResults> all =
      play_many({.files = {drill}, .settings = {}, .varied = {}, .seed = 5, .cases = 1},
                {.out = {}, .shard = {}, .jobs = 1, .program = "/bin/false"}, never);
  REQUIRE(all.at(0).missing.size() == 1);
  CHECK(all[0].missing[0].find("striker_drill.json --seed 5") != std::string::npos);
  ManyMatches wrong = short_ones;
  wrong.varied = {"senses.missed=0.2,1.9"};
  CHECK_THROWS_WITH_AS(variants_of(wrong), doctest::Contains("senses.missed is 1.9"), kadans::InputError);
  wrong.varied = {"senses.missed"};
  CHECK_THROWS_WITH_AS(variants_of(wrong), doctest::Contains("KEY=VALUE,VALUE"), kadans::InputError);
  wrong = short_ones;
  wrong.cases = 1'000'000;
  CHECK_THROWS_AS(play_many(wrong, {.program = program}, never), kadans::InputError);
}

}  // namespace many_matches_test
