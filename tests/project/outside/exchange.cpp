// Exchange and tables from outside: a value published by one thread and read by another, a parameter found by name.
#include <cstdio>
#include <thread>

#include "kadans/exchange/latest.h"
#include "kadans/signal/parameter.h"

int main() {
  kadans::Latest<double> height_m(0.0);
  std::thread writer([&height_m] {
    for (int i = 1; i <= 1000; ++i) height_m.publish(i * 0.001);
  });
  writer.join();

  double kp = 0;
  kadans::ParameterTable table;
  table.add({.name = "knee.kp_Nm_per_rad", .unit = "Nm/rad", .min = 0, .max = 200, .initial = 40, .doc = "Stiffness."},
            &kp);
  const auto id = table.find("knee.kp_Nm_per_rad");
  const bool ok = height_m.newest() == 1.0 && kp == 40 && id && table.set(*id, 60) && kp == 60 && !table.set(*id, 201);
  std::printf("height %.1f m, kp %.0f Nm/rad: %s\n", height_m.newest(), kp, ok ? "as told" : "wrong");
  return ok ? 0 : 1;
}
