#include "ros2_bridge.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <future>
#include <optional>

#include <sys/resource.h>
#include <unistd.h>

#include "engine/behavior_log.h"
#include "engine/clock.h"
#include "realtime/machine/placement.h"
#include "realtime/posix_wait.h"
#include "realtime/task_thread.h"
#include "ros2_topics.h"
#include "text_commands.h"

namespace kadans {
namespace {

constexpr int niceness = 5;
constexpr int commands_a_beat = 8;  // the others wait, or make way for newer ones
constexpr double beats_a_sample = 2;

}  // namespace

// It beats twice as often as rows are asked for, so that whichever way the two clocks drift no row is missed. Its first
// beat joins the domain: the threads that DDS starts are as low as this one, and on the same CPUs.
struct Ros2Bridge::Inside final : Task {
  Inside(const Ros2Settings& wanted, const Parts& parts)
      : settings(wanted),
        port(parts.port),
        urdf(parts.texts.urdf),
        every_ticks(static_cast<std::uint32_t>(
            std::max(1.0, std::round(1 / (wanted.rate_hz * parts.instance.facts().control_period_s))))),
        readings(parts.instance.catalog(), urdf),
        commands({.instance = parts.instance,
                  .port = parts.port,
                  .pace = parts.pace,
                  .allowed = wanted.commands,
                  .refusal = "this run takes no orders over ROS 2: start it with --ros2-commands",
                  .who = "ROS 2"}),
        thread({.name = "ros2", .period_ns = std::llround(1e9 / (beats_a_sample * wanted.rate_hz))}, *this, wait) {}

  bool beat(const Beat&) override {
    if (!topics) return join();
    if (!running.load(std::memory_order_acquire)) return true;
    const auto row = port.signals();
    if (!row->values.empty() && row->tick != last_tick) {
      last_tick = row->tick;
      readings.take(*row);
      topics->publish();
    }
    serve();
    return true;
  }

  bool join() {
    try {
      (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);  // of this thread, and those it starts
      if (settings.avoid_cpu >= 0) (void)leave_cpu(settings.avoid_cpu);
      topics.emplace(settings.domain, readings, urdf);
      joined.set_value();
      return true;
    } catch (...) {
      joined.set_exception(std::current_exception());
      return false;
    }
  }

  void serve() {
    std::string text;
    for (int i = 0; i < commands_a_beat && topics->take(text); ++i) {
      if (const auto answer = commands.take(text)) topics->answer(*answer);
    }
    while (const auto answer = commands.next()) topics->answer(*answer);
  }

  Ros2Settings settings;
  InstancePort& port;
  std::string urdf;
  std::uint32_t every_ticks;
  RobotReadings readings;
  TextCommands commands;
  std::optional<Ros2Topics> topics;
  std::promise<void> joined;
  std::atomic<bool> running{false};
  std::uint64_t last_tick = UINT64_MAX;
  PosixWait wait{0, WallClock().now_ns()};
  TaskThread thread;
};

Ros2Bridge::Ros2Bridge(const Ros2Settings& settings, const Parts& parts)
    : inside_(std::make_unique<Inside>(settings, parts)) {
  std::future<void> joined = inside_->joined.get_future();
  inside_->thread.start();
  joined.get();
}

Ros2Bridge::~Ros2Bridge() { stop(); }

void Ros2Bridge::start() noexcept {
  inside_->port.want_signals(inside_->every_ticks);
  inside_->running.store(true, std::memory_order_release);
}

void Ros2Bridge::stop() noexcept {
  inside_->port.want_signals(0);
  inside_->thread.stop();
  inside_->thread.join();
  if (!inside_->topics) return;  // it has left already
  inside_->topics.reset();
  if (const std::string why = inside_->thread.failure(); !why.empty())
    program_log().message(Line::no_time, BehaviorLog::Severity::error, "ros2", "ended: " + why);
}

}  // namespace kadans
