// Programs beside this one: what they get and what comes back, the doorbell tells when one is gone, its memory cannot
// be taken away, its end is known.
#include "realtime/machine/child_process.h"

#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>
#include <thread>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

using namespace kadans;

namespace {

PartnerProcess shell(const std::string& command, const SharedMemory& memory) {
  return {"/bin/sh", {"sh", "-c", command}, memory};
}

}  // namespace

TEST_CASE("the doorbell ends when the process does, and how it ended is known") {
  const SharedMemory memory(4096);
  for (const auto& [command, end] :
       {std::pair{"exit 7", "exit code 7"}, std::pair{"kill -SEGV $$", "signal 11 (Segmentation fault)"},
        std::pair{"kill -STOP $$", "signal 9 (Killed)"}}) {
    PartnerProcess process(shell(command, memory));
    if (std::string(command).find("STOP") == std::string::npos) {
      CHECK(process.bell().wait(-1) == Doorbell::Heard::end);
    }
    CHECK(process.end() == end);
  }
}

TEST_CASE("a program finds its doorbell and its memory where they are promised, and no other file") {
  const SharedMemory memory(4096);
  const int other = fcntl(STDERR_FILENO, F_DUPFD, 20);
  PartnerProcess process(shell("printf hello >&4 && ! test -e /dev/fd/" + std::to_string(other) +
                                   " && ! test -e /dev/fd/5 && printf x >&3 && exit 0; exit 1",
                               memory));
  CHECK(process.bell().wait(-1) == Doorbell::Heard::ring);
  CHECK(process.end() == "exit code 0");
  CHECK(std::memcmp(memory.get(), "hello", 5) == 0);
  close(other);
}

TEST_CASE("signals that are for the whole group do not reach it") {
  const SharedMemory memory(4096);
  PartnerProcess process(shell("kill -TERM $$; kill -INT $$; kill -HUP $$; exit 5", memory));
  CHECK(process.bell().wait(-1) == Doorbell::Heard::end);
  CHECK(process.end() == "exit code 5");
}

TEST_CASE("a program reads the text that it is given, and what it says and how it ends comes back") {
  const ProgramOutput said = run_program({"sh", "-c", "tr a b; echo err >&2; test -e /dev/fd/3 || exit 3"}, "a\na");
  CHECK(said.out == "b\nb");
  CHECK(said.err == "err\n");
  CHECK(said.exit_code == 3);
  const std::string much(300'000, 'x');
  CHECK(run_program({"cat"}, much).out == much);
}

TEST_CASE("what is stopped takes those of its group with it") {
  const MemoryFile said;
  ChildProcess process({.words = {"sh", "-c", "sleep 1000 & echo $!; wait"},
                        .files = {no_file, said.descriptor(), no_file},
                        .own_group = true});
  while (said.text().find('\n') == std::string::npos) usleep(1000);
  const pid_t grandchild = std::stoi(said.text());
  process.stop();
  CHECK(process.signal() == SIGKILL);
  CHECK(process.exit_code() == -1);
  bool gone = false;  // nobody's child, or nobody's yet
  for (int i = 0; i < 1000 && !gone; ++i) {
    std::ifstream status("/proc/" + std::to_string(grandchild) + "/stat");
    std::string text;
    gone = !std::getline(status, text) || text.find(") Z ") != std::string::npos;
    usleep(1000);
  }
  CHECK(gone);
}

TEST_CASE("what ends takes with it those of its group that it leaves behind") {
  int ends[2];
  REQUIRE(pipe2(ends, O_CLOEXEC) == 0);
  ChildProcess process(
      {.words = {"sh", "-c", "sleep 1000 & exit 4"}, .files = {no_file, ends[1], no_file}, .own_group = true});
  close(ends[1]);
  process.wait();
  CHECK(process.exit_code() == 4);
  char byte = 0;
  CHECK(read(ends[0], &byte, 1) == 0);  // the last that could write is gone
  close(ends[0]);
}

TEST_CASE("what ends takes its group with it also where this process was started with SIGCHLD ignored") {
  struct sigaction ignored {
  }, before{};
  ignored.sa_handler = SIG_IGN;
  REQUIRE(sigaction(SIGCHLD, &ignored, &before) == 0);
  int ends[2];
  REQUIRE(pipe2(ends, O_CLOEXEC) == 0);
  ChildProcess process(
      {.words = {"sh", "-c", "sleep 1000 & exit 4"}, .files = {no_file, ends[1], no_file}, .own_group = true});
  close(ends[1]);
  process.wait();
  sigaction(SIGCHLD, &before, nullptr);
  CHECK(process.exit_code() == 4);
  pollfd gone{ends[0], POLLIN, 0};
  CHECK(poll(&gone, 1, 5000) == 1);
  close(ends[0]);
}

TEST_CASE("a signal that interrupts the wait does not let those of its group live on") {
  struct sigaction handled {
  }, before{};
  handled.sa_handler = [](int) {};  // without SA_RESTART: calls end with EINTR
  REQUIRE(sigaction(SIGUSR1, &handled, &before) == 0);
  int ends[2];
  REQUIRE(pipe2(ends, O_CLOEXEC) == 0);
  ChildProcess process({.words = {"sh", "-c", "sleep 1000 & sleep 0.3; exit 4"},
                        .files = {no_file, ends[1], no_file},
                        .own_group = true});
  close(ends[1]);
  std::thread interrupter([waiting = pthread_self()] {
    usleep(100'000);
    pthread_kill(waiting, SIGUSR1);
  });
  process.wait();
  interrupter.join();
  sigaction(SIGUSR1, &before, nullptr);
  CHECK(process.exit_code() == 4);
  pollfd gone{ends[0], POLLIN, 0};
  CHECK(poll(&gone, 1, 5000) == 1);
  char byte = 0;
  if (gone.revents != 0) CHECK(read(ends[0], &byte, 1) == 0);  // the last that could write is gone
  close(ends[0]);
}

TEST_CASE("a copy of this process goes on by itself, and has no hold on those that were started before") {
  std::optional<ChildProcess> sleeper(ChildProcess({.words = {"sleep", "1000"}}));
  std::optional<ChildProcess> copied = ChildProcess::copy();
  if (!copied) {
    sleeper.reset();
    _exit(7);
  }
  const ChildProcess* const both[] = {&*sleeper, &*copied};
  while (!copied->ended()) ChildProcess::wait_for_one(both, -1);
  CHECK(copied->exit_code() == 7);
  CHECK_FALSE(sleeper->ended());
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
  CHECK_THROWS_AS(PartnerProcess("/no/such/program", {"x"}, memory), std::system_error);
  CHECK_THROWS_AS(run_program({"no-such-program"}), std::system_error);
  auto [one, other] = Doorbell::make_pair();
  for (int i = 0; i < 100'000; ++i) one.ring();  // more than the system keeps
  CHECK(one.wait(0) == Doorbell::Heard::nothing);
  CHECK(other.wait(0) == Doorbell::Heard::ring);
  { const Doorbell gone(std::move(other)); }
  CHECK(one.wait(0) == Doorbell::Heard::end);
}

TEST_CASE("A child that a real-time signal ends is told of by the signal's number") {
  ChildProcess process({.words = {"sh", "-c", "kill -34 $$"}});
  const ChildProcess* const one[] = {&process};
  while (!process.ended()) ChildProcess::wait_for_one(one, -1);
  CHECK(process.end() == "signal 34");
}
