// Writes one record as an MCAP file: rows of signals by topics, events, and messages that viewers understand without
// configuration.
//
// Each signal has its own rate, and topics are split by rates (signal_topics.h). A topic whose values stand still is
// written only every standstill_ticks. When they change, the last row before the change is written first, so that a
// line drawn through the messages is the signal. A missing row means that the values are those of the row before. The
// sequence number of a message is its tick.
//
// One thread at a time; a writer writes one file. Once the file has failed, calls return false and error() says why.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "event_log.h"
#include "input_stream.h"
#include "kadans/signal/parameter.h"
#include "run_inputs.h"
#include "signal_topics.h"
#include "telemetry/mcap/mcap_writer.h"
#include "viewer_messages.h"

namespace kadans {

struct RecorderSettings {
  std::vector<std::uint32_t> every_ticks = {};  // for each signal, 0: not recorded; empty: all in each tick
  std::uint32_t standstill_ticks = 100;         // 1: write each row, whether it changed or not
  Precision precision = Precision::full;
  McapSettings file = {};
  ViewerSubjects subjects = {};  // empty: no channels for viewers
  std::uint32_t viewer_every_ticks = 20;
  const ParameterTable* parameters = nullptr;  // must outlive the record; null: not recorded
};

class RecordWriter {
 public:
  RecordWriter(const SignalTable& signals, const RecorderSettings& settings);

  // Replaces an existing file.
  [[nodiscard]] bool open(const std::string& path);
  // After open() and before the first row. Writes what is needed to repeat this run.
  [[nodiscard]] bool describe_run(const RunInputs& inputs) { return write_inputs(file_, inputs); }
  // After open(). Writes facts under a name, such as how the run ended.
  [[nodiscard]] bool describe(const std::string& name, const TextMap& facts) { return file_.add_metadata(name, facts); }
  // After open(). Attaches the URDF and publishes it on /robot_description, where viewers look for it.
  [[nodiscard]] bool describe_robot(const std::string& name, const std::string& urdf, std::int64_t time_ns);
  // The same for a further robot of the world, on /ROBOT/robot_description alone.
  [[nodiscard]] bool describe_other(const std::string& robot, const std::string& urdf, std::int64_t time_ns);
  // After open(). Writes the text that remote/instance/run_description.h makes on /description.
  [[nodiscard]] bool describe_parts(const std::string& description, std::int64_t time_ns);

  // `row` holds all signals in the order of the table. Ticks and times must not run backwards.
  [[nodiscard]] bool row(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  [[nodiscard]] bool event(const Event& event);
  [[nodiscard]] bool fault(const Fault& fault, std::int64_t time_ns);
  // After open(), once, when the file holds inputs; then what input_stream.h makes of them.
  void add_inputs(const InputLayout& layout);
  [[nodiscard]] bool inputs(std::span<const std::byte> message, std::int64_t time_ns);
  [[nodiscard]] bool behavior_inputs(std::span<const std::byte> message, std::int64_t time_ns);
  [[nodiscard]] bool decision_inputs(std::span<const std::byte> message, std::int64_t time_ns);
  [[nodiscard]] bool state(std::span<const std::byte> message, std::int64_t time_ns);  // in a flight record
  [[nodiscard]] bool timing(const std::string& json, std::int64_t time_ns);
  [[nodiscard]] bool close();

  bool is_open() const noexcept { return file_.is_open(); }
  const std::string& error() const noexcept { return file_.error(); }
  std::uint64_t file_bytes() const noexcept { return file_.file_bytes(); }
  std::uint64_t stride() const noexcept { return stride_; }  // ticks between rows that the file needs; 0: none

 private:
  struct Topic {
    SignalTopic signals;
    std::uint16_t channel = 0;
    std::vector<std::byte> payload = {};  // the last message that was written
    std::uint64_t tick = 0;               // its tick
    bool written = false;
    bool waits = false;  // unwritten rows with the same values followed; the last one:
    std::uint64_t waiting_tick = 0;
    std::int64_t waiting_ns = 0;
  };

  bool put(Topic& topic, std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  bool put_last(const Topic& topic, std::uint64_t tick, std::int64_t time_ns);
  bool put_viewers(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  bool put_parameters(std::int64_t time_ns);
  std::uint16_t add(const ViewerChannel& channel);

  const SignalTable& signals_;
  RecorderSettings settings_;
  std::vector<Topic> topics_;
  ViewerMessages viewers_;
  std::vector<std::uint16_t> viewer_channels_;
  std::uint64_t stride_ = 0;
  McapWriter file_;
  std::uint16_t log_ = 0, transitions_ = 0, active_ = 0, emitted_ = 0, faults_ = 0, timing_ = 0,
                parameters_channel_ = 0, inputs_ = 0, behavior_inputs_ = 0, decision_inputs_ = 0, states_ = 0;
  std::vector<double> parameters_;  // the values that were last written
  ByteWriter message_;
};

}  // namespace kadans
