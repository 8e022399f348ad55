// Reads the inputs of a run out of its record (telemetry/record/input_stream.h), also through the files in which the
// record went on: tick by tick with the recorded signals, and event by event of the behavior thread.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/input_stream.h"
#include "telemetry/record/recorded_inputs.h"

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
  // Of the tick that next() gave: all signals by number, NaN where the record has none; its inputs as they are stored.
  std::span<const double> row() const noexcept { return row_; }
  const InputLayout& layout() const noexcept { return *layout_; }
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

// The saved states of the control engine in a flight record, in their order.
class StateReader {
 public:
  explicit StateReader(const std::string& record) : reader_(record, {states_topic}) {}
  // The state that waits; nullptr: there is none, or it is damaged.
  const EngineStates::Saved* get();
  void drop() noexcept { read_ = false; }

 private:
  TopicReader reader_;
  McapMessage message_;
  std::vector<std::int64_t> found_;
  EngineStates::Saved saved_;
  bool read_ = false, there_ = false;
};

// What the behavior thread took, or the one that decides, event by event.
class BehaviorInputReader {
 public:
  // `any_first`: of a flight record, whose events begin with any number.
  explicit BehaviorInputReader(const std::string& record, bool any_first = false,
                               const char* topic = behavior_inputs_topic)
      : reader_(record, {topic}), any_first_(any_first) {}
  [[nodiscard]] bool next(BehaviorInput& input);
  std::span<const std::byte> bytes() const noexcept;  // of the event that next() gave, as it is stored
  bool damaged() const noexcept { return damaged_; }

 private:
  TopicReader reader_;
  std::vector<std::byte> message_;
  std::size_t began_ = 0, at_ = 0;
  std::uint32_t expected_ = 0;
  bool any_first_, damaged_ = false;
};

// What such a thread took up to the end of one of its ticks, and how far a repetition of the tick has used it up.
class TakenTick {
 public:
  // Replaces it by the next one. False: the record ends before that tick does; begun() says whether it began.
  [[nodiscard]] bool read(BehaviorInputReader& reader);
  bool begun() const noexcept { return begun_; }
  std::uint64_t snapshot() const noexcept { return snapshot_; }  // as BehaviorInput has it
  const std::vector<BehaviorInput>& inputs() const noexcept { return inputs_; }

  // Of decisions: from now on scripts get what they took while the input with this index, which was asked, was carried
  // out. What decided told so afterwards, all else before.
  void turn_to(std::size_t asked) noexcept;

  // What scripts get in the repetition, in their order: a parameter, and whether their time ended at this look.
  double parameter(double newest) noexcept;
  bool time_is_over(std::uint32_t look) noexcept;

 private:
  std::vector<BehaviorInput> inputs_;
  std::uint64_t snapshot_ = 0;
  bool begun_ = false;
  std::size_t moment_ = 0;  // those before are used up
  std::size_t end_ = 0;     // and those from here on are of something else
};

}  // namespace kadans
