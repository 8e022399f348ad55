// One record: rows of signals by topics, what viewers understand without configuration, events, in one MCAP file.
//
// Each signal has its rate, topics are split by rates (signal_topics.h). A topic that stands still is written again
// only each standstill_ticks; when it moves on, its last row before comes first, so that a line through the messages is
// the signal, and a row that is not there holds the values of the one before. The sequence number of a message is its
// tick.
//
// One thread at a time; one file a writer. Calls return false once the file has failed: error() says why.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kadans/signal/parameter.h"
#include "kadans/telemetry/event_log.h"
#include "kadans/telemetry/mcap_writer.h"
#include "kadans/telemetry/run_inputs.h"
#include "kadans/telemetry/signal_topics.h"
#include "kadans/telemetry/viewer_messages.h"

namespace kadans {

struct RecorderSettings {
  std::vector<std::uint32_t> every_ticks = {};  // by signal, 0 = not recorded; none given: all in each tick
  std::uint32_t standstill_ticks = 100;         // 1: each row, whether it changed or not
  Precision precision = Precision::full;
  McapSettings file = {};
  ViewerSubjects subjects = {};  // none: no channels for viewers
  std::uint32_t viewer_every_ticks = 20;
  const ParameterTable* parameters = nullptr;  // must outlive the record; null: not recorded
};

// Of /description, as JSON Schema.
extern const char* const description_schema;

class RecordWriter {
 public:
  RecordWriter(const SignalTable& signals, const RecorderSettings& settings);

  // Replaces a file of that name.
  [[nodiscard]] bool open(const std::string& path);
  // After open(), before the first row: what is needed to make this run again.
  [[nodiscard]] bool describe_run(const RunInputs& inputs) { return write_inputs(file_, inputs); }
  // After open(). Facts under a name of their own: how the run ended.
  [[nodiscard]] bool describe(const std::string& name, const TextMap& facts) { return file_.add_metadata(name, facts); }
  // After open(). Attaches the URDF and publishes it on /robot_description, where viewers look for it.
  [[nodiscard]] bool describe_robot(const std::string& name, const std::string& urdf, std::int64_t time_ns);
  // After open(): what remote/run_description.h makes, on /description.
  [[nodiscard]] bool describe_parts(const std::string& description, std::int64_t time_ns);

  // All signals, in the order of the table. Ticks and times do not run backwards.
  [[nodiscard]] bool row(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  [[nodiscard]] bool event(const Event& event);
  [[nodiscard]] bool fault(const Fault& fault, std::int64_t time_ns);
  [[nodiscard]] bool timing(const std::string& json, std::int64_t time_ns);
  [[nodiscard]] bool close();

  bool is_open() const noexcept { return file_.is_open(); }
  const std::string& error() const noexcept { return file_.error(); }
  std::uint64_t file_bytes() const noexcept { return file_.file_bytes(); }
  std::uint64_t stride() const noexcept { return stride_; }  // ticks between rows that are wanted; 0 = none

 private:
  struct Topic {
    SignalTopic signals;
    std::uint16_t channel = 0;
    std::vector<double> values = {};  // as last written
    std::uint64_t tick = 0;           // likewise
    bool written = false;
    bool waits = false;  // the same values came again since, last then:
    std::uint64_t waiting_tick = 0;
    std::int64_t waiting_ns = 0;
  };

  bool put(Topic& topic, std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  bool put_values(const Topic& topic, std::uint64_t tick, std::int64_t time_ns);
  bool put_viewers(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  bool put_parameters(std::int64_t time_ns);
  std::uint16_t add_json(const char* topic, const char* schema, const char* text);

  RecorderSettings settings_;
  std::vector<Topic> topics_;
  ViewerMessages viewers_;
  std::vector<std::uint16_t> viewer_channels_;
  std::uint64_t stride_ = 0;
  McapWriter file_;
  std::uint16_t log_ = 0, transitions_ = 0, faults_ = 0, timing_ = 0, parameters_channel_ = 0;
  std::vector<double> parameters_;  // as last written
  std::vector<double> values_;      // of one message
  std::vector<std::byte> payload_;  // the same, encoded
  ByteWriter message_;
};

}  // namespace kadans
