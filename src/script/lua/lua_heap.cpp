#include "lua_heap.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

namespace kadans {
namespace {

constexpr std::size_t text_bytes_max = std::size_t{64} << 10;

bool long_text(std::size_t old_bytes, std::size_t new_bytes) noexcept {
  return old_bytes > 0 && new_bytes > text_bytes_max && std::has_single_bit(new_bytes);
}

}  // namespace

struct LuaHeap::Arena {
  Arena* before;
};

LuaHeap::~LuaHeap() {
  while (arenas_ != nullptr) std::free(std::exchange(arenas_, arenas_->before));
}

void LuaHeap::put_back(std::byte* block, std::size_t bytes) noexcept {
  Free*& first = free_[size_class(bytes)];
  first = new (block) Free{first};
}

// What is left of the arena before becomes free blocks.
bool LuaHeap::open_arena(Fresh& fresh) noexcept {
  void* memory = std::aligned_alloc(page_bytes, arena_bytes);
  if (memory == nullptr) return false;
  while (fresh.next != fresh.end) {
    const std::size_t left = std::min(static_cast<std::size_t>(fresh.end - fresh.next), small_bytes_max);
    put_back(std::exchange(fresh.next, fresh.next + left), left);
  }
  arenas_ = new (memory) Arena{arenas_};
  auto* const first = static_cast<std::byte*>(memory);
  fresh = {first + line_bytes, first + arena_bytes};
  return true;
}

void* LuaHeap::cut(Fresh& fresh, std::size_t bytes) noexcept {
  bytes = (bytes + small_step_bytes - 1) / small_step_bytes * small_step_bytes;
  const auto past_line = static_cast<std::size_t>(reinterpret_cast<std::uintptr_t>(fresh.next) % line_bytes);
  const std::size_t gap = bytes % line_bytes == 0 && past_line > 0 ? line_bytes - past_line : 0;
  if (static_cast<std::size_t>(fresh.end - fresh.next) < gap + bytes) return nullptr;
  if (gap > 0) put_back(std::exchange(fresh.next, fresh.next + gap), gap);
  return std::exchange(fresh.next, fresh.next + bytes);
}

void* LuaHeap::take(std::size_t bytes) noexcept {
  if (tick_first_ == nullptr && open_arena(tick_)) {
    tick_first_ = tick_.next;
    return cut(tick_, bytes);
  }
  if (!small(bytes)) return std::malloc(bytes);
  void* block = for_ticks_ ? cut(tick_, bytes) : nullptr;
  if (block != nullptr) return block;
  Free*& first = free_[size_class(bytes)];
  if (first != nullptr) return std::exchange(first, first->next);
  block = cut(fresh_, bytes);
  return block == nullptr && open_arena(fresh_) ? cut(fresh_, bytes) : block;
}

void LuaHeap::give(void* block, std::size_t bytes) noexcept {
  if (block == tick_first_) return;
  if (!small(bytes)) return std::free(block);
  put_back(static_cast<std::byte*>(block), bytes);
}

void* LuaHeap::move(void* block, std::size_t old_bytes, std::size_t new_bytes) noexcept {
  if (!small(old_bytes) && !small(new_bytes)) return std::realloc(block, new_bytes);
  if (small(old_bytes) && small(new_bytes) && size_class(old_bytes) == size_class(new_bytes)) return block;
  void* moved = take(new_bytes);
  if (moved == nullptr) return nullptr;
  std::memcpy(moved, block, std::min(old_bytes, new_bytes));
  give(block, old_bytes);
  return moved;
}

void* LuaHeap::reallocate(void* block, std::size_t old_bytes, std::size_t new_bytes) noexcept {
  if (new_bytes == 0) {
    if (block != nullptr) give(block, old_bytes);
    used_ -= old_bytes;
    return nullptr;
  }
  if (new_bytes > old_bytes) {
    const std::size_t after = used_ - old_bytes + new_bytes;
    const bool large = new_bytes > block_ || long_text(old_bytes, new_bytes);
    if (after > limit_ || large || allocated_ + (new_bytes - old_bytes) > renewal_end_) exceeded_ = true;
    if (after > limit_ + limit_ / 8 || large) return nullptr;
  }
  void* moved = block == nullptr ? take(new_bytes) : move(block, old_bytes, new_bytes);
  if (moved == nullptr) return nullptr;
  used_ += new_bytes - old_bytes;
  if (new_bytes > old_bytes) allocated_ += new_bytes - old_bytes;
  largest_ = std::max(largest_, new_bytes);
  return moved;
}

}  // namespace kadans
