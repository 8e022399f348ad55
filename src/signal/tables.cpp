// The tables of parameters, set-points and signals.
#include <cassert>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "kadans/signal/nearest_name.h"
#include "kadans/signal/parameter.h"
#include "kadans/signal/setpoint.h"
#include "kadans/signal/signal.h"
#include "number_text.h"

namespace kadans {
namespace {

// Copies each run of `length` doubles to its place in the row.
template <std::size_t length>
void copy_runs(const auto& runs, std::span<double> row) noexcept {
  for (const auto& [id, first] : runs) std::memcpy(&row[id], first, length * sizeof(double));
}

// The number of this name or key; nothing where there is none.
template <typename Ids, typename Key>
std::optional<std::uint32_t> found_in(const Ids& ids, const Key& key) {
  const auto found = ids.find(key);
  if (found == ids.end()) return std::nullopt;
  return found->second;
}

}  // namespace

ParameterId ParameterTable::add(Parameter parameter, double* value, std::uint32_t owner) {
  if (!(parameter.min <= parameter.max)) throw std::invalid_argument("parameter " + parameter.name + ": empty range");
  if (!(std::isfinite(parameter.initial) && parameter.initial >= parameter.min && parameter.initial <= parameter.max)) {
    throw std::invalid_argument("parameter " + parameter.name + ": initial value " + number_text(parameter.initial) +
                                " is outside " + number_text(parameter.min) + ".." + number_text(parameter.max));
  }
  const auto id = static_cast<ParameterId>(entries_.size());
  if (!ids_.emplace(parameter.name, id).second) {
    throw std::invalid_argument("parameter " + parameter.name + " is declared twice");
  }
  *value = parameter.initial;
  const OneWriter<double> newest(parameter.initial);
  entries_.push_back({std::move(parameter), value, owner, newest});
  return id;
}

bool ParameterTable::set(ParameterId id, double value) noexcept {
  if (!accepts(id, value)) return false;
  *entries_[id].value = value;
  entries_[id].newest.set(value);
  return true;
}

std::optional<ParameterId> ParameterTable::find(std::string_view name) const {
  return found_in(ids_, std::string(name));
}

std::vector<std::string> ParameterTable::names() const {
  std::vector<std::string> all;
  all.reserve(entries_.size());
  for (const Entry& entry : entries_) all.push_back(entry.info.name);
  return all;
}

SetpointId SetpointTable::add(Setpoint setpoint) {
  if (!(setpoint.min <= setpoint.max)) throw std::invalid_argument("set-point " + setpoint.name + ": empty range");
  if (setpoint.safe < setpoint.min || setpoint.safe > setpoint.max)  // NaN: it has none
    throw std::invalid_argument("set-point " + setpoint.name + ": its safe value is outside its range");
  const auto id = static_cast<SetpointId>(entries_.size());
  if (!ids_.emplace(setpoint.name, id).second) {
    throw std::invalid_argument("set-point " + setpoint.name + " is declared twice");
  }
  entries_.push_back(std::move(setpoint));
  return id;
}

std::optional<SetpointId> SetpointTable::find(std::string_view name) const { return found_in(ids_, std::string(name)); }

std::vector<std::string> SetpointTable::names() const { return names_of(entries_); }

SignalId SignalTable::add_info(Signal signal) {
  const auto id = static_cast<SignalId>(infos_.size());
  if (!ids_.emplace(signal.name, id).second) {
    throw std::invalid_argument("signal " + signal.name + " is declared twice");
  }
  if (!keys_.emplace(signal_key(signal.name), id).second)
    throw std::invalid_argument("signal " + signal.name + " has the key of another one: give it another name");
  infos_.push_back(std::move(signal));
  return id;
}

SignalId SignalTable::add(Signal signal, const double* source) {
  const SignalId id = add_info(std::move(signal));
  const std::size_t length = last_run_;
  if (length > 0 && length < run_max) {
    const Source<double> run = runs_[length - 1].back();
    if (run.id + length == id && run.value + length == source) {
      runs_[length - 1].pop_back();
      runs_[length].push_back(run);
      last_run_ = length + 1;
      sources_.emplace_back(source);
      return id;
    }
  }
  runs_[0].push_back({id, source});
  last_run_ = 1;
  sources_.emplace_back(source);
  return id;
}

template <typename T>
SignalId SignalTable::add_to(std::vector<Source<T>>& sources, Signal signal, const T* source) {
  const SignalId id = add_info(std::move(signal));
  sources.push_back({id, source});
  sources_.emplace_back(source);
  return id;
}

SignalId SignalTable::add(Signal signal, const bool* source) { return add_to(bools_, std::move(signal), source); }

SignalId SignalTable::add(Signal signal, const std::uint8_t* source) {
  return add_to(choices_, std::move(signal), source);
}

SignalId SignalTable::add(Signal signal, const std::uint32_t* source) {
  return add_to(counts_, std::move(signal), source);
}

SignalId SignalTable::add(Signal signal, const std::atomic<std::uint32_t>* source) {
  return add_to(shared_, std::move(signal), source);
}

void SignalTable::read_from(SignalId id, const double* source) {
  const auto of_id = [id](const auto& one) { return one.id == id; };
  std::erase_if(bools_, of_id);
  std::erase_if(choices_, of_id);
  std::erase_if(counts_, of_id);
  std::erase_if(shared_, of_id);
  for (std::size_t length = run_max; length > 1; --length) {  // a run falls apart
    for (const Source<double>& run : runs_[length - 1]) {
      if (id < run.id || id >= run.id + length) continue;
      for (std::size_t i = 0; i < length; ++i) runs_[0].push_back({static_cast<SignalId>(run.id + i), run.value + i});
    }
    std::erase_if(runs_[length - 1], [&](const auto& run) { return id >= run.id && id < run.id + length; });
  }
  std::erase_if(runs_[0], of_id);
  runs_[0].push_back({id, source});
  last_run_ = 0;
  sources_[id] = source;
}

void SignalTable::gather(std::span<double> row) const noexcept {
  assert(row.size() == infos_.size());
  [&]<std::size_t... less_1>(std::index_sequence<less_1...>) { (copy_runs<less_1 + 1>(runs_[less_1], row), ...); }
  (std::make_index_sequence<run_max>{});
  for (const auto& [id, value] : bools_) row[id] = *value ? 1.0 : 0.0;
  for (const auto& [id, value] : choices_) row[id] = static_cast<double>(*value);
  for (const auto& [id, value] : counts_) row[id] = static_cast<double>(*value);
  for (const auto& [id, value] : shared_) row[id] = static_cast<double>(value->load(std::memory_order_relaxed));
}

double SignalTable::read(SignalId id) const noexcept {
  const auto number = []<typename T>(const T* source) {
    if constexpr (std::is_same_v<T, std::atomic<std::uint32_t>>) {
      return static_cast<double>(source->load(std::memory_order_relaxed));
    } else {
      return static_cast<double>(*source);
    }
  };
  return std::visit(number, sources_[id]);
}

std::optional<SignalId> SignalTable::find(std::string_view name) const { return found_in(ids_, std::string(name)); }

std::optional<SignalId> SignalTable::find_key(std::int64_t key) const noexcept { return found_in(keys_, key); }

std::vector<std::string> SignalTable::names() const { return names_of(infos_); }

}  // namespace kadans
