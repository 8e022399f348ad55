// One run of `kadans sim`, from the start or from a checkpoint.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/assembly/assembly.h"
#include "app/commands.h"
#include "app/ctl/sim_remote.h"
#include "app/run/observers.h"
#include "app/run/process_split.h"
#include "checkpoint.h"
#include "hash_trail.h"
#include "ordered_events.h"
#include "run_branches.h"
#include "scenario/report/report.h"
#include "telemetry/record/recorder.h"

namespace kadans {

// The checkpoint from which a run continues, and its branches.
struct SimContinuation {
  Checkpoint from;
  std::vector<RunBranch> branches;  // at least one, which may do nothing
};

class SimRun final : public RunObserver {
 public:
  // `choices` names the scenario's file. Without a continuation the run is recorded from its first tick.
  SimRun(const SimOptions& options, const RunChoices& choices, std::optional<SimContinuation> continuation = {});

  // Runs, prints the report, or those of all branches, and returns the program's exit code.
  int run();

  void tick(double time_s, std::span<const double> row) override;
  void fault(const Fault& fault) override {
    if (recorder_) recorder_->fault(fault);
  }
  void between_ticks(const RunMark& mark) override;
  bool stop_asked() const override { return parted_ || split_; }

 private:
  void make_reachable();
  void describe(RecordWriter& record) const;
  void start_record();
  bool open_record();
  void fly();
  void finish_record(const RunResult& result);
  // To be called when an output file is missing or incomplete: prints that, and the exit code will not be 0.
  void tell_lost(const std::string& what);
  std::string record_name() const;
  int report(RunResult& result);
  void print(const RunResult& result) const;
  RunReport report_of(const RunResult& result) const;
  void write_page(const RunResult& result);
  std::string repeat() const;
  void reach_branch(const RunMark& mark);
  void take_branch(std::size_t index, const RunMark& mark);
  int tell_parting() const;

  const SimOptions& options_;
  RunChoices choices_;
  ScenarioConfig scenario_;
  std::uint64_t seed_;
  double duration_s_;
  LineEcho echo_;
  OrderedEvents ordered_;
  RunLog log_{std::initializer_list<LineSink*>{&echo_, &ordered_}};
  Assembly assembly_;
  Checks checks_;
  Metrics metrics_;
  Evidence evidence_{checks_, assembly_.catalog().signals};
  RunInputs inputs_;
  TraceObserver height_;
  std::unique_ptr<HashTrail> trail_;
  std::unique_ptr<CheckpointWriter> checkpoints_;
  RecordPlan record_plan_;
  std::unique_ptr<Recorder> recorder_;
  std::string record_;
  std::vector<std::string> lost_;

  std::optional<SimContinuation> continuation_;
  std::vector<BranchActions> actions_;  // one for each branch
  RunBranch branch_;                    // the branch that this process takes
  const BranchActions* taken_ = nullptr;
  bool reached_ = false, parted_ = false;
  std::string other_objects_;  // control objects whose state is not the checkpoint's
  bool split_ = false;         // this process has split into the branches and is done
  ProcessSplit processes_;
  std::unique_ptr<SimRemote> remote_;
  HashTrail way_{checkpoint_trail_s};
};

}  // namespace kadans
