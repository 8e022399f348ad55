// Repeats a run on threads from the inputs in its record (telemetry/record/input_stream.h), on one thread and on
// virtual time: the engines get what they got, in the order in which they got it, and every recorded signal, command,
// event of a chart and fault is compared.
//
// The record is read by several readers at once, because the threads ran beside each other: what the behavior thread
// took lies in the file before or after the ticks that it saw. A control tick gets the commands that were recorded. The
// behaviors that are repeated send theirs, which are compared with these.
//
// A flight record begins in the middle of its run: the control engine gets the oldest state that was saved. What came
// down to it is taken from the record; behaviors and high levels are not repeated. Its signals are in single precision,
// but each later state that was saved is compared byte by byte.
//
// A test of a record (a scenario that names one) is the same run to its end, whatever differs from the record: its
// checks judge what this program does with what the robot saw then.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/assembly/assembly.h"
#include "app/commands.h"
#include "input_files.h"
#include "kadans/signal/state_hash.h"
#include "repeated_decisions.h"
#include "telemetry/reading/input_reader.h"
#include "telemetry/reading/record_comparison.h"
#include "telemetry/record/event_log.h"

namespace kadans {

// Repeats the record that the scenario names, and judges it by the scenario's checks; returns the program's exit code.
int run_record_test(const SimOptions& options, const ScenarioConfig& test);
// Repeats a record up to a time, and goes on in the world of a scenario, which judges it; returns the exit code.
int run_then_simulation(const ReplayOptions& options);
// Makes all ready for a test, and says how many checks there are. Throws InputError.
std::size_t count_record_checks(const ScenarioConfig& test);

// The scenario of a run on threads, made of the unpacked files of its record. Throws InputError.
ScenarioConfig unpacked_scenario(const RunInputs& inputs, const std::string& record, const UnpackedInputs& files);
// Whether its behaviors played in a process of their own.
inline bool played_elsewhere(const RunInputs& inputs) { return inputs.fact("behaviors") == "process"; }

class RepeatedRun final : private BehaviorInputs {
 public:
  // What is repeated beside the control engine.
  enum class Behaviors : std::uint8_t {
    saved,     // nothing: of a flight record
    none,      // the high levels of control objects; commands are taken from the record
    compared,  // the behaviors, whose commands are compared with those of the record
    leading,   // the behaviors, and from where they first command otherwise that counts: a run with other files
    tested     // the same; what signals do does not end the run, and those of behaviors are their own
  };
  // `unpacked` holds the scenario's files, and gets those that were read later; `recorded_root` was their folder in the
  // recorded run.
  RepeatedRun(const std::string& record, const ScenarioConfig& scenario, const UnpackedInputs& unpacked,
              std::string recorded_root, Behaviors behaviors);

  // `stop` is asked between ticks. Each tick is shown to `observers`; with some, a signal that differs ends nothing.
  void go(const std::function<bool()>& stop, const std::vector<RunObserver*>& observers = {});
  // After go(): the engines go on, with a model of the robot in place of the record. `model` was made for a scenario of
  // this robot; only its world is used. The observers see its signals, as these engines compute them, and its time,
  // which starts at 0.
  void go_on_in(Assembly& model, const std::function<bool()>& stop, const std::vector<RunObserver*>& observers);

  const RecordComparison& comparison() const noexcept { return *comparison_; }
  bool same() const;
  std::uint64_t compared_ticks() const noexcept { return compared_before_ + comparison_->ticks(); }
  // What differs beside signals: the first command, event or storage, or what decisions ask for. "": nothing.
  const std::string& parting() const noexcept { return parting_; }
  // Why not all of the record was repeated; "": all was.
  std::string shortened() const;
  std::uint64_t ticks() const noexcept { return ticks_; }
  std::uint64_t behavior_ticks() const noexcept { return behavior_ticks_; }
  std::uint64_t commands() const noexcept { return commands_; }
  std::uint64_t events() const noexcept { return events_; }
  // Of the supervisor, when they ran in its thread; nullptr: none are repeated.
  const RepeatedDecisions* decisions() const noexcept { return decisions_.get(); }
  // What these ask for otherwise than recorded; "": nothing. With behaviors that lead it is no parting.
  std::string decided_otherwise() const { return decisions_ ? decisions_->parting() : ""; }
  bool repeats_flight() const noexcept { return behaviors_ == Behaviors::saved; }
  std::uint64_t states() const noexcept { return states_; }  // that were saved, and are the same
  std::int64_t begun_ns() const noexcept { return begun_ns_; }
  // Over all computed signals of all ticks.
  std::uint64_t state_hash() const noexcept { return hash_.value(); }
  const std::vector<RunFault>& faults() const noexcept { return faults_; }
  Assembly& assembly() noexcept { return assembly_; }
  RunLog& log() noexcept { return log_; }
  const RunLog& log() const noexcept { return log_; }
  std::int64_t time_ns() const noexcept { return taken_.time_ns; }  // of the last tick

 private:
  bool begin();
  void find_foreign_signals();
  void begin_from_state();
  bool repeat_tick(const TickTaken& taken);
  bool hand_down(std::size_t storage, std::int64_t number);
  void compare_state();
  void note_objects();
  void compare(const TickTaken& taken);
  void feed(const TickTaken& taken);
  bool feed_commands(std::uint32_t waiting);
  bool feed_next();
  bool is_old(const BehaviorInput& input) const noexcept;
  void show(const std::vector<RunObserver*>& observers);
  void add_hash(std::span<const double> row) noexcept;
  void take_faults(const std::vector<RunObserver*>& observers, std::int64_t time_ns);
  bool plays() const noexcept { return behaviors_ > Behaviors::none; }
  bool leads() const noexcept { return behaviors_ == Behaviors::leading || behaviors_ == Behaviors::tested; }
  bool led() const noexcept { return leads() && !parting_.empty(); }
  void repeat_behaviors(std::uint64_t until_tick);
  bool read_behavior_tick();
  void repeat_behavior_tick();
  void write_file(const BehaviorInput& input);
  void repeat_decisions();
  void ask_again(const BehaviorInput& input);
  std::filesystem::path moved(const std::filesystem::path& file) const;
  void send_again(const BehaviorInput& input);
  bool next_event(std::string& text);
  void compare_events();
  void part(const std::string& what);
  std::string place() const;

  void sent(std::span<const Command> batch, bool in_tick) noexcept override;
  double parameter(double newest) noexcept override;
  bool time_is_over(bool (*over)(void*) noexcept, void* budget) noexcept override;

  const UnpackedInputs& unpacked_;
  std::string recorded_root_;
  Behaviors behaviors_;
  EventLog said_;
  RunLog log_{{&said_}, 1000};
  PlantExchange link_;
  Assembly assembly_;
  BehaviorEngine engine_;
  HandOvers hand_overs_;
  std::unique_ptr<RepeatedDecisions> decisions_;
  std::vector<double> foreign_;
  TickReader ticks_read_;
  std::vector<std::pair<SignalId, std::uint32_t>> foreign_signals_;  // of this run, of the record
  RecordFiles compared_;
  std::uint64_t compared_before_ = 0;  // ticks, in earlier files
  std::unique_ptr<RecordComparison> comparison_;
  BehaviorInputReader commands_read_, behaviors_read_;
  // Of a flight record:
  StateReader states_read_;
  BehaviorInputReader handed_read_;
  std::vector<std::int64_t> handed_;    // by storage: the last value that was read
  std::vector<bool> stepped_;           // by object, since the state
  std::uint32_t last_transaction_ = 0;  // that is in the state or was given to the engine
  std::uint64_t states_ = 0;
  std::int64_t begun_ns_ = 0;
  TopicReader events_read_;
  TickTaken taken_;
  std::optional<TakenTick> next_behaviors_;
  bool behaviors_end_ = false, out_of_commands_ = false;
  std::size_t sent_ = 0;  // in the inputs of next_behaviors_: what was sent before has been compared
  // Batches of the record's commands: given to the control engine, and sent in the behavior ticks before.
  std::uint64_t fed_ = 0, sent_before_ = 0;
  JoystickState joystick_{};
  SeenEntries seen_{};
  std::uint64_t ticks_ = 0, behavior_ticks_ = 0, commands_ = 0, events_ = 0;
  std::string parting_;
  StateHash hash_;
  std::vector<bool> hashed_;  // signals
  std::vector<RunFault> faults_;
};

}  // namespace kadans
