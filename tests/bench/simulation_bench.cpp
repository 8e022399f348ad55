#include <ctime>
#include <filesystem>

#include "app/assembly/assembly.h"
#include "plant/engines.h"
#include "plant/standing.h"
#include "report.h"
#include "telemetry/record/recorder.h"

namespace kadans::bench {
namespace {

constexpr double simulated_s = 2;

// Empties the recorder into its file as a run does.
class Drain final : public RunObserver {
 public:
  explicit Drain(Recorder& recorder) : recorder_(recorder) {}
  void tick(double, std::span<const double>) override {
    if (++ticks_ % 100 == 0) (void)recorder_.drain();
  }

 private:
  Recorder& recorder_;
  int ticks_ = 0;
};

// What a simulated millisecond of the squat takes of the processor, in us: plant, sensors, control and behaviors, with
// a record or without.
double simulated_ms_us(const ScenarioConfig& scenario, bool record) {
  RunLog log;
  Assembly robot(scenario, 1, log);
  Recorder recorder(robot.catalog().signals);
  Drain drain(recorder);
  std::vector<RunObserver*> observers;
  const std::string file = std::filesystem::temp_directory_path() / "kadans_bench.mcap";
  if (record && recorder.open(file)) {
    robot.record_to(&recorder);
    observers.push_back(&drain);
  }
  const RunParts parts = robot.parts();
  Checks checks(robot.catalog().signals);
  const std::clock_t began = std::clock();
  (void)run_scenario(parts, simulated_s, checks, observers);
  const double used_s = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  if (record) {
    (void)recorder.close();
    std::filesystem::remove(file);
  }
  return 1e3 * used_s / simulated_s;
}

// Steps of MuJoCo's CG alone, TULip standing.
double bare_step_us(Engine& mujoco, const RobotModel& model) {
  std::vector<double> each;
  for (int i = 0; i < 2000; ++i) {
    mujoco.set_torques(hold_torques(model, mujoco.state(), 0));
    const double began = now_ns();
    mujoco.step();
    each.push_back(1e-3 * (now_ns() - began));
  }
  return median(each);
}

}  // namespace

// The whole simulation against the bare step of another engine, in turns.
void bench_simulation(Report& report) {
  const ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  const StandingRobot standing = standing_tulip();
  const auto mujoco = mujoco_engine(standing.model, standing.settings, "CG");
  std::vector<double> off_us, on_us, off_ratios, on_ratios;
  for (int run = 0; run < 7; ++run) {
    const double bare_us = bare_step_us(*mujoco, standing.model);
    off_us.push_back(simulated_ms_us(scenario, false));
    on_us.push_back(simulated_ms_us(scenario, true));
    if (run == 0) continue;  // MuJoCo settles
    off_ratios.push_back(off_us.back() / bare_us);
    on_ratios.push_back(on_us.back() / bare_us);
  }
  report.add("sim_realtime_factor", "squat, simulated seconds per second", 1e3 / median(off_us), "x");
  report.add("sim_ratio.record_off", "  its millisecond to a bare step of MuJoCo CG", median(off_ratios), "x");
  report.add("sim_ratio.record_on", "  the same with a record", median(on_ratios), "x");
}

}  // namespace kadans::bench
