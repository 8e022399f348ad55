// What the plant's benchmark steps: our plant with either solver, and MuJoCo, on the same robot with the same torques.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/plant/settings.h"

namespace kadans::bench {

struct EngineState {
  std::vector<double> position_rad, velocity_rad_s;
  std::vector<Vec3> feet_m;
  Pose base;
};

class Engine {
 public:
  virtual ~Engine() = default;
  virtual void set_torques(const std::vector<double>& torque_Nm) = 0;
  virtual void step() = 0;
  virtual EngineState state() const = 0;
  virtual int contact_count() const = 0;  // points that press, or that the solver has
};

std::unique_ptr<Engine> kadans_engine(const RobotModel& model, const PlantSettings& settings, ContactSolver solver,
                                      std::int64_t step_ns = 1'000'000);
// `solver` and `integrator` as MuJoCo writes them: CG, Newton; Euler, RK4.
std::unique_ptr<Engine> mujoco_engine(const RobotModel& model, const PlantSettings& settings, const std::string& solver,
                                      std::int64_t step_ns = 1'000'000, const std::string& integrator = "Euler");

}  // namespace kadans::bench
