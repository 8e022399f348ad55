
#include "kadans/testing/real_time_guard.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <cxxabi.h>
#include <execinfo.h>
#include <unistd.h>

#include "forbidden_call.h"
#include "kadans/testing/allocation_count.h"

namespace kadans::testing {
namespace {

// The first backtrace() of a program loads a library. Better here than in a thread that is about to abort.
bool load_unwinder() noexcept {
  std::array<void*, 2> frames{};
  return backtrace(frames.data(), static_cast<int>(frames.size())) > 0;
}

}  // namespace

RealTimeGuard::RealTimeGuard(const char* file, int line) noexcept
    : outer_file_(thread_marks.guard_file), outer_line_(thread_marks.guard_line) {
  link_heap_calls();
  link_library_calls();
  if (thread_marks.depth == 0) {
    [[maybe_unused]] static const bool loaded = load_unwinder();
  }
  thread_marks.guard_file = file;
  thread_marks.guard_line = line;
  ++thread_marks.depth;
}

RealTimeGuard::~RealTimeGuard() {
  --thread_marks.depth;
  thread_marks.guard_file = outer_file_;
  thread_marks.guard_line = outer_line_;
}

bool RealTimeGuard::calls_are_guarded() noexcept {
#ifdef KADANS_SANITIZED
  return false;
#else
  return true;
#endif
}

RealTimeGuard::Pause::Pause() noexcept : depth_(std::exchange(thread_marks.depth, 0)) {}

RealTimeGuard::Pause::~Pause() { thread_marks.depth = depth_; }

thread_local constinit ThreadMarks thread_marks;

namespace {

// One line of the trace: "  #3 kadans::Pid::step(double) + 0x1c (build/tests/control_test + 0x4242)". A function that
// its file keeps to itself has no name here; addr2line -Cfipe FILE OFFSET finds it. `address` is where the call returns
// to, which may be another function already: the byte before is inside the call.
void print_frame(int number, const char* address) noexcept {
  std::array<char, 2048> line{};
  Dl_info where{};
  if (dladdr(address - 1, &where) == 0) {
    std::snprintf(line.data(), line.size(), "  #%d %p\n", number, static_cast<const void*>(address));
  } else {
    const auto at = reinterpret_cast<std::uintptr_t>(address);
    const auto in_file = static_cast<unsigned long>(at - reinterpret_cast<std::uintptr_t>(where.dli_fbase));
    int failed = 0;
    char* readable = where.dli_sname ? abi::__cxa_demangle(where.dli_sname, nullptr, nullptr, &failed) : nullptr;
    const char* name = readable ? readable : where.dli_sname ? where.dli_sname : "(local)";
    const auto in_function =
        static_cast<unsigned long>(where.dli_sname ? at - reinterpret_cast<std::uintptr_t>(where.dli_saddr) : 0);
    std::snprintf(line.data(), line.size(), "  #%d %.1500s + 0x%lx (%.400s + 0x%lx)\n", number, name, in_function,
                  where.dli_fname, in_file);
    std::free(readable);
  }
  if (write(STDERR_FILENO, line.data(), std::strlen(line.data())) < 0) return;
}

}  // namespace

// The caller stands before the C library's function, which holds no lock of ours: allocating is safe again once the
// thread is unmarked.
void report_forbidden(const char* call) noexcept {
  thread_marks.depth = 0;
  std::array<char, 1024> line{};
  std::snprintf(line.data(), line.size(), "kadans: %s called by a real-time thread, guarded at %.400s:%d\n", call,
                thread_marks.guard_file, thread_marks.guard_line);
  if (write(STDERR_FILENO, line.data(), std::strlen(line.data())) >= 0) {
    std::array<void*, 64> frames{};
    const int count = backtrace(frames.data(), static_cast<int>(frames.size()));
    constexpr int caller = 1;  // 0 is this function
    for (int i = caller; i < count; ++i) {
      print_frame(i, static_cast<const char*>(frames[static_cast<std::size_t>(i)]));
    }
  }
  std::abort();
}

AllocationCount::AllocationCount() noexcept {
  link_heap_calls();
  allocations_before_ = thread_marks.allocations;
  frees_before_ = thread_marks.frees;
}

long AllocationCount::count() const noexcept { return thread_marks.allocations - allocations_before_; }

long AllocationCount::frees() const noexcept { return thread_marks.frees - frees_before_; }

}  // namespace kadans::testing
