#include "repeated_run.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <map>

#include "app/run/behavior_process.h"
#include "kadans/signal/input_error.h"
#include "script/host/behavior_tables.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::int64_t waiting_values_max = 1000;  // of a high level, ahead of its low level
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

bool same_command(const Command& a, const Command& b) noexcept {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return a.kind == b.kind && a.index == b.index && a.count == b.count && a.sequence == b.sequence &&
         a.time_ns == b.time_ns && bits(a.value) == bits(b.value) && bits(a.duration_s) == bits(b.duration_s) &&
         bits(a.velocity) == bits(b.velocity) && bits(a.acceleration) == bits(b.acceleration);
}

std::string command_text(const Command& command, const Catalog& catalog) {
  const auto value = [&] { return " = " + number_text(command.value); };
  switch (command.kind) {
    case CommandKind::set_parameter:
      return command.index < catalog.parameters.size() ? catalog.parameters.info(command.index).name + value() : "?";
    case CommandKind::set_point:
    case CommandKind::trapezoid:
    case CommandKind::via_point:
    case CommandKind::cancel_motion:
      return command.index < catalog.setpoints.size() ? catalog.setpoints[command.index].name + value() : "?";
    case CommandKind::switch_set:
      return command.index < catalog.sets.size() ? "control set " + catalog.sets[command.index].name : "?";
    case CommandKind::transaction:
      return "transaction " + std::to_string(command.sequence);
    default:
      return "command " + std::to_string(static_cast<int>(command.kind)) + value();
  }
}

}  // namespace

ScenarioConfig unpacked_scenario(const RunInputs& inputs, const std::string& record, const UnpackedInputs& files) {
  RunOptions options = options_of(inputs, record);
  options.robot = files.scenario().string();
  ScenarioConfig scenario = live_scenario(options);
  scenario.plugins = files.plugins();
  scenario.repeats = true;
  return scenario;
}

RepeatedRun::RepeatedRun(const std::string& record, const ScenarioConfig& scenario, const UnpackedInputs& unpacked,
                         std::string recorded_root, Behaviors behaviors)
    : unpacked_(unpacked),
      recorded_root_(std::move(recorded_root)),
      behaviors_(behaviors),
      assembly_(scenario, scenario.seed, log_, &link_),
      engine_(assembly_.sets(), assembly_.control().exchange(),
              behaviors <= Behaviors::none ? nullptr : &assembly_.host()),
      hand_overs_(assembly_.sets().hand_overs()),
      foreign_(assembly_.catalog().signals.size(), not_known),
      ticks_read_(record),
      compared_(record),
      commands_read_(record, behaviors == Behaviors::saved),
      behaviors_read_(record),
      states_read_(record),
      handed_read_(record, behaviors == Behaviors::saved),
      events_read_(record, {"/transitions", "/active", "/events"}) {
  assembly_.read_foreign_signals_from(foreign_, behaviors != Behaviors::tested);
  hashed_.assign(assembly_.catalog().signals.size(), true);
  for (const SignalId id : assembly_.unhashed()) hashed_[id] = false;
  for (std::size_t id = assembly_.foreign_first(); id < assembly_.foreign_end(); ++id) hashed_[id] = false;
  comparison_ = std::make_unique<RecordComparison>(compared_.reader(), assembly_.catalog().signals);
  for (DownStorage* storage : hand_overs_.down) storage->hold();
  engine_.take_inputs_by(this, hand_overs_.up);
  assembly_.host().take_inputs_by(this);
  Supervisor* const supervisor = assembly_.supervisor();
  if (!repeats_flight() && supervisor != nullptr && supervisor->decisions() != nullptr)
    decisions_ = std::make_unique<RepeatedDecisions>(record, *supervisor,
                                                     [this](const BehaviorInput& input) { write_file(input); });
}

void RepeatedRun::go(const std::function<bool()>& stop, const std::vector<RunObserver*>& observers) {
  for (bool more = begin(); more && !stop(); more = ticks_read_.next(taken_)) {
    if (!repeats_flight()) {
      repeat_behaviors(taken_.tick);
      repeat_decisions();
    }
    if (!repeat_tick(taken_)) return;
    show(observers);
    if (repeats_flight() && !parting_.empty()) return;
    if (comparison_->parted() && behaviors_ != Behaviors::tested && observers.empty()) return;
  }
}

// To the first tick that is repeated. False: there is none.
bool RepeatedRun::begin() {
  if (!ticks_read_.next(taken_)) return false;
  const bool flight = ticks_read_.layout().state_bytes > 0;
  if (flight && !repeats_flight())
    refuse(compared_.file(),
           "is a flight record: kadans replay repeats its control engine, and nothing else can be done with it");
  if (!flight && taken_.tick != 0)
    refuse(compared_.file(), "begins in tick " + std::to_string(taken_.tick) +
                                 " of its run: only a record from the first tick on can be repeated");
  find_foreign_signals();
  if (flight) begin_from_state();
  return true;
}

// In the record, whose signals are the same in all its files.
void RepeatedRun::find_foreign_signals() {
  std::map<std::string, std::uint32_t> numbers;
  const std::vector<std::string>& names = ticks_read_.signals();
  for (std::uint32_t i = 0; i < names.size(); ++i) numbers[names[i]] = i;
  for (std::size_t id = assembly_.foreign_first(); id < assembly_.foreign_end(); ++id) {
    const auto number = numbers.find(assembly_.catalog().signals.info(static_cast<SignalId>(id)).name);
    if (number != numbers.end()) foreign_signals_.emplace_back(static_cast<SignalId>(id), number->second);
  }
}

void RepeatedRun::begin_from_state() {
  ControlEngine& control = assembly_.control();
  StateBytes measuring(StateBytes::Levels::low);
  control.pass_state(measuring);
  if (measuring.size() != ticks_read_.layout().state_bytes)
    refuse(compared_.file(), "its control engine was another one: it saved " +
                                 std::to_string(ticks_read_.layout().state_bytes) + " bytes of state, this one " +
                                 std::to_string(measuring.size()) +
                                 ". The kadans that recorded it repeats it, on the same architecture");
  const EngineStates::Saved* saved = states_read_.get();
  for (; saved != nullptr && saved->tick + 1 < taken_.tick; saved = states_read_.get()) states_read_.drop();
  if (saved == nullptr) refuse(compared_.file(), "holds no state of its control engine with the ticks behind it");
  if (saved->found.size() != hand_overs_.down.size() || !control.restore(saved->tick + 1, saved->bytes))
    refuse(compared_.file(),
           "its state of the control engine after tick " + std::to_string(saved->tick) + " is damaged");
  for (std::size_t i = 0; i < hand_overs_.down.size(); ++i) hand_overs_.down[i]->resume(saved->found[i]);
  handed_.assign(saved->found.begin(), saved->found.end());
  stepped_.assign(assembly_.sets().size(), false);
  last_transaction_ = control.inbox().last_taken();
  joystick_ = control.state().joystick;
  seen_ = control.seen();
  while (taken_.tick <= saved->tick) {
    if (!ticks_read_.next(taken_))
      refuse(compared_.file(), "ends with its state of the control engine after tick " + std::to_string(saved->tick));
  }
  begun_ns_ = taken_.time_ns;
  states_read_.drop();
}

void RepeatedRun::show(const std::vector<RunObserver*>& observers) {
  ControlEngine& control = assembly_.control();
  const std::span<const double> row = control.row();
  add_hash(row);
  const double time_s = 1e-9 * static_cast<double>(taken_.time_ns);
  const RunMark mark{control.ticks(), taken_.time_ns, hash_.value()};
  for (RunObserver* observer : observers) {
    observer->tick(time_s, row);
    observer->between_ticks(mark);
  }
  take_faults(observers, taken_.time_ns);
}

void RepeatedRun::add_hash(std::span<const double> row) noexcept {
  for (std::size_t id = 0; id < row.size(); ++id) {
    if (hashed_[id]) hash_.add(row[id]);
  }
}

void RepeatedRun::take_faults(const std::vector<RunObserver*>& observers, std::int64_t time_ns) {
  for (Fault fault; assembly_.control().safety().log().try_pop(fault);) {
    for (RunObserver* observer : observers) observer->fault(fault);
    faults_.push_back({fault, told(fault, assembly_.robot().model, time_ns, "")});
  }
}

void RepeatedRun::go_on_in(Assembly& model, const std::function<bool()>& stop,
                           const std::vector<RunObserver*>& observers) {
  ControlEngine& control = assembly_.control();
  const std::int64_t period_ns = assembly_.robot().engine.control_period_ns(), from_ns = taken_.time_ns;
  const std::int64_t every = assembly_.robot().engine.behavior_divisor();
  const SignalTable &shown = model.catalog().signals, &own = assembly_.catalog().signals;
  std::vector<double> row(shown.size());
  std::vector<std::pair<SignalId, SignalId>> computed, true_ones;  // of the model, of the engines
  for (SignalId id = 0; id < shown.size(); ++id) {
    const std::optional<SignalId> same = own.find(shown.info(id).name);
    if (same) (shown.info(id).name.starts_with("plant.") ? true_ones : computed).emplace_back(id, *same);
  }
  next_behaviors_.reset();
  while (!led() && fed_ < sent_before_ && feed_next()) {  // what was commanded, and has not arrived yet
  }
  WorldRobot& robot = model.world()->robot(0);
  SensorFrame sensors;
  for (std::int64_t passed_ns = period_ns; !stop(); passed_ns += period_ns) {
    const std::int64_t now_ns = from_ns + passed_ns;
    {
      const auto actuation = link_.actuation.read();
      robot.write(*actuation);
    }
    model.world()->step(period_ns);
    robot.read(sensors);
    sensors.time_ns = now_ns;
    for (JointSample& joint : sensors.joints) joint.time_ns = 0;
    sensors.imu.time_ns = 0;
    link_.sensors.publish(sensors);
    link_.truth.publish(robot.truth());
    const double time_s = 1e-9 * static_cast<double>(passed_ns - period_ns);
    if (model.truth() != nullptr) model.truth()->update(time_s, row);
    shown.gather(row);
    for (const auto& [id, same] : true_ones) foreign_[same] = row[id];
    for (DownStorage* storage : hand_overs_.down) storage->let_through(std::numeric_limits<std::int64_t>::max());
    control.tick(now_ns, 1e-9 * static_cast<double>(period_ns), 0);
    ++ticks_;
    add_hash(control.row());
    for (const auto& [id, same] : computed) row[id] = control.row()[same];
    for (RunObserver* observer : observers) {
      observer->tick(time_s, row);
      observer->between_ticks({control.ticks(), passed_ns, hash_.value()});
    }
    take_faults(observers, now_ns);
    if (static_cast<std::int64_t>(control.ticks()) % every == 0) {
      control.exchange().heartbeat.publish(now_ns);
      engine_.tick(now_ns);
      ++behavior_ticks_;
    }
  }
}

bool RepeatedRun::repeat_tick(const TickTaken& taken) {
  for (const auto& [id, number] : foreign_signals_) foreign_[id] = ticks_read_.row()[number];
  if (repeats_flight()) {
    for (std::size_t i = 0; i < taken.down.size(); ++i) {
      if (!hand_down(i, taken.down[i])) return false;
    }
  }
  feed(taken);
  if (!feed_commands(taken.inputs.commands)) return false;
  ControlEngine& control = assembly_.control();
  control.tick(taken.time_ns, taken.inputs.dt_s, taken.inputs.missed);
  ++ticks_;
  if (repeats_flight()) note_objects();
  compare(taken);
  for (std::size_t i = 0; i < hand_overs_.down.size() && i < taken.down.size(); ++i) {
    if (hand_overs_.down[i]->taken() != taken.down[i])
      part("a control object found value " + std::to_string(hand_overs_.down[i]->taken()) + " of its high level, not " +
           std::to_string(taken.down[i]));
  }
  if (repeats_flight()) compare_state();
  return true;
}

// Of the values that high levels handed down, all up to this number. False: the record ends before.
bool RepeatedRun::hand_down(std::size_t storage, std::int64_t number) {
  if (storage >= handed_.size()) return true;
  BehaviorInput input;
  while (handed_[storage] < number) {
    if (!handed_read_.next(input)) {
      out_of_commands_ = true;
      return false;
    }
    if (input.kind != BehaviorInput::Kind::handed_down || input.number >= handed_.size()) continue;
    if (input.handed <= handed_[input.number]) continue;
    handed_[input.number] = input.handed;
    DownStorage& down = *hand_overs_.down[input.number];
    if (input.handed - waiting_values_max > down.taken() || !down.feed(input.handed, input.bytes)) {
      part("what a high level handed down has another size, or comes too early");
      return false;
    }
  }
  return true;
}

// An object that has not stepped since the state was restored shows no signals yet.
void RepeatedRun::note_objects() {
  const std::uint64_t tick = assembly_.control().ticks() - 1;
  const Catalog& catalog = assembly_.catalog();
  for (std::uint32_t i = 0; i < stepped_.size(); ++i) {
    const bool steps = assembly_.sets().runs(i) && tick % catalog.objects[i].divisor == 0;
    if (stepped_[i] || (!steps && ticks_ > 1)) continue;
    stepped_[i] = steps;
    const std::string prefix = "control." + catalog.objects[i].name + ".";
    for (SignalId id = 0; id < catalog.signals.size(); ++id) {
      if (catalog.signals.info(id).name.starts_with(prefix)) comparison_->leave_out(id, !steps);
    }
  }
}

// With the one that was saved after this tick.
void RepeatedRun::compare_state() {
  const EngineStates::Saved* const saved = states_read_.get();
  if (saved == nullptr || saved->tick != taken_.tick) return;
  for (std::size_t i = 0; i < hand_overs_.down.size() && i < saved->found.size(); ++i) {
    if (hand_down(i, saved->found[i])) hand_overs_.down[i]->let_through(saved->found[i]);
  }
  ControlEngine& control = assembly_.control();
  std::vector<std::byte> bytes(ticks_read_.layout().state_bytes);
  StateBytes saving = StateBytes::saving(bytes, StateBytes::Levels::low);
  control.pass_state(saving);
  bytes.resize(std::min(bytes.size(), saving.size()));
  const auto first = std::ranges::mismatch(bytes, saved->bytes);
  if (first.in1 == bytes.end() && first.in2 == saved->bytes.end())
    ++states_;
  else
    part("the state of " + control.part_of_state(static_cast<std::size_t>(first.in1 - bytes.begin())) +
         " is another one than was saved");
  states_read_.drop();
}

// With the file in which the tick lies.
void RepeatedRun::compare(const TickTaken& taken) {
  if (comparison_->ended() && !comparison_->parted() && compared_.go_on()) {
    compared_before_ += comparison_->ticks();
    comparison_ = std::make_unique<RecordComparison>(compared_.reader(), assembly_.catalog().signals);
  }
  comparison_->compare(taken.tick, taken.time_ns, assembly_.control().row());
}

void RepeatedRun::feed(const TickTaken& taken) {
  ControlEngine& control = assembly_.control();
  EngineExchange& exchange = control.exchange();
  link_.sensors.publish(taken.sensors);
  exchange.heartbeat.publish(taken.inputs.heartbeat_ns);
  if (std::memcmp(&joystick_, &taken.joystick, sizeof joystick_) != 0) exchange.joystick.publish(taken.joystick);
  joystick_ = taken.joystick;
  if (taken.ball.confidence > 0) exchange.ball.publish(taken.ball);
  if (std::memcmp(&seen_, &taken.seen, sizeof seen_) != 0) exchange.seen.publish(taken.seen);
  seen_ = taken.seen;
  EmergencyStop& stop = control.safety().emergency_stop();
  if ((taken.inputs.stop & heard_lift) != 0) stop.lift();
  if ((taken.inputs.stop & heard_stop) != 0) stop.ask_as_recorded(taken.stopped_by);
  if ((taken.inputs.stop & heard_leave) != 0) stop.leave();
  for (std::size_t i = 0; i < hand_overs_.down.size() && i < taken.down.size(); ++i)
    hand_overs_.down[i]->let_through(taken.down[i]);
}

bool RepeatedRun::feed_commands(std::uint32_t waiting) {
  if (led()) return true;
  while (assembly_.control().exchange().commands.size() < waiting) {
    if (!feed_next()) {
      out_of_commands_ = true;
      return false;
    }
  }
  return true;
}

// Of a flight record: it is in the state already.
bool RepeatedRun::is_old(const BehaviorInput& input) const noexcept {
  const std::uint32_t after = input.commands.front().sequence - last_transaction_;
  return repeats_flight() && (after == 0 || after > std::numeric_limits<std::uint32_t>::max() / 2);
}

// The next batch of the record's commands.
bool RepeatedRun::feed_next() {
  BehaviorInput input;
  do {
    if (!commands_read_.next(input)) return false;
  } while (input.kind != BehaviorInput::Kind::sent || is_old(input));
  if (repeats_flight() && input.commands.front().sequence != ++last_transaction_) return false;
  ++fed_;
  commands_ += input.commands.size() - 1;
  return assembly_.control().exchange().commands.try_push(input.commands);
}

// All that began before this control tick.
void RepeatedRun::repeat_behaviors(std::uint64_t until_tick) {
  while (parting_.empty() || leads()) {
    if (!next_behaviors_ && (behaviors_end_ || !read_behavior_tick())) return;
    if (next_behaviors_->snapshot() > until_tick) return;
    repeat_behavior_tick();
    next_behaviors_.reset();
  }
}

bool RepeatedRun::read_behavior_tick() {
  next_behaviors_.emplace();
  if (next_behaviors_->read(behaviors_read_)) return true;
  behaviors_end_ = true;
  const bool begun = next_behaviors_->begun();
  if (!begun) next_behaviors_.reset();
  return begun;
}

void RepeatedRun::repeat_behavior_tick() {
  const std::vector<BehaviorInput>& inputs = next_behaviors_->inputs();
  for (const BehaviorInput& input : inputs) write_file(input);
  CommandQueue& queue = assembly_.control().exchange().commands;
  const auto take_all = [&queue] {
    std::vector<Command> all;
    for (Command command; queue.try_pop(command);) all.push_back(command);
    return all;
  };
  const std::vector<Command> waiting = take_all();
  sent_ = 0;
  for (const BehaviorInput& input : inputs) {
    if (input.kind == BehaviorInput::Kind::newer && input.number < hand_overs_.up.size() &&
        !hand_overs_.up[input.number]->feed(input.bytes))
      part("a value of a control object has another size");
  }
  for (const BehaviorInput& input : inputs) {
    if (input.kind == BehaviorInput::Kind::asked && plays()) ask_again(input);
    if (input.kind == BehaviorInput::Kind::sent && !input.in_tick && plays()) send_again(input);
    if (input.kind == BehaviorInput::Kind::tick_begins) engine_.tick(input.time_ns);
  }
  ++behavior_ticks_;
  const auto more = std::find_if(inputs.begin() + static_cast<std::ptrdiff_t>(sent_), inputs.end(),
                                 [](const auto& input) { return input.kind == BehaviorInput::Kind::sent; });
  if (more != inputs.end() && !behaviors_end_ && plays())
    part("the behaviors do not send " + command_text(more->commands.back(), assembly_.catalog()));
  const std::vector<Command> commanded = take_all();
  (void)queue.try_push(waiting);
  if (led()) {  // after what was commanded before, and has not arrived yet
    while (fed_ < sent_before_ && feed_next()) {
    }
    (void)queue.try_push(commanded);
    commands_ += commanded.size() -
                 static_cast<std::size_t>(std::ranges::count(commanded, CommandKind::transaction, &Command::kind));
  }
  sent_before_ += static_cast<std::uint64_t>(
      std::ranges::count(inputs, BehaviorInput::Kind::sent, [](const BehaviorInput& input) { return input.kind; }));
  if (led()) fed_ = sent_before_;
  if (plays()) compare_events();
}

void RepeatedRun::write_file(const BehaviorInput& input) {
  if (std::filesystem::path(input.path).is_absolute()) return;  // those of this machine
  if (input.kind == BehaviorInput::Kind::file) unpacked_.replace({input.path, "", input.text});
  if (input.kind == BehaviorInput::Kind::private_file)
    unpacked_.fetch({input.path, input.text, std::nullopt, true}, compared_.file());
}

// They saw snapshots that behaviors had passed on, so their ticks come after those.
void RepeatedRun::repeat_decisions() {
  if (!decisions_ || !parting_.empty()) return;
  {
    const auto snapshot = assembly_.control().exchange().snapshot.read(0);
    decisions_->repeat(*snapshot);
  }
  if (!leads()) parting_ = decisions_->parting();  // behaviors that lead do not answer to decisions that differ
}

void RepeatedRun::ask_again(const BehaviorInput& input) {
  const auto snapshot = assembly_.control().exchange().snapshot.read(0);
  ScriptHost& host = assembly_.host();
  if (input.how == Asked::note) return host.note(*snapshot, engine_.commands());
  if (input.how == Asked::question) {
    if (!host.repeat_question(input.bytes, *snapshot)) part("a question to the behaviors is damaged");
    return;
  }
  ByteReader bytes(input.bytes);
  PlayOrder order = take_order(bytes);
  if (!bytes.ok()) return part("an order to the behaviors is damaged");
  for (PlayItem& item : order.list) item.file = moved(item.file);
  order.file = order.file.empty() ? order.file : moved(order.file);
  try {
    host.order(order);
  } catch (const InputError&) {  // refused, as it was then
  }
}

// A file of the run, among those of the record.
std::filesystem::path RepeatedRun::moved(const std::filesystem::path& file) const {
  if (file.is_relative()) return unpacked_.root() / file;
  const std::filesystem::path below = file.lexically_relative(recorded_root_);
  return below.empty() || *below.begin() == ".." ? file : unpacked_.root() / below;
}

void RepeatedRun::send_again(const BehaviorInput& input) {
  CommandSender& sender = engine_.sender();
  sender.begin(input.commands.front().time_ns);
  for (std::size_t i = 1; i < input.commands.size(); ++i) (void)sender.add(input.commands[i]);
  (void)sender.commit();
}

std::string RepeatedRun::place() const {
  return "in tick " + std::to_string(taken_.tick) + printed(", at %.3f s", 1e-9 * static_cast<double>(taken_.time_ns));
}

void RepeatedRun::part(const std::string& what) {
  if (parting_.empty()) parting_ = place() + ": " + what;
}

// But for those of the decisions, of which only what they ask for is compared.
bool RepeatedRun::next_event(std::string& text) {
  const Supervisor* const supervisor = assembly_.supervisor();
  const Decider* const decider = supervisor == nullptr ? nullptr : supervisor->decider();
  const std::string passed_over = decider == nullptr ? "" : "{\"behavior\":\"" + decider->name() + "\",";
  for (McapMessage message; events_read_.next(message);) {
    text.assign(reinterpret_cast<const char*>(message.payload.data()), message.payload.size());
    if (passed_over.empty() || !text.starts_with(passed_over)) return true;
  }
  return false;
}

// The charts' events, in their order.
void RepeatedRun::compare_events() {
  for (Event event; said_.pop(std::numeric_limits<std::int64_t>::max(), event);) {
    if (event.kind == Event::Kind::message) continue;
    std::string then;
    if (!next_event(then)) return;  // the record ends, or lost them
    const std::string now = json_of(event);
    if (now != then) return part("the behaviors tell " + now + ", recorded was " + then);
    ++events_;
  }
}

bool RepeatedRun::same() const {
  return ticks_ > 0 && !comparison_->parted() && comparison_->gone().empty() && parting_.empty();
}

std::string RepeatedRun::shortened() const {
  if (!ticks_read_.problem().empty()) return ticks_read_.problem();
  if (commands_read_.damaged() || behaviors_read_.damaged())
    return "what its behaviors took is damaged or not complete";
  if (decisions_ && decisions_->damaged()) return "what its decisions took is damaged or not complete";
  if (handed_read_.damaged()) return "what came down to its control engine is damaged or not complete";
  if (out_of_commands_) return "its last commands are missing";
  return "";
}

void RepeatedRun::sent(std::span<const Command> batch, bool) noexcept {
  if (!next_behaviors_ || !plays()) return;
  const std::vector<BehaviorInput>& inputs = next_behaviors_->inputs();
  while (sent_ < inputs.size() && inputs[sent_].kind != BehaviorInput::Kind::sent) ++sent_;
  if (sent_ == inputs.size()) {
    if (!behaviors_end_) part("the behaviors also send " + command_text(batch.back(), assembly_.catalog()));
    return;
  }
  const std::vector<Command>& recorded = inputs[sent_++].commands;
  if (batch.size() != recorded.size())
    return part("the behaviors send " + std::to_string(batch.size() - 1) + " commands, the last " +
                command_text(batch.back(), assembly_.catalog()) + ", recorded were " +
                std::to_string(recorded.size() - 1));
  for (std::size_t i = 1; i <= batch.size(); ++i) {  // their header last
    const Command &now = batch[i % batch.size()], &then = recorded[i % batch.size()];
    if (!same_command(now, then))
      return part("the behaviors send " + command_text(now, assembly_.catalog()) + ", recorded was " +
                  command_text(then, assembly_.catalog()));
  }
}

double RepeatedRun::parameter(double newest) noexcept {
  return next_behaviors_ ? next_behaviors_->parameter(newest) : newest;
}

bool RepeatedRun::time_is_over(bool (*)(void*) noexcept, void*) noexcept {
  ++looks_;
  return next_behaviors_ && next_behaviors_->time_is_over(looks_);
}

}  // namespace kadans
