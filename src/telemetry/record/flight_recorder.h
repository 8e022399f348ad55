// Flight recorder: keeps the last seconds of a run in memory, compressed, and writes them to a record when a fault
// latches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "input_stream.h"
#include "record_writer.h"

namespace kadans {

// The memory of a flight recorder: the newest rows of a run, compressed, in a fixed number of bytes.
//
// Rows are collected in blocks of 100 (0.1 s at 1 kHz). A full block is transposed: it stores signal by signal. Each
// value is in single precision, as the difference of its bits from the bits of the row before; the lowest bytes of all
// rows come first, then the next bytes. So a signal that stands still or moves slowly becomes mostly zeros, and zstd
// compresses them: 30 s of TULip's 220 signals at 1 kHz take 7 MB, a third of a record. The oldest blocks are dropped.
// Ticks and times keep all their bits.
//
// With inputs a block also holds what its ticks took from outside, what came down from the behavior thread, and the
// state of the control engine when one was saved (input_stream.h), so that what is kept can be repeated. They share the
// bytes. Where these do not suffice for both, signals are dropped first, because a repetition computes them again; a
// third of the bytes stays for them.
//
// One thread at a time.
struct FlightSettings {
  double kept_s = 0;                            // 0: no flight recorder
  std::size_t bytes = std::size_t{8} << 20U;    // for all of it; when they do not suffice, less than kept_s is kept
  std::optional<InputLayout> inputs = {};       // of a flight record
  std::vector<std::uint32_t> every_ticks = {};  // for each signal: ticks between its values; empty: all in each tick
};

class FlightMemory {
 public:
  struct Rows {
    std::vector<std::uint64_t> ticks;
    std::vector<std::int64_t> times_ns;
    std::vector<double> values;  // row by row
    // With inputs, as messages of a record: of the ticks, of the behavior thread, and states.
    std::vector<std::byte> inputs, behaviors;
    std::vector<std::vector<std::byte>> states;
    std::int64_t last_ns = 0;  // time of the last row, also when the rows are no longer stored
  };

  // Allocates its memory in the constructor.
  FlightMemory(std::size_t signals, const FlightSettings& settings);
  FlightMemory(const FlightMemory&) = delete;
  FlightMemory& operator=(const FlightMemory&) = delete;

  void add(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row,
           std::span<const std::uint64_t> inputs = {});
  void add_behavior_inputs(std::span<const std::byte> events) { behaviors_.put(events); }
  void add_state(const EngineStates::Saved& state);
  void seal();  // ends the block, which may hold no rows, only what came down after them
  // Blocks before this one are written: they go first when there is no room.
  void spare_before(std::uint64_t block) noexcept { spare_before_ = block; }

  // Blocks are numbered from 0; those in [first(), end()) are stored.
  std::uint64_t first() const noexcept { return end_ - blocks_.size(); }
  std::uint64_t end() const noexcept { return end_; }
  // Of all blocks in [first(), end()) whose signals were not dropped, also of those that read() refuses.
  std::uint64_t rows() const noexcept;
  // False when the block is no longer stored, was too large for the memory, or its memory is damaged. No rows: its
  // signals were dropped.
  [[nodiscard]] bool read(std::uint64_t block, Rows& rows) const;
  std::size_t packed_bytes() const noexcept;

 private:
  static constexpr std::size_t block_rows = 100;
  struct Part {
    std::uint32_t page = 0, size = 0;  // packed; 0: it is not there
  };
  struct Block {
    std::size_t rows = 0;
    std::int64_t last_ns = 0;
    std::uint32_t inputs = 0, behaviors = 0, states = 0;  // bytes of each
    Part taken = {}, signals = {};                        // packed: these three; the rows
    bool lost = false;                                    // too large: only the number of its rows is known
  };

  // A fixed number of bytes, in pages.
  class Store {
   public:
    explicit Store(std::size_t bytes);
    std::size_t bytes() const noexcept { return pages_.size(); }
    // Whether so many more bytes fit.
    bool has_room(std::size_t size) const noexcept { return pages_in(size) <= free_; }
    Part put(std::span<const std::byte> bytes);  // has_room(bytes.size())
    std::vector<std::byte> get(Part part) const;
    void drop(Part& part) noexcept;

   private:
    static constexpr std::size_t page_bytes = 256;
    static constexpr std::size_t pages_in(std::size_t size) noexcept { return (size + page_bytes - 1) / page_bytes; }
    std::vector<std::byte> pages_;
    std::vector<std::uint32_t> next_;  // page behind a page, of a part or of the free ones
    std::uint32_t first_free_ = 0;
    std::size_t free_ = 0;
  };

  bool pack(std::size_t bytes, Part& part);
  void drop_oldest() noexcept;
  void drop_oldest_whole() noexcept;

  std::size_t signals_;
  std::map<std::uint32_t, std::vector<SignalId>> rates_;  // the signals by the ticks between their values
  std::int64_t kept_ns_;
  Store store_;
  std::vector<std::byte> planes_;
  Packer packer_;
  std::size_t signal_bytes_ = 0;  // of all that is stored
  std::int64_t last_ns_ = 0;
  std::deque<Block> blocks_;
  std::uint64_t end_ = 0, spare_before_ = 0;
  std::vector<std::uint64_t> ticks_, times_;  // of the open block
  std::vector<float> values_;                 // row by row
  std::vector<float> held_;                   // the last row: a signal stands still between its values
  std::unique_ptr<InputEncoder> encoder_;     // nullptr: without inputs
  ByteWriter inputs_, behaviors_, states_;
};

// The recorder gets every row and event that the recorder drains, also when no record is open. When the safety.level
// of a robot rises to hold or beyond, a dump becomes due `aftermath` later, so that it shows what followed. A rise
// within kept_s after the last such rise is ignored. The caller names the file. Each step() writes a few blocks, so
// that the draining thread is not held up; meanwhile new rows go into memory. Values are in single precision.
//
// Use it on the draining thread only.
class FlightRecorder {
 public:
  // `record` says how a dump is written; its rates are ignored, those of the memory count. `signals` must outlive this
  // object.
  FlightRecorder(const SignalTable& signals, const FlightSettings& settings, const RecorderSettings& record);

  void row(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row,
           std::span<const std::uint64_t> inputs = {});
  bool takes_inputs() const noexcept { return layout_.has_value(); }
  void behavior_inputs(std::span<const std::byte> events) { memory_.add_behavior_inputs(events); }
  void state(const EngineStates::Saved& state) { memory_.add_state(state); }
  void event(const Event& event);
  void fault(const Fault& fault, std::int64_t time_ns);

  // True when a dump is due: call begin(). `at_once` does not wait for the aftermath, because the run has ended.
  bool due(bool at_once = false) const noexcept {
    return latched_ns_ && !busy() && (at_once || last_ns_ >= *latched_ns_ + aftermath_ns);
  }
  // From now on a rise of safety.level makes no dump due, because the run is ending.
  void watch_no_more() noexcept { watching_ = false; }
  // Begins a dump of the rows in memory. False: error() says why.
  [[nodiscard]] bool begin(const std::string& file);
  // The record of the dump, for its descriptions. Only while busy().
  RecordWriter& dump() noexcept { return *dump_; }
  void step();    // writes a part of the dump
  void finish();  // writes the rest of it
  bool busy() const noexcept { return dump_ != nullptr; }

  const std::string& file() const noexcept { return file_; }    // of the last dump; "": none
  const std::string& error() const noexcept { return error_; }  // of the last dump
  std::uint32_t dumps() const noexcept { return dumps_; }       // complete or failed

 private:
  static constexpr std::int64_t aftermath_ns = 1'000'000'000;
  static constexpr std::size_t events_max = 500, text_max = 300, blocks_a_step = 2;
  struct Happening {
    std::int64_t time_ns = 0;
    std::variant<Event, Fault> what;
  };

  void keep(Happening happening);
  void watch(std::int64_t time_ns, double before, double level) noexcept;
  void write_inputs();
  void write_happenings(std::int64_t until_ns);

  const SignalTable& signals_;
  RecorderSettings record_;
  std::int64_t kept_ns_;
  std::optional<InputLayout> layout_;
  FlightMemory memory_;
  std::deque<Happening> happenings_;
  struct Level {
    SignalId signal;
    double now = 0;
  };
  std::vector<Level> levels_;  // safety.level of each robot
  bool watching_ = true;
  std::int64_t last_ns_ = 0;
  std::optional<std::int64_t> latched_ns_, last_latched_ns_;

  std::unique_ptr<RecordWriter> dump_;
  std::deque<Happening> to_write_;
  std::uint64_t next_block_ = 0, end_block_ = 0;
  std::uint64_t due_rows_ = 0, written_rows_ = 0;  // of the dump
  FlightMemory::Rows rows_;
  std::string file_, error_;
  std::uint32_t dumps_ = 0;
};

}  // namespace kadans
