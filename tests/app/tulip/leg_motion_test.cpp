// TULip on a stand swings its left leg at 0.5 Hz: how well do PID and computed torque follow, at the same gains?
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <doctest/doctest.h>

#include "app/assembly/robot.h"
#include "engine/lockstep.h"
#include "engine/transaction.h"
#include "kadans/model/dynamics.h"
#include "kadans/plant/bullet/bullet_world.h"

using namespace kadans;

namespace {

struct Swing {
  const char* joint;
  double from_rad, to_rad;
};
constexpr Swing swings[] = {{"l_hip_pitch", 0.2, -0.8}, {"l_knee", 0.2, 1.2}, {"l_ankle_pitch", -0.3, 0.3}};

Robot tulip_on_a_stand() {
  Robot robot = read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json");
  robot.config.plant.fixed_base = true;
  // computed_torque knows viscous friction alone
  for (DriveSettings& drive : robot.config.plant.drives) drive.coulomb_Nm = 0;
  robot.config.plant.base.position_m[2] = 1.5;
  return robot;
}

// Every motor joint's mass matrix entry, its rotor included, with the swinging leg in the middle of its way.
Eigen::VectorXd inertias(const RobotConfig& config) {
  std::vector<double> middle(config.model.joints.size(), 0.0), rotors;
  for (const Swing& swing : swings) {
    middle[config.model.find_joint(swing.joint).value()] = (swing.from_rad + swing.to_rad) / 2;
  }
  for (const DriveSettings& drive : config.plant.drives) rotors.push_back(drive.rotor_inertia_kg_m2);
  Dynamics dynamics(config.model, {.rotor_inertia_kg_m2 = rotors});
  dynamics.update(middle, std::vector<double>(middle.size(), 0.0), {});
  return dynamics.mass_matrix().diagonal();
}

// In place of the configured PID: computed torque with the same stiffness and damping on each joint's own inertia.
void use_computed_torque(RobotConfig& config, bool friction_known) {
  ObjectConfig& object = config.objects.at(0);
  const Eigen::VectorXd inertia = inertias(config);
  object.type.name = "computed_torque";
  object.presets.clear();
  const std::vector<NumberEntry> gains = object.parameters;
  object.parameters.clear();
  for (const std::size_t i : object.joints) {
    const std::string name = config.model.joints[i].name;
    const DriveSettings& drive = config.plant.drives[i];
    const auto gain = [&](const std::string& quantity) {
      double value = 0;
      for (const NumberEntry& entry : gains) {
        const std::size_t dot = entry.key.find('.');
        const bool fits = entry.key[0] == '*' && name.ends_with(entry.key.substr(1, dot - 1));
        if (fits && entry.key.substr(dot + 1) == quantity) value = entry.value;
      }
      return value / inertia[static_cast<Eigen::Index>(i)];
    };
    const auto set = [&](const char* quantity, double value) {
      object.parameters.push_back({name + "." + quantity, value, {}, {}});
    };
    set("kp_per_s2", gain("kp_Nm_per_rad"));
    set("kd_per_s", gain("kd_Nms_per_rad"));
    set("rotor_inertia_kg_m2", drive.rotor_inertia_kg_m2);
    if (friction_known) set("viscous_Nms_per_rad", drive.viscous_Nms_per_rad);
  }
}

class Stand {
 public:
  explicit Stand(const Robot& robot)
      : config_(robot.config),
        system_(make_control_system(robot)),
        plant_(config_.model, config_.plant, 1),
        sets_(system_->catalog, std::move(system_->objects)),
        estimator_(config_.model, config_.estimate, config_.engine.control_period_s),
        safety_(config_.safety, config_.model),
        control_(config_.engine, plant_, estimator_, safety_, sets_, system_->catalog, exchange_),
        behaviors_(sets_, exchange_, nullptr),
        lockstep_(config_.engine, plant_, control_, behaviors_) {}

  void move(bool there) {
    const SetpointTable& table = system_->catalog.setpoints;
    for (const Swing& swing : swings) {
      const SetpointId id = table.find("posture." + std::string(swing.joint) + ".position_rad").value();
      sender_.begin(control_.state().time_ns);
      REQUIRE(sender_.add({.kind = CommandKind::set_point,
                           .index = id,
                           .value = there ? swing.to_rad : swing.from_rad,
                           .duration_s = 1.0}));
      REQUIRE(sender_.commit() > 0);
    }
  }
  // Sum of the squared errors of the swinging joints, reference minus true position.
  double step() {
    lockstep_.step();
    double sum = 0;
    for (const Swing& swing : swings) {
      const std::string name = "control.posture." + std::string(swing.joint) + ".reference_rad";
      const double reference_rad = control_.row()[system_->catalog.signals.find(name).value()];
      const double at_rad = truth_before_[config_.model.find_joint(swing.joint).value()];
      sum += (reference_rad - at_rad) * (reference_rad - at_rad);
    }
    truth_before_ = plant_.truth().position_rad;  // what the next tick samples
    return sum;
  }
  SafetyLevel level() const { return control_.state().status.safety.level; }

 private:
  const RobotConfig& config_;
  std::unique_ptr<ControlSystem> system_;
  BulletWorld plant_;
  ControlSets sets_;
  Estimator estimator_;
  Safety safety_;
  EngineExchange exchange_;
  CommandSender sender_{exchange_.commands};
  ControlEngine control_;
  BehaviorEngine behaviors_;
  Lockstep lockstep_;
  std::array<double, max_joints> truth_before_{};
};

double rms_error_rad(const Robot& robot) {
  auto stand = std::make_unique<Stand>(robot);
  double sum = 0;
  for (int tick = 0; tick < 8000; ++tick) {
    if (tick % 1000 == 0) stand->move(tick / 1000 % 2 == 0);
    const double squares = stand->step();
    if (tick >= 2000) sum += squares / 6000 / std::size(swings);
  }
  CHECK(stand->level() == SafetyLevel::normal);
  return std::sqrt(sum);
}

}  // namespace

TEST_CASE("Computed torque follows a leg motion with at most a third of the PID's error at the same gains") {
  Robot pid = tulip_on_a_stand();
  const double pid_rad = rms_error_rad(pid);
  pid.config.objects.at(0).parameters.push_back({"*.ki_Nm_per_rads", 0, {}, {}});
  const double pd_rad = rms_error_rad(pid);
  Robot robot = tulip_on_a_stand();
  use_computed_torque(robot.config, false);
  const double without_friction_rad = rms_error_rad(robot);
  robot = tulip_on_a_stand();
  use_computed_torque(robot.config, true);
  const double computed_rad = rms_error_rad(robot);
  std::printf(
      "RMS error of hip pitch, knee, ankle pitch at 0.5 Hz: PID %.2f mrad, PD %.2f mrad, computed torque "
      "%.2f mrad, with drive friction %.2f mrad\n",
      1e3 * pid_rad, 1e3 * pd_rad, 1e3 * without_friction_rad, 1e3 * computed_rad);
  CHECK(computed_rad < std::min(pid_rad, pd_rad) / 3);
  // Friction that the model does not know of spreads over the joints: no better than PD then.
  CHECK(computed_rad < without_friction_rad / 3);
}
