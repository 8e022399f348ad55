// The memory of a flight recorder: the newest rows of a run, compressed, in a fixed number of bytes.
//
// Rows are collected in blocks of 100 (0.1 s at 1 kHz). A full block is transposed: it stores signal by signal. Each
// value is in single precision, as the difference of its bits from the bits of the row before; the lowest bytes of all
// rows come first, then the next bytes. So a signal that stands still or moves slowly becomes mostly zeros, and zstd
// compresses them: 30 s of TULip's 220 signals at 1 kHz take 7 MB, a third of a record. Packed blocks lie in a ring
// buffer of bytes, and the oldest blocks are dropped. Ticks and times keep all their bits.
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
  std::size_t bytes = std::size_t{8} << 20U;  // for packed rows; when they do not suffice, less than kept_s is kept
};

class FlightMemory {
 public:
  struct Rows {
    std::vector<std::uint64_t> ticks;
    std::vector<std::int64_t> times_ns;
    std::vector<double> values;  // row by row
  };

  // Allocates its memory in the constructor.
  FlightMemory(std::size_t signals, const FlightSettings& settings);
  ~FlightMemory();
  FlightMemory(const FlightMemory&) = delete;
  FlightMemory& operator=(const FlightMemory&) = delete;

  void add(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  void seal();  // ends the block

  // Blocks are numbered from 0; those in [first(), end()) are stored.
  std::uint64_t first() const noexcept { return end_ - blocks_.size(); }
  std::uint64_t end() const noexcept { return end_; }
  // False when the block is no longer stored, or its memory is damaged.
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
  std::size_t head_ = 0;  // offset of the next block
  std::deque<Block> blocks_;
  std::uint64_t end_ = 0;
  std::vector<std::uint64_t> ticks_, times_;  // of the open block
  std::vector<float> values_;                 // row by row
};

}  // namespace kadans
