// Results of shards become one table: the same whatever the shards, and never of different sweeps.
#include "campaign/sweep/merged_sweep.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <doctest/doctest.h>
#include <unistd.h>

#include "campaign/sweep/sweep_summary.h"

namespace merged_sweep_test {

using namespace kadans;
namespace fs = std::filesystem;

namespace {

// A sweep of twelve cases whose runs never happened: what they would have reported is made up from the case.
struct Campaign {
  fs::path root = fs::path(KADANS_BINARY_DIR) / "tests" / ("merged-" + std::to_string(getpid()));
  SweepPlan plan;
  std::vector<SweepSubject> subjects;
  std::vector<SweepCase> cases;
  SweepManifest manifest;

  explicit Campaign(std::uint64_t seed = 1) {
    fs::remove_all(root);
    plan.name = "made_up";
    plan.sampling = Sampling::random;
    plan.cases = 12;
    plan.seed = seed;
    plan.vary.push_back(
        {{{"ground.friction", {}}, {.kind = Distribution::Kind::values, .values = {0.3, 0.6, 0.9}}}, 1});
    plan.vary.push_back({{{"mass", {}}, {.kind = Distribution::Kind::values, .values = {1, 2}}}, 1});
    plan.metrics.push_back({.name = "tilt_rad", .signal = "s", .that = ""});
    plan.worst.name = plan.time.name = plan.first_try.name = "tilt_rad";
    subjects.push_back({.scenario = {"push.json", "/p/push.json", {}},
                        .name = "push, \"hard\"",
                        .quantities = {"ground.friction", "mass"}});
    cases = sweep_cases(plan, subjects, "1");
    manifest = manifest_of(plan, cases, "1");
  }
  ~Campaign() { fs::remove_all(root); }
  Campaign(const Campaign&) = delete;
  Campaign& operator=(const Campaign&) = delete;

  RunOutcome run_of(const SweepCase& one) const {
    RunOutcome run;
    run.scenario = subjects[0].name;
    run.seed = one.seed;
    run.wall_s = static_cast<double>(getpid());  // different each time, in no table
    run.repeat = repeat_command(one, subjects[0]);
    if (one.index == 5) return run;  // crashed, no report
    run.status = one.index == 3 ? RunStatus::failed : RunStatus::passed;
    run.json = R"({"state_hash":"aa","duration_s":2.0,"checks":[{"name":"up, \"high\"","passed":)" +
               std::string(one.index == 3 ? "false" : "true") + R"(}],"quantities":{"ground.friction":)" +
               number_text(one.settings[0].value) + R"(,"mass":)" + number_text(one.settings[1].value) +
               R"(},"metrics":{"tilt_rad":)" + (one.index == 7 ? "null" : std::to_string(one.index)) + "}}";
    return run;
  }
  // The cases whose number has this rest.
  SweepResults part(const std::string& name, std::size_t rest, std::size_t of) const {
    SweepResults results(root / name, manifest);
    for (const SweepCase& one : cases) {
      if (one.index % of == rest) results.store(one, case_json(manifest, one, run_of(one)));
    }
    return results;
  }
};

std::string bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string refusal(const std::vector<SweepResults>& parts) {
  try {
    (void)merge(parts);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("Shards in any order and number give the same text, table, database and picture, byte for byte") {
  const Campaign campaign;
  const MergedSweep whole = merge({campaign.part("whole", 0, 1)});
  const SweepResults a = campaign.part("a", 0, 3), b = campaign.part("b", 1, 3), c = campaign.part("c", 2, 3);
  write_sqlite(whole, campaign.root / "whole.db");
  for (const auto& parts : {std::vector{a, b, c}, std::vector{c, a, b}, std::vector{b, c, a, b}}) {
    const MergedSweep merged = merge(parts);
    CHECK(csv_table(merged) == csv_table(whole));
    CHECK(sweep_summary(merged) == sweep_summary(whole));
    write_sqlite(merged, campaign.root / "parts.db");
    CHECK(bytes(campaign.root / "parts.db") == bytes(campaign.root / "whole.db"));
    CHECK(heat_map_svg(merged, {"ground.friction", "mass", ""}) ==
          heat_map_svg(whole, {"ground.friction", "mass", ""}));
  }
  CHECK(bytes(campaign.root / "whole.db").starts_with("SQLite format 3"));
}

TEST_CASE("A crashed case is a failed row with its quantities, a text with quotes and commas stays one column") {
  const Campaign campaign;
  const MergedSweep merged = merge({campaign.part("whole", 0, 1)});
  REQUIRE(merged.rows.size() == 12);
  CHECK(merged.rows[5].status == RunStatus::crashed);
  CHECK(value_of(merged.rows[5], "mass") == campaign.cases[5].settings[1].value);
  const std::string csv = csv_table(merged);
  CHECK(has(csv, "\"push, \"\"hard\"\"\""));
  CHECK(has(csv, "failed,\"up, \"\"high\"\"\",2,aa,"));
  const SweepCounts of = counts(merged);
  CHECK(of.passed == 10);
  CHECK(of.first_try == 8);     // not case 0, whose metric is 0, nor 7, which has none
  CHECK(of.median_s == 6);      // of 0 1 2 4 6 8 9 10 11
  CHECK_FALSE(passed(merged));  // all must
  CHECK(has(sweep_summary(merged), "10 of 12, 83.3 % (55.2 .. 95.3)"));
}

TEST_CASE("Missing cases are listed and keep a sweep from passing") {
  Campaign campaign;
  campaign.manifest.passed_min = 0.5;
  const SweepResults a = campaign.part("a", 0, 4), b = campaign.part("b", 1, 4);
  const MergedSweep merged = merge({a, b});
  CHECK(has(sweep_summary(merged), "missing: 6 of 12 cases: 2-3, 6-7, 10-11"));
  CHECK_FALSE(passed(merged));
  CHECK(passed(merge({campaign.part("all", 0, 1)})));
}

TEST_CASE("Different sweeps, and different results of one case, are refused") {
  const Campaign campaign;
  Campaign other(2);
  const SweepResults a = campaign.part("a", 0, 2);
  other.root /= "other";
  const SweepResults b = other.part("b", 1, 2);
  CHECK(has(refusal({a, b}), "is of another sweep than"));
  CHECK(has(refusal({a, b}), "seed 1 and 2"));
  CHECK_THROWS_AS(SweepResults(a.folder(), other.manifest), InputError);
  const SweepResults c = campaign.part("c", 0, 2);
  RunOutcome changed = campaign.run_of(campaign.cases[2]);
  changed.json.replace(changed.json.find("\"aa\""), 4, "\"ab\"");
  c.store(campaign.cases[2], case_json(campaign.manifest, campaign.cases[2], changed));
  CHECK(has(refusal({a, c}), "case 2 came out different"));
  CHECK_THROWS_AS(SweepResults(campaign.root / "nothing"), InputError);
}

TEST_CASE("Half a result is no result: what a writer left unfinished is passed over, what is broken is named") {
  const Campaign campaign;
  const SweepResults a = campaign.part("a", 0, 1);
  std::ofstream(a.folder() / "cases" / ".000001-x.json.1.part") << "{\"pl";
  CHECK(a.rows().size() == 12);
  std::ofstream(a.folder() / "cases" / "000001-x.json") << "{\"pl";
  CHECK_THROWS_WITH_AS((void)a.rows(), doctest::Contains("000001-x.json"), InputError);
}

TEST_CASE("A run that took too long is run again when the sweep is, a failed one is not") {
  const Campaign campaign;
  const SweepResults results = campaign.part("a", 0, 1);
  CHECK(results.has(campaign.cases[3]));
  RunOutcome late = campaign.run_of(campaign.cases[4]);
  late.status = RunStatus::timed_out;
  results.store(campaign.cases[4], case_json(campaign.manifest, campaign.cases[4], late));
  CHECK_FALSE(results.has(campaign.cases[4]));
}

TEST_CASE("A case's name changes with whatever its run depends on, and with nothing else") {
  const Campaign one, same;
  CHECK(one.cases[4].id == same.cases[4].id);
  SweepPlan plan = one.plan;
  plan.doc = "other words";
  CHECK(sweep_cases(plan, one.subjects, "1")[4].id == one.cases[4].id);
  CHECK(sweep_cases(plan, one.subjects, "2")[4].id != one.cases[4].id);
  auto subjects = one.subjects;
  subjects[0].content = 7;
  CHECK(sweep_cases(plan, subjects, "1")[4].id != one.cases[4].id);
  plan.metrics[0].from_s = 1;
  CHECK(sweep_cases(plan, one.subjects, "1")[4].id != one.cases[4].id);
}

}  // namespace merged_sweep_test
