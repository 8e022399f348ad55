// The memory of one Lua state, counted and limited. Over the limit a reserve of an eighth still serves, so that the
// script can be stopped at its next instruction, with its line, rather than somewhere inside the interpreter.
//
// Small blocks are cut from chunks, each chunk for one size, so that what is made one after the other stands side by
// side and a table's head fills one cache line: a cold tick waits for memory, not for instructions. Chunks are kept
// until the state ends.
//
// Strings have a bound of their own, since one instruction (.., <, + on digits) may go through a whole string. Lua
// builds them in a buffer that doubles: a block that grows to a power of two is that buffer, no stack or table (these
// hold a few slots more).
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

  // nullptr when refused: Lua raises "not enough memory". Shrinking is never refused; freeing always works.
  void* reallocate(void* block, std::size_t old_bytes, std::size_t new_bytes) noexcept;

  std::size_t used_bytes() const noexcept { return used_; }
  std::size_t limit_bytes() const noexcept { return limit_; }
  std::uint64_t allocated_bytes() const noexcept { return allocated_; }  // ever
  bool exceeded() const noexcept { return exceeded_; }
  void forgive() noexcept { exceeded_ = false; }

 private:
  static constexpr std::size_t small_step_bytes = 16, small_bytes_max = 256;
  struct Free {
    Free* next;
  };
  struct Chunk;  // of small blocks

  static bool small(std::size_t bytes) noexcept { return bytes <= small_bytes_max; }
  static std::size_t size_class(std::size_t bytes) noexcept { return (bytes - 1) / small_step_bytes; }
  void* take(std::size_t bytes) noexcept;
  void give(void* block, std::size_t bytes) noexcept;
  void* move(void* block, std::size_t old_bytes, std::size_t new_bytes) noexcept;
  bool cut_chunk(std::size_t block_bytes, Free*& to) noexcept;

  std::array<Free*, small_bytes_max / small_step_bytes> free_{};  // by size class
  Chunk* chunks_ = nullptr;
  std::size_t limit_, block_;
  std::size_t used_ = 0;
  std::uint64_t allocated_ = 0;
  bool exceeded_ = false;
};

}  // namespace kadans
