// The memory of one Lua state, counted and limited. A reserve of an eighth above the limit is still granted. So the
// script can be stopped at its next instruction, and its line is known, rather than somewhere inside the interpreter.
//
// Small blocks are cut one after the other from arenas of whole pages, which are kept until the state ends. The blocks
// that every tick needs, first of all the interpreter's own state, have an arena of their own. The reason: a tick at
// 100 Hz finds nothing in the caches, and its time goes into waiting for memory and page tables, not into instructions.
// Blocks of whole cache lines are aligned to cache lines.
//
// Strings have a bound of their own, because one instruction (.., <, + on digits) may go through a whole string. Lua
// builds strings in a buffer that doubles its size. So a block that grows to a power of two is that buffer, and no
// stack or table (these have a few slots more).
//
// A table that again and again loses a key and gets another one is allocated anew each time. This needs time but no
// memory. So the bytes allocated since forgive() are limited, too, to four times the limit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kadans {

class LuaHeap {
 public:
  LuaHeap(std::size_t limit_bytes, std::size_t block_bytes) noexcept : limit_(limit_bytes), block_(block_bytes) {}
  ~LuaHeap();
  LuaHeap(const LuaHeap&) = delete;
  LuaHeap& operator=(const LuaHeap&) = delete;

  // Returns nullptr when refused; then Lua raises "not enough memory". Shrinking and freeing are never refused.
  void* reallocate(void* block, std::size_t old_bytes, std::size_t new_bytes) noexcept;

  std::size_t used_bytes() const noexcept { return used_; }
  std::size_t limit_bytes() const noexcept { return limit_; }
  std::uint64_t allocated_bytes() const noexcept { return allocated_; }  // since the beginning
  // Says whether blocks that are allocated from now on are used in every tick. Such blocks are placed together.
  void for_ticks(bool yes) noexcept { for_ticks_ = yes; }

  // The largest block so far: no table, function or stack of the state is larger.
  std::size_t largest_block_bytes() const noexcept { return largest_; }

  bool exceeded() const noexcept { return exceeded_; }
  void forgive() noexcept { exceeded_ = false, renewal_end_ = allocated_ + renewals_max * limit_; }

 private:
  static constexpr std::size_t small_step_bytes = 16, small_bytes_max = 1024;
  static constexpr std::uint64_t renewals_max = 4;
  static constexpr std::size_t line_bytes = 64, page_bytes = 4096, arena_bytes = 16 * page_bytes;
  struct Free {
    Free* next;
  };
  struct Arena;   // a linked list, to free them
  struct Fresh {  // the unused part of an arena
    std::byte* next = nullptr;
    std::byte* end = nullptr;
  };

  static bool small(std::size_t bytes) noexcept { return bytes <= small_bytes_max; }
  static std::size_t size_class(std::size_t bytes) noexcept { return (bytes - 1) / small_step_bytes; }
  void* take(std::size_t bytes) noexcept;
  void give(void* block, std::size_t bytes) noexcept;
  void* move(void* block, std::size_t old_bytes, std::size_t new_bytes) noexcept;
  void put_back(std::byte* block, std::size_t bytes) noexcept;
  bool open_arena(Fresh& fresh) noexcept;
  void* cut(Fresh& fresh, std::size_t bytes) noexcept;  // nullptr: not enough left

  std::array<Free*, small_bytes_max / small_step_bytes> free_{};  // by size class
  Arena* arenas_ = nullptr;
  Fresh fresh_, tick_;
  std::byte* tick_first_ = nullptr;  // also the first block, the interpreter's state
  bool for_ticks_ = true;            // true at first: the state's initial contents
  std::size_t limit_, block_;
  std::size_t used_ = 0, largest_ = 0;
  std::uint64_t allocated_ = 0, renewal_end_ = UINT64_MAX;
  bool exceeded_ = false;
};

}  // namespace kadans
