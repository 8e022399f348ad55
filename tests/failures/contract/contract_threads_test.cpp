// Rows of the failure contract that take real threads; on virtual time, so that nothing depends on the machine's speed.
#include <atomic>
#include <csignal>
#include <filesystem>
#include <thread>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "realtime/live_robot.h"
#include "telemetry/record/recorder.h"

namespace contract_threads_test {

using namespace kadans;
using doctest::description;

namespace {

// Drains the record once a beat, or hangs.
class Drain final : public Task {
 public:
  explicit Drain(Recorder& recorder) : recorder_(recorder) {}
  bool beat(const Beat&) override {
    if (!hangs) (void)recorder_.drain();
    return true;
  }
  bool hangs = false;

 private:
  Recorder& recorder_;
};

struct RecordedRobot : LiveRobot {
  Recorder recorder{catalog.signals};
  Drain drain{recorder};
  std::unique_ptr<Wait> wait = time.make_wait();
  TaskThread thread{{.name = "record", .period_ns = 20 * tick_ns}, drain, *wait};

  void run(const std::string& file, std::int64_t ms) {
    REQUIRE(recorder.open(file));
    control.record_to(&recorder);
    thread.start();
    start();
    (void)run_until(ms);
    thread.stop();
    stop();
    thread.join();
  }
};

// No file grows beyond a few blocks.
class FullDisk {
 public:
  FullDisk() {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{8192, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

// Two threads that do nothing but allocate, touch and free, one that signals the process.
class Storm {
 public:
  Storm() {
    std::signal(SIGUSR1, [](int) {});
    for (int i = 0; i < 2; ++i) {
      threads_.emplace_back([this] {
        for (std::size_t bytes = 1; !over_; bytes = bytes % 1'000'003 + 4099) {
          const std::vector<char> block(bytes, 'x');
          rounds_ += block.back() == 'x' ? 1 : 0;
        }
      });
    }
    threads_.emplace_back([this] {
      while (!over_) kill(getpid(), SIGUSR1);
    });
  }
  ~Storm() {
    over_ = true;
    for (std::thread& thread : threads_) thread.join();
    std::signal(SIGUSR1, SIG_DFL);
  }
  Storm(const Storm&) = delete;
  Storm& operator=(const Storm&) = delete;
  long rounds() const { return rounds_; }

 private:
  std::atomic<bool> over_{false};
  std::atomic<long> rounds_{0};
  std::vector<std::thread> threads_;
};

std::string record_file(const char* name) {
  return (std::filesystem::temp_directory_path() / ("kadans_" + std::to_string(getpid()) + std::string(name) + ".mcap"))
      .string();
}

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("the robot holds, then damps, then is off, as without a heartbeat" *
          description("the behavior thread ends")) {
  LiveRobot robot;
  robot.script.at = [](std::int64_t time_ns) {
    if (time_ns > 300 * tick_ns) throw std::runtime_error("a high level failed");
  };
  robot.start();
  CHECK(robot.run_until(500).status.safety.level == SafetyLevel::hold);
  CHECK(robot.run_until(5000).status.safety.level == SafetyLevel::off);
  robot.stop();
}

TEST_CASE("the robot holds, then damps, then is off, and stays so when the thread goes on" *
          description("the behavior thread hangs for seconds")) {
  LiveRobot robot;
  bool hung = false;
  robot.script.at = [&](std::int64_t time_ns) {
    if (time_ns > 300 * tick_ns && !std::exchange(hung, true)) robot.behavior_wait->until(time_ns + 6000 * tick_ns);
  };
  robot.start();
  CHECK(robot.run_until(500).status.safety.level == SafetyLevel::hold);
  CHECK(robot.run_until(5000).status.safety.level == SafetyLevel::off);
  CHECK(robot.run_until(8000).status.safety.level == SafetyLevel::off);
  robot.stop();
  CHECK(hung);
  CHECK(robot.control_thread.statistics().missed.get() == 0);
}

TEST_CASE("no tick is left out, nothing fails" *
          description("other threads take the CPUs, allocate without end, and signals rain on the process")) {
  const Storm storm;
  LiveRobot robot;
  robot.start();
  const Snapshot& last = robot.run_until(3000);
  CHECK(last.status.safety.level == SafetyLevel::normal);
  CHECK(last.status.safety.fault_count == 0);
  robot.stop();
  CHECK(robot.control_task.ticks() >= 3000);
  CHECK(robot.control_thread.statistics().missed.get() == 0);
  CHECK(storm.rounds() > 0);
}

TEST_CASE("rows that do not fit the ring are dropped and counted, no tick is late" *
          description("the record's thread hangs")) {
  RecordedRobot robot;
  robot.drain.hangs = true;
  const std::int64_t ms = 15'000;  // longer than the ring holds
  robot.run(record_file("hung"), ms);
  CHECK(robot.control_task.ticks() >= static_cast<std::uint64_t>(ms));
  CHECK(robot.control_thread.statistics().missed.get() == 0);
  CHECK(robot.recorder.dropped() > 0);
  CHECK(robot.recorder.close());
  CHECK(robot.recorder.rows() + robot.recorder.dropped() == robot.control_task.ticks());
}

TEST_CASE("rows are lost and counted, the record says why, no tick is late" * description("the disk is full")) {
  const FullDisk disk;
  RecordedRobot robot;
  robot.run(record_file("full"), 3000);
  CHECK(robot.control_task.ticks() >= 3000);
  CHECK(robot.control_thread.statistics().missed.get() == 0);
  CHECK(robot.recorder.lost() > 0);
  CHECK_FALSE(robot.recorder.close());
  CHECK(robot.recorder.error().find("File too large") != std::string::npos);
}

TEST_CASE("both are told how much they missed, no sensor is silent, nothing jumps" *
          description("the machine is taken from the control thread and the model's alike")) {
  LiveRobot robot;
  for (DisturbedWait* wait : {&robot.control_wait, &robot.plant_wait}) {
    wait->late_from_ns = 200 * tick_ns;
    wait->late_by_ns = 60 * tick_ns;
    wait->late_times = 3;
  }
  robot.start();
  const Snapshot& snapshot = robot.run_until(700);
  CHECK(snapshot.status.safety.level == SafetyLevel::normal);
  CHECK(snapshot.status.safety.first_fault.code == FaultCode::tick_overrun);
  CHECK(snapshot.status.safety.fault_count == 1);  // nothing else
  robot.stop();
  CHECK(robot.control_thread.statistics().missed.get() == 180);
  CHECK(robot.plant_task.lost_periods() > 0);
}

TEST_CASE("silent_ticks_max ticks pass unnoticed, beyond them every sensor is silent: the joints are off, latched" *
          description("the model's thread alone is kept from its step")) {
  for (const std::int64_t late_ms : {4, 9}) {
    LiveRobot robot;
    robot.plant_wait.late_from_ns = 200 * tick_ns;
    robot.plant_wait.late_by_ns = late_ms * tick_ns;
    robot.plant_wait.late_times = 1;
    robot.start();
    const SafetyStatus status = robot.run_until(400).status.safety;
    CHECK(status.level == (late_ms == 4 ? SafetyLevel::normal : SafetyLevel::off));
    CHECK(status.first_fault.code == (late_ms == 4 ? FaultCode::none : FaultCode::sensor_silent));
    robot.stop();
  }
}

TEST_CASE("the task gives up after 100 wake-ups without time passing, the run ends, the watchdog is not fed" *
          description("the control thread's clock stands still")) {
  LiveRobot robot;
  robot.control_wait.frozen_at_ns_ = 250 * tick_ns;
  robot.start();
  (void)robot.run_until(400);
  robot.control_thread.join();  // time goes on before the thread's last instruction
  CHECK(robot.control_thread.over());
  CHECK(std::string(robot.control_thread.failure()) == "the clock stands still");
  CHECK(robot.control_task.ticks() <= 250);
  robot.stop();
}

TEST_SUITE_END();

}  // namespace contract_threads_test
