#include "flight_memory.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>

#include <zstd.h>

namespace kadans {
namespace {

constexpr int compression_level = 1;

// `value_of(row)`, as differences, the lowest bytes of all rows first. Returns what is behind.
template <std::unsigned_integral T, typename Value>
std::byte* put_column(std::byte* to, std::size_t rows, Value value_of) {
  T before = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const T value = value_of(row);
    const T step = static_cast<T>(value - before);
    before = value;
    for (std::size_t byte = 0; byte < sizeof(T); ++byte)
      to[byte * rows + row] = static_cast<std::byte>(step >> (8 * byte) & 0xffU);
  }
  return to + rows * sizeof(T);
}

template <std::unsigned_integral T, typename Take>
const std::byte* take_column(const std::byte* from, std::size_t rows, Take take) {
  T value = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    T step = 0;
    for (std::size_t byte = 0; byte < sizeof(T); ++byte)
      step = static_cast<T>(step | static_cast<T>(std::to_integer<T>(from[byte * rows + row]) << (8 * byte)));
    value = static_cast<T>(value + step);
    take(row, value);
  }
  return from + rows * sizeof(T);
}

}  // namespace

void FlightMemory::ZstdDelete::operator()(ZSTD_CCtx_s* context) const noexcept { ZSTD_freeCCtx(context); }

FlightMemory::FlightMemory(std::size_t signals, const FlightSettings& settings)
    : signals_(signals),
      kept_ns_(std::llround(settings.kept_s * 1e9)),
      zstd_(ZSTD_createCCtx()),
      store_(settings.bytes),
      planes_(block_rows * (signals * sizeof(float) + 2 * sizeof(std::uint64_t))),
      packed_(ZSTD_compressBound(planes_.size())) {
  ticks_.reserve(block_rows);
  times_.reserve(block_rows);
  values_.reserve(block_rows * signals);
}

FlightMemory::~FlightMemory() = default;

void FlightMemory::add(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) {
  ticks_.push_back(tick);
  times_.push_back(static_cast<std::uint64_t>(time_ns));
  for (const double value : row.first(signals_)) values_.push_back(static_cast<float>(value));
  if (ticks_.size() == block_rows) seal();
}

void FlightMemory::seal() {
  const std::size_t rows = ticks_.size();
  if (rows == 0) return;
  std::byte* to = put_column<std::uint64_t>(planes_.data(), rows, [&](std::size_t row) { return ticks_[row]; });
  to = put_column<std::uint64_t>(to, rows, [&](std::size_t row) { return times_[row]; });
  for (std::size_t i = 0; i < signals_; ++i) {
    to = put_column<std::uint32_t>(
        to, rows, [&](std::size_t row) { return std::bit_cast<std::uint32_t>(values_[row * signals_ + i]); });
  }
  const auto size = static_cast<std::size_t>(to - planes_.data());
  const std::size_t packed =
      ZSTD_compressCCtx(zstd_.get(), packed_.data(), packed_.size(), planes_.data(), size, compression_level);
  const auto last_ns = static_cast<std::int64_t>(times_.back());
  ticks_.clear();
  times_.clear();
  values_.clear();
  if (ZSTD_isError(packed) != 0 || packed > store_.size()) return;  // out of memory
  while (!blocks_.empty() && blocks_.front().last_ns < last_ns - kept_ns_) blocks_.pop_front();
  make_room(packed);
  std::copy_n(packed_.begin(), packed, store_.begin() + static_cast<std::ptrdiff_t>(head_));
  blocks_.push_back({head_, packed, rows, last_ns});
  head_ += packed;
  ++end_;
}

// The oldest stand behind the head, in their order, then those at the front of the store.
void FlightMemory::make_room(std::size_t size) {
  const auto drop_while = [&](auto in_the_way) {
    while (!blocks_.empty() && in_the_way(blocks_.front())) blocks_.pop_front();
  };
  if (store_.size() - head_ < size) {
    drop_while([&](const Block& block) { return block.offset >= head_; });
    head_ = 0;
  }
  drop_while([&](const Block& block) { return block.offset < head_ + size && block.offset + block.size > head_; });
}

bool FlightMemory::read(std::uint64_t block, Rows& rows) const {
  if (block < first() || block >= end_) return false;
  const Block& found = blocks_[static_cast<std::size_t>(block - first())];
  std::vector<std::byte> planes(planes_.size());
  const std::size_t size = ZSTD_decompress(planes.data(), planes.size(), store_.data() + found.offset, found.size);
  if (ZSTD_isError(size) != 0) return false;
  rows.ticks.resize(found.rows);
  rows.times_ns.resize(found.rows);
  rows.values.resize(found.rows * signals_);
  const std::byte* from = take_column<std::uint64_t>(
      planes.data(), found.rows, [&](std::size_t row, std::uint64_t tick) { rows.ticks[row] = tick; });
  from = take_column<std::uint64_t>(from, found.rows, [&](std::size_t row, std::uint64_t time_ns) {
    rows.times_ns[row] = static_cast<std::int64_t>(time_ns);
  });
  for (std::size_t i = 0; i < signals_; ++i) {
    from = take_column<std::uint32_t>(from, found.rows, [&](std::size_t row, std::uint32_t bits) {
      rows.values[row * signals_ + i] = static_cast<double>(std::bit_cast<float>(bits));
    });
  }
  return true;
}

std::size_t FlightMemory::packed_bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Block& block : blocks_) bytes += block.size;
  return bytes;
}

}  // namespace kadans
