#include "kadans/plant/emulated_drives.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "kadans/signal/nearest_name.h"
#include "signal/number_text.h"

namespace kadans {

void check_fault(const EmulatedFault& fault, std::span<const EmulatedFaultKind> kinds,
                 const std::vector<std::string>& drives, const std::vector<std::string>& lines) {
  using Of = EmulatedFaultKind::Of;
  const auto fail = [](const std::string& why) { throw std::invalid_argument(why); };
  const auto kind = std::ranges::find_if(kinds, [&](const EmulatedFaultKind& one) { return one.name == fault.kind; });
  if (kind == kinds.end())
    fail("no fault '" + fault.kind + "' of this bus; there are " + listed(kinds, &EmulatedFaultKind::name));
  const std::vector<std::string>& names = kind->of == Of::drive ? drives : lines;
  const bool known = std::ranges::find(names, fault.of) != names.end();
  if (kind->of == Of::nothing && !fault.of.empty()) fail(fault.kind + " is of nothing, not of '" + fault.of + "'");
  if (kind->of == Of::drive && fault.of.empty()) fail(fault.kind + " needs a drive, such as " + names.front());
  if (!fault.of.empty() && kind->of != Of::nothing && !known)
    fail((kind->of == Of::drive ? "no drive '" : "no port or board '") + fault.of + "'" +
         did_you_mean(fault.of, names));
  const std::string size = kind->size;
  if (size.empty() && fault.size != 0) fail(fault.kind + " has no size");
  if (!size.empty() && fault.size == 0) fail(fault.kind + " needs a size: " + size);
  if (size.starts_with("share") && !(fault.size > 0 && fault.size <= 1)) fail(fault.kind + ": a share is 0..1");
}

EmulatedFault emulated_fault(const std::string& text) {
  EmulatedFault fault;
  const std::size_t at = text.find('@');
  const std::string what = text.substr(0, at);
  const std::size_t colon = what.find(':');
  fault.kind = what.substr(0, colon);
  if (colon != std::string::npos) fault.of = what.substr(colon + 1);
  const auto number = [&](std::size_t from, std::size_t until) {
    const std::string part = text.substr(from, until - from);
    const std::optional<double> value = number_of<double>(part);
    if (!value || !(std::abs(*value) <= 1e6)) throw std::invalid_argument("'" + part + "' is no number");
    return *value;
  };
  if (at == std::string::npos) throw std::invalid_argument("says no time: @ and seconds");
  const std::size_t equals = std::min(text.find('=', at), text.size()), plus = std::min(text.find('+', at), equals);
  fault.from_s = number(at + 1, plus);
  if (plus < equals) fault.until_s = fault.from_s + number(plus + 1, equals);
  if (equals < text.size()) fault.size = number(equals + 1, text.size());
  if (!(fault.from_s >= 0 && fault.until_s > fault.from_s)) throw std::invalid_argument("times must be above 0");
  return fault;
}

void FaultPlan::add(const std::vector<EmulatedFault>& faults, const EmulatedDrives& drives) {
  for (const EmulatedFault& fault : faults) {
    drives.check(fault);
    faults_.push_back({.is = fault});
  }
}

void FaultPlan::happen(EmulatedDrives& drives, std::int64_t time_ns) noexcept {
  const double time_s = 1e-9 * static_cast<double>(time_ns);
  for (Planned& fault : faults_) {
    if (!fault.begun && time_s >= fault.is.from_s) drives.befall(fault.is, fault.begun = true);
    if (!fault.begun || fault.ended || time_s < fault.is.until_s) continue;
    fault.ended = true;
    drives.befall(fault.is, false);
  }
}

void FaultPlan::end(EmulatedDrives& drives) noexcept {
  for (Planned& fault : faults_) {
    if (fault.begun && !fault.ended) drives.befall(fault.is, false);
    fault.begun = fault.ended = false;
  }
}

}  // namespace kadans
