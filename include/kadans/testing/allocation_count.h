// How often this thread went to the heap since a point in the program:
//
//   const AllocationCount heap;
//   pid.step(target_rad, position_rad, velocity_rad_s);
//   const long allocations = heap.count();  // before any check of the test framework: those allocate
//   CHECK(allocations == 0);
//
// It counts malloc, calloc, realloc, the aligned ones, and operator new through them, whoever calls them: the program,
// the C++ library or any other shared library. Other threads do not count. Counts may nest and overlap.
//
// How: a program that uses this header (or real_time_guard.h) defines malloc and its family itself, which takes the
// place of the C library's, and forwards. In a build with AddressSanitizer or ThreadSanitizer, which have their own
// malloc, their hooks count instead (ThreadSanitizer's does not see aligned blocks).
#pragma once

namespace kadans::testing {

class AllocationCount {
 public:
  AllocationCount() noexcept;

  // Allocations of the calling thread since construction; ask in the thread that constructed it.
  long count() const noexcept;
  // Blocks that the calling thread gave back since construction; freeing nothing does not count.
  long frees() const noexcept;

 private:
  long allocations_before_;
  long frees_before_;
};

}  // namespace kadans::testing
