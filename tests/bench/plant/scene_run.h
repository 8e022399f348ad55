// One engine through one scene of the plant's benchmark: settle, then steps that are timed.
#pragma once

#include "engines.h"

namespace kadans::bench {

enum class Scene : std::uint8_t { standing, squatting, fallen, ball };

inline constexpr int steps_per_turn = 20, run_in_steps = 20, settle_steps = 1000;

// TULip and its world as the scene begins.
PlantSettings settings_of(const RobotModel& model, Scene scene);

class SceneRun {
 public:
  SceneRun(const RobotModel& model, Scene scene, std::unique_ptr<Engine> engine)
      : model_(model), scene_(scene), engine_(std::move(engine)) {}

  void turn();    // the next few steps, each with torques from the engine's own state
  void run_in();  // some steps that are not timed

  double step_us() const;   // median
  double drift_mm() const;  // the largest way of a foot since it settled
  int contact_count() const { return engine_->contact_count(); }

 private:
  std::vector<double> torques(const EngineState& state) const;

  const RobotModel& model_;
  Scene scene_;
  std::unique_ptr<Engine> engine_;
  int steps_ = 0;
  std::vector<double> times_us_;
  EngineState settled_;
};

}  // namespace kadans::bench
