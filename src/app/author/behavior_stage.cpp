#include "behavior_stage.h"

#include <algorithm>

#include "config/json/problems.h"
#include "config/robot/project_root.h"
#include "decision_stage.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

class BehaviorStage final : public RobotStage {
 public:
  explicit BehaviorStage(ScenarioConfig scenario) : RobotStage(std::move(scenario)) {
    assembly_.filter([this](Snapshot& snapshot) { sensors_.change(snapshot); });
  }

  Behavior& behavior() override { return assembly_.host().behavior(0); }
  std::string control_sets() const override {
    std::string all;
    each_bit(seen_.control_sets,
             [&](std::uint32_t set) { all += (all.empty() ? "" : " ") + assembly_.catalog().sets[set].name; });
    return all;
  }
  // One that is not declared is sent between states of the chart; a test may send it, too.
  std::string emit(const PlayedEvent& event) override {
    if (event.data.empty() && find_event(behavior().events(), event.name) == nullptr)
      return behavior().post(event.name) ? "" : "nothing waits for the event '" + event.name + "'";
    try {
      assembly_.host().order({.kind = PlayOrder::Kind::emit, .event = event});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

// Whether the file makes a k.decisions, by the only word that does.
bool may_decide(const fs::path& file) {
  return fs::exists(file) && read_input_file(file).find("k.decisions") != std::string::npos;
}

std::vector<fs::path> robots_in(const fs::path& configs) {
  std::vector<fs::path> robots;
  if (!fs::is_directory(configs)) return robots;
  for (const fs::directory_entry& entry : fs::directory_iterator(configs)) {
    if (fs::exists(entry.path() / "robot.json")) robots.push_back(entry.path() / "robot.json");
  }
  std::ranges::sort(robots);
  return robots;
}

}  // namespace

fs::path robot_of_behavior(const fs::path& behavior) {
  const fs::path configs = project_root(behavior) / "config";
  fs::path own = configs / fs::absolute(behavior).parent_path().filename() / "robot.json";
  if (fs::exists(own)) return own;
  const std::vector<fs::path> robots = robots_in(configs);
  if (robots.size() == 1) return robots.front();
  refuse(behavior, "no robot goes with it: there is no " + own.string() +
                       "; name one: kadans behavior with --robot FILE, kadans repl with a scenario");
}

fs::path only_robot(const fs::path& folder, const std::string& named) {
  const fs::path configs = project_root(folder / "x") / "config";
  const std::vector<fs::path> robots = robots_in(configs);
  if (robots.size() == 1) return robots.front();
  if (robots.empty()) refuse(configs, "there is no robot.json in its folders; name one: " + named);
  const auto shown = [](const fs::path& robot) { return fs::proximate(robot).string(); };
  refuse(configs, "there are several robots, name one: " + named + ": " + listed(robots, shown));
}

std::unique_ptr<TestStage> RobotStages::make(const fs::path& behavior, const Options& options) {
  check_input_file(behavior);
  const std::string& plant = options.plant;
  const std::vector<std::string> models = plant_type_names(&PlantType::is_model);
  if (!plant.empty() && std::ranges::find(models, plant) == models.end())
    refuse("k.play", unknown_name("plant", plant, models));
  ScenarioConfig scenario;
  scenario.file = behavior.string();
  scenario.name = behavior.stem().string();
  scenario.robot = robot_of(behavior, options).string();
  if (!options.scenario.empty())
    scenario.supervisor = read_scenario_config(project_root(behavior) / options.scenario).supervisor;
  scenario.undecided = true;
  scenario.plant = plant.empty() ? "ideal" : plant;
  if (may_decide(behavior)) return std::make_unique<DecisionStage>(std::move(scenario), behavior);
  scenario.behaviors.push_back({.file = behavior});
  return std::make_unique<BehaviorStage>(std::move(scenario));
}

fs::path RobotStages::robot_of(const fs::path& behavior, const Options& options) const {
  const fs::path root = project_root(behavior);
  if (!options.robot.empty()) return root / options.robot;
  if (!options.scenario.empty()) return read_scenario_config(root / options.scenario).robot;
  return robot_.empty() ? robot_of_behavior(behavior) : robot_;
}

}  // namespace kadans
