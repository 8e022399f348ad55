// The drives of a robot, joint by joint, and what couples them. A drive moves its own joint, or, in a coupling, two
// joints: then its position is a sum of both joints' (kadans/model/transmission.h), its rows act along that sum, and
// its torque is shared by the coupling's transpose. Friction of the URDF stays at the joints. A joint that mimics
// another one is tied to it by a row along the difference of the two.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "drive.h"
#include "kadans/model/transmission.h"
#include "kadans/plant/modelled_drives.h"

namespace kadans::bullet {

class ContactWorld;

class Drives {
 public:
  // Keeps the body, whose joints stand where the settings say. Throws std::invalid_argument when none of two coupled
  // joints carries the other.
  Drives(const RobotModel& model, const PlantSettings& settings, btMultiBody& body);
  void add_to(ContactWorld& world);

  // What is asked of the joints, as what is asked of the drives.
  void map(ActuationFrame& frame) const noexcept;
  void ask(std::size_t drive, const JointActuation& asked) noexcept { drives_[drive].ask(asked); }

  // A drive that is not enabled gives no torque; one that is braked holds.
  void begin_step(const ModelledDrives& electronics, double dt_s);
  void end_step(double dt_s);

  std::size_t size() const noexcept { return drives_.size(); }
  const Drive::State& state(std::size_t drive) const noexcept { return drives_[drive].state(); }
  // What is on the joint from its drive or drives, friction included, in the last step.
  double joint_torque_Nm(std::size_t joint) const noexcept { return joint_torque_Nm_[joint]; }
  // What the drives measure, as of the joints: replaces motor positions and efforts of coupled joints.
  void map(SensorFrame& frame) const noexcept;
  void hash(StateHash& hash) const noexcept;

 private:
  struct Coupling {
    Transmission transmission;
    std::array<Drive, 2> own;  // the joints' friction
  };
  struct Tie {
    std::size_t joint;
    Mimic mimic;
    JointRows* rows;
  };
  JointRows& add_rows(const Coordinate& along, const Joint& joint);
  void add_coupling(const RobotModel& model, const PlantSettings& settings, const Transmission& transmission);
  void read_motion();

  btMultiBody* body_;
  std::vector<std::unique_ptr<JointRows>> rows_;
  std::vector<Drive> drives_;
  std::vector<Coupling> couplings_;
  std::vector<Tie> ties_;
  std::vector<double> position_rad_, velocity_rad_s_, torque_Nm_;  // of the drives
  std::vector<double> joint_torque_Nm_;
};

}  // namespace kadans::bullet
