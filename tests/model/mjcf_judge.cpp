#include "mjcf_judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <mujoco/mujoco.h>

#include "kadans/model/dynamics.h"
#include "kadans/model/mjcf.h"
#include "kadans/signal/random.h"

namespace kadans::test {
namespace {

struct FreeModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

}  // namespace

JudgedRobot judge(const std::string& file, int states) {
  JudgedRobot result;
  std::array<char, 500> error{};
  const std::unique_ptr<mjModel, FreeModel> theirs(mj_loadXML(file.c_str(), nullptr, error.data(), error.size()));
  if (theirs == nullptr) {
    result.why = error.data();
    return result;
  }
  const std::unique_ptr<mjData, FreeData> data(mj_makeData(theirs.get()));
  const RobotModel ours = read_urdf_text(read_mjcf(file).urdf, file);
  Dynamics dynamics(ours);
  const std::size_t count = ours.joints.size();
  std::vector<std::size_t> positions, velocities;
  for (const Joint& joint : ours.joints) {
    const int id = mj_name2id(theirs.get(), mjOBJ_JOINT, joint.name.c_str());
    if (id < 0) {
      result.why = "it has no joint " + joint.name;
      return result;
    }
    positions.push_back(static_cast<std::size_t>(theirs->jnt_qposadr[id]));
    velocities.push_back(static_cast<std::size_t>(theirs->jnt_dofadr[id]));
  }
  const std::size_t size = static_cast<std::size_t>(theirs->nv);
  std::vector<double> matrix(size * size);
  RandomStream random(1, "judge");
  std::vector<double> position(count), velocity(count);
  theirs->opt.gravity[0] = theirs->opt.gravity[1] = 0, theirs->opt.gravity[2] = -9.81;
  for (int state = 0; state < states; ++state) {
    mj_resetData(theirs.get(), data.get());
    for (int joint = 0; joint < theirs->njnt; ++joint) {  // a base that floats stands level, as a base does here
      if (theirs->jnt_type[joint] != mjJNT_FREE) continue;
      double* const q = data->qpos + theirs->jnt_qposadr[joint];
      std::fill(q, q + 7, 0.0);
      q[3] = 1;
    }
    for (std::size_t i = 0; i < count; ++i) {
      position[i] = random.uniform(-1, 1), velocity[i] = random.uniform(-3, 3);
      data->qpos[positions[i]] = position[i] + theirs->qpos0[positions[i]];
      data->qvel[velocities[i]] = velocity[i];
    }
    mj_forward(theirs.get(), data.get());
    mj_fullM(theirs.get(), matrix.data(), data->qM);
    dynamics.update(position, velocity, {});
    double most_matrix = 0, most_bias = 1e-3, off_matrix = 0, off_bias = 0;
    for (std::size_t i = 0; i < count; ++i) {
      most_bias = std::max(most_bias, std::abs(dynamics.bias()[static_cast<Eigen::Index>(i)]));
      off_bias =
          std::max(off_bias, std::abs(dynamics.bias()[static_cast<Eigen::Index>(i)] - data->qfrc_bias[velocities[i]]));
      for (std::size_t j = 0; j < count; ++j) {
        double own = dynamics.mass_matrix()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        if (i == j) own += ours.joints[i].rotor_inertia_kg_m2;
        most_matrix = std::max(most_matrix, std::abs(own));
        off_matrix = std::max(off_matrix, std::abs(own - matrix[velocities[i] * size + velocities[j]]));
      }
    }
    result.mass_matrix = std::max(result.mass_matrix, off_matrix / most_matrix);
    result.bias = std::max(result.bias, off_bias / most_bias);
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
