#include "behavior_stage.h"

#include <algorithm>
#include <optional>

#include "app/assembly/assembly.h"
#include "config/json/problems.h"
#include "config/robot/project_root.h"
#include "decision_stage.h"
#include "set_sensors.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

class RobotStage final : public TestStage {
 public:
  explicit RobotStage(ScenarioConfig scenario)
      : scenario_(std::move(scenario)), assembly_(scenario_, scenario_.seed, log_), sensors_(assembly_.catalog()) {
    assembly_.filter(sensors_);
  }

  void advance(double seconds) override {
    const RunParts parts = assembly_.parts();
    due_s_ += seconds;
    while (static_cast<double>(parts.lockstep.time_ns()) < due_s_ * 1e9 - 1) parts.lockstep.step();
    seen_ = parts.control.state();
    sensors_.change(seen_);
  }
  const Snapshot& snapshot() const override { return seen_; }
  const Catalog& catalog() const override { return assembly_.catalog(); }
  std::string state() const override { return behavior().state(); }
  std::vector<std::string> active() const override { return behavior().active(); }
  std::optional<bool> in(const std::string& path) const override { return kadans::in(behavior(), path); }
  std::vector<std::string> paths() const override { return paths_of(behavior().chart()); }
  std::string outcome() const override { return behavior().outcome(); }
  std::string result() const override { return behavior().result(); }
  std::string error() const override { return behavior().failed() ? behavior().error().text() : ""; }
  std::string control_sets() const override {
    std::string all;
    each_bit(seen_.control_sets,
             [&](std::uint32_t set) { all += (all.empty() ? "" : " ") + assembly_.catalog().sets[set].name; });
    return all;
  }
  std::string said() const override { return lines_said(log_); }
  std::string went() const override { return way_of(log_, state()); }
  // One that is not declared is sent between states of the chart; a test may send it, too.
  std::string emit(const PlayedEvent& event) override {
    ScriptHost& host = assembly_.host();
    Behavior& behavior = host.behavior(0);
    if (event.data.empty() && find_event(behavior.events(), event.name) == nullptr)
      return behavior.post(event.name) ? "" : "nothing waits for the event '" + event.name + "'";
    try {
      host.order({.kind = PlayOrder::Kind::emit, .event = event});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  bool set_parameter(const std::string& name, double value) override {
    return assembly_.host().behavior(0).set_parameter(name, value);
  }
  bool set_sensor(const std::string& name, double value) override {
    const bool known = sensors_.set(name, value);
    sensors_.change(seen_);
    return known;
  }

 private:
  const Behavior& behavior() const { return assembly_.host().behavior(0); }

  ScenarioConfig scenario_;
  RunLog log_;
  Assembly assembly_;
  SetSensors sensors_;
  Snapshot seen_;
  double due_s_ = 0;
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
  throw InputError({.file = behavior.string(),
                    .message = "no robot goes with it: there is no " + own.string() +
                               "; name one: kadans behavior with --robot FILE, kadans repl with a scenario"});
}

fs::path only_robot(const fs::path& folder, const std::string& named) {
  const fs::path configs = project_root(folder / "x") / "config";
  const std::vector<fs::path> robots = robots_in(configs);
  if (robots.size() == 1) return robots.front();
  std::string names;
  for (const fs::path& robot : robots) names += (names.empty() ? ": " : ", ") + fs::proximate(robot).string();
  throw InputError({.file = configs.string(),
                    .message = robots.empty() ? "there is no robot.json in its folders; name one: " + named
                                              : "there are several robots, name one: " + named + names});
}

std::unique_ptr<TestStage> RobotStages::make(const fs::path& behavior, const Options& options) {
  const std::string& plant = options.plant;
  const std::vector<std::string> models = plant_type_names(&PlantType::is_model);
  if (!plant.empty() && std::ranges::find(models, plant) == models.end())
    throw InputError({.file = "k.play", .message = unknown_name("plant", plant, models)});
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
  return std::make_unique<RobotStage>(std::move(scenario));
}

fs::path RobotStages::robot_of(const fs::path& behavior, const Options& options) const {
  const fs::path root = project_root(behavior);
  if (!options.robot.empty()) return root / options.robot;
  if (!options.scenario.empty()) return read_scenario_config(root / options.scenario).robot;
  return robot_.empty() ? robot_of_behavior(behavior) : robot_;
}

}  // namespace kadans
