// A model behind the datagrams of `kadans plant`, in step and on one thread: both ends of a socket of this process.
//
// One owner, one thread at a time.
#pragma once

#include <memory>
#include <vector>

#include "kadans/plant/plant_type.h"
#include "kadans/plant/world.h"
#include "plant_server.h"
#include "udp_plant.h"

namespace kadans {

class UdpWorld final : public OneRobotWorld {
 public:
  // Throws InputError when the system gives no sockets.
  UdpWorld(std::unique_ptr<World> model, const UdpSettings& settings, const PlantLayout& layout);

  bool open(bool (*give_up)() noexcept = nullptr) override;
  void declare_signals(SignalTable& table) const override { plant_.declare_signals(table); }
  std::vector<PlantCount> link_counts() const override { return plant_.link_counts(); }
  void read(SensorFrame& sensors) noexcept override { plant_.read(sensors); }
  void write(const ActuationFrame& actuation) noexcept override { plant_.write(actuation); }
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_m) override {
    model_->robot(0).push(link, force_N, point_m);
  }
  void carry(double x_m, double y_m, double heading_rad) override { model_->robot(0).carry(x_m, y_m, heading_rad); }
  void put(std::size_t object, const Vec3& position_m) override { model_->put(object, position_m); }
  void step(std::int64_t) override { (void)server_.beat(*model_, 1); }
  const PlantTruth& truth() const noexcept override { return model_->robot(0).truth(); }
  void hash(StateHash& hash) const noexcept override { model_->hash(hash); }
  void plan_faults(const std::vector<EmulatedFault>& faults) { server_.plan_faults(faults); }

  UdpPlant& driver() noexcept { return plant_; }

 private:
  struct Ends {
    Ends();
    int control, plant;
  };
  UdpWorld(std::unique_ptr<World> model, UdpSettings settings, const PlantLayout& layout, Ends ends);

  std::unique_ptr<World> model_;
  PlantServer server_;
  UdpPlant plant_;
};

}  // namespace kadans
