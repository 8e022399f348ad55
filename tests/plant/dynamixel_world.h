// A model that is driven through servos: the driver, the packets on the wire and the servos, all on virtual time, on
// one thread. A cycle of the bus takes as long as its bytes do, and what it read is seen when it is over.
#pragma once

#include <memory>
#include <vector>

#include "kadans/plant/world.h"
#include "plant/dynamixel/dynamixel_plant.h"
#include "plant/dynamixel/emulator/emulated_robot.h"

namespace kadans::test {

class VirtualPort final : public SerialPort {
 public:
  VirtualPort(dynamixel::EmulatedBus& bus, std::uint32_t baud) : bus_(bus), baud_(baud) {}
  bool send(dynamixel::Octets bytes) noexcept override {
    bus_.receive(bytes, now_, baud_);
    sent += bytes.size();
    return true;
  }
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override {
    if (bus_.due_ns() > until_ns) {
      now_ = std::max(now_, until_ns);
      return 0;
    }
    now_ = std::max(now_, bus_.due_ns());
    std::size_t count = bus_.take(into, now_);
    if (twice > 0 && count >= twice && count + twice <= into.size()) {
      std::copy_backward(into.begin(), into.begin() + static_cast<std::ptrdiff_t>(count),
                         into.begin() + static_cast<std::ptrdiff_t>(count + twice));
      count += twice;
    }
    received += count;
    return count;
  }
  void discard() noexcept override {
    std::array<std::uint8_t, 4096> old;
    while (bus_.take(old, now_) > 0) {
    }
  }
  std::int64_t now_ns() const noexcept override { return now_; }
  void set(std::int64_t now) noexcept { now_ = now; }
  std::size_t sent = 0, received = 0;
  std::size_t twice = 0;  // so many bytes at the begin of what comes come twice

 private:
  dynamixel::EmulatedBus& bus_;
  std::uint32_t baud_;
  std::int64_t now_ = -1'000'000'000'000;
};

class DynamixelWorld final : public OneRobotWorld {
 public:
  // `there`: what the servos are, where that is not what the driver's configuration says.
  DynamixelWorld(std::unique_ptr<World> model, const dynamixel::DynamixelSettings& settings, const PlantSite& site,
                 const dynamixel::DynamixelSettings* there = nullptr)
      : model_(std::move(model)), servos_(there == nullptr ? settings : *there, site, 1) {
    std::vector<std::unique_ptr<SerialPort>> ports;
    for (std::size_t i = 0; i < settings.ports.size(); ++i) {
      auto port = std::make_unique<VirtualPort>(servos_.bus(i), settings.ports[i].baud);
      ports_.push_back(port.get());
      ports.push_back(std::move(port));
    }
    plant_ = std::make_unique<dynamixel::DynamixelPlant>(settings, site, std::move(ports),
                                                         dynamixel::DynamixelPlant::Threads::none);
    servos_.look(inner());
  }

  // Throws InputError, as at the start of a run.
  void start() {
    (void)plant_->open();
    for (VirtualPort* port : ports_) port->set(-plant_->period_ns());
    plant_->run_cycles();
    for (VirtualPort* port : ports_) port->set(0);
    plant_->read(held_);
    started_ = true;
  }

  void read(SensorFrame& sensors) noexcept override {
    if (!started_) start();
    for (VirtualPort* port : ports_) port->set(time_ns_);
    if (time_ns_ >= visible_ns_) plant_->read(held_);
    held_.time_ns = time_ns_;
    // What no servo measures comes from the model.
    inner().read(sensors);
    for (std::size_t i = 0; i < held_.joint_count; ++i) {
      if (held_.joints[i].sequence > 0) sensors.joints[i] = held_.joints[i];
    }
    sensors.supply_V = held_.supply_V;
    sensors.time_ns = time_ns_;
  }
  void write(const ActuationFrame& actuation) noexcept override { plant_->write(actuation); }
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_m) override {
    inner().push(link, force_N, point_m);
  }
  void step(std::int64_t dt_ns) override {
    if (!started_) start();
    servos_.look(inner());
    if (time_ns_ >= next_ns_) {
      for (VirtualPort* port : ports_) port->set(time_ns_);
      if (!silent) plant_->run_cycles();
      visible_ns_ = time_ns_;
      for (VirtualPort* port : ports_) visible_ns_ = std::max(visible_ns_, port->now_ns());
      cycle_ns = visible_ns_ - time_ns_;
      next_ns_ += plant_->period_ns();
      while (next_ns_ < visible_ns_) next_ns_ += plant_->period_ns();
    }
    servos_.drive(inner());
    model_->step(dt_ns);
    servos_.pass(dt_ns);
    time_ns_ += dt_ns;
  }
  const PlantTruth& truth() const noexcept override { return model_->robot(0).truth(); }
  void hash(StateHash& hash) const noexcept override { model_->hash(hash); }

  dynamixel::DynamixelPlant& driver() noexcept { return *plant_; }
  dynamixel::EmulatedRobot& servos() noexcept { return servos_; }
  VirtualPort& port(std::size_t number) noexcept { return *ports_[number]; }
  std::int64_t cycle_ns = 0;  // what the last cycle took
  bool silent = false;        // the driver hangs

 private:
  WorldRobot& inner() noexcept { return model_->robot(0); }

  std::unique_ptr<World> model_;
  dynamixel::EmulatedRobot servos_;
  std::vector<VirtualPort*> ports_;
  std::unique_ptr<dynamixel::DynamixelPlant> plant_;
  SensorFrame held_;
  std::int64_t time_ns_ = 0, next_ns_ = 0, visible_ns_ = 0;
  bool started_ = false;
};

}  // namespace kadans::test
