// The record thread's part of an instance: writes the waiting rows and events, and starts and stops records while the
// loop runs.
//
// The recorder is made with the first record, or at the start when there is a flight recorder. It then lives to the
// end, so it can still take a row that is on its way when a record ends; such a row is thrown away when the next record
// begins. Records that are ordered later lie in the instance's folder of records and never overwrite a file.
//
// A record that nobody named goes on in a new file when it becomes too large, or when its disk failed; no row is lost
// between the two. The oldest ones go when all together become too large (record_folder.h).
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "control_side.h"
#include "engine/tick/fault_state.h"
#include "instance.h"
#include "realtime/task_thread.h"
#include "run_description.h"
#include "telemetry/record/record_folder.h"
#include "telemetry/record/recorder.h"
#include "telemetry/record/viewer_messages.h"

namespace kadans {

struct RecordPlan {
  RecorderSettings settings = {};
  FlightSettings flight = {};
  std::vector<TimingSource> timing = {};    // must outlive the record
  const FaultState* fault_state = nullptr;  // for the dumps of the flight recorder; must outlive them
  std::uint64_t file_bytes = 0;             // at which a record that nobody named goes on in a new file; 0: never
  std::uint64_t folder_bytes = 0;           // of all records of this robot that nobody named; 0: no bound
  Recorder::Inputs inputs = {};             // with which the run can be repeated; what it names must outlive it
};

class RecordSide final : public Task, public LineSink {
 public:
  // The references must outlive this object. `facts` are written into every record under "run".
  RecordSide(Instance& instance, ControlSide& control, TextMap facts)
      : instance_(instance),
        control_(control),
        inputs_{.run = std::move(facts), .program = {}, .files = {}},
        folder_(instance.facts().records, instance.facts().name) {}

  // Before the loop.
  void describe_with(RobotTexts texts) { texts_ = std::move(texts); }
  void describe_with(RunInputs inputs) { inputs_ = std::move(inputs); }
  void record_as(RecordPlan plan);
  // The last step before the loop: starts the flight recorder.
  void begin();
  // start and stop: record thread, or before or after the loop. start throws InputError when the file cannot be made.
  // "": the next one in the instance's folder of records.
  void start(const std::string& file);
  [[nodiscard]] bool stop();  // false: the record is not complete, error() says why
  // Any thread: the robot is about to be released. From now on no fault starts a flight record.
  void expect_end() noexcept { ending_.store(true, std::memory_order_relaxed); }
  // After the loop: calls stop() and writes the flight record that is still due.
  [[nodiscard]] bool end();
  std::string error() const;  // of the record, else of the flight record
  // Before the loop: another part of the program writes a record, `own`, that goes on to the end of the run.
  void leave_to(RecordSink& own, const std::string& file);
  bool beat(const Beat&) override;

  // Behavior thread: a line for the record, if there is one.
  void tell(const Line& line) override {
    if (LineSink* events = events_.load(std::memory_order_acquire); events != nullptr) events->tell(line);
  }
  void tell_active(const ActiveStates& active) override {
    if (LineSink* events = events_.load(std::memory_order_acquire); events != nullptr) events->tell_active(active);
  }

  void tell_emitted(const EmittedEvent& event) override {
    if (LineSink* events = events_.load(std::memory_order_acquire); events != nullptr) events->tell_emitted(event);
  }

  // Supervisor.
  void tell(const Fault& fault) noexcept {
    if (Recorder* recorder = told_.load(std::memory_order_acquire); recorder != nullptr) recorder->fault(fault);
  }
  RecordStatus status() noexcept { return status_.newest(); }
  // The thread that forces records to the disk.
  RecordStatus status_for_disk() noexcept {
    const auto status = status_.read(1);
    return *status;
  }
  // Call after the loop; nullptr: there was no record.
  const Recorder* recorder() const noexcept { return recorder_.get(); }

 private:
  void carry_out(OrderCase& order);
  void make_recorder();
  void describe(RecordWriter& record, std::int64_t time_ns) const;
  void hand_over(bool at_once);
  void fly(const std::filesystem::path& file);
  void tell_timing();
  void keep_bounds();
  void go_on_in_next();
  std::filesystem::path file_for(const std::string& name, const char* suffix) const;
  void publish();

  Instance& instance_;
  ControlSide& control_;
  RunInputs inputs_;
  RecordFolder folder_;
  RobotTexts texts_;
  RecordPlan plan_;
  std::int64_t time_ns_ = 0, timing_told_ns_ = 0, bounds_kept_ns_ = 0, went_on_ns_ = 0;
  std::atomic<bool> ending_{false};
  std::unique_ptr<Recorder> recorder_;
  std::atomic<Recorder*> told_{nullptr};    // the same recorder, for the supervisor
  std::atomic<LineSink*> events_{nullptr};  // its events, for the behavior thread; nullptr: nothing is recorded
  std::string file_;                        // "": none is open
  std::string lost_;                        // why an earlier file of this record is not complete
  bool inputs_in_files_ = false;
  bool unnamed_ = false;  // nobody named the open file
  bool others_ = false;   // the open file is that of leave_to()
  Latest<RecordStatus, 2> status_;
};

}  // namespace kadans
