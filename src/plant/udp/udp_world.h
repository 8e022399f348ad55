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

class UdpWorld final : public WorldAround {
 public:
  // Throws InputError when the system gives no sockets.
  UdpWorld(std::unique_ptr<World> model, const UdpSettings& settings, const PlantLayout& layout);

  bool open(bool (*give_up)() noexcept = nullptr) override;
  void declare_signals(SignalTable& table) const override { plant_.declare_signals(table); }
  std::vector<PlantCount> link_counts() const override { return plant_.link_counts(); }
  void read(SensorFrame& sensors) noexcept override { plant_.read(sensors); }
  void write(const ActuationFrame& actuation) noexcept override { plant_.write(actuation); }
  void step(std::int64_t) override { (void)server_.beat(world_, 1); }
  void plan_faults(const std::vector<EmulatedFault>& faults) { server_.plan_faults(faults); }

  UdpPlant& driver() noexcept { return plant_; }

 private:
  struct Ends {
    Ends();
    int control, plant;
  };
  UdpWorld(std::unique_ptr<World> model, UdpSettings settings, const PlantLayout& layout, Ends ends);

  PlantServer server_;
  UdpPlant plant_;
};

}  // namespace kadans
