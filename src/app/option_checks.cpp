#include "option_checks.h"

#include "config/json/fields.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

std::string refusal(const std::string& given, const char* kind, const std::string& range) {
  return "'" + given + "' is no " + kind + (range.empty() ? "" : " from " + range);
}

std::string range_of(double min, double max) {
  const bool any = min == std::numeric_limits<double>::lowest() && max == std::numeric_limits<double>::max();
  return any ? "" : number_text(min) + " to " + number_text(max);
}

bool whole_fits(const std::string& text, std::int64_t min, std::uint64_t max) {
  if (const auto number = number_of<std::uint64_t>(text))
    return *number <= max && (min <= 0 || *number >= static_cast<std::uint64_t>(min));
  const auto negative = number_of<std::int64_t>(text);
  return negative && *negative < 0 && *negative >= min;
}

}  // namespace

CLI::Validator number_within(double min, double max) {
  const std::string range = range_of(min, max);
  return {[=](std::string& text) {
            const auto number = number_of<double>(text);
            return number && *number >= min && *number <= max ? std::string() : refusal(text, "number", range);
          },
          range};
}

CLI::Validator whole_within(std::int64_t min, std::uint64_t max) {
  const bool any = min == 0 && max == std::numeric_limits<std::uint64_t>::max();
  const std::string range = std::to_string(min) + " to " + std::to_string(max);
  return {[=](std::string& text) {
            return whole_fits(text, min, max) ? std::string() : refusal(text, "whole number", range);
          },
          any ? std::string() : range};
}

}  // namespace kadans
