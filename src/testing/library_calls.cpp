// The calls of the C library that are forbidden to marked threads.
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <typeinfo>

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include "forbidden_call.h"

namespace kadans::testing {

void link_library_calls() noexcept {}

}  // namespace kadans::testing

#ifndef KADANS_SANITIZED
// Exceptions: forbidden to marked threads from the moment memory is asked for one, so that the report says throw.

using Destructor = void (*)(void*);

KADANS_FORBID(void*, __cxa_allocate_exception, (std::size_t size), size)
KADANS_FORBID(void, __cxa_throw, (void* exception, std::type_info* type, Destructor destructor), exception, type,
              destructor)
KADANS_FORBID(void, __cxa_rethrow, (), )

// Files, sockets and mappings, by their descriptors.

namespace {

bool flags_create(int flags) noexcept { return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE; }

}  // namespace

// The mode of a file comes as a variable argument, and only with the flags that create one.
#define KADANS_FORBID_OPEN(name, parameters, ...)                                                    \
  extern "C" int forbidden_##name parameters __asm__(#name);                                         \
  extern "C" int forbidden_##name parameters {                                                       \
    static constinit std::atomic<int(*) parameters> known{nullptr};                                  \
    kadans::testing::forbid(#name);                                                                  \
    va_list more;                                                                                    \
    va_start(more, flags);                                                                           \
    const mode_t mode = flags_create(flags) ? va_arg(more, mode_t) : 0;                              \
    va_end(more);                                                                                    \
    return kadans::testing::next_definition<int parameters>(known, #name)(__VA_ARGS__, flags, mode); \
  }
// One word follows; what it means is the request's matter.
#define KADANS_FORBID_CONTROL(name, Request)                                                            \
  extern "C" int forbidden_##name(int file, Request request, ...) __asm__(#name);                       \
  extern "C" int forbidden_##name(int file, Request request, ...) {                                     \
    static constinit std::atomic<int (*)(int, Request, ...)> known{nullptr};                            \
    kadans::testing::forbid(#name);                                                                     \
    va_list more;                                                                                       \
    va_start(more, request);                                                                            \
    void* word = va_arg(more, void*);                                                                   \
    va_end(more);                                                                                       \
    return kadans::testing::next_definition<int(int, Request, ...)>(known, #name)(file, request, word); \
  }

// NOLINTBEGIN(clang-analyzer-valist.Uninitialized): va_start stands two lines before
KADANS_FORBID_OPEN(open, (const char* path, int flags, ...), path)
KADANS_FORBID_OPEN(open64, (const char* path, int flags, ...), path)
KADANS_FORBID_OPEN(openat, (int folder, const char* path, int flags, ...), folder, path)
KADANS_FORBID_OPEN(openat64, (int folder, const char* path, int flags, ...), folder, path)
// NOLINTEND(clang-analyzer-valist.Uninitialized)
KADANS_FORBID_CONTROL(fcntl, int)
KADANS_FORBID_CONTROL(fcntl64, int)
KADANS_FORBID_CONTROL(ioctl, unsigned long)

KADANS_FORBID(int, creat, (const char* path, mode_t mode), path, mode)
KADANS_FORBID(int, close, (int file), file)
KADANS_FORBID(ssize_t, read, (int file, void* data, std::size_t size), file, data, size)
KADANS_FORBID(ssize_t, write, (int file, const void* data, std::size_t size), file, data, size)
KADANS_FORBID(ssize_t, readv, (int file, const iovec* parts, int count), file, parts, count)
KADANS_FORBID(ssize_t, writev, (int file, const iovec* parts, int count), file, parts, count)
KADANS_FORBID(ssize_t, pread, (int file, void* data, std::size_t size, off_t at), file, data, size, at)
KADANS_FORBID(ssize_t, pread64, (int file, void* data, std::size_t size, off64_t at), file, data, size, at)
KADANS_FORBID(ssize_t, pwrite, (int file, const void* data, std::size_t size, off_t at), file, data, size, at)
KADANS_FORBID(ssize_t, pwrite64, (int file, const void* data, std::size_t size, off64_t at), file, data, size, at)
KADANS_FORBID(off_t, lseek, (int file, off_t to, int from), file, to, from)
KADANS_FORBID(off64_t, lseek64, (int file, off64_t to, int from), file, to, from)
KADANS_FORBID(int, fsync, (int file), file)
KADANS_FORBID(int, fdatasync, (int file), file)
KADANS_FORBID(int, ftruncate, (int file, off_t size), file, size)
KADANS_FORBID(int, ftruncate64, (int file, off64_t size), file, size)
KADANS_FORBID(int, stat, (const char* path, void* facts), path, facts)
KADANS_FORBID(int, fstat, (int file, void* facts), file, facts)
KADANS_FORBID(int, access, (const char* path, int mode), path, mode)
KADANS_FORBID(int, unlink, (const char* path), path)
KADANS_FORBID(int, rename, (const char* from, const char* to), from, to)
KADANS_FORBID(int, pipe, (int* ends), ends)
KADANS_FORBID(void*, mmap, (void* at, std::size_t size, int access, int flags, int file, off_t from), at, size, access,
              flags, file, from)
KADANS_FORBID(void*, mmap64, (void* at, std::size_t size, int access, int flags, int file, off64_t from), at, size,
              access, flags, file, from)
KADANS_FORBID(int, munmap, (void* at, std::size_t size), at, size)
KADANS_FORBID(int, socket, (int domain, int type, int protocol), domain, type, protocol)
KADANS_FORBID(int, connect, (int file, const void* address, socklen_t size), file, address, size)
KADANS_FORBID(int, accept, (int file, void* address, socklen_t* size), file, address, size)
KADANS_FORBID(ssize_t, send, (int file, const void* data, std::size_t size, int flags), file, data, size, flags)
KADANS_FORBID(ssize_t, sendto,
              (int file, const void* data, std::size_t size, int flags, const void* address, socklen_t length), file,
              data, size, flags, address, length)
KADANS_FORBID(ssize_t, sendmsg, (int file, const msghdr* message, int flags), file, message, flags)
KADANS_FORBID(ssize_t, recv, (int file, void* data, std::size_t size, int flags), file, data, size, flags)
KADANS_FORBID(ssize_t, recvfrom, (int file, void* data, std::size_t size, int flags, void* address, socklen_t* length),
              file, data, size, flags, address, length)
KADANS_FORBID(ssize_t, recvmsg, (int file, msghdr* message, int flags), file, message, flags)

// Locks, threads and waiting.

using Time = const timespec*;
using ThreadMain = void* (*)(void*);

KADANS_FORBID(int, pthread_mutex_lock, (pthread_mutex_t * mutex), mutex)
KADANS_FORBID(int, pthread_mutex_trylock, (pthread_mutex_t * mutex), mutex)
KADANS_FORBID(int, pthread_mutex_timedlock, (pthread_mutex_t * mutex, Time until), mutex, until)
KADANS_FORBID(int, pthread_mutex_clocklock, (pthread_mutex_t * mutex, clockid_t clock, Time until), mutex, clock, until)
KADANS_FORBID(int, pthread_mutex_unlock, (pthread_mutex_t * mutex), mutex)
KADANS_FORBID(int, pthread_rwlock_rdlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_rwlock_tryrdlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_rwlock_wrlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_rwlock_trywrlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_rwlock_unlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_spin_lock, (pthread_spinlock_t * lock), lock)
KADANS_FORBID(int, pthread_cond_wait, (pthread_cond_t * condition, pthread_mutex_t* mutex), condition, mutex)
KADANS_FORBID(int, pthread_cond_timedwait, (pthread_cond_t * condition, pthread_mutex_t* mutex, Time until), condition,
              mutex, until)
KADANS_FORBID(int, pthread_cond_clockwait,
              (pthread_cond_t * condition, pthread_mutex_t* mutex, clockid_t clock, Time until), condition, mutex,
              clock, until)
KADANS_FORBID(int, pthread_cond_signal, (pthread_cond_t * condition), condition)
KADANS_FORBID(int, pthread_cond_broadcast, (pthread_cond_t * condition), condition)
KADANS_FORBID(int, pthread_barrier_wait, (pthread_barrier_t * barrier), barrier)
KADANS_FORBID(int, pthread_create, (pthread_t * thread, const pthread_attr_t* attributes, ThreadMain run, void* with),
              thread, attributes, run, with)
KADANS_FORBID(int, pthread_join, (pthread_t thread, void** result), thread, result)
KADANS_FORBID(int, sem_wait, (sem_t * semaphore), semaphore)
KADANS_FORBID(int, sem_trywait, (sem_t * semaphore), semaphore)
KADANS_FORBID(int, sem_timedwait, (sem_t * semaphore, Time until), semaphore, until)
KADANS_FORBID(int, sem_clockwait, (sem_t * semaphore, clockid_t clock, Time until), semaphore, clock, until)
KADANS_FORBID(int, sem_post, (sem_t * semaphore), semaphore)

KADANS_FORBID(unsigned, sleep, (unsigned duration_s), duration_s)
KADANS_FORBID(int, usleep, (useconds_t duration_us), duration_us)
KADANS_FORBID(int, nanosleep, (Time duration, timespec* remaining), duration, remaining)
KADANS_FORBID(int, clock_nanosleep, (clockid_t clock, int flags, Time until, timespec* remaining), clock, flags, until,
              remaining)
KADANS_FORBID(int, sched_yield, (), )
KADANS_FORBID(int, poll, (pollfd * files, nfds_t count, int timeout_ms), files, count, timeout_ms)
KADANS_FORBID(int, select, (int count, fd_set* readable, fd_set* writable, fd_set* failed, timeval* timeout), count,
              readable, writable, failed, timeout)
KADANS_FORBID(int, epoll_wait, (int poller, epoll_event* events, int count, int timeout_ms), poller, events, count,
              timeout_ms)

// The streams of the C library. The C++ streams use these, or the calls by descriptor, and pass here too.

// Variable arguments go on as a list, to the function that takes one.
#define KADANS_FORBID_PRINT(name, list_name, parameters, last, ...) \
  extern "C" int forbidden_##name parameters __asm__(#name);        \
  extern "C" int forbidden_##name parameters {                      \
    kadans::testing::forbid(#name);                                 \
    va_list more;                                                   \
    va_start(more, last);                                           \
    const int written = list_name(__VA_ARGS__, more);               \
    va_end(more);                                                   \
    return written;                                                 \
  }

KADANS_FORBID(int, vfprintf, (FILE * stream, const char* format, va_list more), stream, format, more)
KADANS_FORBID(int, vprintf, (const char* format, va_list more), format, more)
KADANS_FORBID_PRINT(printf, forbidden_vprintf, (const char* format, ...), format, format)
KADANS_FORBID_PRINT(fprintf, forbidden_vfprintf, (FILE * stream, const char* format, ...), format, stream, format)
KADANS_FORBID_PRINT(__printf_chk, forbidden_vprintf, (int, const char* format, ...), format, format)
KADANS_FORBID_PRINT(__fprintf_chk, forbidden_vfprintf, (FILE * stream, int, const char* format, ...), format, stream,
                    format)
KADANS_FORBID(FILE*, fopen, (const char* path, const char* mode), path, mode)
KADANS_FORBID(FILE*, fopen64, (const char* path, const char* mode), path, mode)
KADANS_FORBID(FILE*, freopen, (const char* path, const char* mode, FILE* stream), path, mode, stream)
KADANS_FORBID(FILE*, fdopen, (int file, const char* mode), file, mode)
KADANS_FORBID(int, fclose, (FILE * stream), stream)
KADANS_FORBID(int, fflush, (FILE * stream), stream)
KADANS_FORBID(std::size_t, fread, (void* data, std::size_t size, std::size_t count, FILE* stream), data, size, count,
              stream)
KADANS_FORBID(std::size_t, fwrite, (const void* data, std::size_t size, std::size_t count, FILE* stream), data, size,
              count, stream)
KADANS_FORBID(std::size_t, fwrite_unlocked, (const void* data, std::size_t size, std::size_t count, FILE* stream), data,
              size, count, stream)
KADANS_FORBID(char*, fgets, (char* line, int size, FILE* stream), line, size, stream)
KADANS_FORBID(int, fgetc, (FILE * stream), stream)
KADANS_FORBID(int, getc, (FILE * stream), stream)
KADANS_FORBID(int, fputs, (const char* text, FILE* stream), text, stream)
KADANS_FORBID(int, puts, (const char* text), text)
KADANS_FORBID(int, fputc, (int letter, FILE* stream), letter, stream)
KADANS_FORBID(int, putc, (int letter, FILE* stream), letter, stream)
KADANS_FORBID(int, putchar, (int letter), letter)
KADANS_FORBID(int, fseek, (FILE * stream, long to, int from), stream, to, from)
KADANS_FORBID(int, remove, (const char* path), path)

#endif
