#include "instance.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "config/json/problems.h"
#include "kadans/signal/nearest_name.h"
#include "signal/input_file.h"

namespace kadans {

std::uint64_t InstancePort::send(Order order) {
  const bool to_records = is_about_records(order.kind);
  auto asked = std::make_unique<OrderCase>();
  asked->order = std::move(order);
  asked->answer.number = sent_ + 1;
  if (!(to_records ? records_ : behaviors_).ask(std::move(asked))) return 0;
  return ++sent_;
}

bool InstancePort::next(Answer& answer) {
  std::unique_ptr<OrderCase> answered = behaviors_.answered();
  if (!answered) answered = records_.answered();
  if (!answered) return false;
  answer = std::move(answered->answer);
  return true;
}

std::uint32_t Instance::set_named(const std::string& name) const {
  const std::vector<std::string> names = names_of(catalog_.sets);
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) refuse(unknown_name("control set", name, names));
  return static_cast<std::uint32_t>(found - names.begin());
}

InstancePort& Instance::open_port() {
  if (ports_.size() == ports_max) throw std::logic_error("an instance has no more ports");
  return *ports_.emplace_back(std::make_unique<InstancePort>(catalog_.signals.size()));
}

InstanceStatus status_of(const Snapshot& snapshot, const RecordStatus& record) noexcept {
  return {.tick = snapshot.tick,
          .time_ns = snapshot.time_ns,
          .safety = snapshot.status.safety,
          .control_sets = snapshot.control_sets,
          .commands_refused = snapshot.commands_refused,
          .record = record,
          .power = snapshot.power,
          .seen = snapshot.seen};
}

void Instance::publish(const InstanceStatus& status) noexcept {
  for (const auto& port : ports_) port->status_.publish(status);
}

void Instance::tell(const Line& line) {
  for (const auto& port : ports_) port->events_.tell(line);
}

void Instance::tell_active(const ActiveStates& active) {
  for (const auto& port : ports_) port->events_.tell_active(active);
}

void Instance::tell(const Fault& fault) noexcept {
  for (const auto& port : ports_) (void)port->faults_.try_push(fault);  // its server counts by itself
}

}  // namespace kadans
