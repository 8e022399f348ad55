#include "assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/robot/project_root.h"
#include "estimate/estimator.h"
#include "kadans/signal/nearest_name.h"
#include "remote/instance/run_description.h"

namespace kadans {
namespace {

constexpr double feet_settle_s = 0.5;

std::vector<TruthSignals::Foot> feet_of(const PlantSettings& plant) {
  std::vector<TruthSignals::Foot> feet;
  for (const FootSettings& foot : plant.feet) {
    feet.push_back({foot.link, {foot.sensors_m.begin(), foot.sensors_m.end()}});
  }
  return feet;
}

// The eyes of a gaze object. The object has been made before, so its options exist.
GazeTruth::Eyes eyes_of(const ObjectConfig& object) {
  GazeTruth::Eyes eyes{.object = object.name, .left = {}, .right = {}};
  for (const TextEntry& option : object.options) {
    if (option.key == "left_eye") eyes.left = option.text;
    if (option.key == "right_eye") eyes.right = option.text;
  }
  return eyes;
}

SafePosture::Settings safe_posture_of(const SafeConfig& safe) {
  return {.pose = safe.pose, .after_s = safe.after_s, .time_s = safe.time_s};
}

// Loading or reloading a file may take as long as some ticks. Meanwhile the behaviors and the heartbeat stand still.
ScriptLimits limits_on_wall_clock(const EngineSettings& engine) {
  constexpr std::int64_t ticks_to_load = 20;
  ScriptLimits limits;
  limits.tick_wall_ns = engine.behavior_time_max_ns();
  limits.load_wall_ns = ticks_to_load * limits.tick_wall_ns;
  return limits;
}

// True when a joystick's state is recorded: the robot or this run has one.
bool has_joystick(const ScenarioConfig& scenario, const RobotConfig& robot) {
  return robot.engine.joystick || !scenario.joystick.recording.empty() || !scenario.joystick_device.empty();
}

// Says which robot a behavior plays on.
class NamedLog final : public BehaviorLog, private LineSink {
 public:
  NamedLog(const std::string& robot, BehaviorLog& log) : prefix_(robot + "."), log_(log) { add(*this); }

 private:
  void tell(const Line& line) override {
    const std::string behavior = prefix_ + std::string(line.behavior);
    Line named = line;
    named.behavior = behavior;
    Transition transition;
    if (line.transition != nullptr) {
      transition = *line.transition;
      transition.behavior = behavior;
      named.transition = &transition;
    }
    log_.say(named);
  }
  void tell_emitted(const EmittedEvent& event) override {
    EmittedEvent named = event;
    named.event.insert(0, prefix_);
    log_.emitted(named);
  }
  void tell_active(const ActiveStates& active) override {
    const std::string behavior = prefix_ + std::string(active.behavior);
    log_.active({active.time_ns, behavior, active.states});
  }

  std::string prefix_;
  BehaviorLog& log_;
};

class FilteredHost final : public BehaviorHost {
 public:
  FilteredHost(BehaviorHost& host, std::function<void(Snapshot&)> change) : host_(host), change_(std::move(change)) {}
  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override {
    seen_ = snapshot;
    change_(seen_);
    host_.tick(seen_, commands);
  }
  void before_tick(const Snapshot& snapshot) noexcept override { host_.before_tick(snapshot); }
  void prepare(const Snapshot& newest) noexcept override { host_.prepare(newest); }

 private:
  BehaviorHost& host_;
  std::function<void(Snapshot&)> change_;
  Snapshot seen_;
};

// Checks the behaviors' names in events; they are known only after loading.
void verify_events(const ScenarioConfig& scenario, const ScriptHost& host) {
  const std::vector<std::string> names = host.names();
  for (const ScenarioEvent& event : scenario.events) {
    const PlacedName& behavior = event.order.behavior;
    if (event.order.kind == PlayOrder::Kind::reload && std::ranges::find(names, behavior.name) == names.end())
      refuse_unknown(scenario.file, behavior, "behavior", names);
    if (event.order.kind != PlayOrder::Kind::emit || event.order.event.ordered) continue;
    const WrongData wrong = host.wrong_event(event.order.event);
    if (!wrong.why.empty()) refuse(scenario.file, wrong.place, wrong.why);
  }
}

}  // namespace

std::unique_ptr<ScriptHost> make_script_host(const ScenarioConfig& scenario, const RobotConfig& robot,
                                             const Catalog& catalog, std::uint64_t seed, BehaviorLog& log,
                                             std::span<const std::byte> kept) {
  ScriptHost::Settings settings;
  settings.root = project_root(scenario.file);
  settings.seed = seed;
  settings.play = scenario.behaviors;
  for (const ScenarioEvent& event : scenario.events) {
    settings.events.push_back({std::llround(event.at_s * 1e9), event.order});
  }
  if (!scenario.repeats) settings.ordered_later = robot.supervisor.lost_list;  // an old record may lack their modules
  settings.inputs = overridden(robot.input_events, scenario.joystick.buttons);
  settings.safe = safe_posture_of(robot.safe);
  if (scenario.on_wall_clock) settings.limits = limits_on_wall_clock(robot.engine);
  settings.kept = kept;
  settings.describe = behaviors_description;
  auto host = std::make_unique<ScriptHost>(settings, catalog, log);
  verify_events(scenario, *host);
  return host;
}

Assembly::Assembly(const ScenarioConfig& scenario, std::uint64_t seed, RunLog& log, PlantExchange* link,
                   const Outside& outside)
    : Assembly(Begun{}, scenario, seed, log, link, outside, 0) {
  begin_others();
  complete();
}

Assembly::Assembly(Begun, const ScenarioConfig& scenario, std::uint64_t seed, RunLog& log, PlantExchange* link,
                   const Outside& outside, std::size_t number)
    : scenario_(scenario),
      seed_(seed),
      number_(number),
      log_(log),
      named_log_(number == 0 ? nullptr : std::make_shared<NamedLog>(scenario.name, log)),
      link_(link),
      outside_(outside),
      robot_(read_robot(scenario.robot, scenario.plugins)),
      plant_(scenario, robot_.config, variant_, seed, number, link) {
  control_system_ = make_control_system(robot_);
  robot_.config.engine.joystick = has_joystick(scenario, robot_.config);
  try {
    vary();
    robot_.config.engine.sight = variant_.sees;
    take_supervisor();
  } catch (const std::invalid_argument& error) {
    refuse(robot_.config.file, error.what());
  }
}

// A further robot takes from the first what is the world's and the run's.
void Assembly::begin_others() {
  if (link_ != nullptr && !scenario_.robots.empty())
    refuse(scenario_.file, scenario_.robots.front().plant_place, "robots: a run on the wall clock has one robot");
  further_ = scenario_.robots;
  for (ScenarioConfig& robot : further_) {
    robot.plant = scenario_.plant;
    robot.world = scenario_.world;
    robot.world.settings.payloads.clear();  // the first robot's
    robot.world.payload_links.clear();
    robot.world.carried.clear();
    robot.plugins = scenario_.plugins;
    const std::uint64_t seed = RandomStream(seed_, "robot " + robot.name).next();
    others_.emplace_back(new Assembly(Begun{}, robot, seed, log_, nullptr, Outside(), others_.size() + 1));
    for (const QuantityValue& theirs : others_.back()->quantities_)
      quantities_.push_back({robot.name + "." + theirs.name, theirs.value});
  }
  if (link_ != nullptr) return;
  network_ = std::make_unique<SimulatedNetwork>(scenario_.network, 1 + others_.size(), seed_);
  message_channel_ = &network_->port(0);
  for (const auto& other : others_) other->message_channel_ = &network_->port(other->number_);
}

void Assembly::complete() {
  Catalog& catalog = control_system_->catalog;
  try {
    make_plant();
    if (scenario_.read_only) {
      // Nobody enables the drives, and torque that is asked for moves nothing.
      robot_.config.safety.drives.enable_s = std::numeric_limits<double>::infinity();
      robot_.config.safety.sensors.stuck_ticks = std::numeric_limits<std::uint32_t>::max();
    }
    sets_ = std::make_unique<ControlSets>(catalog, std::move(control_system_->objects));
    robot_.config.safety.drive_words = plant_.drive_words();
    estimator_ =
        std::make_unique<Estimator>(robot_.config.model, robot_.config.estimate, robot_.config.engine.control_period_s);
    safety_ = std::make_unique<Safety>(robot_.config.safety, robot_.config.model);
  } catch (const std::invalid_argument& error) {
    refuse(robot_.config.file, error.what());
  }
  exchange_ = std::make_unique<EngineExchange>();
  foreign_first_ = catalog.signals.size();
  plant_.plant().declare_signals(catalog.signals);
  if (const TruthSource* source = plant_.truth_source()) {
    const bool several = plant_.world() != nullptr && plant_.world()->robot_count() > 1;
    truth_ = std::make_unique<TruthSignals>(*source, catalog, feet_of(variant_.plant), feet_settle_s,
                                            variant_.plant.world, several);
    const std::span<const SignalId> left_out = truth_->unhashed();
    unhashed_.assign(left_out.begin(), left_out.end());
    for (const ObjectConfig& object : robot_.config.objects) {
      if (object.type.name == "gaze") truth_->watch(catalog, eyes_of(object));
    }
  }
  BehaviorLog& told = named_log_ ? *named_log_ : static_cast<BehaviorLog&>(log_);
  if (outside_.behaviors == nullptr) host_ = make_script_host(scenario_, robot_.config, catalog, seed_, told);
  upkeep_first_ = catalog.signals.size();
  if (outside_.behaviors != nullptr) outside_.behaviors->attach(catalog, safe_posture_of(robot_.config.safe));
  if (host_) {
    host_->declare_signals(catalog.signals);
    states_.assign(host_->signal_states().begin(), host_->signal_states().end());
  }
  if (supervising().given) make_supervisor(told);
  upkeep_count_ = catalog.signals.size() - upkeep_first_;
  foreign_end_ = catalog.signals.size();
  for (std::size_t i = 0; i < upkeep_count_; ++i) unhashed_.push_back(static_cast<SignalId>(upkeep_first_ + i));
  show_others();
  control_ = std::make_unique<ControlEngine>(robot_.config.engine, plant_.seen(), *estimator_, *safety_, *sets_,
                                             catalog, *exchange_);
  for (SignalId id = 0; id < catalog.signals.size(); ++id) {
    if (catalog.signals.info(id).name.starts_with("odometry.")) unhashed_.push_back(id);
  }
  if (host_) faulty_host_ = make_faulty_host(scenario_, *host_);
  if (supervisor_ && !scenario_.repeats)  // what is repeated was told what decided
    supervised_ = std::make_unique<SupervisedHost>(
        supervising(), played(), SupervisedHost::Players{host_.get(), outside_.behaviors}, *supervisor_link_, told);
  disturbances_ = std::make_unique<Disturbances>(scenario_, robot_.config.model);
  make_joystick_player();
  make_sight();
  make_perception();
  make_behaviors();
}

void Assembly::take_supervisor() {
  SupervisorConfig& config = robot_.config.supervisor;
  if (scenario_.supervisor.given) config = scenario_.supervisor;
  Catalog& catalog = control_system_->catalog;
  catalog.seen = config.seen;
  if (scenario_.undecided) config.decisions.clear();
  const auto ball = std::ranges::find(catalog.seen, "ball", &SeenInfo::name);
  if (variant_.sees && ball != catalog.seen.end())
    refuse(scenario_.file, scenario_.sight.ball.place,
           "sight shows s.seen.ball, which the supervisor's world has already: take perception");
}

// Of a run: the sockets that the configuration names. What is repeated was told what they said.
void Assembly::open_sockets() {
  if (link_ == nullptr || scenario_.repeats) return;
  try {
    const MessagesConfig& messages = supervising().messages;
    if (!messages.name.empty()) messages_ = std::make_unique<Datagrams>(messages.listen, messages.to);
    if (!supervising().perception.empty())
      perceived_ = std::make_unique<Datagrams>(supervising().perception, std::vector<std::string>());
  } catch (const InputError& error) {
    refuse(robot_.config.file, std::string("supervisor: ") + error.what());
  }
  message_channel_ = messages_.get();
}

// In lockstep it shares the behaviors' thread and log; a log is of one thread.
void Assembly::make_supervisor(BehaviorLog& told) {
  open_sockets();
  const bool named = !supervising().messages.name.empty();
  // A number that another start has not: of a run the time, of a simulation always the same.
  const auto boot = link_ == nullptr ? 1U : static_cast<std::uint32_t>(WallClock().now_ns() / 1'000'000);
  supervisor_link_ = std::make_unique<SupervisorLink>();
  supervisor_log_.add(supervisor_link_->lines);
  supervisor_ = std::make_unique<Supervisor>(Supervisor::Settings{.config = supervising(),
                                                                  .root = project_root(scenario_.file),
                                                                  .folders = folders_of(scenario_),
                                                                  .seed = seed_,
                                                                  .on_wall_clock = scenario_.on_wall_clock,
                                                                  .messages = named ? message_channel_ : nullptr,
                                                                  .perception = perceived_.get(),
                                                                  .boot = boot,
                                                                  .start = outside_.decisions},
                                             control_system_->catalog, *supervisor_link_, exchange_->seen,
                                             link_ != nullptr ? supervisor_log_ : told);
  supervisor_->declare_signals(control_system_->catalog.signals, states_);
}

void Assembly::make_perception() {
  for (const ScenarioPerception& one : variant_.perception) {
    if (!one.record.name.empty()) {
      recorded_.push_back(std::make_unique<RecordedPerception>(one, control_system_->catalog.seen, scenario_.file));
      continue;
    }
    perception_.push_back(std::make_unique<SimulatedPerception>(one, control_system_->catalog.seen,
                                                                variant_.plant.world.objects, seed_, scenario_.file));
  }
}

void Assembly::show_others() {
  for (const auto& other : others_) {
    const SignalTable& theirs = other->catalog().signals;
    for (SignalId id = 0; id < theirs.size(); ++id) {
      const bool upkeep = id - other->upkeep_first_ < other->upkeep_count_;
      if (upkeep && std::ranges::find(other->states_, id, &SignalState::signal) == other->states_.end()) continue;
      if (upkeep || std::ranges::binary_search(other->unhashed_, id))
        unhashed_.push_back(static_cast<SignalId>(control_system_->catalog.signals.size()));
      Signal signal = theirs.info(id);
      signal.name.insert(0, other->scenario_.name + ".");
      if (control_system_->catalog.signals.find(signal.name))
        refuse(scenario_.file, other->scenario_.plant_place,
               "name " + in_quotes(other->scenario_.name) + ": its signal would be the first robot's " + signal.name);
      control_system_->catalog.signals.add(std::move(signal), &other->control_->row()[id]);
    }
    for (SignalState state : other->states_) {
      state.robot = other->scenario_.name;
      state.signal = control_system_->catalog.signals.find(state.robot + "." + theirs.info(state.signal).name).value();
      states_.push_back(std::move(state));
    }
  }
}

// The plant's robot: first the files' values, then the scenario's start pose, then the quantities that it sets and
// draws.
void Assembly::vary() {
  const RobotConfig& config = robot_.config;
  variant_ = plant_variant(scenario_, config);
  if (variant_.plant.fixed_base && !scenario_.carried.empty())
    refuse(scenario_.file, scenario_.carried.front().place, "carried: the robot is bolted down (plant.fixed_base)");
  if (!scenario_.start_pose.name.empty()) start_in_pose();
  if (!scenario_.placed.position_rad.empty()) {
    variant_.plant.position_rad = scenario_.placed.position_rad;
    variant_.plant.base.orientation = scenario_.placed.orientation;
  }
  Problems problems(scenario_.file), of_option("--set");
  Quantities quantities(variant_, control_system_->catalog, number_ > 0);
  for (const NumberEntry& entry : scenario_.set) quantities.set(entry, quantities_, problems);
  for (const Variation& variation : scenario_.randomise) quantities.draw(variation, seed_, quantities_, problems);
  for (const NumberEntry& entry : scenario_.set_last) quantities.set(entry, quantities_, of_option);
  problems.throw_if_any();
  of_option.throw_if_any();
  for (const auto& object : control_system_->objects) object->parameters_changed();
}

void Assembly::start_in_pose() {
  const RobotConfig& config = robot_.config;
  const auto pose = std::ranges::find(config.poses, scenario_.start_pose.name, &PoseInfo::name);
  if (pose == config.poses.end()) {
    refuse_unknown(scenario_.file, scenario_.start_pose, "pose", names_of(config.poses));
  }
  variant_.plant.position_rad.resize(config.model.joints.size());
  for (const auto& [joint, position_rad] : pose->position_rad) variant_.plant.position_rad[joint] = position_rad;
}

// The others' engines are made when all robots are in the world, and before the first's, which shows their signals.
void Assembly::make_plant() {
  if (number_ > 0) return;
  std::vector<WorldSite> sites{{variant_.model, variant_.plant, seed_}};
  for (const auto& other : others_) sites.push_back({other->variant_.model, other->variant_.plant, other->seed_});
  try {
    plant_.make(sites);
  } catch (const std::invalid_argument& error) {
    if (others_.empty()) throw;
    refuse(scenario_.file, scenario_.robots.front().plant_place, std::string("robots: ") + error.what());
  }
  for (const auto& other : others_) {
    other->plant_.join(plant_);
    other->complete();
  }
}

void Assembly::make_joystick_player() {
  const ScenarioJoystick& joystick = scenario_.joystick;
  if (joystick.recording.empty()) return;
  const auto ns = [](double s) { return s < 1e9 ? std::llround(s * 1e9) : std::numeric_limits<std::int64_t>::max(); };
  try {
    joystick_ = std::make_unique<JoystickPlayer>(robot_.config.joystick, joystick.recording, ns(joystick.at_s),
                                                 ns(joystick.lost_at_s));
  } catch (const std::invalid_argument& error) {
    refuse(scenario_.file, joystick.place, error.what());
  }
}

void Assembly::make_sight() {
  if (!variant_.sees) return;
  sight_ = std::make_unique<SimulatedSight>(variant_.sight, object(scenario_.sight.ball.name), seed_);
}

std::size_t Assembly::object(std::string_view name) const {
  const auto& objects = world_settings().objects;
  const auto found = std::ranges::find(objects, name, &WorldObject::name);
  if (found == objects.end()) throw std::invalid_argument("the world has no object '" + std::string(name) + "'");
  return static_cast<std::size_t>(found - objects.begin());
}

BehaviorHost& Assembly::played() noexcept {
  if (supervised_) return *supervised_;
  if (faulty_host_) return *faulty_host_;
  return outside_.behaviors != nullptr ? static_cast<BehaviorHost&>(*outside_.behaviors) : *host_;
}

void Assembly::make_behaviors() {
  BehaviorHost* host = filtered_ ? filtered_.get() : &played();
  lockstep_.reset();
  behaviors_ = std::make_unique<BehaviorEngine>(*sets_, *exchange_, host);
  if (!plant_.in_lockstep() || number_ > 0) return;
  lockstep_ =
      std::make_unique<Lockstep>(robot_.config.engine, *plant_.world(), *control_, *behaviors_, supervisor_.get());
  try {
    for (const auto& other : others_)
      lockstep_->add(other->robot_.config.engine, *other->control_, *other->behaviors_, other->supervisor_.get());
  } catch (const std::invalid_argument& error) {
    refuse(scenario_.file, scenario_.robots.front().plant_place, std::string("robots: ") + error.what());
  }
}

void Assembly::filter(std::function<void(Snapshot&)> change) {
  filtered_ = std::make_unique<FilteredHost>(played(), std::move(change));
  make_behaviors();
}

void Assembly::read_foreign_signals_from(std::span<const double> row, bool of_behaviors) {
  for (std::size_t id = foreign_first_; id < (of_behaviors ? foreign_end_ : upkeep_first_); ++id)
    control_system_->catalog.signals.read_from(static_cast<SignalId>(id), &row[id]);
}

RunParts Assembly::parts_in(Lockstep& lockstep) {
  RunParts parts{.world = *plant_.world(),
                 .robot = plant_.robot(),
                 .control = *control_,
                 .behaviors = *behaviors_,
                 .lockstep = lockstep,
                 .truth = *truth_,
                 .model = robot_.config.model,
                 .log = log_,
                 .disturbances = disturbances_.get(),
                 .joystick = joystick_.get(),
                 .sight = sight_.get(),
                 .observed = supervisor_.get(),
                 .unhashed = unhashed_,
                 .name = number_ == 0 ? "" : scenario_.name,
                 .faulty = number_ == 0 ? nullptr : plant_.faulty()};
  for (const auto& one : perception_) parts.perception.push_back(one.get());
  for (const auto& one : recorded_) parts.recorded.push_back(one.get());
  for (const auto& other : others_) parts.others.push_back(other->parts_in(lockstep));
  return parts;
}

}  // namespace kadans
