#include "script/lua/lua_heap.h"

#include <cstdint>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

constexpr std::size_t mb = std::size_t{1} << 20;

std::uintptr_t address(const void* block) { return reinterpret_cast<std::uintptr_t>(block); }

}  // namespace

TEST_CASE("What a state allocates for its ticks stands side by side, whatever is allocated between") {
  LuaHeap heap(mb, mb);
  void* const state = heap.reallocate(nullptr, 0, 6000);
  void* const first = heap.reallocate(nullptr, 0, 64);
  heap.for_ticks(false);
  void* const other = heap.reallocate(nullptr, 0, 64);
  heap.for_ticks(true);
  void* const second = heap.reallocate(nullptr, 0, 96);
  CHECK(address(first) % 64 == 0);
  CHECK(address(second) == address(first) + 64);
  CHECK(address(first) - address(state) < 6000 + 64);
  const bool outside = address(other) < address(state) || address(other) >= address(second) + 96;
  CHECK(outside);
  CHECK(heap.used_bytes() == 6000 + 64 + 64 + 96);
}

TEST_CASE("A heap goes on when the memory for ticks is full, and uses again what was freed") {
  LuaHeap heap(mb, mb);
  (void)heap.reallocate(nullptr, 0, 6000);
  for (int i = 0; i < 200; ++i) REQUIRE(heap.reallocate(nullptr, 0, 1024) != nullptr);
  heap.for_ticks(false);
  void* const block = heap.reallocate(nullptr, 0, 200);
  CHECK(heap.reallocate(block, 200, 0) == nullptr);
  CHECK(heap.reallocate(nullptr, 0, 193) == block);
}
