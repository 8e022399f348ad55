#include "mjcf_judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Cholesky>
#include <mujoco/mujoco.h>

#include "kadans/model/dynamics.h"
#include "kadans/signal/random.h"

namespace kadans::test {
namespace {

struct FreeModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

// Where libmujoco has what our models have: the base's six first when it floats.
struct Places {
  std::vector<std::size_t> positions, velocities;
  std::vector<int> bodies;  // by link; -1: a link between two joints of one body
  bool floats = false;
};

// libmujoco at a state, without what our dynamics leave to others: contacts, limits, springs and damping.
void place(const mjModel& theirs, mjData& data, const Places& places, const std::vector<double>& position,
           const std::vector<double>& velocity) {
  mj_resetData(&theirs, &data);
  for (int joint = 0; joint < theirs.njnt; ++joint) {  // a base that floats stands level, as a base does here
    if (theirs.jnt_type[joint] != mjJNT_FREE) continue;
    double* const q = data.qpos + theirs.jnt_qposadr[joint];
    std::fill(q, q + 7, 0.0);
    q[3] = 1;
  }
  for (std::size_t i = 0; i < position.size(); ++i) {
    data.qpos[places.positions[i]] = position[i] + theirs.qpos0[places.positions[i]];
    data.qvel[places.velocities[i]] = velocity[i];
  }
  mj_forward(&theirs, &data);
}

}  // namespace

JudgedRobot judge(const std::string& file, int states, const UrdfOptions& options) {
  JudgedRobot result;
  std::array<char, 500> error{};
  const std::unique_ptr<mjModel, FreeModel> theirs(mj_loadXML(file.c_str(), nullptr, error.data(), error.size()));
  if (theirs == nullptr) {
    result.why = error.data();
    return result;
  }
  const std::unique_ptr<mjData, FreeData> data(mj_makeData(theirs.get()));
  const RobotModel ours = read_urdf_text(read_mjcf(file, options).urdf, file);
  const std::size_t count = ours.joints.size();
  Places places;
  for (const Link& link : ours.links) places.bodies.push_back(mj_name2id(theirs.get(), mjOBJ_BODY, link.name.c_str()));
  const int root = places.bodies[0];
  const int root_joint = root < 1 ? -1 : theirs->body_jntadr[root];
  places.floats = root_joint >= 0 && theirs->jnt_type[root_joint] == mjJNT_FREE;
  for (int k = 0; places.floats && k < 6; ++k)
    places.velocities.push_back(static_cast<std::size_t>(theirs->jnt_dofadr[root_joint] + k));
  for (const Joint& joint : ours.joints) {
    const int id = mj_name2id(theirs.get(), mjOBJ_JOINT, joint.name.c_str());
    if (id < 0) {
      result.why = "it has no joint " + joint.name;
      return result;
    }
    places.positions.push_back(static_cast<std::size_t>(theirs->jnt_qposadr[id]));
    places.velocities.push_back(static_cast<std::size_t>(theirs->jnt_dofadr[id]));
  }
  std::vector<double> rotors;
  for (const Joint& joint : ours.joints) rotors.push_back(joint.rotor_inertia_kg_m2);
  Dynamics dynamics(
      ours, {.base = places.floats ? Dynamics::Base::floating : Dynamics::Base::fixed, .rotor_inertia_kg_m2 = rotors});
  const auto n = static_cast<Eigen::Index>(dynamics.size());
  const std::size_t size = static_cast<std::size_t>(theirs->nv);
  std::vector<double> matrix(size * size), across(3 * size), turning(3 * size);
  RandomStream random(1, "judge");
  std::vector<double> position(count), velocity(count);
  theirs->opt.gravity[0] = theirs->opt.gravity[1] = 0, theirs->opt.gravity[2] = -9.81;
  theirs->opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_PASSIVE | mjDSBL_ACTUATION;
  Eigen::MatrixXd mass(n, n), jacobian(6, n), their_jacobian(6, n);
  Eigen::VectorXd bias(n), acceleration(n);
  Places joints = places;
  if (places.floats) joints.velocities.erase(joints.velocities.begin(), joints.velocities.begin() + 6);
  const auto relative = [](const Eigen::MatrixXd& own, const Eigen::MatrixXd& other, double least) {
    return (own - other).cwiseAbs().maxCoeff() / std::max(least, own.cwiseAbs().maxCoeff());
  };
  for (int state = 0; state < states; ++state) {
    for (std::size_t i = 0; i < count; ++i) position[i] = random.uniform(-1, 1), velocity[i] = random.uniform(-3, 3);
    place(*theirs, *data, joints, position, velocity);
    mj_fullM(theirs.get(), matrix.data(), data->qM);
    dynamics.update(position, velocity, {});
    const auto at = [&](Eigen::Index i) { return places.velocities[static_cast<std::size_t>(i)]; };
    for (Eigen::Index i = 0; i < n; ++i) {
      bias[i] = data->qfrc_bias[at(i)], acceleration[i] = data->qacc[at(i)];
      for (Eigen::Index j = 0; j < n; ++j) mass(i, j) = matrix[at(i) * size + at(j)];
    }
    result.mass_matrix = std::max(result.mass_matrix, relative(dynamics.mass_matrix(), mass, 0));
    result.bias = std::max(result.bias, relative(dynamics.bias(), bias, 1e-3));
    const Eigen::VectorXd own = dynamics.mass_matrix().ldlt().solve(-dynamics.bias());
    result.acceleration = std::max(result.acceleration, relative(own, acceleration, 1e-3));
    for (std::size_t link = 0; link < ours.links.size(); ++link) {
      const int body = places.bodies[link];
      if (body < 1) continue;
      dynamics.link_jacobian(link, {}, jacobian);
      const Vec3 point = dynamics.link(link).position_m;
      mj_jac(theirs.get(), data.get(), across.data(), turning.data(), point.data(), body);
      for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index k = 0; k < 3; ++k) {
          their_jacobian(k, i) = across[static_cast<std::size_t>(k) * size + at(i)];
          their_jacobian(3 + k, i) = turning[static_cast<std::size_t>(k) * size + at(i)];
        }
      }
      result.jacobian = std::max(result.jacobian, relative(jacobian, their_jacobian, 1));
    }
  }
  double mass_kg = 0;
  for (const Joint& joint : ours.joints) {
    // The subtree of the base's children: scenery has none of these.
    if (joint.parent != 0) continue;
    const int id = mj_name2id(theirs.get(), mjOBJ_JOINT, joint.name.c_str());
    mass_kg += theirs->body_subtreemass[theirs->jnt_bodyid[id]];
  }
  const double whole_kg = ours.mass_kg() - ours.links[0].inertia.mass_kg;
  result.mass = std::abs(whole_kg - mass_kg) / mass_kg;
  result.judged = true;
  return result;
}

}  // namespace kadans::test
