#include "kadans/script/lua_heap.h"

#include <cstdlib>

namespace kadans {

void* LuaHeap::reallocate(void* block, std::size_t old_bytes, std::size_t new_bytes) noexcept {
  if (new_bytes == 0) {
    std::free(block);
    used_ -= old_bytes;
    return nullptr;
  }
  if (new_bytes > old_bytes) {
    const std::size_t after = used_ - old_bytes + new_bytes;
    if (after > limit_ || new_bytes > block_) exceeded_ = true;
    if (after > limit_ + limit_ / 8 || new_bytes > block_) return nullptr;
  }
  void* moved = std::realloc(block, new_bytes);
  if (moved == nullptr) return nullptr;
  used_ += new_bytes - old_bytes;
  if (new_bytes > old_bytes) allocated_ += new_bytes - old_bytes;
  return moved;
}

}  // namespace kadans
