#include "kadans/app/served_scenario.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "plant/world_server.h"
#include "realtime/posix_wait.h"
#include "served_world.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

constexpr std::int64_t served_late_periods_max = 10;

std::vector<std::unique_ptr<PlantEmulator>> emulators_of(const ServedWorld& world, std::uint64_t seed,
                                                         const std::vector<std::string>& listen) {
  const std::vector<ServedWorld::Site>& sites = world.sites();
  if (listen.size() != sites.size())
    refuse(std::to_string(sites.size()) + " robots are served, but there are " + std::to_string(listen.size()) +
           " addresses to listen on");
  std::vector<std::unique_ptr<PlantEmulator>> emulators;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const RobotConfig& robot = sites[i].robot;
    const PlantType& type = plant_type_named(robot, "udp", {"udp", {}}, &PlantType::is_protocol);
    PlantSite site = plant_site(robot, "");
    site.seed = seed;
    emulators.push_back(type.make_emulator(site, listen[i]));
  }
  return emulators;
}

}  // namespace

class ServedScenario::Served {
 public:
  Served(const std::string& text, const std::filesystem::path& file, std::uint64_t seed,
         const std::vector<std::string>& listen)
      : scenario(read_scenario_config_text(text, file.string())),
        world(scenario, seed),
        server(emulators_of(world, seed, listen)),
        period_ns(world.sites().front().robot.engine.control_period_ns()),
        observed(world.robot_count()) {
    server.look(world);
  }

  // What a robot's perception says, until it is taken.
  struct Observed final : ObservationSink {
    void observe(const Observation& observation) noexcept override { all.push_back(observation); }
    std::vector<Observation> all;
  };

  void look() {
    for (std::size_t i = 0; i < observed.size(); ++i) {
      for (SimulatedPerception* one : world.perception(i)) one->look(time_ns, world.robot(i).truth(), observed[i]);
    }
  }

  // Leaves out what is too late to be caught up.
  void wait_for_period() {
    const std::int64_t now_ns = wait.now_ns();
    if (due_ns == 0) due_ns = now_ns;
    due_ns += period_ns;
    const std::int64_t late = (now_ns - due_ns) / period_ns;
    if (late > served_late_periods_max) {
      lost += static_cast<std::uint64_t>(late - served_late_periods_max);
      due_ns += (late - served_late_periods_max) * period_ns;
    }
    wait.until(due_ns);
  }

  ScenarioConfig scenario;
  ServedWorld world;
  WorldServer server;
  PosixWait wait;
  std::int64_t period_ns, due_ns = 0, time_ns = 0;
  std::uint64_t lost = 0;
  std::vector<Observed> observed;
};

ServedScenario::ServedScenario(const std::string& scenario, const std::filesystem::path& file, std::uint64_t seed,
                               const std::vector<std::string>& listen)
    : served_(std::make_unique<Served>(scenario, file, seed, listen)) {}

ServedScenario::~ServedScenario() = default;

bool ServedScenario::await(int milliseconds) { return served_->server.await(milliseconds); }

bool ServedScenario::step() {
  served_->wait_for_period();
  if (!served_->server.beat(served_->world, 1, served_->period_ns)) return false;
  served_->time_ns += served_->period_ns;
  served_->look();
  return true;
}

std::vector<Observation> ServedScenario::take_observed(std::size_t number) {
  return std::exchange(served_->observed.at(number).all, {});
}

std::string ServedScenario::peer(std::size_t number) {
  if (number >= robots()) throw std::out_of_range("the world has no robot of this number");
  return served_->server.emulator(number).peer_name();
}

std::int64_t ServedScenario::time_ns() const noexcept { return served_->time_ns; }

std::int64_t ServedScenario::period_ns() const noexcept { return served_->period_ns; }

std::uint64_t ServedScenario::lost_periods() const noexcept { return served_->lost; }

World& ServedScenario::world() noexcept { return served_->world; }

std::size_t ServedScenario::object(std::string_view name) const { return served_->world.object(name); }

std::size_t ServedScenario::robots() const noexcept { return served_->world.robot_count(); }

WorldRobot& ServedScenario::robot(std::size_t number) {
  if (number >= robots()) throw std::out_of_range("the world has no robot of this number");
  return served_->world.robot(number);
}

const Catalog& ServedScenario::catalog(std::size_t number) const { return *served_->world.sites().at(number).catalog; }

}  // namespace kadans
