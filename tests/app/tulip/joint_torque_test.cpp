#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"

using namespace kadans;

namespace {

// Compares in each tick what the estimator makes of the sensors with what each drive really put on its joint.
class TorqueComparison final : public RunObserver {
 public:
  explicit TorqueComparison(const RunParts& parts) : parts_(parts) {}
  void tick(double time_s, std::span<const double>) override {
    if (time_s > 0.5) {  // once the robot stands, so that the largest errors are not those of touching down
      const PlantTruth& truth = parts_.robot.truth();
      for (std::uint32_t i = 0; i < truth.joint_count; ++i) {
        const double error_Nm = parts_.control.state().joints.joints[i].effort_Nm - last_[i];
        worst_Nm = std::max(worst_Nm, std::abs(error_Nm));
        sum_Nm2 += error_Nm * error_Nm;
        largest_Nm = std::max(largest_Nm, std::abs(last_[i]));
        ++count;
      }
    }
    last_ = parts_.robot.truth().drive_torque_Nm;  // of the step after the tick: the sensors show it in the next one
  }
  double rms_Nm() const { return std::sqrt(sum_Nm2 / static_cast<double>(count)); }

  double worst_Nm = 0, largest_Nm = 0;

 private:
  const RunParts& parts_;
  std::array<double, max_joints> last_{};
  double sum_Nm2 = 0;
  std::size_t count = 0;
};

}  // namespace

TEST_CASE("The estimated joint torques of a squatting TULip are those that its drives gave") {
  const ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  RunLog log;
  Assembly robot(scenario, 3, log);
  const RunParts parts = robot.parts();
  TorqueComparison comparison(parts);
  Checks checks(robot.catalog().signals);
  const RunResult result = run_scenario(parts, 4.0, checks, {&comparison});
  CHECK(result.error.empty());
  CHECK(comparison.largest_Nm > 5);
  CHECK(comparison.rms_Nm() < 0.2);
  CHECK(comparison.worst_Nm < 1);
  MESSAGE("rms ", comparison.rms_Nm(), " worst ", comparison.worst_Nm, " of at most ", comparison.largest_Nm, " Nm");
}
