#include "kadans/testing/allocation_count.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <stdlib.h>

#include "kadans/testing/real_time_guard.h"
#include "testing/doomed.h"

namespace kadans::testing {
namespace {

using test::keep;

TEST_CASE("AllocationCount starts at nothing and stays there while nobody allocates") {
  const AllocationCount heap;
  int on_the_stack[16] = {};
  keep(on_the_stack);
  const long allocations = heap.count(), frees = heap.frees();
  CHECK(allocations == 0);
  CHECK(frees == 0);
}

TEST_CASE("AllocationCount counts new and delete of every kind") {
  struct alignas(256) Wide {
    char bytes[256];
  };
  const AllocationCount heap;
  auto* one = new int(1);
  keep(one);
  auto* many = new int[10];
  keep(many);
  auto* wide = new Wide;
  keep(wide);
  auto* quiet = new (std::nothrow) int(2);
  keep(quiet);
  const long allocations = heap.count(), frees_before = heap.frees();
  delete one;
  delete[] many;
  delete wide;
  delete quiet;
  const long frees = heap.frees(), allocations_after = heap.count();
  CHECK(allocations == 4);
  CHECK(frees_before == 0);
  CHECK(frees == 4);
  CHECK(allocations_after == 4);
}

TEST_CASE("AllocationCount counts the C family") {
  const AllocationCount heap;
  void* block = malloc(10);
  keep(block);
  free(block);
  block = calloc(3, 7);
  keep(block);
  free(block);
  block = aligned_alloc(64, 128);
  keep(block);
  free(block);
  int failed = posix_memalign(&block, 64, 100);
  keep(block);
  free(block);
  block = strdup("text");
  keep(block);
  free(block);
  free(nullptr);
  const long allocations = heap.count(), frees = heap.frees();
  CHECK(failed == 0);
  CHECK(allocations >= 3);
  CHECK(allocations <= 5);
  if (RealTimeGuard::calls_are_guarded()) CHECK(allocations == 5);
  CHECK(frees == 5);
}

TEST_CASE("AllocationCount sees a block that grows") {
  void* block = malloc(10);
  keep(block);
  const AllocationCount heap;
  void* grown = realloc(block, 1'000'000);
  const long allocations = heap.count();
  keep(grown);
  free(grown);
  CHECK(allocations >= 1);
}

TEST_CASE("AllocationCount sees what the C++ library and other libraries allocate") {
  const AllocationCount strings;
  const std::string text(1000, 'x');
  keep(text.data());
  const long for_string = strings.count();
  std::vector<int> numbers;
  const AllocationCount vectors;
  numbers.reserve(8);
  keep(numbers.data());
  for (int i = 0; i < 8; ++i) numbers.push_back(i);
  const long for_vector = vectors.count();
  char* path = nullptr;
  const AllocationCount c_library;
  path = realpath("/", nullptr);
  const long for_path = c_library.count();
  free(path);
  CHECK(for_string == 1);
  CHECK(for_vector == 1);
  CHECK(for_path >= 1);
}

TEST_CASE("allocation counts nest and overlap") {
  const AllocationCount outer;
  keep(std::make_unique<int>(1).get());
  const AllocationCount inner;
  keep(std::make_unique<int>(2).get());
  const long inside = inner.count(), outside = outer.count();
  CHECK(inside == 1);
  CHECK(outside == 2);
}

TEST_CASE("AllocationCount does not see other threads") {
  long others = -1;
  std::thread thread([&others] {
    const AllocationCount heap;
    for (int i = 0; i < 100; ++i) keep(std::make_unique<int>(i).get());
    others = heap.count();
  });
  const AllocationCount heap;
  thread.join();
  const long own = heap.count();
  CHECK(others == 100);
  CHECK(own == 0);
}

TEST_CASE("memory from the counted functions is aligned, zeroed and refused as the standard says") {
  void* block = nullptr;
  if (RealTimeGuard::calls_are_guarded()) {  // a sanitizer aborts on these
    CHECK(posix_memalign(&block, 3, 10) == EINVAL);
    CHECK(posix_memalign(&block, 2, 10) == EINVAL);
    CHECK(block == nullptr);
  }
  CHECK(posix_memalign(&block, 4096, 10) == 0);
  CHECK(reinterpret_cast<std::uintptr_t>(block) % 4096 == 0);
  free(block);
  auto* zeros = static_cast<unsigned char*>(calloc(100, 10));
  bool all_zero = true;
  for (int i = 0; i < 1000; ++i) all_zero = all_zero && zeros[i] == 0;
  CHECK(all_zero);
  free(zeros);
}

}  // namespace
}  // namespace kadans::testing
