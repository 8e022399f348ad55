// A test bench for control objects: one joint (one_joint_plant.h), its estimate, and the objects, ticked in the order
// of the control engine: read, estimate, write what was computed in the last tick, compute. So the loop contains one
// tick of delay.
//
//   JointBench bench({.plant = {.inertia_kg_m2 = 0.05}}, make_joint_pid);
//   bench.set("kp_Nm_per_rad", 100);
//   bench.set_point(0.5);
//   bench.run(1.0);
//   CHECK(bench.position_rad() == doctest::Approx(0.5));
//
// The robot is a link on a bolted base, its model made to fit the plant. Each object is alone in a control set of its
// own name; the first is active. There is no safety layer: a torque beyond the limit is limited, an actuation that is
// not finite is not written, and both are counted. A name may be given without its first parts when it is unambiguous:
// "kp_Nm_per_rad" for "object.joint.kp_Nm_per_rad".
//
// One thread. The constructor and the functions that take a name allocate; tick() does not, as long as the objects do
// not.
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/control/control_object_types.h"
#include "kadans/control/control_sets.h"
#include "kadans/estimate/velocity_filter.h"
#include "kadans/testing/one_joint_plant.h"

namespace kadans {
class SetpointMotions;
}

namespace kadans::testing {

// Where the measured velocity comes from, before its low pass: from the encoder, as on the robot, or from the joint
// itself, as if it had a tachometer.
enum class VelocitySource : std::uint8_t { encoder, tachometer };

struct JointBenchConfig {
  OneJointPlant::Config plant{};
  double lower_rad = -3, upper_rad = 3;
  double effort_max_Nm = 0;  // of the joint; 0: the drive's torque_max_Nm
  double dt_s = 0.001;
  double velocity_cutoff_Hz = 100;  // 0: the true velocity
  VelocitySource velocity_source = VelocitySource::encoder;
};

struct BenchObject {
  std::string name;
  MakeControlObject make;
};

class JointBench {
 public:
  // Throws std::invalid_argument as the objects and the plant do.
  JointBench(const JointBenchConfig& config, MakeControlObject make);  // one object, named "object"
  JointBench(const JointBenchConfig& config, const std::vector<BenchObject>& objects);
  ~JointBench();

  // All throw std::invalid_argument for a name that is unknown (the message has the nearest one) or ambiguous, and for
  // a value out of range.
  void set(std::string_view parameter, double value);
  double get(std::string_view parameter) const;
  void set_point(double value, double duration_s = 0);  // the first one of the active object
  void set_point(std::string_view setpoint, double value, double duration_s = 0);
  void cancel_motion(std::string_view setpoint);
  // Leads the active object in the next tick, from its first step on, as the engine leads a motion: each of its
  // set-points of position or velocity that it has.
  void lead(const SetpointState& position) noexcept;
  void switch_to(std::string_view object);
  // By what lead() leads this object.
  enum class Led : std::uint8_t { nothing, velocity, position };
  Led led(std::string_view object) const;
  double signal(std::string_view name) const;  // as of the last tick

  void tick();
  void run(double duration_s);

  double time_s() const noexcept { return config_.dt_s * static_cast<double>(tick_); }
  double position_rad() const noexcept { return plant_.state().position_rad; }  // true, now
  double velocity_rad_s() const noexcept { return plant_.state().velocity_rad_s; }
  double torque_Nm() const noexcept { return plant_.state().torque_Nm; }  // of the drive, in the last tick
  double motion_remaining_s() const noexcept;
  std::uint64_t limited_ticks() const noexcept { return limited_ticks_; }
  std::uint64_t not_finite_ticks() const noexcept { return not_finite_ticks_; }

  OneJointPlant& plant() noexcept { return plant_; }
  const JointState& measured() const noexcept { return joints_.joints[0]; }  // what the objects saw last
  const ActuationFrame& computed() const noexcept { return computed_; }
  const Catalog& catalog() const noexcept { return catalog_; }
  const JointBenchConfig& config() const noexcept { return config_; }
  double effort_max_Nm() const noexcept { return model_.joints[0].effort_max_Nm; }

 private:
  // Each object is a set of its own, and all drive the one joint.
  std::uint32_t active_object() const noexcept { return static_cast<std::uint32_t>(std::countr_zero(sets_->active())); }
  void add_objects(const std::vector<BenchObject>& objects);
  void estimate(const SensorFrame& sensors) noexcept;
  void update_high_level();
  SetpointId find_setpoint(std::string_view name) const;
  void lead_active(const ControlInput& input);

  JointBenchConfig config_;
  RobotModel model_;
  OneJointPlant plant_;
  Catalog catalog_;
  std::unique_ptr<ControlSets> sets_;
  std::unique_ptr<SetpointMotions> motions_;
  VelocityFilter filter_;
  double filter_position_rad_ = 0;  // what the filter differentiates
  SensorFrame sensors_;
  JointStates joints_;
  RobotStatus status_;
  ActuationFrame written_, computed_;
  Snapshot snapshot_;
  std::vector<double> row_;
  std::optional<SetpointState> led_;
  std::uint64_t tick_ = 0, limited_ticks_ = 0, not_finite_ticks_ = 0;
};

}  // namespace kadans::testing
