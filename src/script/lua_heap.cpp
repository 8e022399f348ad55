#include "kadans/script/lua_heap.h"

#include <bit>
#include <cstdlib>

namespace kadans {
namespace {

constexpr std::size_t text_bytes_max = std::size_t{64} << 10;

bool long_text(std::size_t old_bytes, std::size_t new_bytes) noexcept {
  return old_bytes > 0 && new_bytes > text_bytes_max && std::has_single_bit(new_bytes);
}

}  // namespace

void* LuaHeap::reallocate(void* block, std::size_t old_bytes, std::size_t new_bytes) noexcept {
  if (new_bytes == 0) {
    std::free(block);
    used_ -= old_bytes;
    return nullptr;
  }
  if (new_bytes > old_bytes) {
    const std::size_t after = used_ - old_bytes + new_bytes;
    const bool large = new_bytes > block_ || long_text(old_bytes, new_bytes);
    if (after > limit_ || large) exceeded_ = true;
    if (after > limit_ + limit_ / 8 || large) return nullptr;
  }
  void* moved = std::realloc(block, new_bytes);
  if (moved == nullptr) return nullptr;
  used_ += new_bytes - old_bytes;
  if (new_bytes > old_bytes) allocated_ += new_bytes - old_bytes;
  return moved;
}

}  // namespace kadans
