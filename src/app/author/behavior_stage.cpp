#include "behavior_stage.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>

#include "app/assembly.h"
#include "app/snapshot_filter.h"
#include "config/json/problems.h"
#include "config/robot/project_root.h"
#include "estimate/leg_chain.h"
#include "signal/sine_cosine.h"
#include "signal/status_fields.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// Replaces numbers of the snapshot.
class Sensors final : public SnapshotFilter {
 public:
  explicit Sensors(const Catalog& catalog)
      : joints_(catalog.model->joint_names()), fields_(status_fields(catalog.sensors, catalog.seen)) {
    for (const FootInfo& sole : catalog.feet) feet_.push_back(sole.name);
    for (const SeenInfo& entry : catalog.seen) seen_.push_back(entry.name);
  }

  bool set(const std::string& name, double value) {
    if (!std::isfinite(value)) return false;
    Snapshot probe;
    if (!put(probe, name, value)) return false;
    values_[name] = value;
    return true;
  }
  void change(Snapshot& snapshot) noexcept override {
    for (const auto& [name, value] : values_) (void)put(snapshot, name, value);
    if (!values_.contains("base.posture") && (values_.contains("base.roll_rad") || values_.contains("base.pitch_rad")))
      lie_as_leant(snapshot.status.base);
  }

 private:
  bool put(Snapshot& snapshot, const std::string& name, double value) const {
    for (const StatusField& field : fields_) {
      const bool chosen = field.type == StatusField::Type::choice;
      if (field.at == nullptr || (chosen && !(value >= 0 && value < static_cast<double>(field.choices)))) continue;
      const std::optional<std::size_t> index = index_in(name, field);
      if (!index) continue;
      field.at(snapshot, *index).set(value);
      return true;
    }
    return false;
  }

  // A test that sets the angles expects the posture that belongs to them.
  static void lie_as_leant(BaseStatus& base) noexcept {
    const auto [sin_roll, cos_roll] = sine_cosine(base.roll_rad);
    const auto [sin_pitch, cos_pitch] = sine_cosine(base.pitch_rad);
    base.posture = posture_of({-sin_pitch, cos_pitch * sin_roll, cos_pitch * cos_roll});
  }

  // The index of the joint or foot if `name` is this field of it: "joints.l_knee.position_rad", "feet.left.contact"; 0
  // for "base.roll_rad".
  std::optional<std::size_t> index_in(const std::string& name, const StatusField& field) const {
    using enum StatusField::Part;
    const auto is = [&](const std::string& path) { return name == path + "." + field.name; };
    const auto only = [&](const char* path) { return is(path) ? std::optional<std::size_t>(0) : std::nullopt; };
    const auto one_of = [&](const char* part, const std::vector<std::string>& names) -> std::optional<std::size_t> {
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (is(std::string(part) + "." + names[i])) return i;
      }
      return std::nullopt;
    };
    switch (field.part) {
      case joint:
        return one_of("joints", joints_);
      case foot:
        return one_of("feet", feet_);
      case base:
        return only("base");
      case rate:
        return only("base.angular_velocity_rad_s");
      case support:
        return only("support");
      case odometry:
        return only("odometry");
      case safety:
        return only("safety");
      case joystick:
        return only("joystick");
      case ball:
        return only("seen.ball");
      case seen: {
        const std::optional<std::size_t> entry = one_of("seen", seen_);
        return entry && field.is_of(seen, *entry) ? entry : std::nullopt;
      }
      case sensors:
        return only("sensors");
      case root:
        break;
    }
    return std::nullopt;
  }

  std::vector<std::string> joints_, feet_, seen_;
  std::vector<StatusField> fields_;
  std::map<std::string, double> values_;
};

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
  std::optional<bool> in(const std::string& path) const override {
    const std::vector<Chart::State>& states = behavior().chart().states;
    const auto found = std::ranges::find(states, path, &Chart::State::path);
    if (path.empty() || found == states.end()) return std::nullopt;
    return behavior().active(static_cast<StateIndex>(found - states.begin()));
  }
  std::vector<std::string> paths() const override {
    std::vector<std::string> all;
    for (const Chart::State& state : behavior().chart().states) all.push_back(state.path);
    return all;
  }
  std::string outcome() const override { return behavior().outcome(); }
  std::string result() const override { return behavior().result(); }
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

std::unique_ptr<TestStage> RobotStages::make(const fs::path& behavior, const std::string& robot,
                                             const std::string& plant) {
  const std::vector<std::string> models = plant_type_names(&PlantType::is_model);
  if (!plant.empty() && std::ranges::find(models, plant) == models.end())
    throw InputError({.file = "k.play", .message = unknown_name("plant", plant, models)});
  ScenarioConfig scenario;
  scenario.file = behavior.string();
  scenario.name = behavior.stem().string();
  scenario.robot =
      (robot.empty() ? (robot_.empty() ? robot_of_behavior(behavior) : robot_) : project_root(behavior) / robot)
          .string();
  scenario.undecided = true;
  scenario.plant = plant.empty() ? "ideal" : plant;
  scenario.behaviors.push_back({.file = behavior});
  return std::make_unique<RobotStage>(std::move(scenario));
}

}  // namespace kadans
