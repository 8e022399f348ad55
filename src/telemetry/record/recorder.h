// Records a run into an MCAP file and into the memory of a flight recorder: rows of signals from the control thread,
// events from the behavior thread, faults from the supervisor.
//
// The control thread only copies its row into a ring buffer. Another thread calls drain(), which passes the rows to the
// open file (record_writer.h) and to the flight recorder. When the ring is full because nobody drains it, rows are
// dropped; when the disk fails, rows are lost. Both are counted, and drops are also noted in the record itself. The
// sequence number of a message is its tick, so a gap is visible. A lockstep loop that drains after each tick needs no
// ring: the row waits where it is.
//
// Threads: record() control thread; events() behavior thread; fault() supervisor thread; counters any thread; all
// others the draining thread.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/tick/record_sink.h"
#include "event_log.h"
#include "flight_recorder.h"
#include "input_stream.h"
#include "kadans/exchange/ring.h"
#include "record_writer.h"
#include "recorded_inputs.h"

namespace kadans {

class Recorder final : public RecordSink {
 public:
  enum class Wait : std::uint8_t {
    in_ring,   // until another thread drains
    in_place,  // the row that record() is given stays until drain(), which is called after each tick on its thread
  };

  // Make it before the loop, when all signals are declared. The table must outlive it.
  explicit Recorder(const SignalTable& signals, const RecorderSettings& settings = {},
                    const FlightSettings& flight = {}, Wait wait = Wait::in_ring);
  explicit Recorder(SignalTable&&, const RecorderSettings& = {}, const FlightSettings& = {},
                    Wait = Wait::in_ring) = delete;

  // Before the first row, of a recorder with a ring: the inputs of the run are kept, too. They must outlive the
  // recorder.
  struct Inputs {
    std::unique_ptr<InputPieces> pieces = {};  // nullptr: they are not kept
    RecordedInputs* behaviors = nullptr;
    RecordedInputs* decisions = nullptr;  // of the supervisor's thread, for files alone
    bool in_files = true;
    EngineStates* states = nullptr;  // for the flight recorder, if its settings want inputs
  };
  void record_inputs(Inputs inputs);

  // Replaces an existing file. False: error() says why. After close() another file may be opened.
  [[nodiscard]] bool open(const std::string& path);
  // Completes the open file, whole or failed, and opens another in which the following rows go on: none is lost between
  // the two. Other threads may record meanwhile. False: error() says why.
  [[nodiscard]] bool go_on_in(const std::string& path);
  // The file, for its descriptions: after open().
  RecordWriter& file() noexcept { return *file_; }
  // Has an effect only while a file is open.
  void timing(const std::string& json, std::int64_t time_ns);

  void record(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept override;
  LineSink& events() noexcept { return events_; }
  void fault(const Fault& fault) noexcept { (void)faults_.try_push(fault); }

  // Writes all waiting rows, events and faults; the file grows chunk by chunk. False once the file has failed; the ring
  // is still emptied.
  [[nodiscard]] bool drain();
  // Drains, and completes the file. Without a flight recorder, no other thread may record during this call.
  [[nodiscard]] bool close();
  // nullptr when there is no flight recorder.
  FlightRecorder* flight() noexcept { return flight_.get(); }

  bool is_open() const noexcept { return file_->is_open(); }
  const std::string& error() const noexcept { return file_->error(); }
  std::uint64_t file_bytes() const noexcept { return file_->file_bytes(); }
  std::uint64_t rows() const noexcept { return rows_; }  // rows drained while a file was open
  std::uint64_t lost() const noexcept { return lost_; }  // of these rows, not written because the file had failed
  std::uint32_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }  // the ring was full
  std::uint32_t dropped_events() const noexcept { return events_.dropped(); }

 private:
  // 2 MB each: one second of 260 signals at 1 kHz, and what their ticks took from outside.
  using Rows = Ring<double, std::size_t{1} << 18U>;
  static constexpr std::size_t head_size = 2;  // tick and time, bit for bit
  static constexpr std::int64_t end_of_time_ns = std::numeric_limits<std::int64_t>::max();

  void complete();
  bool open_new(const std::string& path);
  bool begin_file(const std::string& path);
  void take_row();
  void put_row(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  bool push(std::span<const double> head, std::span<const double> row) noexcept;
  void take_inputs(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  void put_inputs();
  void take_behavior_inputs();
  void take_events(std::int64_t until_ns);
  void take_faults();
  void write_event(const Event& event);
  void report_drops();

  const SignalTable& signals_;
  std::size_t signal_count_;
  RecorderSettings settings_;
  std::unique_ptr<RecordWriter> file_;
  std::unique_ptr<FlightRecorder> flight_;
  std::uint64_t stride_ = 0;  // ticks between two rows that are needed; 0: none
  Inputs inputs_;
  EventSorter sorter_;
  std::unique_ptr<InputEncoder> encoder_;  // of the open file
  std::size_t word_count_ = 0;
  std::vector<std::uint64_t> words_;
  ByteWriter message_, for_file_, for_flight_;
  // The second is there when files hold inputs; for the flight recorder alone they stand behind the rows.
  // Neither when rows wait in place.
  std::unique_ptr<Rows> ring_, inputs_ring_;
  struct {
    std::uint64_t tick = 0;
    std::int64_t time_ns = 0;
    std::span<const double> row;  // empty: none waits
  } in_place_;
  std::vector<std::span<const double>> pushed_;  // a row with its inputs
  std::atomic<std::uint32_t> dropped_{0};
  EventLog events_;
  Ring<Fault, 256> faults_;

  bool opened_ = false;
  std::vector<double> row_;
  Event event_;
  std::uint64_t rows_ = 0, lost_ = 0, last_tick_ = 0;
  std::int64_t last_time_ns_ = 0, period_ns_ = 0;
  std::uint32_t reported_drops_ = 0;
};

}  // namespace kadans
