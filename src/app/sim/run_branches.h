// Changes a run between two ticks, so that it branches off from the original run: other parameters of control objects,
// other behaviors, a push. The plant itself stays the same, because a robot does not change its masses while it moves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/assembly/assembly.h"
#include "app/run/run_choices.h"
#include "scenario/disturb/disturbances.h"
#include "telemetry/record/run_inputs.h"

namespace kadans {

// "softer: set control.*.kp_Nm_per_rad_scale=0.5; push torso=0,2,0; play wave". Throws InputError.
RunBranch parse_branch(const std::string& text);
std::string branch_text(const RunBranch& branch);

// Carries out the changes of a branch.
class BranchActions {
 public:
  // Throws InputError for an unknown parameter, link or behavior, and for a value out of its range.
  BranchActions(const RunBranch& branch, const ScenarioConfig& scenario, Assembly& assembly, double at_s);

  void begin(const RunMark& mark);  // call it once, between two ticks
  // Call it after begin(), between two ticks: applies the pushes of the next tick.
  void between_ticks(const RunMark& mark) const;

 private:
  struct Setting {
    ParameterId parameter = 0;
    double number = 0;
    bool scale = false;  // `number` multiplies the value at the branch
  };
  void read_setting(const NumberEntry& setting, const ParameterTable& parameters);

  Assembly& assembly_;
  std::vector<Setting> settings_;
  std::vector<PlayItem> play_;
  Pushes pushes_;
};

// Repeats the branch of a record that was simulated from a checkpoint; nothing where the record's facts tell of none.
class RecordedBranch final : public RunObserver {
 public:
  // Keeps references.
  RecordedBranch(const TextMap& facts, const ScenarioConfig& scenario, Assembly& assembly);

  void between_ticks(const RunMark& mark) override;

 private:
  const TextMap& facts_;
  const ScenarioConfig& scenario_;
  Assembly& assembly_;
  std::optional<std::uint64_t> tick_;
  std::optional<BranchActions> actions_;
};

}  // namespace kadans
