#include "kadans/app/simulation.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "app/assembly.h"
#include "played_behaviors.h"

namespace kadans {
namespace {

constexpr std::size_t simulation_lines_kept = 1000;

ScenarioConfig simulated_scenario(const std::string& text, const std::filesystem::path& file) {
  ScenarioConfig scenario = read_scenario_config_text(text, file.string());
  if (!scenario.record.empty())
    throw InputError({.file = scenario.file, .message = "repeats a record, so it cannot be simulated"});
  return scenario;
}

}  // namespace

class Simulation::Stepped {
 public:
  class Lines final : public LineSink {
   public:
    std::vector<SaidLine> kept;

   private:
    void tell(const Line& line) override {
      constexpr SaidLine::Kind kinds[] = {SaidLine::Kind::info, SaidLine::Kind::warning, SaidLine::Kind::error};
      if (line.transition == nullptr) {
        kept.push_back({line.time_ns, kinds[static_cast<std::size_t>(line.severity)], std::string(line.behavior),
                        std::string(line.text)});
        return;
      }
      const Transition& change = *line.transition;
      const std::string why = change.why.empty() ? "" : " (" + change.why + ")";
      kept.push_back(
          {line.time_ns, SaidLine::Kind::transition, change.behavior, change.from + " -> " + change.to + why});
    }
  };

  Stepped(const std::string& text, const std::filesystem::path& file, std::uint64_t seed)
      : scenario(simulated_scenario(text, file)),
        log({&lines}, simulation_lines_kept),
        assembly(scenario, seed, log),
        all(assembly.parts()),
        steps(all) {
    refuse_faulty_behaviors(assembly);
  }

  const Assembly& of(std::size_t number) const { return number == 0 ? assembly : *assembly.others().at(number - 1); }
  const RunParts& parts(std::size_t number) const { return number == 0 ? all : all.others.at(number - 1); }

  ScenarioConfig scenario;
  Lines lines;
  RunLog log;
  Assembly assembly;
  RunParts all;
  RunSteps steps;
};

Simulation::Simulation(const std::string& scenario, const std::filesystem::path& file, std::uint64_t seed)
    : stepped_(std::make_unique<Stepped>(scenario, file, seed)) {}

Simulation::~Simulation() = default;

void Simulation::step() { stepped_->steps.step(); }

std::int64_t Simulation::time_ns() const noexcept { return stepped_->steps.mark().time_ns; }

std::int64_t Simulation::period_ns() const noexcept { return stepped_->all.lockstep.control_period_ns(); }

std::uint64_t Simulation::state_hash() const noexcept { return stepped_->steps.mark().state_hash; }

std::vector<SaidLine> Simulation::take_lines() { return std::exchange(stepped_->lines.kept, {}); }

World& Simulation::world() noexcept { return stepped_->all.world; }

std::size_t Simulation::object(std::string_view name) const {
  const auto& objects = stepped_->assembly.world_settings().objects;
  const auto found = std::ranges::find(objects, name, &WorldObject::name);
  if (found == objects.end()) throw std::invalid_argument("the world has no object '" + std::string(name) + "'");
  return static_cast<std::size_t>(found - objects.begin());
}

std::size_t Simulation::robots() const noexcept { return 1 + stepped_->assembly.others().size(); }

WorldRobot& Simulation::robot(std::size_t number) { return stepped_->parts(number).robot; }

const Catalog& Simulation::catalog(std::size_t number) const { return stepped_->of(number).catalog(); }

double Simulation::signal(std::size_t number, SignalId id) const {
  const std::span<const double> row = stepped_->parts(number).control.row();
  if (id >= row.size()) throw std::out_of_range("a robot has no signal of this number");
  return row[id];
}

const RobotStatus& Simulation::status(std::size_t number) const {
  return stepped_->parts(number).control.state().status;
}

void Simulation::observe(std::size_t number, const Observation& observation) {
  ObservationSink* sink = stepped_->parts(number).observed;
  if (sink == nullptr) throw std::invalid_argument("this robot has no supervisor, so it knows nothing of the world");
  sink->observe(observation);
}

std::uint32_t Simulation::entry(std::size_t number, std::string_view name) const {
  const std::vector<SeenInfo>& seen = catalog(number).seen;
  const auto found = std::ranges::find(seen, name, &SeenInfo::name);
  if (found == seen.end())
    throw std::invalid_argument("the robot's world model has no entry '" + std::string(name) + "'");
  return static_cast<std::uint32_t>(found - seen.begin());
}

}  // namespace kadans
