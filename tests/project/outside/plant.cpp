// The heavy end from outside: an installed robot read from its URDF, falling in Bullet for a tenth of a second.
#include <cstdio>
#include <string>

#include "kadans/model/urdf.h"
#include "kadans/plant/bullet/bullet_world.h"

int main() {
  const kadans::RobotModel model = kadans::read_urdf(std::string(KADANS_DATA_DIR) + "/models/tulip/tulip.urdf");
  kadans::PlantSettings settings;
  settings.drives.resize(model.joints.size());
  settings.encoders.resize(model.joints.size());
  settings.position_rad.resize(model.joints.size());
  settings.base.position_m = {0, 0, 5};
  settings.stand_on_ground = false;
  kadans::BulletWorld plant(model, settings, 1);
  const double start_m = plant.truth().base.position_m[2];
  for (int i = 0; i < 100; ++i) plant.step(1'000'000);

  const double fallen_m = start_m - plant.truth().base.position_m[2];
  const bool ok = fallen_m > 0.045 && fallen_m < 0.053;  // g t^2 / 2 = 0.049 m
  std::printf("%s fell %.4f m in 0.1 s: %s\n", model.name.c_str(), fallen_m, ok ? "as the law says" : "wrong");
  return ok ? 0 : 1;
}
