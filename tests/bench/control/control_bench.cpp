#include "app/assembly/assembly.h"
#include "bench/report.h"
#include "chain_rig.h"
#include "kadans/testing/allocation_count.h"
#include "telemetry/record/recorder.h"

namespace kadans::bench {
namespace {

constexpr int batch = 100, batches = 500;

struct TickCost {
  double median_ns = 0;
  double allocations = 0;  // in all ticks
};

// The behavior engine ticks between the batches, so that its heartbeat does not grow old. The world steps after each
// tick, outside of what is timed.
TickCost tick_cost(ControlEngine& control, BehaviorEngine& behaviors, World& world, Recorder& recorder) {
  control.record_to(&recorder);
  std::int64_t time_ns = 0;
  std::vector<double> ticks;
  TickCost cost;
  for (int i = 0; i < batches; ++i) {
    double spent_ns = 0;
    {
      const kadans::testing::AllocationCount heap;
      for (int j = 0; j < batch; ++j) {
        const double began = now_ns();
        control.tick(time_ns, 0.001);
        spent_ns += now_ns() - began;
        world.step(1'000'000);
        time_ns += 1'000'000;
      }
      cost.allocations += static_cast<double>(heap.count());
    }
    ticks.push_back(spent_ns / batch);
    behaviors.tick(time_ns);
    (void)recorder.drain();
  }
  expect_normal(control);
  cost.median_ns = median(std::move(ticks));
  return cost;
}

TickCost tulip_tick() {
  ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  scenario.plant = "ideal";
  scenario.behaviors.clear();
  RunLog log;
  Assembly robot(scenario, 1, log);
  Recorder recorder(robot.catalog().signals);
  return tick_cost(robot.parts().control, robot.parts().behaviors, *robot.world(), recorder);
}

TickCost chain_tick(std::size_t joints, const ControlObjectTypes& types) {
  ChainRig rig(joints, types);
  Recorder recorder(rig.catalog.signals);
  return tick_cost(rig.control, rig.behaviors, rig.plant, recorder);
}

}  // namespace

// One control tick with everything but the plant's physics: estimate, safety, PID laws, snapshot, record.
void bench_control(Report& report) {
  const Robot tulip = read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json");
  double allocations = 0;
  for (const std::size_t joints : {1, 14, 64}) {
    const TickCost cost = chain_tick(joints, tulip.types);
    const std::string count = std::to_string(joints);
    report.add("control_tick_ns." + count, "control tick with " + count + " PID: estimate, safety, record",
               cost.median_ns, "ns");
    allocations += cost.allocations;
  }
  const TickCost cost = tulip_tick();
  report.add("control_tick_ns.tulip", "the same of TULip: 12 PID, IMU, feet, truth for checks", cost.median_ns, "ns");
  report.add("control_tick_allocations", "heap allocations in these ticks", allocations + cost.allocations, "");
}

}  // namespace kadans::bench
