// Paths inside files, and patterns over names.
#include "config/robot/project_root.h"

#include <fstream>

#include <doctest/doctest.h>

#include "kadans/signal/nearest_name.h"

namespace kadans::project_root_test {
namespace {

namespace fs = std::filesystem;

// A project in a folder of its own, gone at the end.
class Project {
 public:
  explicit Project(const char* name) : root(fs::path(KADANS_BINARY_DIR) / "tests" / "project_root" / name) {
    fs::remove_all(root);
    fs::create_directories(root / "config" / "tulip");
    fs::create_directories(root / "models" / "tulip");
    std::ofstream(root / "models" / "tulip" / "tulip.urdf") << "<robot/>";
  }
  ~Project() {
    std::error_code ignored;
    fs::remove_all(root, ignored);
  }
  Project(const Project&) = delete;
  Project& operator=(const Project&) = delete;

  fs::path root;
};

}  // namespace

TEST_CASE("A file's project is the nearest folder above it that holds two of config, models and behaviors") {
  const Project project("copied");
  CHECK(project_root(project.root / "config" / "tulip" / "robot.json") == project.root);
  CHECK(project_root(project.root / "robot.json") == project.root);
  fs::create_directories(project.root / "config" / "models");  // one of the three is not enough
  CHECK(project_root(project.root / "config" / "tulip" / "robot.json") == project.root);
}

TEST_CASE("A file outside any project belongs to the project around the working directory") {
  const Project project("around");
  const fs::path before = fs::current_path();
  fs::current_path(project.root / "config");
  const fs::path root = project_root("/nowhere/else/scenario.json");
  fs::current_path(before);
  CHECK(root == fs::canonical(project.root));
}

TEST_CASE("Paths are meant from the project's root, or from the file's folder when they begin with a dot") {
  const Project project("paths");
  const fs::path file = project.root / "config" / "tulip" / "robot.json";
  CHECK(resolve("models/tulip/tulip.urdf", file) == project.root / "models" / "tulip" / "tulip.urdf");
  CHECK(resolve("./a.urdf", file) == project.root / "config" / "tulip" / "a.urdf");
  CHECK(resolve("../a.urdf", file) == project.root / "config" / "a.urdf");
  CHECK(resolve("/x/./a.urdf", file) == "/x/a.urdf");
}

TEST_CASE("A file that is not there is a problem at its place, with the nearest file") {
  const Project project("missing");
  Problems problems((project.root / "config" / "robot.json").string());
  CHECK(resolve_file("models/tulip/tulip.urdf", {3, 4}, "urdf", problems).filename() == "tulip.urdf");
  CHECK(problems.empty());
  CHECK(resolve_file("models/tulip/tulipp.urdf", {3, 4}, "urdf", problems).empty());
  CHECK(resolve_file("models/tulip", {5, 6}, "urdf", problems).empty());
  std::string message;
  try {
    problems.throw_if_any();
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 2);
    CHECK(error.problems()[0].line == 3);
    message = error.problems()[0].message;
  }
  CHECK(message.ends_with("did you mean 'tulip.urdf'?"));
}

TEST_CASE("A star in a pattern stands for any characters, none included") {
  CHECK(matches("*", ""));
  CHECK(matches("*", "l_knee"));
  CHECK(matches("*_knee", "l_knee"));
  CHECK(matches("l_*", "l_"));
  CHECK(matches("*.kp*rad", "l_knee.kp_Nm_per_rad"));
  CHECK(matches("*a*b*", "xaxxaxbx"));
  CHECK_FALSE(matches("*_knee", "l_knees"));
  CHECK_FALSE(matches("", "l"));
  CHECK_FALSE(matches("l_knee", "l_kne"));
  CHECK_FALSE(matches("*a*b*c", "ab"));
  const std::vector<std::string> names{"l_knee", "r_knee", "torso"};
  CHECK(matching("*knee", names) == std::vector<std::size_t>{0, 1});
  CHECK(matching("head", names).empty());
}

}  // namespace kadans::project_root_test
