// A program beside this one: the doorbell tells when it is gone, its memory cannot be taken away, its end is known.
#include "kadans/realtime/child_process.h"

#include <csignal>
#include <cstring>
#include <system_error>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

using namespace kadans;

namespace {

ChildProcess shell(const std::string& command, const SharedMemory& memory) {
  return {"/bin/sh", {"sh", "-c", command}, memory};
}

}  // namespace

TEST_CASE("the doorbell ends when the process does, and how it ended is known") {
  const SharedMemory memory(4096);
  for (const auto& [command, end] :
       {std::pair{"exit 7", "exit code 7"}, std::pair{"kill -SEGV $$", "signal 11 (Segmentation fault)"},
        std::pair{"kill -STOP $$", "signal 9 (Killed)"}}) {
    ChildProcess process(shell(command, memory));
    if (std::string(command).find("STOP") == std::string::npos) {
      CHECK(process.bell().wait(-1) == Doorbell::Heard::end);
    }
    CHECK(process.end() == end);
  }
}

TEST_CASE("a program finds its doorbell and its memory where they are promised, and no other file") {
  const SharedMemory memory(4096);
  const int other = fcntl(STDERR_FILENO, F_DUPFD, 20);
  ChildProcess process(shell("printf hello >&4 && ! test -e /dev/fd/" + std::to_string(other) +
                                 " && ! test -e /dev/fd/5 && printf x >&3 && exit 0; exit 1",
                             memory));
  CHECK(process.bell().wait(-1) == Doorbell::Heard::ring);
  CHECK(process.end() == "exit code 0");
  CHECK(std::memcmp(memory.get(), "hello", 5) == 0);
  close(other);
}

TEST_CASE("signals that are for the whole group do not reach it") {
  const SharedMemory memory(4096);
  ChildProcess process(shell("kill -TERM $$; kill -INT $$; kill -HUP $$; exit 5", memory));
  CHECK(process.bell().wait(-1) == Doorbell::Heard::end);
  CHECK(process.end() == "exit code 5");
}

TEST_CASE("shared memory cannot be cut short, and one that is too small is refused") {
  const SharedMemory memory(8192);
  CHECK(ftruncate(memory.descriptor(), 0) != 0);
  const SharedMemory same(dup(memory.descriptor()), 8192);
  static_cast<char*>(memory.get())[8191] = 3;
  CHECK(static_cast<char*>(same.get())[8191] == 3);
  CHECK_THROWS_AS(SharedMemory(dup(memory.descriptor()), 8193), std::system_error);
}

TEST_CASE("a program that does not exist is told of, a doorbell without anybody rings in vain") {
  const SharedMemory memory(4096);
  CHECK_THROWS_AS(ChildProcess("/no/such/program", {"x"}, memory), std::system_error);
  auto [one, other] = Doorbell::make_pair();
  for (int i = 0; i < 100'000; ++i) one.ring();  // more than the system keeps
  CHECK(one.wait(0) == Doorbell::Heard::nothing);
  CHECK(other.wait(0) == Doorbell::Heard::ring);
  { const Doorbell gone(std::move(other)); }
  CHECK(one.wait(0) == Doorbell::Heard::end);
}
