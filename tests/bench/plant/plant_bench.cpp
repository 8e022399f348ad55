// One step of TULip in our plant, in the same plant with Bullet's own solver, and in MuJoCo: the same robot, the same
// rigid drives (reflected inertia, damping), the same torques by the same rule from each engine's own state, 1 ms. The
// engines take turns, a few steps each, so that whatever the machine does beside meets all alike; compare ratios, not
// figures. Our step includes what a plant does beyond mechanics: encoders, IMU and foot sensors with noise, truth.
#include <cmath>
#include <numbers>

#include "../report.h"
#include "engines.h"
#include "kadans/model/urdf.h"
#include "standing.h"

namespace kadans::bench {
namespace {

constexpr int steps_per_turn = 20, settle_steps = 1000;

enum class Scene : std::uint8_t { standing, squatting, fallen, ball };

struct SceneInfo {
  Scene scene;
  const char* key;
  const char* text;
  int timed_steps;
};
constexpr SceneInfo scenes[] = {{Scene::standing, "standing", "standing", 10000},
                                {Scene::squatting, "squatting", "squatting", 4000},
                                {Scene::fallen, "fallen", "lying", 3000},
                                {Scene::ball, "ball", "standing, ball on its foot", 3000}};

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

struct Runner {
  std::string key, text;
  std::unique_ptr<Engine> engine;
  std::vector<double> times_us;
  EngineState settled;
};

class SceneRun {
 public:
  SceneRun(const RobotModel& model, Scene scene) : model_(model), scene_(scene) {
    const PlantSettings settings = settings_of(model, scene);
    add("kadans", "Kadans", kadans_engine(model, settings, ContactSolver::tree));
    add("bullet", "Bullet's solver", kadans_engine(model, settings, ContactSolver::stock));
    add("mujoco_cg", "MuJoCo CG", mujoco_engine(model, settings, "CG"));
    add("mujoco_newton", "MuJoCo Newton", mujoco_engine(model, settings, "Newton"));
  }

  void run(int timed_steps) {
    for (int k = 0; k < settle_steps + timed_steps; k += steps_per_turn) {
      for (Runner& runner : runners_) {
        if (k == settle_steps) runner.settled = runner.engine->state();
        for (int i = 0; i < steps_per_turn; ++i) step(runner, k + i);
      }
    }
  }
  const std::vector<Runner>& runners() const { return runners_; }

 private:
  void add(std::string key, std::string text, std::unique_ptr<Engine> engine) {
    runners_.push_back({std::move(key), std::move(text), std::move(engine), {}, {}});
  }

  void step(Runner& runner, int number) {
    runner.engine->set_torques(torques(runner.engine->state(), 1e-3 * number));
    const double began = now_ns();
    runner.engine->step();
    if (number >= settle_steps) runner.times_us.push_back(1e-3 * (now_ns() - began));
  }

  std::vector<double> torques(const EngineState& state, double time_s) const {
    const double depth = scene_ == Scene::squatting ? (1 - std::cos(std::numbers::pi * time_s)) / 2 : 0;
    return hold_torques(model_, state, depth);
  }

  const RobotModel& model_;
  Scene scene_;
  std::vector<Runner> runners_;
};

double drift_mm(const Runner& runner) {
  const EngineState now = runner.engine->state();
  double worst_m = 0;
  for (std::size_t i = 0; i < now.feet_m.size(); ++i) {
    const Vec3 &a = now.feet_m[i], &b = runner.settled.feet_m[i];
    worst_m = std::max(worst_m, std::hypot(a[0] - b[0], a[1] - b[1]));
  }
  return 1e3 * worst_m;
}

void report_scene(Report& report, const SceneInfo& info, const SceneRun& run) {
  const bool main = info.scene == Scene::standing;
  const double ours_us = median(run.runners()[0].times_us);
  for (const Runner& runner : run.runners()) {
    const double step_us = median(runner.times_us);
    const std::string text = std::string(info.text) + ", " + runner.text, end = info.key + ("." + runner.key);
    report.add(main ? "plant_step_us." + runner.key : "plant_scenes_us." + end, "step, " + text, step_us, "us");
    if (&runner != &run.runners()[0]) {
      report.add("plant_ratio." + end, "  Kadans to that", ours_us / step_us, "x");
    }
    report.add("plant_contacts." + end, "  points of contact", runner.engine->contact_count(), "");
    if (main) report.add("plant_drift_mm." + runner.key, "  drift of the feet in 10 s", drift_mm(runner), "mm");
  }
}

}  // namespace

void bench_plant(Report& report) {
  const RobotModel model = read_urdf(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf");
  for (const SceneInfo& info : scenes) {
    SceneRun run(model, info.scene);
    run.run(info.timed_steps);
    report_scene(report, info, run);
  }
  bench_simulation(report);
}

}  // namespace kadans::bench
