// One step of TULip in our plant, in the same plant with Bullet's own solver, and in MuJoCo: the same robot, the same
// rigid drives (reflected inertia, damping), the same torques by the same rule from each engine's own state, 1 ms. The
// engines take turns, a few steps each, so that whatever the machine does beside meets all alike; compare ratios, not
// figures. Our step includes what a plant does beyond mechanics: encoders, IMU and foot sensors with noise, truth.
// Standing, our plant in single precision takes its turns too, in a program of its own.
#include <optional>

#include "../report.h"
#include "kadans/model/urdf.h"
#include "scene_run.h"
#include "single_precision.h"

namespace kadans::bench {
namespace {

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

struct Figures {
  std::string key, text;
  double step_us = 0;
  int contact_count = 0;
  double drift_mm = 0;
};

// All engines through one scene, in turns; ours first.
std::vector<Figures> run_scene(const RobotModel& model, const SceneInfo& info) {
  const PlantSettings settings = settings_of(model, info.scene);
  struct Runner {
    std::string key, text;
    SceneRun run;
  };
  std::vector<Runner> runners;
  const auto add = [&](const char* key, const char* text, std::unique_ptr<Engine> engine) {
    runners.push_back({key, text, SceneRun(model, info.scene, std::move(engine))});
  };
  add("kadans", "Kadans", kadans_engine(model, settings, ContactSolver::tree));
  add("bullet", "Bullet's solver", kadans_engine(model, settings, ContactSolver::stock));
  add("mujoco_cg", "MuJoCo CG", mujoco_engine(model, settings, "CG"));
  add("mujoco_newton", "MuJoCo Newton", mujoco_engine(model, settings, "Newton"));
  std::optional<SinglePrecisionRun> single;
  if (info.scene == Scene::standing) single.emplace();

  for (int k = 0; k < settle_steps + info.timed_steps; k += steps_per_turn) {
    for (Runner& runner : runners) runner.run.turn();
    if (single) single->turn();
  }

  std::vector<Figures> figures;
  for (const Runner& runner : runners) {
    const SceneRun& run = runner.run;
    figures.push_back({runner.key, runner.text, run.step_us(), run.contact_count(), run.drift_mm()});
  }
  if (!single) return figures;
  const SinglePrecision result = single->end();
  figures.push_back(
      {"kadans_float", "Kadans in single precision", result.step_us, result.contact_count, result.drift_mm});
  return figures;
}

void report_scene(Report& report, const SceneInfo& info, const std::vector<Figures>& all) {
  const bool main = info.scene == Scene::standing;
  const double ours_us = all.front().step_us;
  for (const Figures& figures : all) {
    const std::string text = std::string(info.text) + ", " + figures.text, end = info.key + ("." + figures.key);
    report.add(main ? "plant_step_us." + figures.key : "plant_scenes_us." + end, "step, " + text, figures.step_us,
               "us");
    if (&figures != &all.front()) {
      report.add("plant_ratio." + end, "  Kadans to that", ours_us / figures.step_us, "x");
    }
    report.add("plant_contacts." + end, "  points of contact", figures.contact_count, "");
    if (main) report.add("plant_drift_mm." + figures.key, "  drift of the feet in 10 s", figures.drift_mm, "mm");
  }
}

}  // namespace

void bench_plant(Report& report) {
  const RobotModel model = read_urdf(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf");
  for (const SceneInfo& info : scenes) report_scene(report, info, run_scene(model, info));
  bench_simulation(report);
}

}  // namespace kadans::bench
