// Repeats a run on threads from the inputs in its record (telemetry/record/input_stream.h), on one thread and on
// virtual time: the engines get what they got, in the order in which they got it, and every recorded signal, command,
// event of a chart and fault is compared.
//
// The record is read by several readers at once, because the threads ran beside each other: what the behavior thread
// took lies in the file before or after the ticks that it saw. A control tick gets the commands that were recorded. The
// behaviors that are repeated send theirs, which are compared with these.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/assembly.h"
#include "input_files.h"
#include "kadans/signal/state_hash.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/reading/record_comparison.h"
#include "telemetry/record/event_log.h"
#include "telemetry/record/input_stream.h"

namespace kadans {

// A record, and the files in which it went on.
class RecordFiles {
 public:
  explicit RecordFiles(const std::string& record);

  McapReader& reader() noexcept { return *reader_; }
  const McapReader& reader() const noexcept { return *reader_; }
  const std::string& file() const noexcept { return file_; }
  // After the last message of a file: to the next one. False: there is none.
  [[nodiscard]] bool go_on();

 private:
  std::string file_;
  std::unique_ptr<McapReader> reader_;
  std::set<std::string> read_;  // names of the files before
};

// The messages of some topics of a record, in the order of its files.
class TopicReader {
 public:
  TopicReader(const std::string& record, std::vector<std::string> topics);
  // False at the end, or where the record is damaged.
  [[nodiscard]] bool next(McapMessage& message);

 private:
  RecordFiles files_;
  std::vector<std::string> topics_;
};

// The ticks of a record with their inputs and the recorded signals.
class TickReader final : private SignalBits {
 public:
  explicit TickReader(const std::string& record);

  // False at the end; then problem() says why it ends there, "": it is the proper end.
  [[nodiscard]] bool next(TickTaken& taken);
  // Of the tick that next() gave; NaN where the record has none.
  double signal(std::uint32_t number) const;
  const std::vector<std::string>& signals() const noexcept { return names_; }  // by number
  const std::string& problem() const noexcept { return problem_; }

 private:
  std::optional<std::uint64_t> bits(std::uint64_t tick, std::uint32_t signal) const override;
  bool read();
  bool learn();
  void take_row(const McapMessage& message);
  bool take_inputs(const McapMessage& message);
  bool reach(std::uint64_t tick);
  bool stop(const std::string& why);

  RecordFiles files_;
  std::optional<InputLayout> layout_;
  std::unique_ptr<InputDecoder> decoder_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t> numbers_;
  std::map<std::uint16_t, std::vector<std::uint32_t>> topics_;  // numbers of the signals in its messages
  std::vector<double> values_;                                  // of one message
  std::uint64_t first_ = 0;                                     // tick of rows_.front()
  std::deque<std::vector<double>> rows_;
  std::deque<TickTaken> ticks_;
  std::optional<std::uint64_t> next_tick_;
  std::vector<double> row_;
  std::string problem_;
};

// What the behavior thread took, event by event.
class BehaviorInputReader {
 public:
  explicit BehaviorInputReader(const std::string& record) : reader_(record, {behavior_inputs_topic}) {}
  [[nodiscard]] bool next(BehaviorInput& input);
  bool damaged() const noexcept { return damaged_; }

 private:
  TopicReader reader_;
  std::vector<std::byte> message_;
  std::size_t at_ = 0;
  std::uint32_t expected_ = 0;
  bool damaged_ = false;
};

// What the behavior thread took up to the end of one of its ticks.
struct TakenByBehaviors {
  std::vector<BehaviorInput> inputs;
  std::uint64_t snapshot = 0;
};

class RepeatedRun final : private BehaviorInputs {
 public:
  // What is repeated beside the control engine.
  enum class Behaviors : std::uint8_t {
    none,      // the high levels of control objects; commands are taken from the record
    compared,  // the behaviors, whose commands are compared with those of the record
    leading    // the behaviors, and from where they first command otherwise that counts: a run with other files
  };
  // `unpacked` holds the scenario's files, and gets those that were read later; `recorded_root` was their folder in the
  // recorded run.
  RepeatedRun(const std::string& record, const ScenarioConfig& scenario, const UnpackedInputs& unpacked,
              std::string recorded_root, Behaviors behaviors);

  // `stop` is asked between ticks.
  void go(const std::function<bool()>& stop);
  // Before go(): it hears of ticks and faults, with the hash of the rows of all signals.
  void show_to(RunObserver& observer) noexcept { observer_ = &observer; }
  Assembly& assembly() noexcept { return assembly_; }
  RunLog& log() noexcept { return log_; }

  const RecordComparison& comparison() const noexcept { return *comparison_; }
  bool same() const;
  std::uint64_t compared_ticks() const noexcept { return compared_before_ + comparison_->ticks(); }
  // What differs beside signals: the first command, event or storage. "": nothing.
  const std::string& parting() const noexcept { return parting_; }
  // Why not all of the record was repeated; "": all was.
  std::string shortened() const;
  std::uint64_t ticks() const noexcept { return ticks_; }
  std::uint64_t behavior_ticks() const noexcept { return behavior_ticks_; }
  std::uint64_t commands() const noexcept { return commands_; }
  std::uint64_t events() const noexcept { return events_; }

 private:
  bool repeat_tick(const TickTaken& taken);
  void compare(const TickTaken& taken);
  void feed(const TickTaken& taken);
  bool feed_commands(std::uint32_t waiting);
  bool feed_next();
  void show(const TickTaken& taken);
  bool led() const noexcept { return behaviors_ == Behaviors::leading && !parting_.empty(); }
  void repeat_behaviors(std::uint64_t until_tick);
  bool read_behavior_tick();
  void repeat_behavior_tick();
  void write_files();
  void ask_again(const BehaviorInput& input);
  std::filesystem::path moved(const std::filesystem::path& file) const;
  void send_again(const BehaviorInput& input);
  const BehaviorInput* next_moment(BehaviorInput::Kind kind);
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
  std::vector<double> foreign_;
  TickReader ticks_read_;
  std::vector<std::pair<SignalId, std::uint32_t>> foreign_signals_;  // of this run, of the record
  RecordFiles compared_;
  std::uint64_t compared_before_ = 0;  // ticks, in earlier files
  std::unique_ptr<RecordComparison> comparison_;
  BehaviorInputReader commands_read_, behaviors_read_;
  TopicReader events_read_;
  TickTaken taken_;
  std::optional<TakenByBehaviors> next_behaviors_;
  bool behaviors_end_ = false, out_of_commands_ = false;
  std::size_t moment_ = 0;  // in the inputs of next_behaviors_: those before are used up
  std::size_t sent_ = 0;    // the same for what was sent
  // Batches of the record's commands: given to the control engine, and sent in the behavior ticks before.
  std::uint64_t fed_ = 0, sent_before_ = 0;
  JoystickState joystick_{};
  SeenEntries seen_{};
  std::uint64_t ticks_ = 0, behavior_ticks_ = 0, commands_ = 0, events_ = 0;
  std::string parting_;
  RunObserver* observer_ = nullptr;
  StateHash rows_;  // for the observer
};

}  // namespace kadans
