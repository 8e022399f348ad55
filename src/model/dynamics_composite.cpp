// What follows from composite bodies, each link welded together with all that hangs on it: mass matrix, gravity,
// Jacobians, centre of mass.
#include <Eigen/Geometry>

#include "kadans/model/dynamics.h"

namespace kadans {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& v) noexcept {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// The inertia of a point mass about an origin `arm` away.
Matrix3d point_inertia(double mass_kg, const Vector3d& arm) noexcept {
  return mass_kg * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
}

}  // namespace

void Dynamics::gather_composites() noexcept {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    body.mass_kg = model_->links[i].inertia.mass_kg;
    body.com = body.origin + body.com_arm;
    body.composite_inertia = body.inertia;
  }
  for (std::size_t i = bodies_.size(); i-- > 1;) {
    const Body& body = bodies_[i];
    Body& carrier = bodies_[parent(i)];
    const double sum_kg = carrier.mass_kg + body.mass_kg;
    const double reduced_kg = sum_kg > 0 ? carrier.mass_kg * body.mass_kg / sum_kg : 0.0;
    const Vector3d apart = body.com - carrier.com;
    carrier.composite_inertia += body.composite_inertia + point_inertia(reduced_kg, apart);
    if (sum_kg > 0) carrier.com += body.mass_kg / sum_kg * apart;
    carrier.mass_kg = sum_kg;
  }
}

// The force and moment that a unit acceleration of one joint takes, seen at all the joints that carry it.
void Dynamics::fill_mass_column(std::size_t link) noexcept {
  const Body& body = bodies_[link];
  const bool slides = prismatic(link);
  const Vector3d force = body.mass_kg * (slides ? body.axis : Vector3d(body.axis.cross(body.com - body.origin)));
  const Vector3d moment = slides ? Vector3d::Zero() : Vector3d(body.composite_inertia * body.axis);  // about com
  for (std::size_t i = link; i > 0; i = parent(i)) {
    const Body& carrier = bodies_[i];
    const double entry =
        carrier.axis.dot(prismatic(i) ? force : Vector3d(moment + (body.com - carrier.origin).cross(force)));
    mass_(index(i), index(link)) = mass_(index(link), index(i)) = entry;
  }
  if (base_size_ == 0) return;
  mass_.block<3, 1>(0, index(link)) = force;
  mass_.block<3, 1>(3, index(link)) = moment + (body.com - bodies_[0].origin).cross(force);
  mass_.block<1, 6>(index(link), 0) = mass_.block<6, 1>(0, index(link)).transpose();
}

void Dynamics::fill_mass() noexcept {
  mass_.setZero();
  for (std::size_t i = 1; i < bodies_.size(); ++i) fill_mass_column(i);
  for (std::size_t i = 0; i < config_.rotor_inertia_kg_m2.size(); ++i) {
    mass_(index(i + 1), index(i + 1)) += config_.rotor_inertia_kg_m2[i];
  }
  if (base_size_ == 0) return;
  const Body& base = bodies_[0];
  const Vector3d arm = base.com - base.origin;
  mass_.block<3, 3>(0, 0) = base.mass_kg * Matrix3d::Identity();
  mass_.block<3, 3>(3, 0) = base.mass_kg * cross_matrix(arm);
  mass_.block<3, 3>(0, 3) = mass_.block<3, 3>(3, 0).transpose();
  const Matrix3d turning = base.composite_inertia + point_inertia(base.mass_kg, arm);
  mass_.block<3, 3>(3, 3) = 0.5 * (turning + turning.transpose());  // symmetric to the last bit
}

void Dynamics::fill_gravity() noexcept {
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const Vector3d lever = prismatic(i) ? body.axis : Vector3d(body.axis.cross(body.com - body.origin));
    gravity_[index(i)] = -body.mass_kg * gravity_m_s2_.dot(lever);
  }
  if (base_size_ == 0) return;
  const Body& base = bodies_[0];
  const Vector3d weight = base.mass_kg * gravity_m_s2_;
  gravity_.head<3>() = -weight;
  gravity_.segment<3>(3) = -(base.com - base.origin).cross(weight);
}

// Turning joint k turns the lever of every joint that it carries; sliding it moves them without a change.
void Dynamics::gravity_gradient(Eigen::Ref<Eigen::MatrixXd> gradient) const noexcept {
  gradient.setZero();
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const Vector3d lever = prismatic(i) ? body.axis : Vector3d(body.axis.cross(body.com - body.origin));
    for (std::size_t k = i; k > 0; k = parent(k)) {
      if (prismatic(k)) continue;
      const auto row = static_cast<Eigen::Index>(i - 1), column = static_cast<Eigen::Index>(k - 1);
      gradient(row, column) = gradient(column, row) = -body.mass_kg * gravity_m_s2_.dot(bodies_[k].axis.cross(lever));
    }
  }
}

void Dynamics::link_jacobian(std::size_t link, const Vec3& point_in_link_m,
                             Eigen::Ref<Eigen::MatrixXd> jacobian) const noexcept {
  const Vec3 at = transform(kinematics_.link(link), point_in_link_m);
  const Vector3d point(at[0], at[1], at[2]);
  jacobian.setZero();
  if (base_size_ > 0) {
    jacobian.block<6, 6>(0, 0).setIdentity();
    jacobian.block<3, 3>(0, 3) = -cross_matrix(point - bodies_[0].origin);
  }
  for (std::size_t i = link; i > 0; i = parent(i)) {
    const Body& body = bodies_[i];
    if (prismatic(i)) {
      jacobian.block<3, 1>(0, index(i)) = body.axis;
    } else {
      jacobian.block<3, 1>(0, index(i)) = body.axis.cross(point - body.origin);
      jacobian.block<3, 1>(3, index(i)) = body.axis;
    }
  }
}

void Dynamics::com_jacobian(Eigen::Ref<Eigen::MatrixXd> jacobian) const noexcept {
  const Body& base = bodies_[0];
  if (base_size_ > 0) {
    jacobian.block<3, 3>(0, 0).setIdentity();
    jacobian.block<3, 3>(0, 3) = -cross_matrix(base.com - base.origin);
  }
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const double share = base.mass_kg > 0 ? body.mass_kg / base.mass_kg : 0.0;
    jacobian.block<3, 1>(0, index(i)) =
        share * (prismatic(i) ? body.axis : Vector3d(body.axis.cross(body.com - body.origin)));
  }
}

Vec3 Dynamics::com_m() const noexcept {
  const Vector3d& com = bodies_[0].com;
  return {com.x(), com.y(), com.z()};
}

double Dynamics::potential_energy_J() const noexcept { return -bodies_[0].mass_kg * gravity_m_s2_.dot(bodies_[0].com); }

}  // namespace kadans
