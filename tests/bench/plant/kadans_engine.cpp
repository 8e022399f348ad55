#include "engines.h"
#include "kadans/plant/bullet/bullet_world.h"

namespace kadans::bench {
namespace {

class KadansEngine final : public Engine {
 public:
  KadansEngine(const RobotModel& model, const PlantSettings& settings, std::int64_t step_ns)
      : plant_(model, settings, 1), step_ns_(step_ns) {}

  void set_torques(const std::vector<double>& torque_Nm) override {
    ActuationFrame frame;
    frame.joint_count = static_cast<std::uint32_t>(torque_Nm.size());
    for (std::size_t i = 0; i < torque_Nm.size(); ++i) {
      frame.joints[i].mode = ActuationMode::effort;
      frame.joints[i].effort_Nm = torque_Nm[i];
    }
    plant_.write(frame);
  }
  void step() override { plant_.step(step_ns_); }
  EngineState state() const override {
    const PlantTruth& truth = plant_.truth();
    EngineState state;
    state.position_rad.assign(truth.position_rad.begin(), truth.position_rad.begin() + truth.joint_count);
    state.velocity_rad_s.assign(truth.velocity_rad_s.begin(), truth.velocity_rad_s.begin() + truth.joint_count);
    for (std::size_t i = 0; i < truth.foot_count; ++i) state.feet_m.push_back(truth.feet[i].position_m);
    state.base = truth.base;
    return state;
  }
  int contact_count() const override { return static_cast<int>(plant_.truth().contact_count); }

 private:
  BulletWorld plant_;
  std::int64_t step_ns_;
};

}  // namespace

std::unique_ptr<Engine> kadans_engine(const RobotModel& model, const PlantSettings& settings, ContactSolver solver,
                                      std::int64_t step_ns) {
  PlantSettings own = settings;
  own.solver = solver;
  return std::make_unique<KadansEngine>(model, own, step_ns);
}

}  // namespace kadans::bench
