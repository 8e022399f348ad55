#include "drives.h"

#include <limits>
#include <stdexcept>

#include "plant/bullet/contact/contact_world.h"

namespace kadans::bullet {
Drives::Drives(const RobotModel& model, const PlantSettings& settings, btMultiBody& body) : body_(&body) {
  const std::size_t joints = model.joints.size();
  for (std::vector<double>* each : {&position_rad_, &velocity_rad_s_, &torque_Nm_, &joint_torque_Nm_})
    each->resize(joints);
  for (std::size_t i = 0; i < joints; ++i) {
    JointRows& rows = add_rows({.joint = static_cast<int>(i)}, model.joints[i]);
    drives_.emplace_back(settings.drives[i], model.joints[i], rows, settings.position_rad[i]);
  }
  for (std::size_t i = 0; i < joints; ++i) {
    const auto& mimic = model.joints[i].mimic;
    if (!mimic) continue;
    const Coordinate apart{
        .joint = static_cast<int>(i), .carrier = static_cast<int>(mimic->joint), .carrier_share = -mimic->multiplier};
    ties_.push_back({i, *mimic, &add_rows(apart, {.type = JointType::continuous})});
  }
  for (const Transmission& transmission : model.transmissions) {
    if (transmission.coupled()) add_coupling(model, settings, transmission);
  }
}

JointRows& Drives::add_rows(const Coordinate& along, const Joint& joint) {
  const double infinite = std::numeric_limits<double>::infinity();
  const bool limited = joint.type != JointType::continuous;
  rows_.push_back(std::make_unique<JointRows>(*body_, along, limited ? joint.lower_rad : -infinite,
                                              limited ? joint.upper_rad : infinite));
  return *rows_.back();
}

void Drives::add_coupling(const RobotModel& model, const PlantSettings& settings, const Transmission& transmission) {
  const std::size_t first = transmission.joints()[0], second = transmission.joints()[1];
  if (!model.on_one_path(first, second)) {
    throw std::invalid_argument("joints '" + model.joints[first].name + "' and '" + model.joints[second].name +
                                "' are coupled, but none of them carries the other");
  }
  const std::vector<double>& start_rad = settings.position_rad;
  const auto own = [&](std::size_t joint) { return Drive({}, model.joints[joint], *rows_[joint], start_rad[joint]); };
  couplings_.push_back({transmission, {own(first), own(second)}});
  const Transmission::Pair drive_rad = transmission.drive_position_rad({start_rad[first], start_rad[second]});
  const std::size_t carried = first < second ? 1 : 0, carrier = 1 - carried;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t slot = transmission.joints()[i];
    const Coordinate along{.joint = static_cast<int>(transmission.joints()[carried]),
                           .carrier = static_cast<int>(transmission.joints()[carrier]),
                           .share = transmission.drive_per_joint(i, carried),
                           .carrier_share = transmission.drive_per_joint(i, carrier)};
    const Joint free{.type = JointType::continuous};
    drives_[slot] = Drive(settings.drives[slot], free, add_rows(along, free), drive_rad[i]);
  }
}

void Drives::add_to(ContactWorld& world) {
  for (auto& rows : rows_) world.add(*rows);
}

void Drives::map(ActuationFrame& frame) const noexcept {
  for (const Coupling& coupling : couplings_) coupling.transmission.to_drives(frame);
}

void Drives::map(SensorFrame& frame) const noexcept {
  for (const Coupling& coupling : couplings_) coupling.transmission.to_joints(frame, Transmission::Side::motor);
}

void Drives::read_motion() {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    position_rad_[i] = body_->getJointPos(static_cast<int>(i));
    velocity_rad_s_[i] = body_->getJointVel(static_cast<int>(i));
  }
  for (const Coupling& coupling : couplings_) {
    coupling.transmission.map(position_rad_, &Transmission::drive_position_rad);
    coupling.transmission.map(velocity_rad_s_, &Transmission::drive_velocity_rad_s);
  }
}

void Drives::begin_step(const ModelledDrives& electronics, double dt_s) {
  read_motion();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (!electronics.enabled(i)) drives_[i].ask({});
    drives_[i].brake(electronics.braked(i));
    torque_Nm_[i] = drives_[i].begin_step(position_rad_[i], velocity_rad_s_[i], dt_s);
  }
  for (Coupling& coupling : couplings_) {
    const Transmission& t = coupling.transmission;
    t.map(torque_Nm_, &Transmission::joint_effort_Nm);
    for (std::size_t i = 0; i < 2; ++i) {
      const int joint = static_cast<int>(t.joints()[i]);
      coupling.own[i].begin_step(body_->getJointPos(joint), body_->getJointVel(joint), dt_s);
    }
  }
  for (std::size_t i = 0; i < drives_.size(); ++i) body_->addJointTorque(static_cast<int>(i), torque_Nm_[i]);
  for (const Tie& tie : ties_) {
    const double led = tie.mimic.multiplier * body_->getJointPos(static_cast<int>(tie.mimic.joint)) + tie.mimic.offset;
    tie.rows->set_tie(tie_erp * (led - body_->getJointPos(static_cast<int>(tie.joint))) / dt_s);
  }
}

void Drives::end_step(double dt_s) {
  read_motion();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i].end_step(position_rad_[i], velocity_rad_s_[i], dt_s);
    joint_torque_Nm_[i] = drives_[i].state().joint_torque_Nm;
  }
  for (Coupling& coupling : couplings_) {
    const Transmission& t = coupling.transmission;
    t.map(joint_torque_Nm_, &Transmission::joint_effort_Nm);
    for (std::size_t i = 0; i < 2; ++i) {
      const int joint = static_cast<int>(t.joints()[i]);
      coupling.own[i].end_step(body_->getJointPos(joint), body_->getJointVel(joint), dt_s);
      joint_torque_Nm_[t.joints()[i]] += coupling.own[i].state().joint_torque_Nm;
    }
  }
}

void Drives::hash(StateHash& hash) const noexcept {
  for (const Drive& drive : drives_) drive.hash(hash);
  for (const Coupling& coupling : couplings_) {
    for (const Drive& own : coupling.own) own.hash(hash);
  }
}

}  // namespace kadans::bullet
