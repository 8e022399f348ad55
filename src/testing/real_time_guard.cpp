#include "kadans/testing/real_time_guard.h"

#include <array>
#include <utility>

#include <execinfo.h>

#include "forbidden_call.h"

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
  link_exception_calls();
  link_file_calls();
  link_lock_calls();
  link_stream_calls();
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

bool RealTimeGuard::calls_are_guarded() noexcept { return KADANS_SANITIZER == 0; }

RealTimeGuard::Pause::Pause() noexcept : depth_(std::exchange(thread_marks.depth, 0)) {}

RealTimeGuard::Pause::~Pause() { thread_marks.depth = depth_; }

}  // namespace kadans::testing
