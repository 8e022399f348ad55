// A model that is driven through HostMot2 boards: the driver, the datagrams and the boards, all on virtual time, on one
// thread.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "imu_line.h"
#include "kadans/model/kinematics.h"
#include "kadans/plant/world.h"
#include "plant/hostmot2/emulator/emulated_machine.h"
#include "plant/hostmot2/emulator/register_file.h"
#include "plant/hostmot2/hostmot2_plant.h"
#include "plant/hostmot2/lbp_link.h"
#include "plant/hostmot2/mapped_link.h"
#include "plant/imu/imu_plant.h"

namespace kadans::test {

class VirtualCable final : public hostmot2::DatagramPort {
 public:
  explicit VirtualCable(hostmot2::EmulatedWire& wire) : wire_(wire) {}
  bool send(hostmot2::Octets datagram) noexcept override {
    sent = datagram.size();
    if (holds) {
      std::copy_n(datagram.begin(), sent, held_.begin());
      return true;
    }
    wire_.receive(datagram, now_);
    return true;
  }
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t) noexcept override {
    if (holds) {
      std::copy_n(held_.begin(), std::min(answered_, into.size()), into.begin());
      return std::exchange(answered_, 0);
    }
    const std::vector<std::uint8_t> bytes = wire_.take(now_);
    std::copy_n(bytes.begin(), std::min(bytes.size(), into.size()), into.begin());
    if (!bytes.empty()) received = bytes.size();
    return bytes.size();
  }
  void await(std::int64_t until_ns) noexcept override { now_ = std::max(now_, std::min(until_ns, wire_.due_ns())); }
  std::int64_t now_ns() const noexcept override { return now_; }
  void set(std::int64_t now) noexcept { now_ = now; }
  std::size_t sent = 0, received = 0;  // bytes of the last datagrams

  // The board gets a datagram, and the host the reply, with answer(): until then neither end allocates.
  bool holds = false;
  void answer() {
    wire_.receive({held_.data(), sent}, now_);
    const std::vector<std::uint8_t> bytes = wire_.take(now_);
    std::ranges::copy(bytes, held_.begin());
    answered_ = bytes.size();
  }

 private:
  hostmot2::EmulatedWire& wire_;
  std::array<std::uint8_t, 2048> held_{};
  std::size_t answered_ = 0;
  std::int64_t now_ = -1'000'000'000'000;
};

// A card on PCI answers at once; its register file does so here at each write outside of the tick's.
class VirtualCard final : public hostmot2::MappedLink {
 public:
  VirtualCard(const std::string& path, hostmot2::RegisterFile& file) : MappedLink(path), file_(file) {}
  bool write(hostmot2::RegisterWrite one) override {
    const bool good = MappedLink::write(one);
    answer();
    return good;
  }
  void write_all(std::span<const hostmot2::RegisterWrite> writes) noexcept override {
    MappedLink::write_all(writes);
    answer();
  }

 private:
  void answer() noexcept {
    file_.take();
    file_.show();
  }
  hostmot2::RegisterFile& file_;
};

class HostMot2World final : public OneRobotWorld {
 public:
  HostMot2World(std::unique_ptr<World> model, const hostmot2::HostMot2Settings& settings,
                const hostmot2::HostMot2Settings& there, const PlantSite& site,
                const imu::SerialImuSettings& beside = {})
      : model_(std::move(model)), machine_(there, site, 1), wired_feet_(!settings.feet.empty()) {
    std::vector<std::unique_ptr<hostmot2::BoardLink>> links;
    for (std::size_t i = 0; i < settings.boards.size(); ++i) {
      if (!settings.boards[i].resource.empty()) {  // a card on PCI
        files_.push_back(std::make_unique<hostmot2::RegisterFile>(machine_.board(i), settings.boards[i].resource));
        links.push_back(std::make_unique<VirtualCard>(settings.boards[i].resource, *files_.back()));
        continue;
      }
      auto cable = std::make_unique<VirtualCable>(machine_.wire(i));
      cables_.push_back(cable.get());
      links.push_back(std::make_unique<hostmot2::LbpLink>(std::move(cable), 50'000'000, 0));
    }
    plant_ = std::make_unique<hostmot2::HostMot2Plant>(settings, site, std::move(links));
    machine_.look(inner());
    for (const auto& file : files_) file->show();
    if (beside.given()) stand_beside(beside, {1, 0, 0, 0});
  }

  // Before the start: its IMU is one on a serial line.
  void stand_beside(const imu::SerialImuSettings& settings, const Quat& to_base) {
    imu_ =
        std::make_unique<imu::EmulatedImu>(imu::EmulatedImu::Settings{.old = settings.protocol == imu::Protocol::mtdata,
                                                                      .delay_ns = std::llround(1e9 * settings.delay_s)},
                                           1);
    auto line = std::make_unique<ImuLine>(*imu_);
    line_ = line.get();
    line_->set(-100'000'000);
    to_base_ = to_base;
    feel();
    plant_ = std::make_unique<imu::ImuPlant>(std::move(plant_), settings, to_base, std::move(line),
                                             imu::ImuPlant::Threads::none);
  }

  // Throws InputError, as at the start of a run.
  void start() {
    for (VirtualCable* cable : cables_) cable->set(time_ns_);
    (void)plant_->open(nullptr);
    started_ = true;
  }

  void read(SensorFrame& sensors) noexcept override {
    if (!started_) start();
    set_time();
    // What no board measures comes from the model.
    inner().read(sensors);
    const auto feet = sensors.feet;
    plant_->read(sensors);
    if (!wired_feet_) sensors.feet = feet;
  }
  void write(const ActuationFrame& actuation) noexcept override {
    if (!silent) plant_->write(actuation);
  }
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_m) override {
    inner().push(link, force_N, point_m);
  }
  void step(std::int64_t dt_ns) override {
    if (!started_) start();
    for (const auto& file : files_) file->take();
    machine_.drive(inner());
    model_->step(dt_ns);
    machine_.pass(dt_ns);
    time_ns_ += dt_ns;
    machine_.look(inner());
    for (const auto& file : files_) file->show();
    if (imu_) feel();
  }
  const PlantTruth& truth() const noexcept override { return model_->robot(0).truth(); }
  void hash(StateHash& hash) const noexcept override { model_->hash(hash); }

  Plant& driver() noexcept { return *plant_; }
  hostmot2::EmulatedMachine& machine() noexcept { return machine_; }
  imu::EmulatedImu& imu_device() noexcept { return *imu_; }
  VirtualCable& cable(std::size_t number) noexcept { return *cables_[number]; }
  bool silent = false;  // the driver hangs

 private:
  WorldRobot& inner() noexcept { return model_->robot(0); }
  void set_time() noexcept {
    for (VirtualCable* cable : cables_) cable->set(time_ns_);
    if (line_ != nullptr) line_->set(time_ns_);
  }
  void feel() {
    if (started_) imu_->pass(time_ns_);  // what was due until now it has measured
    SensorFrame sensors;
    inner().read(sensors);
    imu_->feels(rotate_inverse(to_base_, sensors.imu.angular_velocity_rad_s),
                rotate_inverse(to_base_, sensors.imu.acceleration_m_s2));
  }

  std::unique_ptr<World> model_;
  hostmot2::EmulatedMachine machine_;
  bool wired_feet_;
  std::vector<VirtualCable*> cables_;
  std::vector<std::unique_ptr<hostmot2::RegisterFile>> files_;
  std::unique_ptr<imu::EmulatedImu> imu_;
  ImuLine* line_ = nullptr;
  Quat to_base_{1, 0, 0, 0};
  std::unique_ptr<Plant> plant_;
  std::int64_t time_ns_ = 0;
  bool started_ = false;
};

}  // namespace kadans::test
