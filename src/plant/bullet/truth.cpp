#include "truth.h"

#include "convert.h"
#include "plant/bullet/contact/link_contact.h"

namespace kadans::bullet {

TruthReader::TruthReader(const Body& body, std::size_t joints)
    : body_(&body), omegas_(body.mass_count()), velocities_(body.mass_count()) {
  truth_.joint_count = static_cast<std::uint32_t>(joints);
}

btVector3 TruthReader::base_point_velocity_m_s(const btVector3& point_in_base_m) const {
  const btMultiBody& multibody = body_->multibody();
  const btVector3 arm = multibody.getBaseWorldTransform().getBasis() *
                        (body_->com_frame(0).inverse() * (body_->link_frame(0) * point_in_base_m));
  return multibody.getBaseVel() + multibody.getBaseOmega().cross(arm);
}

void TruthReader::read_com() {
  body_->multibody().compTreeLinkVelocities(omegas_.data(), velocities_.data());  // in each link's own axes
  btVector3 moment(0, 0, 0), momentum(0, 0, 0);
  double mass_kg = 0;
  for (std::size_t i = 0; i < body_->mass_count(); ++i) {
    const btTransform frame = body_->com_frame(i);
    moment += body_->mass_kg(i) * frame.getOrigin();
    momentum += body_->mass_kg(i) * (frame.getBasis() * velocities_[i]);
    mass_kg += body_->mass_kg(i);
  }
  truth_.com_m = from_bullet(moment / mass_kg);
  truth_.com_velocity_m_s = from_bullet(momentum / mass_kg);
}

void TruthReader::read(const Drives& drives, const std::vector<FootLoad>& feet) {
  const btMultiBody& multibody = body_->multibody();
  truth_.base = from_bullet(body_->link_frame(0));
  truth_.base_velocity_m_s = from_bullet(base_point_velocity_m_s(btVector3(0, 0, 0)));
  truth_.base_angular_velocity_rad_s = from_bullet(multibody.getBaseOmega());
  for (std::size_t i = 0; i < drives.size(); ++i) {
    truth_.position_rad[i] = multibody.getJointPos(static_cast<int>(i));
    truth_.velocity_rad_s[i] = multibody.getJointVel(static_cast<int>(i));
    truth_.drive_torque_Nm[i] = drives.joint_torque_Nm(i);
    truth_.motor_torque_Nm[i] = drives.state(i).motor_torque_Nm;
    truth_.motor_torque_max_Nm[i] = drives.state(i).motor_torque_max_Nm;
  }
  truth_.foot_count = static_cast<std::uint32_t>(feet.size());
  for (std::size_t i = 0; i < feet.size(); ++i) {
    truth_.feet[i] = from_bullet(body_->link_frame(feet[i].link));
    truth_.foot_force_N[i] = from_bullet(feet[i].force_N);
  }
  read_com();
}

void TruthReader::read_world(const ContactWorld& world, const WorldObjects& objects, double dt_s) {
  truth_.object_count = static_cast<std::uint32_t>(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) objects.read(i, truth_.objects[i]);
  truth_.ground_m = from_bullet(world.ground().getWorldTransform().getOrigin());
  if (dt_s > 0) read_contacts(world, *body_, dt_s, truth_);
  truth_.residual_m_s = world.residual_m_s();
}

}  // namespace kadans::bullet
