// The exchange between two processes: both types stand in anonymous shared memory, a forked child answers. Nobody
// sleeps; who waits gives up when the other has died.
#include <array>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <memory>
#include <new>

#include <doctest/doctest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "exchange/payload.h"
#include "kadans/exchange/latest.h"
#include "kadans/exchange/ring.h"

namespace kadans {
namespace {

using test::is_whole;
using test::make_payload;
using test::Payload;
using test::stress_count;

struct Shared {
  Latest<Payload> down, up;
  Ring<std::uint64_t, 16> commands, replies;
};
static_assert(std::is_trivially_copyable_v<Shared>);

class SharedMemory {
 public:
  SharedMemory() : memory_(mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    REQUIRE(memory_ != MAP_FAILED);
    new (memory_) Shared;
  }
  ~SharedMemory() { munmap(memory_, sizeof(Shared)); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  Shared& operator*() noexcept { return *static_cast<Shared*>(memory_); }

 private:
  void* memory_;
};

// The child's life: values come back with their number doubled, pairs of commands as their sum. The pair (0, 0) ends
// it.
int serve(Shared& shared) {
  const pid_t parent = getppid();
  for (;;) {
    if (shared.down.has_news()) {
      const auto reading = shared.down.read();
      const Payload& payload = *reading;
      if (!is_whole(payload)) return 1;
      shared.up.publish(make_payload(2 * payload.sequence));
    }
    if (shared.commands.size() == 1) return 2;  // half a pair
    if (shared.commands.size() >= 2) {
      const std::uint64_t sum = shared.commands.peek(0) + shared.commands.peek(1);
      shared.commands.drop(2);
      if (sum == 0) return 0;
      if (!shared.replies.try_push(sum)) return 3;  // the parent keeps room
    }
    sched_yield();
    if (getppid() != parent) return 4;
  }
}

class Child {
 public:
  explicit Child(Shared& shared) {
    std::cout.flush();  // or the child might write it once more
    pid_ = fork();
    if (pid_ == 0) _exit(serve(shared));
  }
  bool alive() {
    if (!ended_ && waitpid(pid_, &status_, WNOHANG) == pid_) ended_ = true;
    return !ended_;
  }
  int exit_code() {
    if (!ended_) waitpid(pid_, &status_, 0);
    ended_ = true;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
  }

 private:
  pid_t pid_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

TEST_CASE("values and a queue pass between two processes in both directions through shared memory") {
  SharedMemory memory;
  Shared& shared = *memory;
  Child child(shared);
  const std::uint64_t count = stress_count(20'000) / 10;
  std::uint64_t wrong = 0;
  for (std::uint64_t i = 1; i <= count && child.alive(); ++i) {
    shared.down.publish(make_payload(i));
    const std::array<std::uint64_t, 2> pair{i, 3 * i};
    if (!shared.commands.try_push(pair)) ++wrong;
    while (shared.replies.size() == 0 && child.alive()) sched_yield();
    std::uint64_t sum = 0;
    if (!shared.replies.try_pop(sum) || sum != 4 * i) ++wrong;
    while (!shared.up.has_news() && child.alive()) sched_yield();
    const Payload answer = shared.up.newest();
    if (answer.sequence != 2 * i || !is_whole(answer)) ++wrong;
  }
  const bool ended = shared.commands.try_push(std::array<std::uint64_t, 2>{0, 0});
  CHECK(child.exit_code() == 0);
  CHECK(ended);
  CHECK(wrong == 0);
}

TEST_CASE("what a process left in shared memory can be copied out and read elsewhere") {
  SharedMemory memory;
  {
    Child child(*memory);
    (*memory).down.publish(make_payload(21));
    while (!(*memory).up.has_news() && child.alive()) sched_yield();
    CHECK((*memory).commands.try_push(std::array<std::uint64_t, 4>{5, 6, 0, 0}));
    CHECK(child.exit_code() == 0);
  }
  const auto copy = std::make_unique<Shared>();
  std::memcpy(static_cast<void*>(copy.get()), &*memory, sizeof(Shared));
  CHECK(copy->up.newest().sequence == 42);
  CHECK(is_whole(copy->up.newest()));
  std::uint64_t sum = 0;
  CHECK(copy->replies.try_pop(sum));
  CHECK(sum == 11);
}

}  // namespace
}  // namespace kadans
