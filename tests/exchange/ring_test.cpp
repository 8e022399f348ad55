#include "kadans/exchange/ring.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

namespace kadans {
namespace {

using SmallRing = Ring<int, 8>;
static_assert(std::is_trivially_copyable_v<SmallRing>);
static_assert(std::is_standard_layout_v<SmallRing>);
static_assert(sizeof(SmallRing) == std::size_t{3} * 64);  // two positions and eight integers, on lines of their own
static_assert(noexcept(std::declval<SmallRing&>().try_push(1)));

std::vector<int> waiting(const SmallRing& ring) {
  std::vector<int> all;
  for (std::size_t i = 0; i < ring.size(); ++i) all.push_back(ring.peek(i));
  return all;
}

// Both positions set as if that many elements had gone through; head stands at byte 0, tail a cache line further.
SmallRing ring_after(std::uint32_t pushed_and_popped) {
  SmallRing ring;
  std::array<unsigned char, sizeof ring> bytes{};
  std::memcpy(&bytes[0], &pushed_and_popped, sizeof pushed_and_popped);
  std::memcpy(&bytes[64], &pushed_and_popped, sizeof pushed_and_popped);
  std::memcpy(static_cast<void*>(&ring), bytes.data(), bytes.size());
  return ring;
}

TEST_CASE("Ring gives elements in the order in which they came") {
  SmallRing ring;
  CHECK(ring.try_push(1));
  CHECK(ring.try_push(std::array{2, 3}));
  CHECK(ring.try_push(4));
  int value = 0;
  for (int expected = 1; expected <= 4; ++expected) {
    CHECK(ring.try_pop(value));
    CHECK(value == expected);
  }
  CHECK_FALSE(ring.try_pop(value));
  CHECK(value == 4);
}

TEST_CASE("Ring holds exactly its capacity and refuses the next element without losing one") {
  SmallRing ring;
  CHECK(SmallRing::capacity() == 8);
  for (int i = 0; i < 8; ++i) {
    CHECK(ring.free() == static_cast<std::size_t>(8 - i));
    CHECK(ring.try_push(i));
  }
  CHECK(ring.free() == 0);
  CHECK_FALSE(ring.try_push(99));
  CHECK(waiting(ring) == std::vector{0, 1, 2, 3, 4, 5, 6, 7});
  ring.drop(1);
  CHECK(ring.try_push(8));
  CHECK(waiting(ring) == std::vector{1, 2, 3, 4, 5, 6, 7, 8});
}

TEST_CASE("Ring takes a batch whole or not at all") {
  SmallRing ring;
  CHECK(ring.try_push(std::array{1, 2, 3, 4, 5}));
  CHECK_FALSE(ring.try_push(std::array{6, 7, 8, 9}));
  CHECK(ring.size() == 5);
  CHECK(ring.free() == 3);
  CHECK(ring.try_push(std::array{6, 7, 8}));
  CHECK(waiting(ring) == std::vector{1, 2, 3, 4, 5, 6, 7, 8});
}

TEST_CASE("Ring takes a batch that lies in two places as one, whole or not at all, across the end of its slots") {
  SmallRing ring = ring_after(6);
  CHECK(ring.try_push(std::array{1}, std::array{2, 3, 4}));
  CHECK(ring.try_push(std::array{5, 6}, {}));
  CHECK_FALSE(ring.try_push(std::array{7, 8}, std::array{9}));
  CHECK(ring.size() == 6);
  CHECK(ring.try_push({}, std::array{7, 8}));
  CHECK(waiting(ring) == std::vector{1, 2, 3, 4, 5, 6, 7, 8});
}

TEST_CASE("Ring takes a batch that lies in many places as one, whole or not at all, across the end of its slots") {
  SmallRing ring = ring_after(6);
  const std::array first{1, 2, 3};
  const std::array second{4};
  const std::array third{5, 6, 7, 8};
  const std::array<std::span<const int>, 4> pieces{first, {}, second, third};
  CHECK(ring.try_push(0));
  CHECK_FALSE(ring.try_push_all(pieces));
  CHECK(ring.size() == 1);
  ring.drop(1);
  CHECK(ring.try_push_all(pieces));
  CHECK(waiting(ring) == std::vector{1, 2, 3, 4, 5, 6, 7, 8});
  CHECK_FALSE(ring.try_push_all(pieces));
}

TEST_CASE("Ring takes a batch as large as its capacity, none larger, and an empty one always") {
  SmallRing ring;
  CHECK_FALSE(ring.try_push(std::array{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  CHECK(ring.size() == 0);
  CHECK(ring.try_push(std::array{0, 1, 2, 3, 4, 5, 6, 7}));
  CHECK(ring.try_push(std::span<const int>()));
  CHECK(ring.size() == 8);
}

TEST_CASE("Ring lets the consumer look at a whole transaction before it drops it at once") {
  SmallRing ring;
  CHECK(ring.try_push(std::array{1, 2, 3}));
  CHECK(ring.peek() == 1);
  CHECK(ring.peek(2) == 3);
  CHECK(ring.size() == 3);
  ring.drop(2);
  CHECK(ring.size() == 1);
  CHECK(ring.peek() == 3);
  CHECK(ring.free() == 7);
}

TEST_CASE("Ring goes round its slots with batches that do not divide the capacity") {
  SmallRing ring;
  int next_in = 0, next_out = 0;
  for (int round = 0; round < 1000; ++round) {
    while (ring.try_push(std::array{next_in, next_in + 1, next_in + 2})) next_in += 3;
    int value = -1;
    for (int i = 0; i < 5 && ring.try_pop(value); ++i) CHECK(value == next_out++);
  }
  CHECK(next_out == 5000);
}

TEST_CASE("Ring keeps its positions where the tests that set them expect them") {
  SmallRing ring;
  CHECK(ring.try_push(std::array{1, 2, 3}));
  ring.drop(1);
  std::uint32_t head = 0, tail = 0;
  std::memcpy(&head, &ring, sizeof head);
  std::memcpy(&tail, reinterpret_cast<const unsigned char*>(&ring) + 64, sizeof tail);
  CHECK(head == 3);
  CHECK(tail == 1);
}

TEST_CASE("Ring goes on when its positions wrap around at 2^32") {
  for (std::uint32_t before = 0; before <= 10; ++before) {
    SmallRing ring = ring_after(0U - before);
    CHECK(ring.size() == 0);
    CHECK(ring.free() == 8);
    CHECK(ring.try_push(std::array{1, 2, 3, 4, 5}));
    CHECK(ring.size() == 5);
    CHECK(ring.free() == 3);
    CHECK_FALSE(ring.try_push(std::array{6, 7, 8, 9}));
    CHECK(ring.try_push(std::array{6, 7, 8}));
    CHECK(waiting(ring) == std::vector{1, 2, 3, 4, 5, 6, 7, 8});
    ring.drop(6);
    CHECK(ring.try_push(std::array{9, 10, 11, 12, 13, 14}));
    CHECK_FALSE(ring.try_push(15));
    CHECK(waiting(ring) == std::vector{7, 8, 9, 10, 11, 12, 13, 14});
    ring.drop(8);
    CHECK(ring.size() == 0);
    CHECK(ring.free() == 8);
  }
}

TEST_CASE("a copy of Ring made byte by byte holds the same elements and goes on by itself") {
  SmallRing ring;
  CHECK(ring.try_push(std::array{1, 2, 3}));
  SmallRing copy;
  std::memcpy(static_cast<void*>(&copy), &ring, sizeof ring);
  ring.drop(3);
  CHECK(waiting(copy) == std::vector{1, 2, 3});
  CHECK(copy.try_push(std::array{4, 5, 6, 7, 8}));
  CHECK(copy.free() == 0);
  CHECK(ring.size() == 0);
}

}  // namespace
}  // namespace kadans
