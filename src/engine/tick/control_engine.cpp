#include "control_engine.h"

#include <span>
#include <utility>

#include "estimate/estimator.h"
#include "seen_entries.h"
#include "signal/status_fields.h"

namespace kadans {
ControlEngine::ControlEngine(const EngineSettings& settings, Plant& plant, Estimator& estimator, Safety& safety,
                             ControlSets& sets, Catalog& catalog, EngineExchange& exchange)
    : plant_(plant),
      estimator_(estimator),
      safety_(safety),
      sets_(sets),
      exchange_(exchange),
      inbox_(exchange.commands, catalog, sets, settings.commands_per_tick_max, settings.command_age_max_ns()),
      fault_state_(sets, catalog),
      catalog_(catalog),
      signals_(catalog.signals),
      rehearsal_(settings.control_period_s, estimator, safety, *catalog.model) {
  actuation_.joint_count = static_cast<std::uint32_t>(catalog.model->joints.size());
  written_ = actuation_;  // all of it, once
  declare_signals(catalog);
  if (settings.joystick) declare_part(catalog.signals, StatusField::Part::joystick, "joystick", snapshot_);
  declare_seen(catalog.signals, catalog.seen, snapshot_.seen);
  if (settings.sight) declare_part(catalog.signals, StatusField::Part::ball, "seen.ball", snapshot_);
  if (!catalog.feet.empty()) declare_part(catalog.signals, StatusField::Part::odometry, "odometry", snapshot_);
  row_.resize(catalog.signals.size());
}

void ControlEngine::tick(std::int64_t time_ns, double dt_s, std::uint32_t missed) noexcept {
  plant_.read(sensors_);
  inputs_.dt_s = dt_s;
  inputs_.missed = missed;
  inputs_.heartbeat_ns = exchange_.heartbeat.newest();
  estimator_.update(sensors_, dt_s, tick_, snapshot_.joints, snapshot_.status);
  safety_.check({.tick = tick_,
                 .dt_s = dt_s,
                 .missed_ticks = missed,
                 .heartbeat_age_s = 1e-9 * static_cast<double>(time_ns - inputs_.heartbeat_ns),
                 .sensors = sensors_,
                 .joints = snapshot_.joints,
                 .base = snapshot_.status.base,
                 .health = estimator_.health()},
                actuation_, snapshot_.status.safety);
  fault_state_.watch(tick_, snapshot_.status.safety.level);
  if (safety_.fall_phase() == FallWatch::Phase::falling && snapshot_.status.base.posture == Posture::upright)
    snapshot_.status.base.posture = Posture::falling;
  heed_stop();
  plant_.write(drive(time_ns, dt_s));
  copy_used(actuation_, written_);
  const ControlInput input{snapshot_.joints, snapshot_.status, written_, time_ns, dt_s};
  if (safety_.came_back()) sets_.restart(input);
  inbox_.apply(tick_, input, safety_);
  if (inbox_.odometry_resets()) estimator_.reset_odometry();
  inbox_.carry_out_armed(tick_, input, safety_);
  copy_first(inbox_.drive_requests(), actuation_.joint_count, actuation_.drives);
  inbox_.motions().step(dt_s);
  sets_.step(tick_, input, actuation_);
  publish(time_ns);
  ++tick_;
}

void ControlEngine::heed_stop() noexcept {
  if (std::exchange(stopped_, safety_.stopped()) || !stopped_) return;
  inbox_.revoke_orders(sensors_);
  copy_first(inbox_.drive_requests(), actuation_.joint_count, actuation_.drives);
}

// Objects at the drives turn what is wanted of the joints into what is asked of the motors.
const ActuationFrame& ControlEngine::drive(std::int64_t time_ns, double dt_s) noexcept {
  if (!sets_.drives()) return actuation_;
  copy_used(actuation_, motors_);
  const SensorHealth& health = estimator_.health();
  JointMask blind = 0;
  for (std::size_t i = 0; i < health.joint_count; ++i) {
    const SensorState& joint = health.joints[i];
    if (joint.silent_ticks >= joint.period_ticks || !joint.finite) blind |= joint_bit(i);
  }
  sets_.drive({snapshot_.joints, snapshot_.status, written_, time_ns, dt_s}, blind, motors_);
  return motors_;
}

// Step by step as tick(). The snapshot's slots are left out: they would push out of the smallest cache what is needed
// before them.
void ControlEngine::rehearse() noexcept {
  Rehearsal& r = rehearsal_;
  r.sample(sensors_);
  r.estimator = estimator_;
  r.safety.imitate(safety_);
  copy_used(snapshot_, r.snapshot);
  copy_used(actuation_, r.actuation);
  r.estimator.update(r.sensors, r.dt_s, tick_, r.snapshot.joints, r.snapshot.status);
  r.safety.check({.tick = tick_,
                  .dt_s = r.dt_s,
                  .missed_ticks = 0,
                  .heartbeat_age_s = 0,
                  .sensors = r.sensors,
                  .joints = r.snapshot.joints,
                  .base = r.snapshot.status.base,
                  .health = r.estimator.health()},
                 r.actuation, r.snapshot.status.safety);
  if (sets_.drives()) copy_used(actuation_, motors_);  // as drive() does before all else
  sets_.rehearse(tick_, {r.snapshot.joints, r.snapshot.status, written_, snapshot_.time_ns, r.dt_s}, r.actuation);
  inbox_.fill(r.snapshot);
  sets_.fill(r.snapshot);
  inbox_.motions().fill(r.snapshot);
  signals_.gather(row_);
}

void ControlEngine::tell_drives() noexcept {
  PowerStatus& power = snapshot_.power;
  power.supply_V = sensors_.supply_V;
  power.emergency = sensors_.emergency;
  const JointSample* said = sensors_.joints.data();
  for (DriveStatus& drive : std::span(power.drives).first(snapshot_.joints.count)) {
    drive = {said->temperature_C, said->code, said->drive, said->homed, said->braked};
    ++said;
  }
}

void ControlEngine::publish(std::int64_t time_ns) noexcept {
  snapshot_.tick = tick_;
  snapshot_.time_ns = time_ns;
  inbox_.fill(snapshot_);
  sets_.fill(snapshot_);
  inbox_.motions().fill(snapshot_);
  if (exchange_.joystick.has_news()) snapshot_.joystick = exchange_.joystick.newest();
  if (exchange_.ball.has_news()) snapshot_.ball = exchange_.ball.newest();
  if (snapshot_.ball.confidence > 0)
    snapshot_.ball.age_s = 1e-9 * static_cast<double>(time_ns - snapshot_.ball.time_ns);
  if (exchange_.seen.has_news()) {
    const auto reading = exchange_.seen.read();
    copy_used(*reading, seen_);
  }
  show_seen(seen_, snapshot_.status.odometry, time_ns, snapshot_.seen);
  tell_drives();
  exchange_.snapshot.publish(snapshot_);
  signals_.gather(row_);
  inputs_.commands = inbox_.arrived();
  inputs_.stop = safety_.heard();
  if (sink_ != nullptr) sink_->record(tick_, time_ns, row_);
}

void ControlEngine::pass_own_state(StateBytes& bytes) noexcept {
  bytes(stopped_, snapshot_.control_sets, snapshot_.status.safety, snapshot_.joystick, snapshot_.ball, seen_,
        snapshot_.seen, snapshot_.power, sensors_.imu);
  bytes.must(seen_.count <= max_seen && snapshot_.seen.count <= max_seen);
  for (ActuationFrame* frame : {&actuation_, &written_}) {
    for (std::size_t joint = 0; joint < frame->joint_count; ++joint) {
      bytes(frame->joints[joint], frame->drives[joint]);
      bytes.must(frame->joints[joint].mode <= last_actuation_mode);
    }
  }
  fault_state_.pass_state(bytes);
}

void ControlEngine::pass_state(StateBytes& bytes) noexcept {
  pass_own_state(bytes);
  inbox_.pass_state(bytes);
  estimator_.pass_state(bytes);
  safety_.pass_state(bytes);
  sets_.pass_state(bytes);
}

bool ControlEngine::restore(std::uint64_t ticks, std::span<const std::byte> state) noexcept {
  StateBytes restoring = StateBytes::restoring(state, StateBytes::Levels::low);
  pass_state(restoring);
  tick_ = ticks;
  return restoring.ok() && restoring.size() == state.size();
}

// By the sizes of the parts in front: where a part begins, what is in front of it has been passed.
std::string ControlEngine::part_of_state(std::size_t offset) {
  std::vector<std::byte> bytes(offset);
  StateBytes saving = StateBytes::saving(bytes, StateBytes::Levels::low);
  pass_own_state(saving);
  if (saving.size() > offset) return "the control engine itself";
  inbox_.pass_state(saving);
  if (saving.size() > offset) return "commands, parameters and motions of set-points";
  estimator_.pass_state(saving);
  if (saving.size() > offset) return "the estimate";
  safety_.pass_state(saving);
  if (saving.size() > offset) return "safety";
  StateBytes all = StateBytes::saving(bytes, StateBytes::Levels::low), objects = all;
  sets_.pass_state(all);
  for (std::uint32_t i = 0; i < sets_.size(); ++i) sets_.object(i).pass_state(objects);
  std::size_t end = saving.size() + all.size() - objects.size();  // the objects' states are the last
  if (end > offset) return "the control sets";
  for (std::uint32_t i = 0; i < sets_.size(); ++i) {
    StateBytes object = StateBytes::saving(bytes, StateBytes::Levels::low);
    sets_.object(i).pass_state(object);
    end += object.size();
    if (end > offset) return "control object " + catalog_.objects[i].name;
  }
  return "its end";
}

void ControlEngine::declare_signals(Catalog& catalog) {
  SignalTable& table = catalog.signals;
  kadans::declare_signals(table, *catalog.model, estimator_.settings(), snapshot_);
  constexpr const char* axes[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    table.add({std::string("imu.acceleration_") + axes[i] + "_m_s2", "m/s2",
               std::string("What the accelerometer says along the base's ") + axes[i] + " axis; at rest 9.81 upwards."},
              &sensors_.imu.acceleration_m_s2[i]);
  }
  for (std::size_t i = 0; i < catalog.model->joints.size(); ++i) {
    table.add({"actuation." + catalog.model->joints[i].name + ".effort_Nm", "Nm", "Torque demanded of the drive."},
              &written_.joints[i].effort_Nm);
  }
  table.add({"engine.commands.applied", "", "Commands applied since the start."}, &inbox_.state().applied);
  table.add({"engine.commands.refused", "", "Commands refused since the start."}, &inbox_.state().refused);
  table.add({"engine.control_sets", "", "Active control sets, a bit each, in the order of the configuration."},
            &snapshot_.control_sets);
  safety_.declare_signals(table, *catalog.model);
}

}  // namespace kadans
