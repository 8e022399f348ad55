#include "config/scenario/based_on.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <unistd.h>

#include "config/plan/experiment_plans.h"
#include "config/robot/robot_config.h"

namespace kadans::based_on_test {
namespace {

namespace fs = std::filesystem;

// A project of its own, so that paths count from its root.
class Project {
 public:
  Project() : root_(fs::temp_directory_path() / ("kadans_based_on_" + std::to_string(getpid()))) {
    fs::remove_all(root_);
    for (const char* folder : {"config", "models", "behaviors"}) fs::create_directories(root_ / folder);
  }
  ~Project() { fs::remove_all(root_); }
  std::string write(const std::string& name, const std::string& text) const {
    const fs::path file = root_ / "config" / name;
    std::ofstream(file) << text;
    return file.string();
  }

 private:
  fs::path root_;
};

std::string message_of(const std::string& text, const std::string& file) {
  try {
    (void)parse_based_json(text, file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A file based on another has its keys, its own in their place, and lists of named things merged by name") {
  const Project project;
  const std::string base = project.write(
      "base.json", R"({ "a": 1, "in": { "x": 1, "y": [1, 2] }, "list": [{ "name": "p", "v": 1 }, { "name": "q" }] })");
  const std::string text =
      R"({ "based_on": "config/base.json", "in": { "y": [3], "z": 4 }, "list": [{ "name": "p", "w": 2 }, { "name": "r" }] })";
  const BasedJson json = parse_based_json(text, project.write("file.json", text));
  REQUIRE(json.bases.size() == 1);
  CHECK(json.bases.front() == fs::path(base));
  CHECK(json.value.find("a")->value.number == 1);
  const JsonValue& in = json.value.find("in")->value;
  CHECK(in.find("x")->value.number == 1);
  CHECK(in.find("y")->value.items.size() == 1);
  CHECK(in.find("z")->value.number == 4);
  const std::vector<JsonValue>& list = json.value.find("list")->value.items;
  REQUIRE(list.size() == 3);
  CHECK(list[0].find("v")->value.number == 1);
  CHECK(list[0].find("w")->value.number == 2);
  CHECK(list[2].find("name")->value.text == "r");
}

TEST_CASE(
    "Two things of one name in a file stay two, so that their reader refuses them, whether its base has one or not") {
  const Project project;
  project.write("base.json", R"({ "list": [{ "name": "p" }, { "name": "q" }] })");
  for (const auto& [name, items] : {std::pair{"p", 3U}, {"r", 4U}}) {
    const std::string item = R"({ "name": ")" + std::string(name) + "\", \"v\": ";
    const std::string text = R"({ "based_on": "config/base.json", "list": [)" + item + "1 }, " + item + "2 }] }";
    const BasedJson json = parse_based_json(text, project.write("file.json", text));
    const std::vector<JsonValue>& list = json.value.find("list")->value.items;
    REQUIRE(list.size() == items);
    CHECK(list.back().find("name")->value.text == name);
    CHECK(list.back().find("v")->value.number == 2);
  }
}

TEST_CASE("What a base says stands where the file names the base, what the file says in its own place") {
  const Project project;
  project.write("base.json", "{\n\n\n \"a\": { \"x\": 1 } }");
  const std::string text = "{ \"based_on\": \"config/base.json\",\n  \"a\": { \"y\": 2 } }";
  const BasedJson json = parse_based_json(text, project.write("file.json", text));
  const JsonValue& a = json.value.find("a")->value;
  CHECK(a.find("x")->value.place == TextPlace{1, 15});
  CHECK(a.find("y")->value.place == TextPlace{2, 15});
}

TEST_CASE("A base that is not there, and files based on each other, are refused at their place") {
  const Project project;
  const std::string alone = R"({ "based_on": "config/nothing.json" })";
  CHECK(message_of(alone, project.write("alone.json", alone)).find("alone.json:1:15: ") != std::string::npos);
  project.write("one.json", R"({ "based_on": "config/two.json" })");
  const std::string two = R"({ "based_on": "config/one.json" })";
  CHECK(message_of(two, project.write("two.json", two)).find("based on itself") != std::string::npos);
}

TEST_CASE("A mistake in the base of a tuning is told at its place in the base") {
  const Project project;
  project.write("base.json", R"({ "name": "base", "program": ["true"], "score": "score", "failed_score": 1,
    "tune": { "gain": { "min": 0, "max": 1, "start": 0.5 } },
    "population": 1 })");
  const std::string text = R"({ "based_on": "config/base.json", "population": 8 })";
  const std::string file = project.write("file.json", text);
  std::string told;
  try {
    (void)read_tune_plan_text(text, file);
  } catch (const InputError& error) {
    told = error.what();
  }
  CAPTURE(told);
  CHECK(told.find("base.json:3:19: population is 1") != std::string::npos);
}

TEST_CASE("TULip with its soft springs is TULip but for the springs and their loop") {
  const std::vector<std::string> types{"joint_pid",  "dcm_balance",     "stance",       "dcm_walk",
                                       "stance_leg", "joint_impedance", "spring_torque"};
  const fs::path folder = fs::path(KADANS_SOURCE_DIR) / "config/tulip";
  const RobotConfig stiff = read_robot_config(folder / "robot.json", types);
  const RobotConfig soft = read_robot_config(folder / "soft.json", types);
  CHECK(soft.name == stiff.name);
  CHECK(soft.objects.size() == stiff.objects.size() + 1);
  CHECK(soft.at_drives.size() == 1);
  const std::size_t knee = soft.model.find_joint("l_knee").value(), yaw = soft.model.find_joint("l_hip_yaw").value();
  CHECK(soft.plant.drives[knee].spring_Nm_per_rad == 300);
  CHECK(soft.plant.drives[knee].rotor_inertia_kg_m2 == stiff.plant.drives[knee].rotor_inertia_kg_m2);
  CHECK(soft.plant.drives[yaw].spring_Nm_per_rad == stiff.plant.drives[yaw].spring_Nm_per_rad);
  CHECK(files_of(folder / "soft.json").size() == 2);
}

}  // namespace kadans::based_on_test
