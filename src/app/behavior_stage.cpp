#include "behavior_stage.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "kadans/app/assembly.h"
#include "kadans/app/snapshot_filter.h"
#include "kadans/config/project_root.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// What stands in for numbers of the snapshot.
class Sensors final : public SnapshotFilter {
 public:
  explicit Sensors(const RobotModel& model) : model_(model) {}

  bool set(const std::string& name, double value) {
    if (!std::isfinite(value)) return false;
    Snapshot probe;
    if (!put(probe, name, value)) return false;
    values_[name] = value;
    return true;
  }
  void change(Snapshot& snapshot) noexcept override {
    for (const auto& [name, value] : values_) (void)put(snapshot, name, value);
  }

 private:
  bool put(Snapshot& snapshot, const std::string& name, double value) const {
    if (name == "safety.level") {
      if (!(value >= 0 && value <= static_cast<double>(SafetyLevel::off))) return false;
      snapshot.status.safety.level = static_cast<SafetyLevel>(value);
      return true;
    }
    if (bool* held = find_button(snapshot, name)) return *held = value != 0, true;
    for (const auto& [foot, side] : {std::pair{0, "left"}, std::pair{1, "right"}}) {
      if (name != std::string("feet.") + side + ".contact") continue;
      snapshot.status.feet[static_cast<std::size_t>(foot)].contact = value != 0;
      return true;
    }
    double* number = find(snapshot, name);
    if (number != nullptr) *number = value;
    return number != nullptr;
  }

  static bool* find_button(Snapshot& snapshot, const std::string& name) {
    JoystickState& joystick = snapshot.joystick;
    if (name == "joystick.connected") return &joystick.connected;
    for (std::size_t i = 0; i < joystick_buttons; ++i) {
      if (name == "joystick.button_" + std::to_string(i + 1)) return &joystick.buttons[i];
    }
    return nullptr;
  }

  double* find(Snapshot& snapshot, const std::string& name) const {
    for (std::size_t i = 0; i < joystick_axes; ++i) {
      if (name == std::string("joystick.") + joystick_axis_names[i]) return &snapshot.joystick.axes[i];
    }
    BaseStatus& base = snapshot.status.base;
    const std::pair<const char*, double*> fields[] = {
        {"base.roll_rad", &base.roll_rad},
        {"base.pitch_rad", &base.pitch_rad},
        {"base.yaw_rad", &base.yaw_rad},
        {"base.tilt_rad", &base.tilt_rad},
        {"base.height_m", &base.height_m},
        {"base.angular_velocity_rad_s.x", &base.angular_velocity_rad_s[0]},
        {"base.angular_velocity_rad_s.y", &base.angular_velocity_rad_s[1]},
        {"base.angular_velocity_rad_s.z", &base.angular_velocity_rad_s[2]},
        {"feet.left.force_N", &snapshot.status.feet[0].force_N},
        {"feet.left.cop_x_m", &snapshot.status.feet[0].cop_x_m},
        {"feet.left.cop_y_m", &snapshot.status.feet[0].cop_y_m},
        {"feet.right.force_N", &snapshot.status.feet[1].force_N},
        {"feet.right.cop_x_m", &snapshot.status.feet[1].cop_x_m},
        {"feet.right.cop_y_m", &snapshot.status.feet[1].cop_y_m},
        {"support.force_N", &snapshot.status.support.force_N},
        {"support.cop_x_m", &snapshot.status.support.cop_x_m},
        {"support.cop_y_m", &snapshot.status.support.cop_y_m}};
    for (const auto& [known, number] : fields) {
      if (name == known) return number;
    }
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      const std::string prefix = "joints." + model_.joints[i].name + ".";
      if (!name.starts_with(prefix)) continue;
      JointState& joint = snapshot.joints.joints[i];
      const std::string field = name.substr(prefix.size());
      if (field == "position_rad") return &joint.position_rad;
      if (field == "velocity_rad_s") return &joint.velocity_rad_s;
      if (field == "effort_Nm") return &joint.effort_Nm;
    }
    return nullptr;
  }

  const RobotModel& model_;
  std::map<std::string, double> values_;
};

class IdealStage final : public TestStage {
 public:
  explicit IdealStage(ScenarioConfig scenario)
      : scenario_(std::move(scenario)), assembly_(scenario_, scenario_.seed, log_), sensors_(assembly_.robot().model) {
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
  const RobotModel& model() const override { return assembly_.robot().model; }
  std::string state() const override { return behavior().state(); }
  std::string outcome() const override { return behavior().outcome(); }
  std::string error() const override { return behavior().failed() ? behavior().error().text() : ""; }
  std::string control_sets() const override {
    std::string all;
    each_bit(seen_.control_sets,
             [&](std::uint32_t set) { all += (all.empty() ? "" : " ") + assembly_.catalog().sets[set].name; });
    return all;
  }
  std::string said() const override {
    std::string all;
    for (const LogLine& line : log_.lines()) all += line.text + "\n";
    return all;
  }
  std::string went() const override {
    std::string all = log_.transitions().empty() ? state() : log_.transitions().front().from;
    for (const Transition& transition : log_.transitions()) all += " " + transition.to;
    return all;
  }
  bool emit(const std::string& event) override { return assembly_.host().behavior(0).post(event); }
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
  Sensors sensors_;
  Snapshot seen_;
  double due_s_ = 0;
};

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
                    .message = "no robot goes with it: there is no " + own.string() + "; name one with --robot FILE"});
}

fs::path only_robot(const fs::path& folder) {
  const fs::path configs = project_root(folder / "x") / "config";
  const std::vector<fs::path> robots = robots_in(configs);
  if (robots.size() == 1) return robots.front();
  std::string names;
  for (const fs::path& robot : robots) names += (names.empty() ? ": " : ", ") + fs::proximate(robot).string();
  throw InputError({.file = configs.string(),
                    .message = robots.empty() ? "there is no robot.json in its folders; name one with --robot FILE"
                                              : "there are several robots, name one with --robot" + names});
}

std::unique_ptr<TestStage> IdealStages::make(const fs::path& behavior, const std::string& robot) {
  ScenarioConfig scenario;
  scenario.file = behavior.string();
  scenario.name = behavior.stem().string();
  scenario.robot =
      (robot.empty() ? (robot_.empty() ? robot_of_behavior(behavior) : robot_) : project_root(behavior) / robot)
          .string();
  scenario.plant = "ideal";
  scenario.behaviors.push_back({.file = behavior});
  return std::make_unique<IdealStage>(std::move(scenario));
}

}  // namespace kadans
