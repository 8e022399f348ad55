// A control object: an algorithm for one joint or many, in two levels.
//
// The low level, step(), runs in the control thread each tick: bounded, no allocation, no lock, no exception. The high
// level, update(), runs in the behavior thread and may be costly. What it computes reaches the low level through a
// HandDown<> that the object owns (hand_over.h). Neither level reads a clock: dt comes in.
//
// An object declares its tunables, its recorded state and its set-points once, in declare(). Configuration, scripts,
// recorder and viewers know it only through these tables.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kadans/control/hand_over.h"
#include "kadans/control/object_options.h"
#include "kadans/control/state_bytes.h"
#include "kadans/control/switchover.h"
#include "kadans/model/robot_model.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/parameter.h"
#include "kadans/signal/setpoint.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/status.h"

namespace kadans {

// What the low level sees. The references are valid during the call only.
struct ControlInput {
  const JointStates& joints;
  const RobotStatus& status;
  const ActuationFrame& last;  // the actuation written in this tick: computed in the last one, after safety
  std::int64_t time_ns;
  double dt_s;
};

// Where an object declares its parameters, set-points and signals. Their names get the object's name in front.
class Declaration {
 public:
  Declaration(std::string object, std::uint32_t owner, ParameterTable& parameters, SetpointTable& setpoints,
              SignalTable& signals)
      : object_(std::move(object)), owner_(owner), parameters_(parameters), setpoints_(setpoints), signals_(signals) {}

  // `parameter.name` without the object: "l_knee.kp_Nm_per_rad". Throws std::invalid_argument as the tables do.
  ParameterId parameter(Parameter parameter, double* value);
  // The same of a value that is its own default.
  ParameterId tunable(const std::string& name, const std::string& unit, double min, double max, double& value,
                      const std::string& doc) {
    return parameter({name, unit, min, max, value, doc}, &value);
  }
  SetpointId setpoint(Setpoint setpoint);
  template <typename T>
  SignalId signal(Signal signal, const T* source) {
    signal.name = "control." + object_ + "." + signal.name;
    return signals_.add(std::move(signal), source);
  }

 private:
  std::string object_;
  std::uint32_t owner_;
  ParameterTable& parameters_;
  SetpointTable& setpoints_;
  SignalTable& signals_;
};

// What every object is made from.
struct ObjectSetup {
  const RobotModel& model;
  std::vector<std::size_t> joints;  // the joints it drives, indices into the model; at least one, none twice
  ObjectOptions options{};
  std::vector<DriveLaw> drives{};  // one per joint of the model; empty: not known
};

// Says before set-points are sent whether an object can reach them, in the time that is given. Behavior thread, or a
// process that plays behaviors: there it belongs to an object that never runs. Bounded; it changes nothing of the
// object.
class Foresight {
 public:
  struct Goal {
    std::uint32_t channel = 0;
    double value = 0;
  };
  struct Asked {  // a motion
    std::span<const Goal> goals;
    double time_s = 0;  // of the way there; 0: it acts at once
  };
  enum class Why : std::uint8_t {
    none,    // they are reached, as far as it knows
    reach,   // by: how far from there it stays; channel: of the set-point, or the first of its group, that is missed
    topple,  // by: the least time that it needs, s; after_s: when it topples or slips in the time that was asked for
    speed,   // by: the least time that it needs, s; joint: the one that would be too fast
    jump,    // by: the share of the way after which there is no smooth way on: `joint` would jump
    clash,   // by: the share of the way after which two links, `link` and `other`, come too near to each other
    tilt,    // by: how far the trunk would lean on the way, rad
    bear     // by: the stiffness that is missing in this joint without a motor to stand on one foot, Nm/rad
  };
  struct Miss {
    Why why = Why::none;
    double by = 0;
    std::uint32_t channel = 0;
    double after_s = 0;
    std::size_t joint = 0, link = 0, other = 0;  // of the model
  };
  Foresight() = default;
  virtual ~Foresight() = default;
  Foresight(const Foresight&) = delete;
  Foresight& operator=(const Foresight&) = delete;
  virtual Miss miss(const Asked& asked, const Snapshot& snapshot) noexcept = 0;
};

class ControlObject {
 public:
  virtual ~ControlObject() = default;
  ControlObject() = default;
  ControlObject(const ControlObject&) = delete;
  ControlObject& operator=(const ControlObject&) = delete;

  // Before the loop, once.
  virtual void declare(Declaration& declaration) = 0;

  // Control thread, in the tick that makes the object active: takes over without a jump from the measured state and the
  // last actuation.
  virtual void start(const ControlInput& input) noexcept = 0;
  // Control thread: writes the actuation of its joints. An actuator-level object (control_sets.h) finds there what is
  // wanted of its joints and replaces it by what their motors shall do.
  virtual void step(const ControlInput& input, ActuationFrame& actuation) noexcept = 0;
  // Control thread, in the wait before a tick: computes what step would, by the same functions but on copies, so that
  // its code and its memory are in the caches. Changes nothing; an object may leave it out. For an actuator-level
  // object input.last holds what was last wanted of the joints.
  virtual void rehearse(const ControlInput& input) const noexcept { (void)input; }
  // Control thread: where the set-point is on its way. False: this object cannot be led along a motion that the engine
  // plans (src/engine/motion/setpoint_motions.h).
  virtual bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept {
    (void)channel, (void)state;
    return false;
  }
  // Control thread, before each step of such a motion, and once for a set-point that acts at once: where the set-point
  // is in this tick. After the last call it stays there.
  virtual void follow(std::uint32_t channel, const SetpointState& state) noexcept { (void)channel, (void)state; }
  // Control thread: the way to a set-point that the object plans itself (Setpoint::own_motion, or it cannot be led).
  // The caller has checked that the value is in the set-point's range and duration_s >= 0. A duration of 0 acts at
  // once.
  virtual void set_point(std::uint32_t channel, double value, double duration_s) noexcept {
    (void)channel, (void)value, (void)duration_s;
  }
  // Control thread: such a motion comes to rest where it is now.
  virtual void cancel_motion(std::uint32_t channel) noexcept { (void)channel; }
  // Control thread: the time until the last motion of its own has arrived; 0 when all are at rest.
  virtual double motion_remaining_s() const noexcept { return 0; }
  // Control thread: one or more of its parameters have new values.
  virtual void parameters_changed() noexcept {}
  // Between ticks: saves or restores all that changes from tick to tick (state_bytes.h). An object without such state
  // leaves it out.
  virtual void pass_state(StateBytes& bytes) noexcept { (void)bytes; }

  // Before the loop: adds the storages between its levels (hand_over.h), so that runs can be repeated.
  virtual void hand_overs(HandOvers& all) noexcept { (void)all; }

  // Before the loop: nullptr for an object that cannot know. It lives as long as the object.
  virtual Foresight* foresight() noexcept { return nullptr; }

  // Behavior thread: the high level.
  virtual void update(const Snapshot& snapshot) { (void)snapshot; }
};

}  // namespace kadans
