#include "campaign/suite/golden.h"

#include <fstream>

#include <doctest/doctest.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"

namespace golden_test {

using namespace kadans;

namespace {

namespace fs = std::filesystem;

class GoldenFile {
 public:
  GoldenFile() : path_(fs::temp_directory_path() / ("kadans_golden_" + std::to_string(getpid()) + ".json")) {
    fs::remove(path_);
  }
  ~GoldenFile() { fs::remove(path_); }
  GoldenFile(const GoldenFile&) = delete;
  GoldenFile& operator=(const GoldenFile&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

RunOutcome run(const std::string& scenario, std::uint64_t seed, const std::vector<std::string>& hashes,
               RunStatus status = RunStatus::passed) {
  RunOutcome outcome;
  outcome.scenario = scenario;
  outcome.seed = seed;
  outcome.status = status;
  outcome.hashes = hashes;
  outcome.state_hash = hashes.empty() ? "" : hashes.back();
  return outcome;
}

const std::string a = "aaaaaaaa00000001", b = "bbbbbbbb00000002", c = "cccccccc00000003";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("Golden hashes are taken, written and read again, and tell where a run parts from them") {
  const GoldenFile file;
  GoldenHashes first(file.path());
  CHECK(has(first.difference(run("push", 1, {a, b})), "no golden hash"));
  CHECK(first.take({run("squat", 1, {a, b, c}), run("push", 2, {b}), run("push", 1, {a, b})}, true).size() == 3);
  first.write();
  const GoldenHashes golden(file.path());
  CHECK(golden.size() == 3);
  CHECK(golden.difference(run("squat", 1, {a, b, c})).empty());
  CHECK(has(golden.difference(run("squat", 1, {a, c, c})), "between 1 s and 2 s"));
  CHECK(has(golden.difference(run("squat", 1, {a, b})), "after 2 s"));
  RunOutcome last = run("squat", 1, {a, b, c});
  last.state_hash = "dddddddd00000004";  // behind the last whole second
  CHECK(has(golden.difference(last), "after 3 s"));
  CHECK_FALSE(golden.difference(run("squat", 2, {a, b, c})).empty());
}

TEST_CASE("Renewing tells what is new, changed and gone, and leaves what failed as it was") {
  const GoldenFile file;
  GoldenHashes golden(file.path());
  (void)golden.take({run("same", 1, {a}), run("changed", 1, {a, b}), run("gone", 1, {a}), run("failed", 1, {a})}, true);
  const std::vector<RunOutcome> now{run("same", 1, {a}), run("changed", 1, {a, c}), run("new", 1, {a}),
                                    run("failed", 1, {c}, RunStatus::failed)};
  const std::vector<std::string> changes = golden.take(now, true);
  REQUIRE(changes.size() == 4);
  CHECK(changes[0] == "changed changed (seed 1): between 1 s and 2 s");
  CHECK(changes[1] == "new     new (seed 1)");
  CHECK(changes[2] == "left    failed (seed 1): failed");
  CHECK(changes[3] == "gone    gone (seed 1)");
  CHECK(golden.difference(run("failed", 1, {a})).empty());
  CHECK(golden.size() == 4);
  CHECK(golden.take({run("same", 1, {a})}, false).empty());  // one of them alone
  CHECK(golden.size() == 4);
}

TEST_CASE("Golden hashes say of which Bullet they are when another one leads elsewhere") {
  const GoldenFile file;
  GoldenHashes made(file.path(), "Bullet 3.24 of here");
  (void)made.take({run("squat", 1, {a, b})}, true);
  made.write();
  CHECK(GoldenHashes(file.path(), "Bullet 3.25").difference(run("squat", 1, {a, b})).empty());
  const std::string other = GoldenHashes(file.path(), "Bullet 3.25").difference(run("squat", 1, {a, c}));
  CHECK(has(other, "between 1 s and 2 s: the golden hashes are those of Bullet 3.24 of here, this is Bullet 3.25"));
  CHECK(has(GoldenHashes(file.path(), "Bullet 3.24 of here").difference(run("squat", 1, {a, c})), "--renew-golden"));
}

TEST_CASE("The golden hashes of another machine, and files that hold none, are refused") {
  const GoldenFile file;
  std::ofstream(file.path()) << R"({"machine": "pdp11", "runs": []})";
  CHECK_THROWS_WITH_AS(GoldenHashes(file.path()), doctest::Contains("pdp11"), InputError);
  std::ofstream(file.path()) << R"({"machine": 1})";
  CHECK_THROWS_AS(GoldenHashes(file.path()), InputError);
  std::ofstream(file.path()) << "nothing";
  CHECK_THROWS_AS(GoldenHashes(file.path()), InputError);
}

}  // namespace golden_test
