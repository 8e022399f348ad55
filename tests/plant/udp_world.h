// A model behind the datagrams of `kadans plant`, in step and on one thread.
#pragma once

#include <memory>

#include "kadans/plant/world.h"
#include "lossy_wire.h"
#include "plant/udp/plant_server.h"
#include "plant/udp/udp_plant.h"

namespace kadans::test {

class UdpWorld final : public OneRobotWorld {
 public:
  UdpWorld(std::unique_ptr<World> model, const PlantLayout& layout)
      : model_(std::move(model)),
        server_(settings_, layout, wire_.plant_end()),
        plant_(settings_, layout, wire_.control_end(), 1) {
    (void)plant_.greet();
    wire_.step();
    REQUIRE(server_.await(0));
    REQUIRE(server_.beat(*model_, 1));
    wire_.step();
    REQUIRE(plant_.welcomed());
  }

  void read(SensorFrame& sensors) noexcept override { plant_.read(sensors); }
  void write(const ActuationFrame& actuation) noexcept override { plant_.write(actuation); }
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_m) override {
    model_->robot(0).push(link, force_N, point_m);
  }
  void step(std::int64_t) override {
    wire_.step();
    (void)server_.beat(*model_, 1);
    wire_.step();
  }
  const PlantTruth& truth() const noexcept override { return model_->robot(0).truth(); }
  void hash(StateHash& hash) const noexcept override { model_->hash(hash); }
  UdpPlant& driver() noexcept { return plant_; }

 private:
  UdpSettings settings_{.peer = "the test"};
  std::unique_ptr<World> model_;
  LossyWire wire_{1};
  PlantServer server_;
  UdpPlant plant_;
};

}  // namespace kadans::test
