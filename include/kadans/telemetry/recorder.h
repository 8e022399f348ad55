// Records a run: rows of signals from the control thread, events from the behavior thread, into one MCAP file.
//
// The control thread copies its row into a ring and returns; that is all it pays. Another thread, or the lockstep loop
// between ticks, calls drain(), which sorts the rows into topics and writes the file. When the ring is full because
// nobody drains, rows are dropped; when the disk fails, rows are lost; both are counted, the drops also told in the
// record itself, and the sequence number of a message is its tick, so a gap shows.
//
// Threads: record() control; events() behavior; everything else the one that drains. The counters: any.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kadans/engine/record_sink.h"
#include "kadans/exchange/ring.h"
#include "kadans/telemetry/event_log.h"
#include "kadans/telemetry/mcap_writer.h"
#include "kadans/telemetry/run_inputs.h"
#include "kadans/telemetry/signal_topics.h"

namespace kadans {

struct RecorderSettings {
  struct Topic {
    std::string name;               // first part of its signals' names: "joint"
    std::uint32_t every_ticks = 1;  // 0 = not recorded
  };
  std::uint32_t every_ticks = 1;  // of the topics that are not named
  std::vector<Topic> topics = {};
  Precision precision = Precision::full;
  McapSettings file = {};
};

// Of /description, as JSON Schema.
extern const char* const description_schema;

class Recorder final : public RecordSink {
 public:
  // Before the loop, when all signals are declared. Throws std::invalid_argument on a topic that is not there.
  explicit Recorder(const SignalTable& signals, const RecorderSettings& settings = {});

  // False: error() says why. Replaces a file of that name. After close() another one may be opened.
  [[nodiscard]] bool open(const std::string& path);
  // After open(), before the first row: what is needed to make this run again.
  [[nodiscard]] bool describe_run(const RunInputs& inputs);
  // After open(). Facts under a name of their own: how the run ended.
  [[nodiscard]] bool describe(const std::string& name, const TextMap& facts);
  // After open(). Attaches the URDF and publishes it on /robot_description, where viewers look for it.
  [[nodiscard]] bool describe_robot(const std::string& name, const std::string& urdf, std::int64_t time_ns);
  // After open(): what remote/run_description.h makes, on /description.
  [[nodiscard]] bool describe_parts(const std::string& description, std::int64_t time_ns);

  void record(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept override;
  void warm() noexcept override { ring_->warm(head_size + signal_count_); }
  BehaviorLog& events() noexcept { return events_; }

  // Writes what waits; the file gets it chunk by chunk. False once the file has failed: the ring is emptied all the
  // same.
  [[nodiscard]] bool drain();
  // Drains and completes the file. Nothing may be recorded meanwhile.
  [[nodiscard]] bool close();

  const std::string& error() const noexcept { return file_->error(); }
  std::uint64_t file_bytes() const noexcept { return file_->file_bytes(); }
  std::uint64_t rows() const noexcept { return rows_; }  // drained
  std::uint64_t lost() const noexcept { return lost_; }  // of them, not written because the file had failed
  std::uint32_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }  // the ring was full
  std::uint32_t dropped_events() const noexcept { return events_.dropped(); }

 private:
  // 4 MB: one second at 1 kHz of 522 signals.
  using Rows = Ring<double, std::size_t{1} << 19U>;
  static constexpr std::size_t head_size = 2;  // tick and time, bit for bit
  static constexpr std::int64_t end_of_time_ns = std::numeric_limits<std::int64_t>::max();

  struct Topic {
    SignalTopic signals;
    std::uint32_t every_ticks = 1;
    std::uint16_t channel = 0;
  };

  void choose_topics(const SignalTable& signals, const RecorderSettings& settings);
  void write_row(std::uint64_t tick, std::int64_t time_ns);
  void write_events(std::int64_t until_ns);
  void write_event(const Event& event);
  void report_drops();
  void start_anew();

  std::size_t signal_count_;
  Precision precision_;
  std::vector<Topic> topics_;
  std::uint64_t stride_ = 0;  // ticks between rows that any topic wants; 0 = none
  std::unique_ptr<Rows> ring_;
  std::atomic<std::uint32_t> dropped_{0};
  EventLog events_;

  McapSettings file_settings_;
  std::unique_ptr<McapWriter> file_;
  bool opened_ = false;
  std::uint16_t log_channel_ = 0, transition_channel_ = 0;
  std::vector<double> values_;      // of one message
  std::vector<std::byte> payload_;  // the same, encoded
  Event event_;
  std::uint64_t rows_ = 0, lost_ = 0;
  std::int64_t last_time_ns_ = 0;
  std::uint32_t reported_drops_ = 0;
};

}  // namespace kadans
