// Bytes that came on a line, until the packets in them have been taken. Nothing here allocates or throws.
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
  // Where to put bytes from outside; then tell how many. What has been dropped makes room.
  std::span<std::uint8_t> room() noexcept {
    std::memmove(bytes_.data(), bytes_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    return std::span(bytes_).subspan(end_);
  }
  void filled(std::size_t bytes) noexcept { end_ = std::min(end_ + bytes, size); }
  // What is here; it holds until room().
  std::span<const std::uint8_t> here() const noexcept { return {bytes_.data() + begin_, end_ - begin_}; }
  void drop(std::size_t bytes) noexcept { begin_ += bytes; }  // at most here().size()
  void clear() noexcept { begin_ = end_ = 0; }

 private:
  std::array<std::uint8_t, size> bytes_;
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace kadans
