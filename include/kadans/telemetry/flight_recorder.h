// The last seconds of a run, always in memory, written to a record of their own when a fault latches.
//
// It sees every row and event that the recorder drains, whatever record goes on. When safety.level rises to hold or
// beyond, a dump is due `aftermath` later, so that what followed is in it; not again before as much time as is kept has
// passed. Its caller gives the file. The dump is written a few blocks a step, so that the thread that drains does not
// stay away; rows go on into memory meanwhile. Values are in single precision.
//
// One thread at a time: the one that drains.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "kadans/telemetry/flight_memory.h"
#include "kadans/telemetry/record_writer.h"

namespace kadans {

class FlightRecorder {
 public:
  // `record`: how a dump is written; its rates do not count, all signals are kept in each tick. `signals` must outlive
  // it.
  FlightRecorder(const SignalTable& signals, const FlightSettings& settings, const RecorderSettings& record);

  void row(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  void event(const Event& event);
  void fault(const Fault& fault, std::int64_t time_ns);

  // A latched fault is waiting for its file. `at_once`: what follows does not come any more.
  bool due(bool at_once = false) const noexcept {
    return latched_ns_ && !busy() && (at_once || last_ns_ >= *latched_ns_ + aftermath_ns);
  }
  // The ladder's rungs tell of no fault from here on: the run ends.
  void watch_no_more() noexcept { watching_ = false; }
  // Begins a dump of what is kept. False: error() says why.
  [[nodiscard]] bool begin(const std::string& file);
  // To be described; only while busy().
  RecordWriter& dump() noexcept { return *dump_; }
  void step();    // writes some of it
  void finish();  // all that is left
  bool busy() const noexcept { return dump_ != nullptr; }

  const std::string& file() const noexcept { return file_; }    // of the last dump; "": none
  const std::string& error() const noexcept { return error_; }  // of the last dump
  std::uint32_t dumps() const noexcept { return dumps_; }       // complete or failed
  std::size_t packed_bytes() const noexcept { return memory_.packed_bytes(); }

 private:
  static constexpr std::int64_t aftermath_ns = 1'000'000'000;
  static constexpr std::size_t events_max = 500, text_max = 300, blocks_a_step = 2;
  struct Happening {
    std::int64_t time_ns = 0;
    std::variant<Event, Fault> what;
  };

  void keep(Happening happening);
  void watch(std::int64_t time_ns, double level) noexcept;
  void write_happenings(std::int64_t until_ns);

  const SignalTable& signals_;
  RecorderSettings record_;
  std::int64_t kept_ns_;
  FlightMemory memory_;
  std::deque<Happening> happenings_;
  std::optional<SignalId> level_signal_;
  double level_ = 0;
  bool watching_ = true;
  std::int64_t last_ns_ = 0;
  std::optional<std::int64_t> latched_ns_, last_latched_ns_;

  std::unique_ptr<RecordWriter> dump_;
  std::deque<Happening> to_write_;
  std::uint64_t next_block_ = 0, end_block_ = 0;
  FlightMemory::Rows rows_;
  std::string file_, error_;
  std::uint32_t dumps_ = 0;
};

}  // namespace kadans
