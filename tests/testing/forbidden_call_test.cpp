// Each forbidden call, made for real: harmless outside a guard, the end of the process inside one. The message must
// name the function, and the trace the function that called it.
#include <array>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "kadans/testing/real_time_guard.h"
#include "testing/doomed.h"

namespace kadans::testing {

// With a name that a stack trace can show.
__attribute__((noinline)) void caller_of(void (*call)()) {
  call();
  test::keep(nullptr);  // no tail call
}

namespace {

using test::Ending;
using test::keep;
using test::run_in_child;

struct Things {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  pthread_rwlock_t rwlock = PTHREAD_RWLOCK_INITIALIZER;
  std::mutex cpp_mutex;
  sem_t semaphore{};
  int file = open("/dev/null", O_RDWR);
  FILE* stream = fopen("/dev/null", "w");
  std::ofstream cpp_stream{"/dev/null"};
  void* block = malloc(10);
  std::array<char, 16> data{};
  timespec past{};
  Things() { sem_init(&semaphore, 0, 1); }
};
Things& things() {
  static Things all;
  return all;
}

struct Call {
  const char* name;  // what the message must say was called
  void (*make)();
};

void ignore(long) {}

const std::vector<Call> heap_calls{
    {"malloc", [] { keep(malloc(10)); }},
    {"malloc", [] { keep(new int(1)); }},
    {"malloc", [] { keep(std::string(100, 'x').data()); }},
    {"calloc", [] { keep(calloc(1, 10)); }},
    {"realloc", [] { keep(realloc(things().block, 100)); }},
    {"free", [] { free(things().block); }},
    {"aligned_alloc", [] { keep(aligned_alloc(64, 64)); }},
    {"posix_memalign",
     [] {
       void* block = nullptr;
       ignore(posix_memalign(&block, 64, 64));
     }},
    {"malloc", [] { keep(strdup("text")); }},
};

const std::vector<Call> lock_calls{
    {"pthread_mutex_lock", [] { pthread_mutex_lock(&things().mutex); }},
    {"pthread_mutex_trylock", [] { ignore(pthread_mutex_trylock(&things().mutex)); }},
    {"pthread_mutex_timedlock", [] { pthread_mutex_timedlock(&things().mutex, &things().past); }},
    {"pthread_mutex_unlock", [] { pthread_mutex_unlock(&things().mutex); }},
    {"pthread_mutex_lock", [] { const std::lock_guard lock(things().cpp_mutex); }},
    {"pthread_rwlock_rdlock", [] { pthread_rwlock_rdlock(&things().rwlock); }},
    {"pthread_rwlock_trywrlock", [] { pthread_rwlock_trywrlock(&things().rwlock); }},
    {"pthread_cond_timedwait", [] { pthread_cond_timedwait(&things().condition, &things().mutex, &things().past); }},
    {"pthread_cond_signal", [] { pthread_cond_signal(&things().condition); }},
    {"pthread_cond_broadcast", [] { pthread_cond_broadcast(&things().condition); }},
    {"sem_wait", [] { sem_wait(&things().semaphore); }},
    {"sem_trywait", [] { sem_trywait(&things().semaphore); }},
    {"sem_post", [] { sem_post(&things().semaphore); }},
    {"nanosleep", [] { nanosleep(&things().past, nullptr); }},
    {"clock_nanosleep", [] { clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &things().past, nullptr); }},
    {"usleep", [] { usleep(0); }},
    {"sched_yield", [] { std::this_thread::yield(); }},
    {"poll", [] { poll(nullptr, 0, 0); }},
};

const std::vector<Call> file_calls{
    {"open", [] { ignore(open("/dev/null", O_RDONLY)); }},
    {"openat", [] { ignore(openat(AT_FDCWD, "/dev/null", O_RDONLY)); }},
    {"read", [] { ignore(read(things().file, things().data.data(), 1)); }},
    {"write", [] { ignore(write(things().file, "x", 1)); }},
    {"pwrite", [] { ignore(pwrite(things().file, "x", 1, 0)); }},
    {"lseek", [] { ignore(lseek(things().file, 0, SEEK_SET)); }},
    {"close", [] { close(-1); }},
    {"fsync", [] { fsync(things().file); }},
    {"fcntl", [] { fcntl(things().file, F_GETFL, 0); }},
    {"mmap", [] { keep(mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)); }},
    {"socket", [] { ignore(socket(AF_UNIX, SOCK_STREAM, 0)); }},
    {"send", [] { ignore(send(things().file, "x", 1, 0)); }},
    {"fopen", [] { ignore(fopen("/dev/null", "r") != nullptr); }},
    {"fwrite", [] { ignore(static_cast<long>(fwrite(things().data.data(), 1, 16, things().stream))); }},
    {"fprintf", [] { fprintf(things().stream, "%d\n", 1); }},
    {"fflush", [] { fflush(things().stream); }},
    {"fputs", [] { fputs(things().data.data(), things().stream); }},
    {"fclose", [] { fclose(things().stream); }},
    {"write", [] { things().cpp_stream << "x" << std::flush; }},
};

const std::vector<Call> throws{
    {"__cxa_allocate_exception",
     [] {
       try {
         throw 1;
       } catch (int) {
       }
     }},
    {"__cxa_allocate_exception",
     [] {
       try {
         ignore(std::optional<int>().value());  // others format their message first
       } catch (const std::bad_optional_access&) {
       }
     }},
};

void check_each(const std::vector<Call>& calls) {
  things();
  for (const Call& call : calls) {
    CAPTURE(call.name);
    const Ending free_thread = run_in_child(call.make);
    CHECK(free_thread.exit_code == 0);
    CHECK(free_thread.words.empty());
    const Ending marked = run_in_child([&call] {
      const RealTimeGuard guard("here.cpp", 42);
      caller_of(call.make);
    });
    CHECK(marked.aborted);
    CAPTURE(marked.words);
    const auto says = [&marked](const std::string& name) {
      return marked.says("kadans: " + name + " called by a real-time thread, guarded at here.cpp:42\n");
    };
    CHECK((says(call.name) || says("__" + std::string(call.name) + "_chk")));  // the latter with _FORTIFY_SOURCE
    CHECK(marked.says("kadans::testing::caller_of(void (*)())"));
  }
}

TEST_CASE("a marked thread that goes to the heap is aborted") {
  if (RealTimeGuard::calls_are_guarded()) check_each(heap_calls);
}

TEST_CASE("a marked thread that locks or waits is aborted") {
  if (RealTimeGuard::calls_are_guarded()) check_each(lock_calls);
}

TEST_CASE("a marked thread that touches files is aborted") {
  if (RealTimeGuard::calls_are_guarded()) check_each(file_calls);
}

TEST_CASE("a marked thread that throws is aborted") {
  if (RealTimeGuard::calls_are_guarded()) check_each(throws);
}

TEST_CASE("a marked thread that goes to the heap is aborted with a sanitizer too") {
  const Ending allocates = run_in_child([] {
    const RealTimeGuard guard("here.cpp", 42);
    keep(new int(1));
  });
  CHECK(allocates.aborted);
  CHECK(allocates.says("kadans: malloc called by a real-time thread, guarded at here.cpp:42"));
  int* block = new int(1);
  keep(block);
  const Ending gives_back = run_in_child([block] {
    const RealTimeGuard guard;
    delete block;
  });
  delete block;
  CHECK(gives_back.aborted);
  CHECK(gives_back.says("kadans: free called by a real-time thread"));
}

}  // namespace
}  // namespace kadans::testing
