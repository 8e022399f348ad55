// Bytes that came on a line, until the packets in them have been taken, and what they were. Nothing here allocates or
// throws.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace kadans {

template <std::size_t size>
class ReceiveBuffer {
 public:
  struct Counts {
    std::uint64_t packets = 0;
    std::uint64_t corrupt = 0;  // began like packets, with a wrong checksum or length
    std::uint64_t skipped = 0;  // bytes that belong to no packet
  };
  const Counts& counts() const noexcept { return counts_; }
  // Where to put bytes from outside; then tell how many. What has been dropped makes room: there is always some after
  // next() returned false.
  std::span<std::uint8_t> room() noexcept {
    std::memmove(bytes_.data(), bytes_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    return std::span(bytes_).subspan(end_);
  }
  void filled(std::size_t bytes) noexcept { end_ = std::min(end_ + bytes, size); }
  void clear() noexcept { begin_ = end_ = 0; }  // forgets what is here: a new exchange begins

 protected:
  ~ReceiveBuffer() = default;
  // What is here; it holds until room().
  std::span<const std::uint8_t> here() const noexcept { return {bytes_.data() + begin_, end_ - begin_}; }
  void drop(std::size_t bytes) noexcept { begin_ += bytes; }  // at most here().size()
  void skip(std::size_t bytes) noexcept {
    counts_.skipped += bytes;
    drop(bytes);
  }

  Counts counts_;

 private:
  std::array<std::uint8_t, size> bytes_;
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace kadans
