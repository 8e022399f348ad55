// Files of earlier versions, kept in tests/versions/VERSION: what a version wrote and what people wrote for it. Later
// versions read them, or refuse them with a sentence that says what is meant now. tests/versions/keep_sample.sh adds
// those of the present version, at its release.
#include <filesystem>
#include <set>
#include <string>

#include <doctest/doctest.h>

#include "app/program.h"
#include "version.h"

namespace versions_test {

namespace fs = std::filesystem;
using namespace kadans;
using namespace kadans::program;

namespace {

const fs::path samples = fs::path(KADANS_SOURCE_DIR) / "tests/versions";

std::set<std::string> versions_kept() {
  std::set<std::string> names;
  for (const auto& folder : fs::directory_iterator(samples)) {
    if (folder.is_directory()) names.insert(folder.path().filename().string());
  }
  return names;
}

fs::path copy_of(const std::string& kept) {
  const fs::path folder = fresh_folder("version_" + kept);
  fs::copy(samples / kept, folder, fs::copy_options::recursive);
  return folder;
}

}  // namespace

TEST_CASE("samples are kept of every version, and of this one") {
  CHECK(versions_kept().contains("0.1.0"));
  CHECK(versions_kept().contains(version));
}

TEST_CASE("robots, scenarios and behaviors of earlier versions are read") {
  for (const std::string& kept : versions_kept()) {
    CAPTURE(kept);
    const Outcome outcome = run("check config behaviors", copy_of(kept));
    CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
    CHECK(has(outcome.out, "ok  config/tulip/robot.json"));
  }
}

TEST_CASE("records of earlier versions are read, and run again with their own files") {
  for (const std::string& kept : versions_kept()) {
    CAPTURE(kept);
    const fs::path folder = copy_of(kept);
    const Outcome info = run("log info squat.mcap", folder);
    CHECK_MESSAGE(info.exit_code == 0, info.err);
    CHECK(has(info.out, "recorded by  kadans " + kept));
    const Outcome csv = run("log csv squat.mcap joint.l_knee.position_rad", folder);
    CHECK_MESSAGE(csv.exit_code == 0, csv.err);
    CHECK(has(csv.out, "joint.l_knee.position_rad"));
    // A later program may compute otherwise; then it says so and that it is another one.
    const Outcome again = run("replay squat.mcap --from-record", folder);
    CHECK_MESSAGE((again.exit_code == 0 || again.exit_code == 1), again.err);
    if (again.exit_code == 1) CHECK(has(again.out + again.err, "program"));
  }
}

TEST_CASE("runs on threads that earlier versions recorded are repeated from their inputs") {
  for (const std::string& kept : versions_kept()) {
    CAPTURE(kept);
    const fs::path folder = copy_of(kept);
    if (!fs::exists(folder / "run.mcap")) continue;  // records of its time held none
    const Outcome again = run("replay run.mcap", folder);
    CHECK_MESSAGE((again.exit_code == 0 || again.exit_code == 1), again.err);
    CHECK(has(again.out, "repeated from its inputs"));
    if (again.exit_code == 1) CHECK(has(again.out + again.err, "program"));
  }
}

TEST_CASE("what this version does not know in a robot's file is refused with its place") {
  const fs::path folder = copy_of("0.1.0");
  REQUIRE(edit(folder / "config/tulip/robot.json", "\"control_period_s\"", "\"control_periods_s\""));
  const Outcome outcome = run("check config/tulip/robot.json", folder);
  CHECK(outcome.exit_code != 0);
  CHECK(has(outcome.out + outcome.err, "config/tulip/robot.json:"));
  CHECK(has(outcome.out + outcome.err, "control_period_s"));
}

}  // namespace versions_test
