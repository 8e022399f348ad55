// A recorder's process killed with SIGKILL, which nothing can catch: what its record holds.
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <vector>

#include <doctest/doctest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kadans/signal/random.h"
#include "scratch_file.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/recorder.h"
#include "telemetry/record/signal_topics.h"

namespace killed_record_test {

using namespace kadans;

namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr std::size_t joints = 100;
const double zero = 0;

SignalTable robot_table() {
  SignalTable table;
  for (std::size_t i = 0; i < joints; ++i) table.add({"joint.j" + std::to_string(i) + ".rad", "rad", ""}, &zero);
  table.add({"mode", "", ""}, &zero);  // stands still
  return table;
}

// Records at 1 kHz of its own time, as fast as it can, drained each 20 ms of it, until it is killed.
[[noreturn]] void record_for_ever(const std::string& file, std::atomic<std::uint64_t>& ticks) {
  const SignalTable table = robot_table();
  Recorder recorder(table, {.subjects = {.joints = {"j0"}, .base = "torso", .feet = {}}});
  if (!recorder.open(file)) _exit(1);
  RandomStream random(1, "noise");
  std::vector<double> row(table.size());
  for (std::uint64_t tick = 0;; ++tick) {
    row[0] = static_cast<double>(tick);
    for (std::size_t i = 1; i < joints; ++i) row[i] = random.uniform();
    recorder.record(tick, static_cast<std::int64_t>(tick) * ms, row);
    if (tick % 20 == 19 && !recorder.drain()) _exit(1);
    ticks.store(tick + 1, std::memory_order_release);
  }
}

// Rows of the record, each of which holds its own number.
std::uint64_t rows_of(const std::string& file) {
  McapReader reader(file);
  std::uint64_t rows = 0;
  std::vector<double> values(joints);
  for (McapMessage message; reader.next(message);) {
    if (reader.channels().at(message.channel).topic != "/joint") continue;
    REQUIRE(message.sequence == rows);
    REQUIRE(read_cdr(message.payload, values) == Precision::full);
    REQUIRE(values[0] == static_cast<double>(rows));
    ++rows;
  }
  CHECK_FALSE(reader.complete());
  const bool cut = reader.problem().find("the file ends") != std::string::npos;  // nothing else is wrong
  CHECK_MESSAGE(cut, reader.problem());
  return rows;
}

}  // namespace

TEST_CASE("A record whose process is killed at any moment opens, and lacks no row that is older than a second") {
  const bool soak = std::getenv("KADANS_SOAK") != nullptr;  // NOLINT(concurrency-mt-unsafe): one thread
  void* const shared =
      mmap(nullptr, sizeof(std::atomic<std::uint64_t>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  REQUIRE(shared != MAP_FAILED);
  auto& ticks = *new (shared) std::atomic<std::uint64_t>(0);
  RandomStream random(1, "kills");
  for (int i = 0; i < (soak ? 20 : 3); ++i) {
    const ScratchFile file;
    ticks = 0;
    const auto until = static_cast<std::uint64_t>(random.uniform(1'000, 6'000));
    const pid_t child = fork();
    if (child == 0) record_for_ever(file.path(), ticks);
    int status = 0;
    while (ticks.load(std::memory_order_acquire) < until && waitpid(child, &status, WNOHANG) == 0) sched_yield();
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    const std::uint64_t reached = ticks.load();
    CHECK(reached >= until);
    CHECK(rows_of(file.path()) + 1000 >= reached);
  }
  munmap(shared, sizeof ticks);
}

}  // namespace killed_record_test
