// mcap_sample FILE: writes the record that mcap_check/check.mjs reads. 5 s of 1 kHz ticks; signal number i holds
// 1000 i + tick at every tick; a transition every second, a message every half second.
#include <cstdio>
#include <string>
#include <vector>

#include "telemetry/record/recorder.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: mcap_sample FILE\n", stderr);
    return 2;
  }
  kadans::SignalTable table;
  const double zero = 0;
  for (const char* joint : {"l_hip", "l_knee", "r_hip", "r_knee"}) {
    const std::string start = std::string("joint.") + joint;
    table.add({start + ".position_rad", "rad", "Position of the joint."}, &zero);
    table.add({start + ".motor.effort_Nm", "Nm", "Torque of its motor; # is no comment here."}, &zero);
    table.add({start + ".velocity_rad_s", "rad/s", "Velocity of the joint."}, &zero);
  }
  table.add({"base.tilt_rad", "rad", "Between the base's z axis and up."}, &zero);
  table.add({"base.2nd-imu.x", "", ""}, &zero);
  table.add({"tick_overruns", "", "Ticks that came late."}, &zero);

  table.add({"foot.l_foot.force_N", "N", "Sum of the foot's pressure sensors."}, &zero);
  table.add({"foot.l_foot.cop_x_m", "m", "Centre of pressure, forward."}, &zero);

  std::vector<std::uint32_t> every_ticks(table.size(), 1);
  every_ticks[12] = every_ticks[13] = 10;  // the base
  every_ticks[15] = every_ticks[16] = 0;   // the foot
  kadans::Recorder recorder(
      table, {.every_ticks = every_ticks,
              .subjects = {.joints = {"l_hip", "l_knee", "r_hip", "r_knee"}, .base = "torso", .feet = {"l_foot"}}});
  if (!recorder.open(argv[1]) || !recorder.file().describe_run({.run = {{"scenario", "sample"}, {"seed", "1"}}}) ||
      !recorder.file().describe_robot("sample", "<robot name=\"sample\"/>", 0)) {
    std::fprintf(stderr, "%s\n", recorder.error().c_str());
    return 1;
  }
  kadans::BehaviorLog log{&recorder.events()};
  std::vector<double> row(table.size());
  for (std::uint64_t tick = 0; tick < 5000; ++tick) {
    const std::int64_t time_ns = static_cast<std::int64_t>(tick) * 1'000'000;
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = 1000.0 * static_cast<double>(i) + static_cast<double>(tick);
    recorder.record(tick, time_ns, row);
    if (tick % 1000 == 0) {
      log.transition({.time_ns = time_ns, .behavior = "sample", .from = "up", .to = "down", .why = "second"});
    }
    if (tick % 500 == 0) {
      recorder.fault({.code = kadans::FaultCode::velocity_limit, .joint = 1, .tick = tick, .value = 9, .limit = 8});
      log.message(time_ns, kadans::BehaviorLog::Severity::warning, "sample", "half a second");
    }
    if (tick % 10 == 9 && !recorder.drain()) break;
  }
  if (recorder.close()) return 0;
  std::fprintf(stderr, "%s\n", recorder.error().c_str());
  return 1;
}
