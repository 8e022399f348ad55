// A type of plant of somebody else's: a bus "bench" whose drives are an ideal model. What a real bus would do is said
// where it would do it. The same source goes into a program of one's own (plant_type.cpp) and into a plug-in
// (bench_plugin.cpp).
#include "bench.h"

#include <optional>

#include "kadans/model/urdf.h"
#include "kadans/plant/ideal_world.h"
#include "kadans/signal/input_error.h"

namespace {

class Bench final : public kadans::Plant {
 public:
  Bench(kadans::PlantSite site, std::string model, double period_s)
      : site_(std::move(site)), model_file_(std::move(model)), period_ns_(static_cast<std::int64_t>(1e9 * period_s)) {}

  // Find the drives, ask them what they are, compare that with the robot, say what to do about it.
  bool open(bool (*)() noexcept) override {
    model_ = kadans::read_urdf(model_file_);
    if (model_.joint_names() != site_.layout.joints) {
      throw kadans::InputError({.file = site_.file, .message = "the drives on the bench are those of another robot"});
    }
    kadans::PlantSettings settings;
    settings.drives.resize(model_.joints.size());
    settings.encoders.resize(model_.joints.size());
    settings.position_rad.resize(model_.joints.size());
    for (const std::string& foot : site_.layout.feet) settings.feet.push_back({.link = foot});
    world_.emplace(model_, settings);
    return true;
  }
  // Tell the drives to let go.
  void close() noexcept override { ++closed_; }
  std::vector<kadans::PlantCount> link_counts() const override { return {{"written", written_}, {"closed", closed_}}; }

  // One exchange with the bus a tick, bounded.
  void read(kadans::SensorFrame& sensors) noexcept override {
    world_->step(period_ns_);
    world_->read(sensors);
  }
  void write(const kadans::ActuationFrame& actuation) noexcept override {
    world_->write(actuation);
    ++written_;
  }

 private:
  kadans::PlantSite site_;
  std::string model_file_;
  std::int64_t period_ns_;
  kadans::RobotModel model_;
  std::optional<kadans::IdealWorld> world_;
  std::uint64_t written_ = 0, closed_ = 0;
};

class BenchType final : public kadans::PlantType {
 public:
  std::string_view name() const noexcept override { return "bench"; }
  std::string_view doc() const noexcept override { return "drives on the bench"; }
  bool has_fields() const noexcept override { return true; }
  void fields(kadans::PlantFields& f) override {
    f.number("period_s", period_s_, {1e-4, 0.1, "s"}, "of the bus");
    f.string("model", model_, "what the drives obey, a URDF");
  }
  std::unique_ptr<kadans::Plant> make_plant(const kadans::PlantSite& site) const override {
    return std::make_unique<Bench>(site, site.peer.empty() ? model_ : site.peer, period_s_);
  }

 private:
  double period_s_ = 0.001;
  std::string model_ = KADANS_DATA_DIR "/models/tulip/tulip.urdf";
};

}  // namespace

std::unique_ptr<kadans::PlantType> make_bench_type() { return std::make_unique<BenchType>(); }
