// TULip standing on our plant in single precision: a turn for each letter on stdin, answered with a letter on stdout;
// at the end the median step, the drift and the points of contact.
#include <cstdio>

#include "kadans/model/urdf.h"
#include "scene_run.h"

int main() {
  using namespace kadans;
  using namespace kadans::bench;
  const RobotModel model = read_urdf(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf");
  SceneRun run(model, Scene::standing, kadans_engine(model, settings_of(model, Scene::standing), ContactSolver::tree));
  while (std::getchar() != EOF) {
    run.run_in();  // a process that slept finds its caches taken: the others, in one process, do not sleep
    run.turn();
    std::putchar('t');
    std::fflush(stdout);
  }
  std::printf("%.9g %.9g %d\n", run.step_us(), run.drift_mm(), run.contact_count());
  return 0;
}
