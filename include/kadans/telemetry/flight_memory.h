// The newest rows of a run, packed into memory of a fixed size: what a flight recorder keeps.
//
// Rows gather in a block of 0.1 s. A full block is turned: by signal, each value in single precision as the difference
// of its bits from those of the row before, first the lowest bytes of all rows, then the next. What stands still or
// moves slowly so becomes zeros, and zstd does the rest: 30 s of TULip's 220 signals at 1 kHz take 7 MB, a third of
// what a record would. Packed blocks lie in a ring of bytes, the oldest make way. Ticks and times keep all their bits.
//
// One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

struct ZSTD_CCtx_s;

namespace kadans {

struct FlightSettings {
  double kept_s = 0;                          // 0: no flight recorder
  std::size_t bytes = std::size_t{8} << 20U;  // of packed rows; less than kept_s stays where they do not suffice
};

class FlightMemory {
 public:
  struct Rows {
    std::vector<std::uint64_t> ticks;
    std::vector<std::int64_t> times_ns;
    std::vector<double> values;  // row by row
  };

  // Takes its memory at once.
  FlightMemory(std::size_t signals, const FlightSettings& settings);
  ~FlightMemory();
  FlightMemory(const FlightMemory&) = delete;
  FlightMemory& operator=(const FlightMemory&) = delete;

  void add(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  void seal();  // ends the block

  // Blocks count from 0; those from first() to end() are there.
  std::uint64_t first() const noexcept { return end_ - blocks_.size(); }
  std::uint64_t end() const noexcept { return end_; }
  // False: it is there no more, or memory is damaged.
  [[nodiscard]] bool read(std::uint64_t block, Rows& rows) const;
  std::size_t packed_bytes() const noexcept;

 private:
  static constexpr std::size_t block_rows = 100;
  struct Block {
    std::size_t offset, size, rows;
    std::int64_t last_ns;
  };
  struct ZstdDelete {
    void operator()(ZSTD_CCtx_s* context) const noexcept;
  };

  void make_room(std::size_t size);

  std::size_t signals_;
  std::int64_t kept_ns_;
  std::unique_ptr<ZSTD_CCtx_s, ZstdDelete> zstd_;
  std::vector<std::byte> store_, planes_, packed_;
  std::size_t head_ = 0;  // where the next block goes
  std::deque<Block> blocks_;
  std::uint64_t end_ = 0;
  std::vector<std::uint64_t> ticks_, times_;  // of the open block
  std::vector<float> values_;                 // row by row
};

}  // namespace kadans
