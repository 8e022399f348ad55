// JIWIY and TULip on HostMot2 boards: their whole control systems, the driver, the datagrams and the boards, on virtual
// time.
#include <fstream>

#include <doctest/doctest.h>

#include "app/assembly.h"
#include "plant/hostmot2_world.h"
#include "plant/json_plant_fields.h"
#include "program.h"

using namespace kadans;
using namespace kadans::program;

namespace {

const std::string source = KADANS_SOURCE_DIR "/";
std::string robot_on_boards;  // the configuration of the robot that stands there
test::HostMot2World* newest_machine = nullptr;

// A model for scenarios: Bullet's, driven through the boards that the robot's configuration names.
class BoardsType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "boards"; }
  std::string_view doc() const noexcept override { return "of the test"; }
  bool is_model() const noexcept override { return true; }
  std::unique_ptr<World> make_world(const WorldSite& world) const override {
    std::ifstream in(robot_on_boards);
    const nlohmann::ordered_json robot = nlohmann::ordered_json::parse(in);
    hostmot2::HostMot2Settings settings;
    test::JsonPlantFields fields(robot.at("plant").at("hm2-eth"));
    settings.fields(fields);
    PlantSite site{.file = robot_on_boards, .layout = {.robot = robot.at("name")}};
    for (const auto& joint : world.model.joints) site.layout.joints.push_back(joint.name);
    for (const FootSettings& foot : world.settings.feet) site.layout.feet.push_back(foot.link);
    const PlantTypes types = plant_types();
    auto made =
        std::make_unique<test::HostMot2World>(plant_type(types, "bullet").make_world(world), settings, settings, site);
    newest_machine = made.get();
    return made;
  }
};
std::unique_ptr<PlantType> make_boards_type() { return std::make_unique<BoardsType>(); }
KADANS_REGISTER_PLANT_TYPE(make_boards_type);

struct Through {
  bool passed = false;
  std::string why;
  std::uint64_t hash = 0;
  std::vector<PlantCount> counts;
};

Through run_through(const char* plant, const std::string& file, const char* scenario_name, std::uint64_t seed) {
  robot_on_boards = source + file;
  ScenarioConfig scenario = read_scenario_config(source + "config/scenarios/" + scenario_name + ".json");
  scenario.robot = robot_on_boards;
  scenario.plant = plant;
  RunLog log;
  Assembly robot(scenario, seed, log);
  Checks checks(robot.catalog().signals, scenario.checks);
  const RunResult result = run_scenario(robot.parts(), scenario.duration_s, checks, {});
  Through is{.passed = result.passed};
  for (const CheckResult& check : result.checks) {
    if (!check.passed) is.why += check.name + "; ";
  }
  for (const RunFault& one : result.faults) is.why += std::string(name(one.code)) + "; ";
  is.hash = result.state_hash;
  is.why += result.error;
  if (std::string_view(plant) == "boards") is.counts = newest_machine->driver().link_counts();
  return is;
}

std::uint64_t count_of(const Through& run, std::string_view name) {
  for (const PlantCount& one : run.counts) {
    if (one.name == name) return one.value;
  }
  return ~std::uint64_t{0};
}

}  // namespace

TEST_CASE("JIWIY follows its sine through a HostMot2 board, with the behavior that drives the model, on every seed") {
  constexpr const char* file = "config/jiwiy/anything_io.json";
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    const Through model = run_through("bullet", file, "jiwiy_sine", seed);
    const Through board = run_through("boards", file, "jiwiy_sine", seed);
    CAPTURE(board.why);
    CHECK(model.passed);
    CHECK(board.passed);
    CHECK(board.hash != model.hash);
    CHECK(count_of(board, "sent") == 7500);  // one in each tick
    CHECK(count_of(board, "lost") == 0);
    CHECK(count_of(board, "bites") == 0);
  }
  CHECK(run_through("boards", file, "jiwiy_sine", 1).hash == run_through("boards", file, "jiwiy_sine", 1).hash);
}

TEST_CASE("TULip squats, gets up and catches pushes through two HostMot2 boards, with the same behaviors") {
  constexpr const char* file = "config/tulip/anything_io.json";
  for (const std::string scenario : {"squat", "get_up_prone", "get_up_supine", "push_forward", "push_left"}) {
    CAPTURE(scenario);
    const Through boards = run_through("boards", file, scenario.c_str(), 1);
    CAPTURE(boards.why);
    CHECK(boards.passed);
    CHECK(count_of(boards, "lost") == 0);
    CHECK(count_of(boards, "strange") == 0);
  }
  CHECK(run_through("boards", file, "squat", 1).hash == run_through("boards", file, "squat", 1).hash);
}
