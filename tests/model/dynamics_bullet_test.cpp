// Our inverse dynamics against Bullet's forward dynamics (articulated body algorithm): an independent implementation.
#include <memory>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>

#include "random_state.h"

using namespace kadans;
using namespace kadans::test;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

btVector3 vector(const Vec3& v) { return {v[0], v[1], v[2]}; }
btTransform frame(const Pose& pose) {
  const Quat& q = pose.orientation;
  return btTransform(btQuaternion(q[1], q[2], q[3], q[0]), vector(pose.position_m));
}

// Where Bullet has a link's frame: in its centre of mass, along its principal axes.
struct ComFrame {
  btTransform in_link;
  btVector3 moments_kg_m2;
};

ComFrame com_frame(const Inertia& i) {
  Eigen::Matrix3d tensor;
  tensor << i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(tensor);
  Eigen::Matrix3d r = solved.eigenvectors();
  if (r.determinant() < 0) r.col(0) *= -1;
  const btMatrix3x3 basis(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2));
  const Eigen::Vector3d m = solved.eigenvalues();
  return {btTransform(basis, vector(i.com_m)), {m[0], m[1], m[2]}};
}

class BulletRobot {
 public:
  BulletRobot(const RobotModel& model, bool fixed_base) : model_(model) {
    for (const Link& link : model.links) frames_.push_back(com_frame(link.inertia));
    body_ = std::make_unique<btMultiBody>(static_cast<int>(model.joints.size()), model.links[0].inertia.mass_kg,
                                          frames_[0].moments_kg_m2, fixed_base, false);
    for (std::size_t i = 0; i < model.joints.size(); ++i) add_joint(i);
    body_->finalizeMultiDof();
    body_->setLinearDamping(0);
    body_->setAngularDamping(0);
    body_->setMaxCoordinateVelocity(1e9);
  }

  // Generalised accelerations, those of a floating base first: of its frame's origin.
  VectorXd accelerations(const State& state, const VectorXd& force, Index base_size) {
    const btVector3 com_arm = place(state);
    const btVector3 v0 = body_->getBaseVel(), w0 = body_->getBaseOmega();
    push(force, base_size, com_arm);
    btAlignedObjectArray<btScalar> scratch_r;
    btAlignedObjectArray<btVector3> scratch_v;
    btAlignedObjectArray<btMatrix3x3> scratch_m;
    const double dt = 1e-3;  // velocities move on by acceleration times dt, exactly
    body_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(dt, scratch_r, scratch_v, scratch_m, false, false,
                                                                false);
    VectorXd result(force.size());
    const btVector3 turn = (body_->getBaseOmega() - w0) / dt;
    const btVector3 at_com = (body_->getBaseVel() - v0) / dt;
    const btVector3 at_origin = at_com - turn.cross(com_arm) - w0.cross(w0.cross(com_arm));
    for (int k = 0; base_size > 0 && k < 3; ++k) result[k] = at_origin[k], result[3 + k] = turn[k];
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      const double after = body_->getJointVel(static_cast<int>(i));
      result[base_size + static_cast<Index>(i)] = (after - state.velocity_rad_s[i]) / dt;
    }
    return result;
  }

 private:
  void add_joint(std::size_t index) {
    const Joint& joint = model_.joints[index];
    const btTransform parent = frames_[joint.parent].in_link, child = frames_[index + 1].in_link;
    const btTransform origin = frame(joint.origin);
    const btQuaternion parent_to_child =
        (parent.inverse().getRotation() * origin.getRotation() * child.getRotation()).inverse();
    const btVector3 axis = child.getBasis().transpose() * vector(joint.axis);
    const btVector3 pivot = parent.inverse() * origin.getOrigin();
    const btVector3 com = child.getBasis().transpose() * child.getOrigin();
    const int link = static_cast<int>(index), parent_link = static_cast<int>(joint.parent) - 1;
    const double mass_kg = model_.links[index + 1].inertia.mass_kg;
    const btVector3& moments = frames_[index + 1].moments_kg_m2;
    if (joint.type == JointType::prismatic) {
      body_->setupPrismatic(link, mass_kg, moments, parent_link, parent_to_child, axis, pivot, com, false);
    } else {
      body_->setupRevolute(link, mass_kg, moments, parent_link, parent_to_child, axis, pivot, com, false);
    }
  }

  // Returns the way from the base frame's origin to its centre of mass, in the world.
  btVector3 place(const State& state) {
    const btTransform base = frame(state.base.pose);
    body_->setBaseWorldTransform(base * frames_[0].in_link);
    const btVector3 com_arm = base.getBasis() * frames_[0].in_link.getOrigin();
    const btVector3 w = vector(state.base.angular_velocity_rad_s);
    body_->setBaseOmega(w);
    body_->setBaseVel(vector(state.base.velocity_m_s) + w.cross(com_arm));
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      body_->setJointPos(static_cast<int>(i), state.position_rad[i]);
      body_->setJointVel(static_cast<int>(i), state.velocity_rad_s[i]);
    }
    return com_arm;
  }

  void push(const VectorXd& force, Index base_size, const btVector3& com_arm) {
    const btVector3 gravity(0, 0, -9.81);
    body_->clearForcesAndTorques();
    body_->addBaseForce(body_->getBaseMass() * gravity);
    if (base_size > 0) {
      const btVector3 push_N(force[0], force[1], force[2]), moment_Nm(force[3], force[4], force[5]);
      body_->addBaseForce(push_N);
      body_->addBaseTorque(moment_Nm - com_arm.cross(push_N));
    }
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      const int link = static_cast<int>(i);
      body_->addLinkForce(link, body_->getLinkMass(link) * gravity);
      body_->addJointTorque(link, force[base_size + static_cast<Index>(i)]);
    }
  }

  const RobotModel& model_;
  std::vector<ComFrame> frames_;
  std::unique_ptr<btMultiBody> body_;
};

}  // namespace

TEST_CASE("Dynamics finds the forces that Bullet's forward dynamics was given, in 50 states of three robots") {
  for (const RobotModel& model : {tulip(), skew_tree(), bare_tree()}) {
    for (const auto base : {Dynamics::Base::fixed, Dynamics::Base::floating}) {
      const bool fixed = base == Dynamics::Base::fixed;
      CAPTURE(model.name);
      CAPTURE(fixed);
      BulletRobot bullet(model, fixed);
      Dynamics dynamics(model, {.base = base});
      RandomStream random(11, "states");
      for (int i = 0; i < 50; ++i) {
        State state = random_state(model, random);
        if (fixed) state.base.velocity_m_s = state.base.angular_velocity_rad_s = {};
        VectorXd given(static_cast<Index>(dynamics.size())), found(given.size());
        for (double& force : given) force = random.uniform(-5, 5);
        const VectorXd acceleration = bullet.accelerations(state, given, static_cast<Index>(dynamics.base_size()));
        dynamics.update(state.position_rad, state.velocity_rad_s, state.base);
        CHECK((dynamics.mass_matrix() * acceleration + dynamics.bias() - given).cwiseAbs().maxCoeff() < 1e-7);
        dynamics.inverse_dynamics(acceleration, found);
        CHECK((found - given).cwiseAbs().maxCoeff() < 1e-7);
      }
    }
  }
}
