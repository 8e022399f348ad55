#include "rig.h"

#include "safety/detection.h"

namespace kadans::failures {

std::vector<std::unique_ptr<ControlObject>> Rig::sabotaged(std::vector<std::unique_ptr<ControlObject>> objects) {
  auto made = std::make_unique<Saboteur>(std::move(objects.at(0)));
  saboteur = made.get();
  objects[0] = std::move(made);
  return objects;
}

Rig::Rig(RigParts parts)
    : model(parts.model),
      faulty(parts.plant, parts.seed),
      plant(faulty),
      catalog(parts.catalog),
      sets(catalog, sabotaged(std::move(parts.objects))),
      estimator(model, parts.estimate, 1e-9 * static_cast<double>(period_ns)),
      safety(parts.safety, model),
      control(parts.engine, plant, estimator, safety, sets, catalog, *exchange),
      sender(exchange->commands),
      watch(model) {
  play_nothing();
}

void Rig::send(const Command& command, std::int64_t age_ns) {
  sender.begin(time_ns - age_ns);
  (void)sender.add(command);
  (void)sender.commit();
}

Command Rig::to(std::size_t joint, double position_rad, double duration_s) const {
  for (const SetpointId id : catalog.objects[0].setpoints) {
    if (catalog.setpoints[id].joint == joint) {
      return {.kind = CommandKind::set_point, .index = id, .value = position_rad, .duration_s = duration_s};
    }
  }
  return {};  // refused
}

void Rig::move(const std::string& pose, double duration_s) {
  sender.begin(time_ns);
  for (const PoseInfo& known : catalog.poses) {
    if (known.name != pose) continue;
    for (const auto& [joint, position_rad] : known.position_rad) {
      const Command command = to(joint, position_rad, duration_s);
      if (command.kind == CommandKind::set_point) (void)sender.add(command);
    }
  }
  (void)sender.commit();
}

void Rig::tick(std::int64_t dt_ns, std::uint32_t missed) {
  if (control.ticks() > 0) {
    plant.step(dt_ns);
    time_ns += dt_ns;
  }
  const double dt_s = 1e-9 * static_cast<double>(dt_ns);
  control.tick(time_ns, dt_s, missed);
  watch.look(control.ticks() - 1, dt_s, plant.written(), control.state().joints, safety);
  Fault fault;
  while (safety.log().try_pop(fault)) faults.push_back(fault);
  if (behaviors_alive && control.ticks() % 10 == 1) behaviors->tick(time_ns);
}

std::int64_t Rig::first(FaultCode code) const {
  for (const Fault& fault : faults) {
    if (fault.code == code) return static_cast<std::int64_t>(fault.tick);
  }
  return -1;
}

bool Rig::in_time(FaultCode code, std::int64_t shows) const {
  const std::int64_t found = first(code);
  const std::int64_t promised = detection_ticks(code, limits(), 1e-9 * static_cast<double>(period_ns));
  return found >= shows && found < shows + promised;
}

std::string Rig::codes() const {
  std::string text;
  for (const Fault& fault : faults) text += (text.empty() ? "" : " ") + std::string(name(fault.code));
  return text;
}

}  // namespace kadans::failures
