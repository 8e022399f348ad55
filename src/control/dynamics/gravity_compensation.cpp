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
// Option      from_off: what a joint gets whose drive was off before, so that something else held it: "fade", as below,
//             or "at_once", all of the torque with the first G of this activation. An arm that the world holds until
//             the run begins sinks while the torque comes up, and stays where it is when it has all of it.
// Parameters  gain (0..1; a new value is reached within 0.2 s) and <joint>.effort_max_Nm.
// Signals     <joint>.effort_Nm, <joint>.saturated, gain, and model_age_s: the time since the measurement that G comes
//             from, or since the start while G is older than the start.
// Start       the torque from before continues, but for from_off. The part that gravity does not explain fades within
// 0.2 s after the
//             first G of this activation.
// Not finite  a joint that is not measured gets a torque that is not finite, which the safety layer stops; for the
//             other joints it counts as at q0. A snapshot that is not finite gives no new G: the last one stays.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kadans/control/control_object.h"
#include "kadans/control/effort_takeover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/joint_matrix.h"
#include "kadans/control/model_state.h"

namespace kadans {

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

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void pass_state(StateBytes& bytes) noexcept override;
  void hand_overs(HandOvers& all) noexcept override { all.down.push_back(&data_); }
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
    bool at_once = false;  // until the first G of this activation
  };

  bool at_once_from_off_;        // any thread
  std::vector<Part> parts_;      // control thread
  Config config_;                // control thread
  double gain_ = 1;              // control thread: on its way to config_.gain
  std::int64_t started_ns_ = 0;  // control thread
  double model_age_s_ = 0;       // control thread
  ModelState model_;             // behavior thread
  Eigen::MatrixXd slope_;        // behavior thread: of all joints
  Handed<GravityData> draft_;    // behavior thread
  HandDown<GravityData> data_;
};

namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
constexpr double gain_rate_per_s = 1 / FadingEffort::fade_s;

bool at_once_from_off(const ObjectOptions& options) {
  const std::string* const given = options.find("from_off");
  if (given == nullptr || *given == "fade") return false;
  if (*given != "at_once") throw OptionError("from_off", "from_off is '" + *given + "', must be fade or at_once");
  return true;
}

}  // namespace

GravityCompensation::GravityCompensation(const ObjectSetup& setup)
    : at_once_from_off_(at_once_from_off(setup.options)), model_(setup.model) {
  for (JointAxis& axis : joint_axes(setup)) parts_.push_back({.axis = std::move(axis)});
  const auto joints = static_cast<Eigen::Index>(setup.model.joints.size());
  slope_.setZero(joints, joints);
}

void GravityCompensation::declare(Declaration& declaration) {
  declaration.tunable("gain", "", 0, 1, config_.gain, "Share of gravity that is compensated.");
  declaration.signal({"gain", "", "Share of gravity that is compensated."}, &gain_);
  declaration.signal({"model_age_s", "s", "Age of the measurement from which the gravity torques were computed."},
                     &model_age_s_);
  for (Part& part : parts_) {
    AxisTables tables(declaration, part.axis, 0);
    const double most = part.axis.effort_max_Nm;
    tables.tunable("effort_max_Nm", "Nm", 0, most, most, &part.effort_max_Nm, "Bound of the torque.");
    tables.signal("effort_Nm", "Nm", "Torque asked for.", &part.state.effort_Nm);
    tables.signal("saturated", "", "Whether the torque is limited.", &part.state.saturated);
  }
}

void GravityCompensation::update(const Snapshot& snapshot) {
  if (!model_.update(snapshot)) return;
  const Dynamics& dynamics = model_.dynamics();
  dynamics.gravity_gradient(slope_);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const std::size_t joint = parts_[i].axis.joint;
    draft_.position_rad[i] = model_.position_rad(joint);
    draft_.gravity_Nm[i] = model_.effort_of(dynamics.gravity(), joint);
    for (std::size_t j = 0; j <= i; ++j) {
      draft_.slope_Nm_per_rad(i, j) = model_.entry_of(slope_, joint, parts_[j].axis.joint);
    }
  }
  draft_.time_ns = snapshot.time_ns;
  data_.publish(draft_);
}

void GravityCompensation::start(const ControlInput& input) noexcept {
  started_ns_ = input.time_ns;
  gain_ = config_.gain;
  for (Part& part : parts_) {
    const std::size_t joint = part.axis.joint;
    part.at_once = at_once_from_off_ && input.last.joints[joint].mode == ActuationMode::off;
    part.takeover.start(effort_before_Nm({input.joints.joints[joint], input.last.joints[joint], input.dt_s}));
  }
}

void GravityCompensation::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const auto newest = data_.read();
  const GravityData& data = *newest;
  const bool known = data.time_ns >= started_ns_;
  model_age_s_ = 1e-9 * static_cast<double>(input.time_ns - (known ? data.time_ns : started_ns_));
  const double most = gain_rate_per_s * input.dt_s;
  gain_ += std::clamp(config_.gain - gain_, -most, most);
  std::array<double, max_joints> way_rad{};
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const double position_rad = input.joints.joints[parts_[i].axis.joint].position_rad;
    if (std::isfinite(position_rad)) way_rad[i] = position_rad - data.position_rad[i];
  }
  const std::array<double, max_joints> change_Nm = data.slope_Nm_per_rad.times(way_rad, parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    State& s = part.state;
    const bool measured = std::isfinite(input.joints.joints[part.axis.joint].position_rad);
    const double law_Nm = measured ? gain_ * (data.gravity_Nm[i] + change_Nm[i]) : not_measured;
    if (part.at_once && known && measured) {
      part.takeover.start(law_Nm);  // which goes on
      part.at_once = false;
    }
    const double offset_Nm = part.takeover.step(law_Nm, known, input.dt_s);
    s.effort_Nm = std::clamp(law_Nm + offset_Nm, -part.effort_max_Nm, part.effort_max_Nm);
    s.saturated = s.effort_Nm != law_Nm + offset_Nm;
    if (std::isfinite(s.effort_Nm)) part.takeover.leave(s.effort_Nm);
    actuation.joints[part.axis.joint] = {.effort_Nm = s.effort_Nm, .mode = ActuationMode::effort};
  }
}

void GravityCompensation::pass_state(StateBytes& bytes) noexcept {
  for (Part& part : parts_) bytes(part.state, part.takeover, part.at_once);
  bytes(gain_, started_ns_, model_age_s_);
  bytes.newest(data_);
}

std::unique_ptr<ControlObject> make_gravity_compensation(const ObjectSetup& setup) {
  return std::make_unique<GravityCompensation>(setup);
}

}  // namespace kadans
