#include "kadans/app/simulation.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "app/assembly/assembly.h"
#include "app/ctl/sim_remote.h"
#include "app/record_options.h"
#include "app/run/observers.h"
#include "app/services.h"
#include "input_files.h"
#include "played_behaviors.h"
#include "signal/input_file.h"
#include "telemetry/record/recorder.h"

namespace kadans {
namespace {

constexpr std::size_t simulation_lines_kept = 1000;

ScenarioConfig simulated_scenario(const std::string& text, const std::filesystem::path& file) {
  ScenarioConfig scenario = read_scenario_config_text(text, file.string());
  if (!scenario.record.empty()) refuse(scenario.file, "repeats a record, so it cannot be simulated");
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
        run_seed(seed),
        log({&lines, &echo}, simulation_lines_kept),
        assembly(scenario, seed, log),
        all(assembly.parts()),
        steps(all) {
    refuse_faulty_behaviors(assembly);
    hear_perception();
  }

  const Assembly& of(std::size_t number) const { return number == 0 ? assembly : *assembly.others().at(number - 1); }
  const RunParts& parts(std::size_t number) const { return number == 0 ? all : all.others.at(number - 1); }

  // What a robot's perception says goes on to its supervisor, and waits here for who asks.
  struct Heard final : ObservationSink {
    void observe(const Observation& observation) noexcept override {
      if (kept.size() == kept_max) kept.clear();
      kept.push_back(observation);
      to->observe(observation);
    }
    static constexpr std::size_t kept_max = 1000;
    ObservationSink* to = nullptr;
    std::vector<Observation> kept;
  };

  void hear_perception() {
    heard.resize(1 + all.others.size());
    for (std::size_t i = 0; i < heard.size(); ++i) {
      RunParts& one = i == 0 ? all : all.others[i - 1];
      heard[i].to = one.observed;
      if (one.observed != nullptr) one.observed = &heard[i];
    }
  }

  void step() {
    steps.step();
    if (recorder == nullptr && remote == nullptr) return;
    const double time_s = 1e-9 * static_cast<double>(all.control.state().time_ns);
    if (recorder) (void)recorder->drain();  // a failing disk is told at the end
    if (pacer) pacer->tick(time_s, all.control.row());
    if (remote) remote->between_ticks(steps.mark());
    for (std::size_t i = 0; i <= all.others.size(); ++i) tell_faults(i);
  }

  void tell_faults(std::size_t number) {
    for (Fault fault; parts(number).control.safety().log().try_pop(fault);) {
      fault.robot = static_cast<std::uint16_t>(number);
      if (recorder) recorder->fault(fault);
      if (remote) remote->fault(fault);
    }
  }

  void record(const SimulationRecord& asked) {
    RecordPlan plan = record_plan(assembly, {.signals = asked.signals, .flight_s = {}, .folder_MB = {}}, false);
    recorder = std::make_unique<Recorder>(assembly.catalog().signals, plan.settings, FlightSettings{},
                                          Recorder::Wait::in_place);
    if (!recorder->open(asked.file.string())) refuse(recorder->error());
    RunChoices choices;
    choices.scenario = scenario.file;
    choices.seed = run_seed;
    RunInputs inputs = inputs_of(choices, scenario, assembly);
    inputs.run["clock"] = clock_of_programs;
    inputs.run["repeat"] = asked.repeat;
    (void)recorder->file().describe_run(inputs);
    describe_robots(recorder->file(), robot_texts(assembly), 0);
    log.add(recorder->events());
    record_file = asked.file.string();
    assembly.record_to(recorder.get());
  }

  void show(const SimulationPage& page) {
    ServiceOptions places;
    places.live.port = std::to_string(page.port);
    places.live.address = page.address;
    places.ctl.wanted = false;
    remote = std::make_unique<SimRemote>(places, assembly, record_plan(assembly, {}, false), log, echo);
    remote->begin(recorder.get(), record_file);
    pacer.emplace(remote->pace());
  }

  ScenarioConfig scenario;
  std::uint64_t run_seed;
  Lines lines;
  LineEcho echo;
  RunLog log;
  Assembly assembly;
  RunParts all;
  RunSteps steps;
  std::vector<Heard> heard;  // a robot each
  std::unique_ptr<Recorder> recorder;
  std::string record_file;
  std::unique_ptr<SimRemote> remote;
  std::optional<ViewerPacer> pacer;
};

Simulation::Simulation(const std::string& scenario, const std::filesystem::path& file, std::uint64_t seed)
    : stepped_(std::make_unique<Stepped>(scenario, file, seed)) {}

Simulation::~Simulation() = default;

void Simulation::step() { stepped_->step(); }

void Simulation::record(const SimulationRecord& record) { stepped_->record(record); }

void Simulation::show(const SimulationPage& page) { stepped_->show(page); }

void Simulation::end_record(const std::map<std::string, std::string>& result) {
  Recorder* recorder = stepped_->recorder.get();
  if (recorder == nullptr || !recorder->is_open()) return;
  TextMap facts(result.begin(), result.end());
  facts["state_hash"] = hash_text(state_hash());
  facts["control_ticks"] = std::to_string(stepped_->steps.mark().ticks);
  (void)recorder->drain();
  (void)recorder->file().describe("result", facts);
  if (!recorder->close()) throw std::runtime_error("the record is not complete: " + recorder->error());
  if (recorder->dropped() > 0)
    throw std::runtime_error(std::to_string(recorder->dropped()) + " rows are missing in the record");
}

std::int64_t Simulation::time_ns() const noexcept { return stepped_->steps.mark().time_ns; }

std::int64_t Simulation::period_ns() const noexcept { return stepped_->all.lockstep.control_period_ns(); }

std::uint64_t Simulation::state_hash() const noexcept { return stepped_->steps.mark().state_hash; }

std::vector<SaidLine> Simulation::take_lines() { return std::exchange(stepped_->lines.kept, {}); }

World& Simulation::world() noexcept { return stepped_->all.world; }

std::size_t Simulation::object(std::string_view name) const { return stepped_->assembly.object(name); }

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
  if (number >= stepped_->heard.size()) throw std::out_of_range("there is no robot of this number");
  ObservationSink* sink = stepped_->heard[number].to;
  if (sink == nullptr) throw std::invalid_argument("this robot has no supervisor, so it knows nothing of the world");
  sink->observe(observation);
}

std::vector<Observation> Simulation::take_observed(std::size_t number) {
  return std::exchange(stepped_->heard.at(number).kept, {});
}

std::uint32_t Simulation::entry(std::size_t number, std::string_view name) const {
  const std::vector<SeenInfo>& seen = catalog(number).seen;
  const auto found = std::ranges::find(seen, name, &SeenInfo::name);
  if (found == seen.end())
    throw std::invalid_argument("the robot's world model has no entry '" + std::string(name) + "'");
  return static_cast<std::uint32_t>(found - seen.begin());
}

}  // namespace kadans
