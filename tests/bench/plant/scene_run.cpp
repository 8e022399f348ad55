#include "scene_run.h"

#include <cmath>
#include <numbers>

#include "../report.h"
#include "standing.h"

namespace kadans::bench {

PlantSettings settings_of(const RobotModel& model, Scene scene) {
  PlantSettings settings = standing_settings(model);
  if (scene == Scene::fallen) settings.base.orientation = {std::sqrt(0.5), 0, std::sqrt(0.5), 0};
  if (scene == Scene::ball) {
    settings.world.objects.push_back({.name = "ball",
                                      .shape = WorldBall{.radius_m = 0.1, .mass_kg = 0.4, .velocity_m_s = {-0.2, 0, 0}},
                                      .pose = {.position_m = {0.4, 0.1, 0.1}}});
  }
  put_on_ground(model, settings);
  return settings;
}

void SceneRun::turn() {
  if (steps_ == settle_steps) settled_ = engine_->state();
  for (int i = 0; i < steps_per_turn; ++i, ++steps_) {
    engine_->set_torques(torques(engine_->state()));
    const double began = now_ns();
    engine_->step();
    if (steps_ >= settle_steps) times_us_.push_back(1e-3 * (now_ns() - began));
  }
}

void SceneRun::run_in() {
  for (int i = 0; steps_ >= settle_steps && i < run_in_steps; ++i) {
    engine_->set_torques(torques(engine_->state()));
    engine_->step();
  }
}

double SceneRun::step_us() const { return median(times_us_); }

double SceneRun::drift_mm() const {
  const EngineState now = engine_->state();
  double worst_m = 0;
  for (std::size_t i = 0; i < now.feet_m.size(); ++i) {
    const Vec3 &a = now.feet_m[i], &b = settled_.feet_m[i];
    worst_m = std::max(worst_m, std::hypot(a[0] - b[0], a[1] - b[1]));
  }
  return 1e3 * worst_m;
}

std::vector<double> SceneRun::torques(const EngineState& state) const {
  const double time_s = 1e-3 * steps_;
  const double depth = scene_ == Scene::squatting ? (1 - std::cos(std::numbers::pi * time_s)) / 2 : 0;
  return hold_torques(model_, state, depth);
}

}  // namespace kadans::bench
