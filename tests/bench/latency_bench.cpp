// From the queue to the motor, counted in ticks: a behavior commits a set-point, and so many control ticks begin until
// the plant has another torque. A count, the same on every machine.
#include <cmath>

#include "bench/control/chain_rig.h"
#include "report.h"

namespace kadans::bench {
namespace {

constexpr int settle_ticks = 50, ticks_max = 100;
constexpr std::int64_t period_ns = 1'000'000;

double queue_to_actuation_ticks(const ControlObjectTypes& types) {
  ChainRig rig(1, types);
  std::int64_t time_ns = 0;
  const auto tick = [&] {
    if (time_ns % (10 * period_ns) == 0) rig.behaviors.tick(time_ns);
    rig.control.tick(time_ns, 1e-9 * period_ns);
    rig.plant.step(period_ns);
    time_ns += period_ns;
  };
  for (int i = 0; i < settle_ticks; ++i) tick();
  const double before_Nm = rig.plant.truth().drive_torque_Nm[0];
  CommandSender sender(rig.exchange->commands);
  sender.begin(time_ns);
  (void)sender.add({.kind = CommandKind::set_point, .index = 0, .value = 0.5});
  (void)sender.commit();
  int ticks = 0;
  while (ticks < ticks_max && std::abs(rig.plant.truth().drive_torque_Nm[0] - before_Nm) < 0.1) tick(), ++ticks;
  return ticks;
}

}  // namespace

void bench_latency(Report& report) {
  const Robot tulip = read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json");
  report.add("queue_to_actuation_ticks", "from a committed command to another torque of the motor",
             queue_to_actuation_ticks(tulip.types), "ticks");
}

}  // namespace kadans::bench
