#include "drive_bench.h"

#include <algorithm>
#include <ctime>
#include <stdexcept>

#include <pthread.h>

#include "app/assembly/assembled_plant.h"
#include "app/terminal.h"
#include "signal/monotonic_clock.h"

namespace kadans {
namespace {

constexpr int bench_priority = 85;  // above the drives' own threads

}  // namespace

DriveBench::DriveBench(const Robot& robot, const std::string& plant, const std::string& peer, const std::string& imu)
    : period_ns_(robot.config.engine.control_period_ns()),
      joint_count_(static_cast<std::uint32_t>(robot.config.model.joints.size())) {
  const PlantType& type = plant_type_named(robot.config, "--plant", {plant, {}});
  words_ = type.drive_words();
  try {
    if (type.is_model()) {
      world_ = type.make_world({robot.config.model, robot.config.plant, 1});
    } else {
      plant_ = make_bus(robot.config, type, peer, imu);
    }
  } catch (const std::invalid_argument& error) {
    refuse(robot.config.file, error.what());
  }
}

DriveBench::~DriveBench() {
  const sched_param usual{};
  (void)pthread_setschedparam(pthread_self(), SCHED_OTHER, &usual);
  if (!open_) return;
  ActuationFrame nothing;
  nothing.joint_count = joint_count_;
  plant().write(nothing);
  plant().close();
}

bool DriveBench::open() {
  open_ = plant().open(interrupted);
  // Without the right it is a usual thread: then drives' watchdogs may let go when the machine is busy.
  sched_param parameter{};
  parameter.sched_priority = bench_priority;
  if (!world_) (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  due_ns_ = now_ns();
  return open_;
}

void DriveBench::read(SensorFrame& sensors) { plant().read(sensors); }

void DriveBench::write(const ActuationFrame& actuation) {
  plant().write(actuation);
  if (world_) world_->step(period_ns_);
  due_ns_ = std::max(due_ns_ + period_ns_, now_ns() - period_ns_);
  const timespec until = timespec_of(due_ns_);
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

std::int64_t DriveBench::now_ns() const noexcept { return monotonic_ns(); }

}  // namespace kadans
