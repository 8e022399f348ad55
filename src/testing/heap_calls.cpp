// The heap: counted always, forbidden to marked threads. glibc exports its allocator under a second set of names, so
// forwarding needs no search, which would itself allocate.
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#include "forbidden_call.h"

namespace kadans::testing {

void link_heap_calls() noexcept {}

namespace {

void count_allocation(const char* call) noexcept {
  forbid(call);
  ++thread_marks.allocations;
}

void count_free(const char* call) noexcept {
  forbid(call);
  ++thread_marks.frees;
}

}  // namespace

#ifdef KADANS_SANITIZED

extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t),
                                                         void (*)(const volatile void*));

namespace {

void allocated(const volatile void*, std::size_t) { count_allocation("malloc"); }
void freed(const volatile void*) { count_free("free"); }

[[maybe_unused]] const int hooks = __sanitizer_install_malloc_and_free_hooks(allocated, freed);

}  // namespace
}  // namespace kadans::testing

#else

extern "C" {
void* libc_malloc(std::size_t) __asm__("__libc_malloc");
void* libc_calloc(std::size_t, std::size_t) __asm__("__libc_calloc");
void* libc_realloc(void*, std::size_t) __asm__("__libc_realloc");
void* libc_memalign(std::size_t, std::size_t) __asm__("__libc_memalign");
void libc_free(void*) __asm__("__libc_free");
}

namespace {

void* aligned(const char* call, std::size_t alignment, std::size_t size) noexcept {
  count_allocation(call);
  return libc_memalign(alignment, size);
}

}  // namespace
}  // namespace kadans::testing

// Under C++ names of their own, as KADANS_FORBID does.
extern "C" {
void* counted_malloc(std::size_t size) __asm__("malloc");
void* counted_calloc(std::size_t count, std::size_t size) __asm__("calloc");
void* counted_realloc(void* block, std::size_t size) __asm__("realloc");
void counted_free(void* block) __asm__("free");
void* counted_memalign(std::size_t alignment, std::size_t size) __asm__("memalign");
void* counted_aligned_alloc(std::size_t alignment, std::size_t size) __asm__("aligned_alloc");
int counted_posix_memalign(void** block, std::size_t alignment, std::size_t size) __asm__("posix_memalign");
void* counted_valloc(std::size_t size) __asm__("valloc");

void* counted_malloc(std::size_t size) {
  kadans::testing::count_allocation("malloc");
  return kadans::testing::libc_malloc(size);
}

void* counted_calloc(std::size_t count, std::size_t size) {
  kadans::testing::count_allocation("calloc");
  return kadans::testing::libc_calloc(count, size);
}

void* counted_realloc(void* block, std::size_t size) {
  kadans::testing::count_allocation("realloc");
  return kadans::testing::libc_realloc(block, size);
}

void counted_free(void* block) {
  if (block == nullptr) return;
  kadans::testing::count_free("free");
  kadans::testing::libc_free(block);
}

void* counted_memalign(std::size_t alignment, std::size_t size) {
  return kadans::testing::aligned("memalign", alignment, size);
}

void* counted_aligned_alloc(std::size_t alignment, std::size_t size) {
  return kadans::testing::aligned("aligned_alloc", alignment, size);
}

int counted_posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  const int before = errno;
  void* memory = kadans::testing::aligned("posix_memalign", alignment, size);
  errno = before;  // the result tells, errno does not
  if (memory == nullptr) return ENOMEM;
  *block = memory;
  return 0;
}

void* counted_valloc(std::size_t size) {
  constexpr std::size_t page = 4096;
  return kadans::testing::aligned("valloc", page, size);
}
}  // extern "C"

#endif
