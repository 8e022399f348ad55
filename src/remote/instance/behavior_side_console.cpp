// The consoles of clients, on the behavior thread. Their budget is smaller than that of a simulation's: the robot is
// waiting.
#include "behavior_side.h"

namespace kadans {
namespace {

constexpr ScriptLimits console_limits{.tick_instructions = 200'000,
                                      .load_instructions = 5'000'000,
                                      .tick_wall_ns = 20'000'000,
                                      .load_wall_ns = 100'000'000,
                                      .memory_bytes = std::size_t{4} << 20};

}  // namespace

Console& BehaviorSide::console_of(const Order& order) {
  if (p_.host == nullptr)
    throw InputError(
        {.message = "there is no console while behaviors play in a process of their own: run with --behaviors thread"});
  const auto found = consoles_.find(order.client);
  if (found != consoles_.end()) return *found->second;
  if (consoles_.size() == consoles_max) throw InputError({.message = "all consoles are taken"});
  const Instance::Facts& facts = p_.instance.facts();
  return *(consoles_[order.client] = std::make_unique<Console>(
               Console::Settings{.root = facts.root, .folders = facts.folders, .limits = console_limits},
               p_.instance.catalog(), *p_.host));
}

void BehaviorSide::evaluate(const Order& order, Answer& answer) {
  if (!consoles_.contains(order.client)) return;  // who typed it is gone
  const ParameterTable& table = p_.instance.catalog().parameters;
  parameters_.resize(table.size());
  for (ParameterId id = 0; id < table.size(); ++id) parameters_[id] = table.newest(id);
  Console& console = console_of(order);
  const auto snapshot = p_.exchange.snapshot.read(0);
  const auto row = p_.instance.console_row();
  const Console::Reply reply = console.evaluate(order.text, {*snapshot, row->values, parameters_, p_.engine.sender()});
  answer.done = !reply.error && reply.run_s == 0;
  answer.text = reply.run_s > 0 ? ":run is for a simulation that waits; time goes on by itself here" : reply.text;
  answer.incomplete = reply.incomplete;
  answer.writes = console.writes();
  answer.leaves = reply.quit;
  if (console.writes()) say(time_ns_, order.who, "typed " + order.text);
}

}  // namespace kadans
