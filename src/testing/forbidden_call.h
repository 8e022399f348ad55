// The common part of the functions that take the C library's place: the marks of the current thread, the report when a
// marked thread calls such a function, and the way on to the library's own.
#pragma once

#include <atomic>

#include <dlfcn.h>

namespace kadans::testing {

struct ThreadMarks {
  int depth = 0;  // guards around the current call; 0 when the thread may do anything
  const char* guard_file = "";
  int guard_line = 0;
  long allocations = 0;
  long frees = 0;
};
// Storage in the program itself: reaching it never allocates.
extern thread_local constinit ThreadMarks thread_marks __attribute__((tls_model("initial-exec")));

// Tells what was called, from where, and aborts.
[[noreturn]] void report_forbidden(const char* call) noexcept;

inline void forbid(const char* call) noexcept {
  if (thread_marks.depth != 0) [[unlikely]]
    report_forbidden(call);
}

// The next definition of a function after the program's own. Found when first asked for; no lock, no allocation of
// ours.
template <typename Function>
Function* next_definition(std::atomic<Function*>& known, const char* name) noexcept {
  Function* function = known.load(std::memory_order_relaxed);
  if (function == nullptr) {
    function = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
    known.store(function, std::memory_order_relaxed);
  }
  return function;
}

// From a static library a program gets only what it refers to: by these the guard refers to each group of calls.
void link_heap_calls() noexcept;
void link_library_calls() noexcept;

}  // namespace kadans::testing

// Defines the symbol `name` under a C++ name of its own, since the system's headers may have declared `name` with
// attributes, macros or redirections: forbids it, then forwards. PARAMETERS is a list in parentheses, the rest are the
// arguments to hand on.
#define KADANS_FORBID(result, name, parameters, ...)                                       \
  extern "C" result forbidden_##name parameters __asm__(#name);                            \
  extern "C" result forbidden_##name parameters {                                          \
    static constinit std::atomic<result(*) parameters> known{nullptr};                     \
    kadans::testing::forbid(#name);                                                        \
    return kadans::testing::next_definition<result parameters>(known, #name)(__VA_ARGS__); \
  }
