#include "kadans/testing/allocation_count.h"

#include "forbidden_call.h"

namespace kadans::testing {

AllocationCount::AllocationCount() noexcept {
  link_heap_calls();
  allocations_before_ = thread_marks.allocations;
  frees_before_ = thread_marks.frees;
}

long AllocationCount::count() const noexcept { return thread_marks.allocations - allocations_before_; }

long AllocationCount::frees() const noexcept { return thread_marks.frees - frees_before_; }

}  // namespace kadans::testing
