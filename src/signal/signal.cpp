#include "kadans/signal/signal.h"

#include <cassert>
#include <stdexcept>
#include <utility>

namespace kadans {

SignalId SignalTable::add_info(Signal signal) {
  const auto id = static_cast<SignalId>(infos_.size());
  if (!ids_.emplace(signal.name, id).second) {
    throw std::invalid_argument("signal " + signal.name + " is declared twice");
  }
  infos_.push_back(std::move(signal));
  return id;
}

SignalId SignalTable::add(Signal signal, const double* source) {
  const SignalId id = add_info(std::move(signal));
  doubles_.push_back({id, source});
  return id;
}

SignalId SignalTable::add(Signal signal, const bool* source) {
  const SignalId id = add_info(std::move(signal));
  bools_.push_back({id, source});
  return id;
}

SignalId SignalTable::add(Signal signal, const std::uint8_t* source) {
  const SignalId id = add_info(std::move(signal));
  choices_.push_back({id, source});
  return id;
}

SignalId SignalTable::add(Signal signal, const std::uint32_t* source) {
  const SignalId id = add_info(std::move(signal));
  counts_.push_back({id, source});
  return id;
}

SignalId SignalTable::add(Signal signal, const std::atomic<std::uint32_t>* source) {
  const SignalId id = add_info(std::move(signal));
  shared_.push_back({id, source});
  return id;
}

void SignalTable::gather(std::span<double> row) const noexcept {
  assert(row.size() == infos_.size());
  for (const auto& [id, value] : doubles_) row[id] = *value;
  for (const auto& [id, value] : bools_) row[id] = *value ? 1.0 : 0.0;
  for (const auto& [id, value] : choices_) row[id] = static_cast<double>(*value);
  for (const auto& [id, value] : counts_) row[id] = static_cast<double>(*value);
  for (const auto& [id, value] : shared_) row[id] = static_cast<double>(value->load(std::memory_order_relaxed));
}

std::optional<SignalId> SignalTable::find(std::string_view name) const {
  const auto found = ids_.find(std::string(name));
  if (found == ids_.end()) return std::nullopt;
  return found->second;
}

std::vector<std::string> SignalTable::names() const {
  std::vector<std::string> all;
  all.reserve(infos_.size());
  for (const Signal& signal : infos_) all.push_back(signal.name);
  return all;
}

}  // namespace kadans
