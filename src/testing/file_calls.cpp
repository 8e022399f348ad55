// Files, sockets and mappings, by their descriptors.
#include <cstdarg>
#include <cstddef>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include "forbidden_call.h"

namespace kadans::testing {

void link_file_calls() noexcept {}

}  // namespace kadans::testing

#if !KADANS_SANITIZER
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
#endif
