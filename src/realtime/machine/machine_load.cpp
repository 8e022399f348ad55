#include "machine_load.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <optional>
#include <vector>

#include <unistd.h>

namespace kadans {
namespace {

// Each for ever: its end is the end of its process.

void compute() {
  for (volatile std::uint64_t sum = 0;;) sum = sum * 6364136223846793005U + 1;
}

void fill_memory() {
  std::vector<char> from(std::size_t{16} << 20U), to(from.size());
  for (int i = 0;; ++i) {
    std::memset(from.data(), i, from.size());
    std::memcpy(to.data(), from.data(), from.size());
    free(std::malloc(std::size_t{8} << 20U));
  }
}

void write_disk() {
  const std::vector<char> block(std::size_t{1} << 20U);
  FILE* const file = std::tmpfile();
  while (file != nullptr) {
    std::rewind(file);
    for (int i = 0; i < 16; ++i) (void)!std::fwrite(block.data(), 1, block.size(), file);
    std::fflush(file);
    fsync(fileno(file));
  }
  pause();
}

// Two processes that wake each other.
void switch_contexts() {
  int there[2], back[2];
  if (pipe(there) != 0 || pipe(back) != 0) return;
  const std::optional<ChildProcess> other = ChildProcess::copy();
  const bool first = other.has_value();
  if (!first) die_with_parent();
  char token = 0;
  if (first) (void)!write(there[1], &token, 1);
  while (read(first ? back[0] : there[0], &token, 1) == 1) (void)!write(first ? there[1] : back[1], &token, 1);
}

void set_timers() {
  const timespec short_time{0, 50'000};
  for (;;) nanosleep(&short_time, nullptr);
}

}  // namespace

MachineLoad::MachineLoad() {
  const long cpus = sysconf(_SC_NPROCESSORS_ONLN);
  for (long i = 0; i < cpus; ++i) {
    start(compute);
    start(switch_contexts);
    start(set_timers);
  }
  start(fill_memory);
  start(write_disk);
}

void MachineLoad::start(void (*work)()) {
  if (std::optional<ChildProcess> process = ChildProcess::copy()) return processes_.push_back(std::move(*process));
  die_with_parent();
  work();
  _exit(0);
}

}  // namespace kadans
