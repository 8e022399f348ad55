#include "switch_pairs.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/assembly/assembly.h"
#include "bench/report.h"

namespace kadans::bench {
namespace {

constexpr const char* robot_file = KADANS_SOURCE_DIR "/tests/bench/control/switching_robot.json";
constexpr int settle_ticks = 120, disturbed_ticks = 150, saturated_ticks = 15;
constexpr int loaded_ticks = 40;
constexpr double load_N = 25;

ScenarioConfig scenario() {
  ScenarioConfig scenario;
  scenario.file = KADANS_SOURCE_DIR "/config/scenarios/squat.json";  // for the project's root; not read
  scenario.name = "switching";
  scenario.robot = robot_file;
  return scenario;
}

std::uint32_t set_index(const Catalog& catalog, const std::string& name) {
  const auto found =
      std::find_if(catalog.sets.begin(), catalog.sets.end(), [&](const auto& set) { return set.name == name; });
  return static_cast<std::uint32_t>(found - catalog.sets.begin());
}

class Hanging {
 public:
  Hanging()
      : scenario_(scenario()),
        robot_(scenario_, 7, log_),
        parts_(robot_.parts()),
        sender_(parts_.control.exchange().commands) {}

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      for (const std::size_t foot : feet_) {
        if (loaded_) parts_.robot.push(foot, {0.6 * load_N, 0.3 * load_N, -load_N}, {0, 0, 0});
      }
      parts_.lockstep.step();
    }
  }
  void load() { loaded_ = true; }
  void send(const std::vector<Command>& commands) {
    sender_.begin(parts_.lockstep.time_ns());
    for (const Command& command : commands) (void)sender_.add(command);
    (void)sender_.commit();
  }
  void switch_to(const std::string& set) {
    send({{.kind = CommandKind::switch_set, .index = set_index(robot_.catalog(), set)}});
  }
  // Tells every set-point of the set's objects to go `by` of what it measures within duration_s.
  void move(const std::string& set, double by, double duration_s) {
    std::vector<Command> commands;
    const Catalog& catalog = robot_.catalog();
    for (const std::uint32_t object : catalog.sets[set_index(catalog, set)].objects) {
      for (const SetpointId id : catalog.objects[object].setpoints) {
        const Setpoint& setpoint = catalog.setpoints[id];
        const bool position = setpoint.joint != no_joint && setpoint.unit == "rad";
        if (!position && setpoint.unit != "rad/s") continue;
        const double now = position ? parts_.robot.truth().position_rad[setpoint.joint] : 0;
        commands.push_back({.kind = CommandKind::set_point,
                            .index = id,
                            .value = std::clamp(now + by, setpoint.min, setpoint.max),
                            .duration_s = duration_s});
      }
    }
    send(commands);
  }
  // Sends the robot on by two ticks; the largest change of a drive's torque from the first to the second. The first
  // applies a command that was sent and computes the new set; in the second it acts.
  void watch(SwitchStep& step) {
    const PlantTruth& truth = parts_.robot.truth();
    run(1);
    const auto before = truth.drive_torque_Nm;
    run(1);
    const RobotModel& model = robot_.robot().model;
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      if (model.joints[i].passive()) continue;
      const double share = std::abs(truth.drive_torque_Nm[i] - before[i]) / model.joints[i].effort_max_Nm;
      if (share <= step.share) continue;
      step.share = share;
      step.joint = model.joints[i].name;
    }
    step.without_share = absorbed_share();
  }
  double absorbed_share() const {
    return parts_.control.row()[robot_.catalog().signals.find("composition.switch_share").value()];
  }

 private:
  ScenarioConfig scenario_;
  RunLog log_;
  Assembly robot_;
  RunParts parts_;
  CommandSender sender_;
  bool loaded_ = false;
  std::vector<std::size_t> feet_{robot_.robot().model.find_link("l_ankle_roll_link").value(),
                                 robot_.robot().model.find_link("r_ankle_roll_link").value()};
};

}  // namespace

const char* name(Situation situation) {
  switch (situation) {
    case Situation::rest:
      return "at rest";
    case Situation::moving:
      return "moving";
    case Situation::load:
      return "under load";
    case Situation::saturated:
      return "saturated";
  }
  return "";
}

std::vector<std::string> switch_sets() {
  const auto robot = read_robot(robot_file);
  std::vector<std::string> names;
  for (const ControlSetInfo& set : robot.config.sets) names.push_back(set.name);
  return names;
}

double switch_step_max() { return read_robot(robot_file).config.switching.step_max; }

namespace {

std::unique_ptr<Hanging> robot_in(const std::string& set, Situation situation) {
  auto robot = std::make_unique<Hanging>();
  robot->run(settle_ticks);
  robot->switch_to(set);
  robot->run(settle_ticks);
  switch (situation) {
    case Situation::rest:
      break;
    case Situation::moving:
      robot->move(set, 0.5, 0.5);
      robot->run(disturbed_ticks);
      break;
    case Situation::load:
      robot->load();
      robot->run(loaded_ticks);
      break;
    case Situation::saturated:
      robot->move(set, 1.5, 0);
      robot->run(saturated_ticks);
      break;
  }
  return robot;
}

}  // namespace

SwitchStep measure_switch(const std::string& from, const std::string& to, Situation situation) {
  SwitchStep step{.from = from, .to = to, .situation = situation};
  const auto robot = robot_in(from, situation);
  robot->switch_to(to);
  robot->watch(step);
  return step;
}

double switch_cost_ns(const std::string& from, const std::string& to) {
  const auto robot = read_robot(robot_file);
  const auto system = make_control_system(robot);
  Catalog& catalog = system->catalog;
  ControlSets sets(catalog, std::move(system->objects));
  JointStates joints;
  RobotStatus status;
  ActuationFrame actuation;
  joints.count = actuation.joint_count = static_cast<std::uint32_t>(robot.config.model.joints.size());
  ActuationFrame last = actuation;
  const std::uint32_t index[] = {set_index(catalog, from), set_index(catalog, to)};
  std::vector<double> costs;
  std::uint64_t tick = 0;
  const auto timed_step = [&] {
    const double began = now_ns();
    sets.step(tick, {joints, status, last, static_cast<std::int64_t>(tick) * 1'000'000, 0.001}, actuation);
    ++tick;
    last = actuation;
    return now_ns() - began;
  };
  for (int i = 0; i < 200; ++i) {
    sets.switch_to(index[0]);
    for (int j = 0; j < 3; ++j) timed_step();
    sets.switch_to(index[1]);
    const double switching = timed_step();
    costs.push_back(switching - timed_step());  // the next one still fades, as every tick after a switch
  }
  return median(costs);
}

}  // namespace kadans::bench
