#include "kadans/script/lua_heap.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

namespace kadans {
namespace {

constexpr std::size_t text_bytes_max = std::size_t{64} << 10;
constexpr std::size_t chunk_bytes = 4096, line_bytes = 64;

bool long_text(std::size_t old_bytes, std::size_t new_bytes) noexcept {
  return old_bytes > 0 && new_bytes > text_bytes_max && std::has_single_bit(new_bytes);
}

}  // namespace

struct LuaHeap::Chunk {
  Chunk* next;
};

LuaHeap::~LuaHeap() {
  while (chunks_ != nullptr) std::free(std::exchange(chunks_, chunks_->next));
}

// All blocks of a new chunk become free, the first in memory first.
bool LuaHeap::cut_chunk(std::size_t block_bytes, Free*& to) noexcept {
  void* memory = std::aligned_alloc(line_bytes, chunk_bytes);
  if (memory == nullptr) return false;
  chunks_ = new (memory) Chunk{chunks_};
  auto* first = static_cast<std::byte*>(memory) + line_bytes;
  for (std::size_t i = (chunk_bytes - line_bytes) / block_bytes; i > 0; --i) {
    to = new (first + (i - 1) * block_bytes) Free{to};
  }
  return true;
}

void* LuaHeap::take(std::size_t bytes) noexcept {
  if (!small(bytes)) return std::malloc(bytes);
  const std::size_t which = size_class(bytes);
  if (free_[which] == nullptr && !cut_chunk((which + 1) * small_step_bytes, free_[which])) return nullptr;
  return std::exchange(free_[which], free_[which]->next);
}

void LuaHeap::give(void* block, std::size_t bytes) noexcept {
  if (!small(bytes)) return std::free(block);
  Free*& first = free_[size_class(bytes)];
  first = new (block) Free{first};
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
    if (after > limit_ || large) exceeded_ = true;
    if (after > limit_ + limit_ / 8 || large) return nullptr;
  }
  void* moved = block == nullptr ? take(new_bytes) : move(block, old_bytes, new_bytes);
  if (moved == nullptr) return nullptr;
  used_ += new_bytes - old_bytes;
  if (new_bytes > old_bytes) allocated_ += new_bytes - old_bytes;
  return moved;
}

}  // namespace kadans
