#include <array>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include <mujoco/mujoco.h>

#include "kadans/model/kinematics.h"
#include "parameter_reader.h"

namespace kadans::truth {
namespace {

struct MujocoParameters {
  double friction = 0.2, time_constant_s = 0.02, damping_ratio = 1, impedance = 0.95;
};

std::string model_of(const MujocoParameters& p) {
  std::ostringstream xml;
  xml << std::setprecision(17) << "<mujoco><option timestep=\"" << step_s
      << "\" cone=\"elliptic\"/><default><geom friction=\"" << p.friction << " 0 0\" solref=\"" << p.time_constant_s
      << ' ' << p.damping_ratio << "\" solimp=\"" << p.impedance << ' ' << p.impedance
      << " 0.001\"/></default><worldbody><geom type=\"plane\" size=\"0 0 1\"/>"
      << "<body><freejoint/><inertial pos=\"0 0 0\" mass=\"" << mass_kg << "\" diaginertia=\"" << inertia_kg_m2 << ' '
      << inertia_kg_m2 << ' ' << inertia_kg_m2 << "\"/><geom type=\"box\" size=\"" << edge_m / 2 << ' ' << edge_m / 2
      << ' ' << edge_m / 2 << "\"/></body></worldbody></mujoco>";
  return xml.str();
}

class MujocoCube final : public Cube {
 public:
  explicit MujocoCube(const MujocoParameters& parameters)
      : model_(load(model_of(parameters))), data_(mj_makeData(model_)) {}
  ~MujocoCube() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  MujocoCube(const MujocoCube&) = delete;
  MujocoCube& operator=(const MujocoCube&) = delete;

  void start(const Toss& toss) override {
    mj_resetData(model_, data_);
    const Pose& pose = toss.frames.front();
    const Vec3 turn = rotate_inverse(pose.orientation, toss.angular_velocity_rad_s);  // MuJoCo's is in body axes
    for (std::size_t i = 0; i < 3; ++i) data_->qpos[i] = pose.position_m[i];
    for (std::size_t i = 0; i < 4; ++i) data_->qpos[3 + i] = pose.orientation[i];
    for (std::size_t i = 0; i < 3; ++i) data_->qvel[i] = toss.velocity_m_s[i];
    for (std::size_t i = 0; i < 3; ++i) data_->qvel[3 + i] = turn[i];
  }
  void step() override { mj_step(model_, data_); }
  Pose pose() const override {
    const mjtNum* q = data_->qpos;
    return {{q[0], q[1], q[2]}, {q[3], q[4], q[5], q[6]}};
  }

 private:
  static mjModel* load(const std::string& xml) {
    auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "cube.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[0], xml.data(), xml.size());
    std::array<char, 500> error{};
    mjModel* const model = mj_loadXML("cube.xml", files.get(), error.data(), static_cast<int>(error.size()));
    mj_deleteVFS(files.get());
    if (model == nullptr) throw std::runtime_error(std::string("MuJoCo refuses the model: ") + error.data());
    return model;
  }

  mjModel* model_;
  mjData* data_;
};

}  // namespace

std::unique_ptr<Cube> mujoco_cube(const Parameters& given) {
  MujocoParameters parameters;
  ParameterReader(given)
      .take("friction", parameters.friction)
      .take("time_constant_s", parameters.time_constant_s)
      .take("damping_ratio", parameters.damping_ratio)
      .take("impedance", parameters.impedance)
      .end();
  return std::make_unique<MujocoCube>(parameters);
}

}  // namespace kadans::truth
