// A scope in which the current thread must behave like a real-time thread:
//
//   {
//     const RealTimeGuard guard;
//     engine.tick(now_ns);  // must not allocate, lock, sleep, touch files or throw
//   }
//
// A forbidden call from this thread writes to stderr what was called, where the guard stands and a stack trace with
// names, and aborts the program, so that a debugger or the core stands at the call. Forbidden are
//   the heap    malloc, calloc, realloc, free, posix_memalign, ..., and so operator new and delete
//   locks       mutexes, read-write locks, condition variables, semaphores, barriers; starting and joining threads
//   waiting     nanosleep, usleep, sched_yield, poll, select, epoll_wait, ...
//   files       open, read, write, close, fsync, mmap, ioctl, sockets, and the streams: fopen, fwrite, printf, ...
//   exceptions  throw and rethrow
// Reading the clock, snprintf and free(nullptr) are not: they make no system call. Other threads are not affected.
//
// How: a program that uses this header defines those functions itself; they take the place of the C library's and
// forward to it. What the C library calls within itself does not pass here, so each entry is guarded by its own name; a
// direct syscall() is not seen. Sanitizers bring their own versions of these functions: in such a build (see
// calls_are_guarded) only the heap is guarded.
#pragma once

namespace kadans::testing {

class RealTimeGuard {
 public:
  // Marks the calling thread until destruction, in the same thread. Guards nest. `file` and `line` are for the message.
  explicit RealTimeGuard(const char* file = __builtin_FILE(), int line = __builtin_LINE()) noexcept;
  ~RealTimeGuard();
  RealTimeGuard(const RealTimeGuard&) = delete;
  RealTimeGuard& operator=(const RealTimeGuard&) = delete;

  // False in a build with AddressSanitizer or ThreadSanitizer: there only the heap is guarded.
  static bool calls_are_guarded() noexcept;

  // A scope inside guards in which the thread may do anything: a model's step in a lockstep test, say.
  class Pause {
   public:
    Pause() noexcept;
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    int depth_;
  };

 private:
  const char* outer_file_;
  int outer_line_;
};

}  // namespace kadans::testing
