// The torque that holds a robot's joints against gravity, in effort mode: type "gravity_compensation" (Takegaki and
// Arimoto 1981, J. Dyn. Sys. Meas. Control 103(2)). Meant to be composed with other objects on the same joints ("sum").
//
//   u = limit(gain (G(q0) + dG/dq (q - q0)), +-effort_max)
//
// The high level computes the gravity torques G and their slope at the newest pose q0 (model/dynamics.h). The low level
// uses them to extrapolate G to the joints' present positions. G holds for a robot that hangs from its base, with the
// base's orientation from the estimator: limbs in the air, or a robot on a stand. It does not hold for the legs of a
// standing robot, which carry it from below.
//
// Parameters  gain (0..1; a new value is reached within 0.2 s) and <joint>.effort_max_Nm.
// Signals     <joint>.effort_Nm, <joint>.saturated, gain, and model_age_s: the time since the measurement that G comes
//             from, or since the start while G is older than the start.
// Start       the torque from before continues. The part that gravity does not explain fades within 0.2 s after the
//             first G of this activation.
// Not finite  a joint that is not measured gets a torque that is not finite, which the safety layer stops; for the
//             other joints it counts as at q0. A snapshot that is not finite gives no new G: the last one stays.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "kadans/control/control_object.h"
#include "kadans/control/effort_takeover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/joint_matrix.h"
#include "kadans/exchange/latest.h"

namespace kadans {

class ModelState;

class GravityCompensation final : public ControlObject {
 public:
  struct Config {
    double gain = 1;  // 0..1
  };
  struct State {  // of a joint
    double effort_Nm = 0;
    bool saturated = false;
  };

  // Throws std::invalid_argument for a passive joint.
  explicit GravityCompensation(const ObjectSetup& setup);
  ~GravityCompensation() override;

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void pass_state(StateBytes& bytes) noexcept override;
  void update(const Snapshot& snapshot) override;

 private:
  // From the high level to the low level: behavior thread -> control thread.
  struct GravityData {
    std::int64_t time_ns = std::numeric_limits<std::int64_t>::min();  // of the state that G belongs to
    std::array<double, max_joints> position_rad{};                    // q0
    std::array<double, max_joints> gravity_Nm{};
    JointMatrix slope_Nm_per_rad;
  };
  struct Part {
    JointAxis axis;
    double effort_max_Nm = 0;
    State state;
    EffortTakeover takeover;
  };

  std::vector<Part> parts_;            // control thread
  Config config_;                      // control thread
  double gain_ = 1;                    // control thread: on its way to config_.gain
  std::int64_t started_ns_ = 0;        // control thread
  double model_age_s_ = 0;             // control thread
  std::unique_ptr<ModelState> model_;  // behavior thread
  Eigen::MatrixXd slope_;              // behavior thread: of all joints
  GravityData draft_;                  // behavior thread
  Latest<GravityData> data_;
};

std::unique_ptr<ControlObject> make_gravity_compensation(const ObjectSetup& setup);

}  // namespace kadans
