// Torque control of series elastic drives: an inner loop around the spring's deflection turns the wanted joint torque
// into the motor's torque. Type "spring_torque".
//
// It is an actuator-level object (control_sets.h), not part of a control set: "drives" in the robot's configuration
// names it. It works on the actuation after composition and the safety layer, in the tick in which the state was
// measured. So the outer loops that compute torques stay as they are, and the inner loop's delay is that of the plant
// alone. A joint that is not in effort mode is left to its drive.
//
// Joints      with a spring in their drives. Of coupled joints both: then the loops run in the drives' coordinates, on
//             what the coupling makes of the joints' torques, and their parts carry the drives' names.
// Parameters  <joint>. spring_Nm_per_rad, rotor_inertia_kg_m2 (the loop's model; the drive's own values unless given),
//             bandwidth_Hz, damping_ratio, rate_cutoff_Hz, observer_Hz, and share: 0 gives the motor the wanted torque,
//             1 closes the loop.
// Signals     SpringTorqueLoop::State of each joint, without its rate.
// Start       each time a joint comes back to effort mode: from the measured torque, with the disturbance at 0.
// Not finite  the motor gets the wanted joint torque.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"
#include "kadans/estimate/velocity_filter.h"
#include "kadans/model/transmission.h"
#include "kadans/signal/frames.h"

namespace kadans {

// The torque of one series elastic drive: an inner loop around its spring's deflection (Pratt and Williamson 1995,
// IROS; Robinson 2000, PhD thesis, MIT; the observer as in Paine, Oh and Sentis 2014, IEEE/ASME T-Mech 19(3)).
//
// With the joint held still, the spring's torque T responds to the motor's torque u like a mass on a spring,
//     J/k T'' = u - f - T,      f: friction and everything else that the model leaves out,
// so it oscillates at w0 = sqrt(k/J). The law
//     u = T_d + (w^2/w0^2 - 1) (T_d - T) - 2 z w/w0^2 T' + f^
// makes T follow T_d as w^2 / (s^2 + 2 z w s + w^2). The estimate f^ of f comes from the rotor's momentum (De Luca and
// Mattone 2005, ICRA):
//     p^' = u - T - f^,   f^ = o (p^ - J rotor'),
// a first-order low pass, of bandwidth o, of what the motor's torque does not explain. Here u is the torque after the
// limit, so nothing winds up. The acceleration is never needed.
//
// What it cannot do: above w the joint feels the bare spring, and no stiffness above k can be rendered passively
// (Vallery et al. 2008, IEEE RAM 15(3)). So w is modest, and a stiffer outer loop needs a stiffer spring.
//
// One owner, the control thread; step() neither allocates, locks nor throws.
class SpringTorqueLoop {
 public:
  struct Config {
    double spring_Nm_per_rad = 300;     // k
    double rotor_inertia_kg_m2 = 0.02;  // J, reflected to the joint
    double bandwidth_Hz = 22;           // w / 2 pi; not below the rotor's own w0
    double damping_ratio = 0.7;         // z
    double observer_Hz = 5;             // o / 2 pi; 0: no observer
    double rate_cutoff_Hz = 200;        // of T'; retune() after a change
    double effort_max_Nm = 0;           // of the motor
  };
  struct State {
    double wanted_Nm = 0;       // T_d
    double torque_Nm = 0;       // T
    double rate_Nm_s = 0;       // T'
    double disturbance_Nm = 0;  // f^
    double motor_Nm = 0;        // u
    bool saturated = false;
  };

  explicit SpringTorqueLoop(double dt_s = 0.001) : rate_({.dt_s = dt_s}) { (void)retune(); }

  Config& config() noexcept { return config_; }
  const State& state() const noexcept { return state_; }

  // The next step is a first one: the estimate of the disturbance starts at 0.
  void restart() noexcept;
  // Takes over rate_cutoff_Hz. False, and nothing changes, when the tick is too long for it.
  bool retune() noexcept { return rate_.set_cutoff(config_.rate_cutoff_Hz); }
  // Returns the motor's torque. `joint`.effort_Nm is the spring's deflection times k. When the measurement is not
  // finite, the motor gets wanted_Nm.
  double step(double wanted_Nm, const JointState& joint, double dt_s) noexcept;

  double stiffest_gain() const noexcept;  // w^2/w0^2 - 1
  void pass_state(StateBytes& bytes) noexcept { bytes(state_, rate_, momentum_Nms_, fresh_); }

 private:
  double observe(double rotor_rad_s, double dt_s) noexcept;

  Config config_;
  State state_;
  VelocityFilter rate_;
  double momentum_Nms_ = 0;  // p^
  bool fresh_ = true;
};

class SpringTorque final : public ControlObject {
 public:
  // Throws std::invalid_argument for a passive joint, one without a spring, and one of two coupled joints.
  explicit SpringTorque(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  // `actuation` holds the wanted joint torques; for its own joints they are replaced by motor torques.
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void rehearse(const ControlInput& input) const noexcept override;
  void parameters_changed() noexcept override;
  void pass_state(StateBytes& bytes) noexcept override {
    for (Part& part : parts_) bytes(part.loop);
  }

 private:
  struct Part {
    JointAxis axis;
    SpringTorqueLoop loop{};
    double share = 1;
  };
  void add(JointAxis axis, const SpringTorqueLoop::Config& config);
  void add_pair(const ObjectSetup& setup, const Transmission& transmission);
  void declare(Declaration& declaration, Part& part, double least);
  static void step_pair(const ControlInput& input, const Transmission& coupling, std::span<Part> parts,
                        ActuationFrame& actuation) noexcept;

  std::vector<Part> parts_;  // joint by joint, then two drives of each coupling
  std::size_t single_ = 0;   // parts that are of a joint alone
  std::vector<Transmission> couplings_;
};

std::unique_ptr<ControlObject> make_spring_torque(const ObjectSetup& setup);

}  // namespace kadans
