#include "imu_line.h"

#include <algorithm>
#include <utility>

namespace kadans::imu {
namespace {

constexpr std::uint32_t virtual_baud = 115'200;

}  // namespace

bool ImuLine::send(std::span<const std::uint8_t> bytes) noexcept {
  passed_.pass(bytes, now_);
  device_.receive(bytes, now_, virtual_baud);
  return true;
}

std::size_t ImuLine::receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept {
  if (fetched_ > 0) {
    std::copy_n(ready_.begin(), std::min(fetched_, into.size()), into.begin());
    return std::min(std::exchange(fetched_, 0), into.size());
  }
  for (;;) {
    device_.pass(now_);
    const std::size_t got = device_.take(into, now_);
    if (got > 0) passed_.pass(into.first(got), now_);
    if (got > 0 || now_ >= until_ns) return got;
    now_ = std::max(now_, std::min(until_ns, device_.due_ns()));
  }
}

void ImuLine::fetch() {
  device_.pass(now_);
  fetched_ = device_.take(ready_, now_);
}

}  // namespace kadans::imu
