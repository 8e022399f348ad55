#include "dynamixel_plant.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "kadans/plant/bus_thread.h"

namespace kadans::dynamixel {
namespace {

constexpr NamedCount<PortCounts> named_counts[] = {
    {"cycles", &PortCounts::cycles, "cycles of all serial ports"},
    {"answers", &PortCounts::answers, "readings of servos"},
    {"lost", &PortCounts::lost, "readings that never came"},
    {"corrupt", &PortCounts::corrupt, "packets that were not what was asked for, or had a wrong CRC"},
    {"strange", &PortCounts::strange, "readings that no servo with its settings gives: not used"},
    {"late", &PortCounts::late, "cycles that took longer than their period"},
    {"limited", &PortCounts::limited, "goals beyond the servos' own limits, cut to these"},
};

}  // namespace

struct DynamixelPlant::Port {
  Port(SerialPort& of, const PortCycle::Timing& timing, std::vector<Servo> servos, std::vector<std::size_t> its_joints)
      : serial(of), cycle(of, timing, std::move(servos)), period_ns(timing.period_ns), joints(std::move(its_joints)) {}

  SerialPort& serial;
  PortCycle cycle;
  std::int64_t period_ns;
  Latest<ActuationFrame> actuation;
  Latest<PortSample> sample;
  std::vector<std::size_t> joints;  // of its servos
  BusThread thread;

  void run_once() noexcept {
    {
      const auto asked = actuation.read();
      cycle.run(*asked);
    }
    sample.publish(cycle.sample());
  }
  void loop() noexcept {
    std::int64_t due_ns = serial.now_ns();
    while (!thread.asked_to_stop()) {
      run_once();
      const std::int64_t now_ns = serial.now_ns();
      due_ns += period_ns;
      if (due_ns < now_ns) due_ns += (now_ns - due_ns + period_ns - 1) / period_ns * period_ns;  // on the grid again
      const timespec until = timespec_of(due_ns);
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    }
  }
};

DynamixelPlant::DynamixelPlant(DynamixelSettings settings, PlantSite site,
                               std::vector<std::unique_ptr<SerialPort>> ports, Threads threads)
    : settings_(std::move(settings)),
      site_(std::move(site)),
      serial_(std::move(ports)),
      threads_(threads),
      period_ns_(bus_period_ns(settings_, site_.layout.period_ns)) {}

DynamixelPlant::~DynamixelPlant() { close(); }

bool DynamixelPlant::open(bool (*give_up)() noexcept) {
  if (serial_.empty()) {
    for (const PortSettings& port : settings_.ports) serial_.push_back(open_port(port.device, port.baud, port.place));
  }
  const std::vector<std::string> drives = drive_names(site_.layout.joints, site_.transmissions);
  for (std::size_t i = 0; i < settings_.ports.size(); ++i) {
    const PortSettings& port = settings_.ports[i];
    std::vector<Servo> servos;
    std::vector<std::size_t> joints;
    for (const ServoSettings& servo : settings_.servos) {
      if (servo.port != port.name) continue;
      joints.push_back(static_cast<std::size_t>(std::ranges::find(drives, servo.drive) - drives.begin()));
      servos.emplace_back(servo, joints.back(), settings_.watchdog_s);
    }
    const PortCycle::Timing timing{.baud = port.baud,
                                   .period_ns = period_ns_,
                                   .usb_latency_ns = std::llround(1e9 * settings_.usb_latency_s),
                                   .patience_ns = std::llround(1e9 * settings_.patience_s),
                                   .watchdog_s = settings_.watchdog_s};
    ports_.push_back(std::make_unique<Port>(*serial_[i], timing, std::move(servos), std::move(joints)));
    if (!ports_.back()->cycle.open(port.device, give_up)) return false;
  }
  open_ = true;
  run_cycles();  // the first reading is here before the loop
  if (threads_ == Threads::none) return true;
  for (const auto& port : ports_) port->thread.start("servos", "a serial port", [its = port.get()] { its->loop(); });
  return true;
}

void DynamixelPlant::close() noexcept {
  for (const auto& port : ports_) port->thread.ask_to_stop();
  for (const auto& port : ports_) {
    port->thread.stop();
    if (open_) port->cycle.close();
  }
  open_ = false;
}

void DynamixelPlant::run_cycles() noexcept {
  for (const auto& port : ports_) port->run_once();
}

void DynamixelPlant::write(const ActuationFrame& actuation) noexcept {
  copy_used(actuation, drives_);
  for (const Transmission& transmission : site_.transmissions) transmission.to_drives(drives_);
  for (const auto& port : ports_) port->actuation.publish(drives_);
}

void DynamixelPlant::read(SensorFrame& sensors) noexcept {
  sensors.joint_count = static_cast<std::uint32_t>(site_.layout.joints.size());
  sensors.foot_count = static_cast<std::uint32_t>(site_.layout.feet.size());
  sensors.channel_count = static_cast<std::uint32_t>(site_.layout.sensors.size());
  sensors.time_ns = ports_.empty() ? 0 : ports_.front()->serial.now_ns();
  sensors.supply_V = std::numeric_limits<double>::quiet_NaN();
  counts_ = {};
  age_ms_ = cycle_ms_ = 0;
  for (const auto& port : ports_) {
    const auto sample = port->sample.read();
    for (const auto& one : named_counts) counts_.*one.value += sample->counts.*one.value;
    cycle_ms_ = std::max(cycle_ms_, sample->cycle_ms);
    for (std::size_t i = 0; i < port->joints.size() && i < sample->count; ++i) {
      const ServoReading& is = sample->servos[i];
      sensors.joints[port->joints[i]] = is.joint;
      age_ms_ = std::max(age_ms_, 1e3 * seconds_between(is.joint.time_ns, sensors.time_ns));
      if (!(sensors.supply_V <= is.supply_V)) sensors.supply_V = is.supply_V;  // the lowest
    }
  }
  drives_to_joints(site_.transmissions, sensors);
}

std::vector<PlantCount> DynamixelPlant::link_counts() const { return counts_of(named_counts, counts_); }

void DynamixelPlant::declare_signals(SignalTable& table) const {
  declare_counts(table, named_counts, counts_);
  table.add({"plant.bus.cycle_ms", "ms", "time that the last cycle of the slowest port took"}, &cycle_ms_);
  table.add({"plant.bus.age_ms", "ms", "age of the oldest servo's newest reading"}, &age_ms_);
}

}  // namespace kadans::dynamixel
