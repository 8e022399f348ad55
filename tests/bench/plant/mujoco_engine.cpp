#include <array>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include <mujoco/mujoco.h>

#include "engines.h"
#include "mjcf.h"

namespace kadans::bench {
namespace {

struct FreeModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

std::unique_ptr<mjModel, FreeModel> load(const std::string& xml) {
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "robot.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  std::array<char, 500> error{};
  std::unique_ptr<mjModel, FreeModel> model(mj_loadXML("robot.xml", files.get(), error.data(), error.size()));
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(std::string("MuJoCo refuses the model: ") + error.data());
  return model;
}

class MujocoEngine final : public Engine {
 public:
  MujocoEngine(const RobotModel& model, const PlantSettings& settings, const MjcfOptions& options)
      : model_(load(mjcf(model, settings, options))), data_(mj_makeData(model_.get())) {
    for (const Joint& joint : model.joints) {
      const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint.name.c_str());
      positions_.push_back(static_cast<std::size_t>(model_->jnt_qposadr[id]));
      velocities_.push_back(static_cast<std::size_t>(model_->jnt_dofadr[id]));
    }
    for (std::size_t i = 0; i < positions_.size(); ++i) data_->qpos[positions_[i]] = settings.position_rad[i];
    for (const FootSettings& foot : settings.feet) {
      feet_.push_back(mj_name2id(model_.get(), mjOBJ_BODY, foot.link.c_str()));
    }
    mj_forward(model_.get(), data_.get());
  }

  void set_torques(const std::vector<double>& torque_Nm) override {
    for (std::size_t i = 0; i < torque_Nm.size(); ++i) data_->ctrl[i] = torque_Nm[i];
  }
  void step() override { mj_step(model_.get(), data_.get()); }
  EngineState state() const override {
    EngineState state;
    for (const std::size_t i : positions_) state.position_rad.push_back(data_->qpos[i]);
    for (const std::size_t i : velocities_) state.velocity_rad_s.push_back(data_->qvel[i]);
    for (const int foot : feet_) {
      const mjtNum* at = data_->xpos + 3 * foot;
      state.feet_m.push_back({at[0], at[1], at[2]});
    }
    const mjtNum* const q = data_->qpos;
    state.base = {{q[0], q[1], q[2]}, {q[3], q[4], q[5], q[6]}};
    return state;
  }
  int contact_count() const override { return data_->ncon; }

 private:
  std::unique_ptr<mjModel, FreeModel> model_;
  std::unique_ptr<mjData, FreeData> data_;
  std::vector<std::size_t> positions_, velocities_;
  std::vector<int> feet_;
};

}  // namespace

std::unique_ptr<Engine> mujoco_engine(const RobotModel& model, const PlantSettings& settings, const std::string& solver,
                                      std::int64_t step_ns, const std::string& integrator) {
  const MjcfOptions options{
      .solver = solver, .integrator = integrator, .time_step_s = 1e-9 * static_cast<double>(step_ns)};
  return std::make_unique<MujocoEngine>(model, settings, options);
}

}  // namespace kadans::bench
