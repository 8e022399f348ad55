// What the low level of each shipped control object costs a tick, on 1, 14 and 64 joints, every joint on its way to a
// set-point.
#include <algorithm>
#include <set>
#include <string>

#include "bench/report.h"
#include "chain_robot.h"

namespace kadans::bench {
namespace {

constexpr int batches = 600, calls = 50;
// What a chain of plain joints lacks: feet, eyes, springs, a link to hold.
const std::set<std::string> elsewhere{"dcm_balance", "dcm_walk",       "stance",         "gaze",      "spring_torque",
                                      "stance_leg",  "support_forces", "task_impedance", "whole_body"};

// Gains that keep every law busy, within each parameter's range.
void tune(Catalog& catalog) {
  for (ParameterId id = 0; id < catalog.parameters.size(); ++id) {
    const Parameter& parameter = catalog.parameters.info(id);
    if (parameter.initial == 0) (void)catalog.parameters.set(id, std::clamp(1.0, parameter.min, parameter.max));
  }
}

double object_tick_ns(const Robot& robot) {
  const auto system = make_control_system(robot);
  ControlObject& object = *system->objects.front();
  tune(system->catalog);
  object.parameters_changed();
  Snapshot snapshot;
  ActuationFrame written, computed;
  snapshot.joints.count = written.joint_count = computed.joint_count =
      static_cast<std::uint32_t>(robot.config.model.joints.size());
  std::int64_t time_ns = 0;
  object.start({snapshot.joints, snapshot.status, written, time_ns, 0.001});
  object.update(snapshot);
  std::vector<double> each;
  for (int batch = 0; batch < batches; ++batch) {
    for (SetpointId id = 0; id < system->catalog.setpoints.size(); ++id) {
      const Setpoint& setpoint = system->catalog.setpoints[id];
      const double value = std::clamp(batch % 2 == 0 ? 0.5 : -0.5, setpoint.min, setpoint.max);
      object.set_point(setpoint.channel, value, 1.0);
      if (!setpoint.own_motion) object.follow(setpoint.channel, {.value = value});
    }
    const double began = now_ns();
    for (int i = 0; i < calls; ++i) {
      object.step({snapshot.joints, snapshot.status, written, time_ns, 0.001}, computed);
      keep(computed);
      time_ns += 1'000'000;
    }
    each.push_back((now_ns() - began) / calls);
  }
  return median(std::move(each));
}

}  // namespace

void bench_objects(Report& report) {
  const Robot tulip = read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json");
  for (const std::string& type : tulip.types.names()) {
    if (elsewhere.contains(type)) continue;
    for (const std::size_t joints : {1, 14, 64}) {
      const std::string count = std::to_string(joints);
      report.add("object_tick_ns." + type + "." + count, type + ", " + count + (joints == 1 ? " joint" : " joints"),
                 object_tick_ns(chain_robot(joints, tulip.types, type)), "ns");
    }
  }
}

}  // namespace kadans::bench
