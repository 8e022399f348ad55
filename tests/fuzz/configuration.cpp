// The JSON files of a project: robots, scenarios, plans of sweeps and of tunings, each perhaps based on others. What is
// read lies in its ranges; what is refused is refused with places.
//
// An input's first line is the kind: robot, scenario, sweep, tune; behind it comes the file.
#include <array>
#include <cmath>

#include "config/plan/experiment_plans.h"
#include "config/robot/robot_config.h"
#include "config/scenario/based_on.h"
#include "config/scenario/scenario_config.h"
#include "fuzz_input.h"
#include "temporary_folder.h"

namespace {

using namespace kadans;
using fuzz::require;

constexpr const char* urdf = R"(<robot name="arm"><link name="base"/><link name="upper"/><link name="lower"/>
<joint name="hip" type="revolute"><limit lower="-1" upper="1" effort="5" velocity="6"/>
<parent link="base"/><child link="upper"/></joint>
<joint name="knee" type="revolute"><limit lower="-1" upper="1" effort="5" velocity="6"/>
<parent link="upper"/><child link="lower"/></joint></robot>)";
constexpr const char* robot = R"({ "name": "arm", "urdf": "models/arm.urdf", "poses": { "up": { "*": 0 } },
"control": { "objects": [ { "name": "posture", "type": "joint_pid", "joints": ["*"] } ],
"sets": { "posture": { "objects": ["posture"] } }, "initial_set": "posture" } })";
constexpr const char* scenario =
    R"({ "name": "nods", "robot": "config/robot.json", "duration_s": 2, "behaviors": ["nod"],
"checks": [ { "name": "up", "kind": "always", "signal": "base.tilt_rad", "max": 1 } ] })";
constexpr const char* sweep = R"({ "name": "many", "scenarios": ["config/scenario.json"], "cases": 9,
"vary": { "joint.*.torque_scale": { "uniform": [0.9, 1] } } })";
constexpr const char* tune = R"({ "name": "better", "scenarios": ["config/scenario.json"],
"tune": { "control.posture.*.kp_Nm_per_rad": { "min": 1, "max": 9, "log": true } },
"metrics": { "tilt": { "kind": "max", "signal": "base.tilt_rad" } }, "score": "tilt", "failed_score": 1 })";

struct Project {
  test::TemporaryFolder folder;
  std::string file = folder.path() / "config/given.json";

  Project() {
    folder.write("models/arm.urdf", urdf);
    folder.write("behaviors/nod.lua", "return require('kadans').behavior 'nod' {}\n");
    folder.write("config/robot.json", robot);
    folder.write("config/scenario.json", scenario);
    folder.write("config/sweep.json", sweep);
    folder.write("config/tune.json", tune);
    folder.write("config/loop.json", R"({ "based_on": "config/loop.json" })");
    folder.write("config/wrong.json", R"({ "based_on": "config/robot.json", "name": 3, "control": [] })");
  }
};

bool within(double value, double low, double high) { return value >= low && value <= high; }

void require_right(const RobotConfig& config) {
  const std::size_t joints = config.model.joints.size();
  require(config.engine.behavior_divisor() > 0, "the behavior period is a multiple of the control period");
  require(config.safety.joints.size() == joints && config.unheld.size() == joints, "each joint has its limits");
  for (const JointLimits& limits : config.safety.joints)
    require(limits.lower_rad <= limits.upper_rad && limits.effort_max_Nm >= 0, "limits are a range");
  for (const ControlSetInfo& set : config.sets) {
    for (const std::uint32_t object : set.objects) require(object < config.objects.size(), "a set holds objects");
  }
  for (const PoseInfo& pose : config.poses) {
    for (const auto& [joint, position_rad] : pose.position_rad)
      require(joint < joints && std::isfinite(position_rad), "a pose is of joints");
  }
}

void require_right(const Distribution& distribution) {
  for (const double u : {0.0, 0.3, 0.999999}) {
    const double value = distribution.at(u);
    require(std::isfinite(value), "a quantile is a number");
    if (distribution.kind == Distribution::Kind::uniform || distribution.kind == Distribution::Kind::log_uniform)
      require(within(value, distribution.of[0], distribution.of[1]), "a quantile lies in its range");
  }
}

void require_right(const ScenarioConfig& config) {
  require(within(config.duration_s, 0, 1e9) && config.duration_s > 0 && config.repeat > 0, "a scenario lasts");
  for (const Variation& variation : config.randomise) require_right(variation.distribution);
  for (const ScenarioPush& push : config.pushes) require(push.duration_s > 0 && push.at_s >= 0, "a push lasts");
  for (const ScenarioCheck& check : config.checks)
    require(check.signal.empty() != check.that.empty() && check.min <= check.max, "a check demands something");
}

void require_right(const SweepPlan& plan) {
  require(plan.cases <= sweep_cases_max && within(plan.passed_min, 0, 1), "a sweep is bounded");
  for (const ExperimentAxis& axis : plan.vary) require_right(axis.variation.distribution);
}

void require_right(const TunePlan& plan) {
  for (const TunedParameter& tuned : plan.tune) {
    require_right(tuned.range);
    if (tuned.start) require(within(*tuned.start, tuned.range.of[0], tuned.range.of[1]), "a start lies in its range");
  }
}

void read(std::string_view kind, const std::string& text, const std::string& file) {
  const std::array<std::string, 2> types{"joint_pid", "stance"};
  if (kind == "robot") require_right(read_robot_config_text(text, file, types));
  if (kind == "scenario") require_right(read_scenario_config_text(text, file));
  if (kind == "sweep") require_right(read_sweep_plan_text(text, file));
  if (kind == "tune") require_right(read_tune_plan_text(text, file));
  require(parse_based_json(text, file).bases.size() <= based_on_depth_max, "bases are bounded");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Project project;
  fuzz::FuzzInput input(data, size);
  const std::string_view kind = input.line();
  try {
    read(kind, std::string(input.rest()), project.file);
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems())
      require(problem.file.starts_with(project.folder.path().string()) && problem.line > 0 && problem.column > 0,
              "a problem has a place: " + problem.text());
  }
  return 0;
}
