#include "drive_watch.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace kadans {
namespace {

// The number to look up, and what the maker calls it: "code 18: undervoltage".
FaultWords words_of(std::uint32_t code, DriveWords words) noexcept {
  FaultWords text = fault_words("code ");
  char* const end = text.data() + text.size() - 1;
  char* at = std::to_chars(text.data() + 5, end, code).ptr;
  const auto add = [&](std::string_view more) {
    at = std::copy_n(more.begin(), std::min(more.size(), static_cast<std::size_t>(end - at)), at);
  };
  const std::string_view said = words == nullptr ? std::string_view() : words(code);
  if (!said.empty()) add(": ");
  add(said);
  return text;
}

}  // namespace

void DriveWatch::describe(const SafetySettings& settings, const Input& in, Fault& fault) const noexcept {
  switch (fault.code) {
    case FaultCode::drive_fault:
      fault.value = in.sample.code;
      fault.words = words_of(in.sample.code, settings.drive_words);
      break;
    case FaultCode::drive_not_enabled:
      fault.value = idle_s_;
      fault.limit = settings.drives.enable_s;
      fault.words = fault_words(name(in.sample.drive));
      break;
    case FaultCode::drive_hot:
      fault.value = static_cast<double>(in.sample.temperature_C);
      fault.limit = settings.drives.hot_C;
      break;
    case FaultCode::sample_old:
      fault.value = age_s(in);
      fault.limit = settings.drives.sample_age_max_s;
      break;
    default:
      break;
  }
}

FaultMask SupplyWatch::look(const SensorFrame& sensors, double dt_s) noexcept {
  using enum FaultCode;
  supply_V_ = sensors.supply_V;
  // One that is not told any more may be empty.
  const bool low = settings_.lowest_V > 0 && !(supply_V_ >= settings_.lowest_V);
  const bool high = settings_.highest_V > 0 && supply_V_ > settings_.highest_V;
  low_s_ = low ? low_s_ + dt_s : 0;
  high_s_ = high ? high_s_ + dt_s : 0;
  return bit_if(low && low_s_ > settings_.time_s, supply_low) |
         bit_if(high && high_s_ > settings_.time_s, supply_high) | bit_if(sensors.emergency, emergency_input);
}

void SupplyWatch::describe(Fault& fault) const noexcept {
  if (fault.code == FaultCode::supply_low) {
    fault.value = supply_V_;
    fault.limit = settings_.lowest_V;
  } else if (fault.code == FaultCode::supply_high) {
    fault.value = supply_V_;
    fault.limit = settings_.highest_V;
  } else if (fault.code == FaultCode::emergency_input) {
    fault.words = fault_words("the button");
  }
}

}  // namespace kadans
