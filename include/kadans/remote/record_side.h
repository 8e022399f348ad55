// The record thread's part of an instance: writes what waits, and starts and stops records while the loop goes on.
//
// The recorder is made with the first record, or at the start where there is a flight recorder, and stays, so a row
// that is on its way when a record ends finds it still there; it is thrown away when the next one begins. A file is
// never overwritten, but by the one named when the run began, and lies in the instance's folder of records.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "kadans/realtime/task_thread.h"
#include "kadans/remote/control_side.h"
#include "kadans/remote/instance.h"
#include "kadans/remote/robot_texts.h"
#include "kadans/telemetry/recorder.h"
#include "kadans/telemetry/timing_json.h"

namespace kadans {

// Hands on what behaviors say while there is a record. Behavior thread, but for to().
class RecordLog final : public BehaviorLog {
 public:
  void to(BehaviorLog* log) noexcept { log_.store(log, std::memory_order_release); }
  void transition(const Transition& transition) override {
    if (BehaviorLog* log = log_.load(std::memory_order_acquire); log != nullptr) log->transition(transition);
  }
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override {
    if (BehaviorLog* log = log_.load(std::memory_order_acquire); log != nullptr)
      log->message(time_ns, severity, behavior, text);
  }

 private:
  std::atomic<BehaviorLog*> log_{nullptr};
};

struct RecordPlan {
  RecorderSettings settings = {};
  FlightSettings flight = {};
  std::vector<TimingSource> timing = {};  // must outlive the record
};

class RecordSide final : public Task {
 public:
  // All must outlive it. `facts` stand in every record, under "run".
  RecordSide(Instance& instance, ControlSide& control, RecordLog& log, TextMap facts)
      : instance_(instance), control_(control), log_(log), facts_(std::move(facts)) {}

  // Before the loop.
  void describe_with(RobotTexts texts) { texts_ = std::move(texts); }
  void record_as(RecordPlan plan) { plan_ = std::move(plan); }
  // The last step before the loop: the flight recorder begins to look.
  void begin();
  // Record thread, or before the loop and after it. Throws InputError when there can be none.
  void start(const std::string& file);
  [[nodiscard]] bool stop();  // false: error() says why the record is not complete
  // Any thread: the robot is about to be let go. No flight record any more.
  void expect_end() noexcept { ending_.store(true, std::memory_order_relaxed); }
  // After the loop: stop(), and the flight record that is still to be written.
  [[nodiscard]] bool end();
  std::string error() const;  // of the record, else of the flight record
  // Before the loop: somebody else has a record that goes on to the end.
  void leave_to(RecordSink& own, const std::string& file);
  bool beat(const Beat&) override;

  // Supervisor.
  void tell(const Fault& fault) noexcept {
    if (Recorder* recorder = told_.load(std::memory_order_acquire); recorder != nullptr) recorder->fault(fault);
  }
  RecordStatus status() noexcept { return status_.newest(); }
  // After the loop; nullptr: there was no record.
  const Recorder* recorder() const noexcept { return recorder_.get(); }

 private:
  void carry_out(OrderCase& order);
  void make_recorder();
  template <typename Record>
  void describe(Record& record, std::int64_t time_ns) const;
  void hand_over(bool at_once);
  void fly(const std::filesystem::path& file);
  void tell_timing();
  std::filesystem::path file_for(const std::string& name, const char* suffix) const;
  void publish();

  Instance& instance_;
  ControlSide& control_;
  RecordLog& log_;
  TextMap facts_;
  RobotTexts texts_;
  RecordPlan plan_;
  std::int64_t time_ns_ = 0, timing_told_ns_ = 0;
  std::atomic<bool> ending_{false};
  std::unique_ptr<Recorder> recorder_;
  std::atomic<Recorder*> told_{nullptr};  // the same, for the supervisor
  std::string file_;                      // "": none is open
  bool others_ = false;                   // and it is not ours
  Latest<RecordStatus> status_;
};

}  // namespace kadans
