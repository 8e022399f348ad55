#include "urdf_value.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <vector>

#include "model/source_text.h"

namespace kadans {
namespace {

constexpr double largest = 1e9;
constexpr std::size_t longest_name = 128, longest_number = 64;
using Defect = std::optional<std::string>;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of(xml_blanks), text.size());
  return text.substr(first, text.find_last_not_of(xml_blanks) + 1 - first);
}

std::vector<std::string_view> pieces(std::string_view text) {
  constexpr std::size_t enough = 16;  // nothing in URDF has more than four
  std::vector<std::string_view> result;
  for (text = trimmed(text); !text.empty() && result.size() < enough; text = trimmed(text)) {
    const std::size_t end = std::min(text.find_first_of(xml_blanks), text.size());
    result.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return result;
}

// std::from_chars: no locale, no hexadecimal; a leading '+' is what it leaves out.
std::errc parse(std::string_view text, double& value) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  if (text.size() > longest_number) return std::errc::invalid_argument;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return end != text.data() + text.size() ? std::errc::invalid_argument : error;
}

Defect read_number(std::string_view text, double& value) {
  const std::errc error = parse(text, value);
  if (text.empty()) return "is empty, a number was expected";
  if (error == std::errc::invalid_argument) {
    std::string pointed(text.substr(0, longest_number));
    std::replace(pointed.begin(), pointed.end(), ',', '.');
    const bool comma = pointed != text && parse(pointed, value) == std::errc();
    return comma ? "is not a number, did you mean '" + pointed + "'?" : "is not a number";
  }
  if (error == std::errc::result_out_of_range) return "is out of the range of numbers";
  if (!std::isfinite(value)) return "is not finite";
  if (!(std::abs(value) <= largest)) return "is beyond 1e9, too large for a robot";
  return std::nullopt;
}

Defect read_numbers(std::string_view text, std::span<double> values);

// ", did you mean '0 1 0'?" when commas or semicolons between the numbers were all that is wrong.
std::string spaces_meant(std::string_view text, std::size_t count) {
  if (text.size() > 4 * longest_number || text.find_first_of(",;") == std::string_view::npos) return {};
  std::string spaced(text), better;
  std::replace_if(
      spaced.begin(), spaced.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  for (const std::string_view piece : pieces(spaced)) better += (better.empty() ? "" : " ") + std::string(piece);
  std::vector<double> values(count);
  return read_numbers(better, values) ? "" : ", did you mean '" + better + "'?";
}

Defect read_numbers(std::string_view text, std::span<double> values) {
  const std::vector<std::string_view> parts = pieces(text);
  const auto or_spaces = [&](const std::string& defect) {
    const std::string hint = spaces_meant(text, values.size());
    return hint.empty() ? defect : "is not separated by spaces" + hint;
  };
  if (parts.size() != values.size()) {
    return or_spaces("has " + std::to_string(parts.size()) + (parts.size() == 1 ? " number, " : " numbers, ") +
                     std::to_string(values.size()) + " were expected");
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (const Defect defect = read_number(parts[i], values[i]))
      return or_spaces("has a part '" + shown(parts[i]) + "' that " + *defect);
  }
  return std::nullopt;
}

Defect name_defect(std::string_view text) {
  if (text.empty()) return "is empty";
  if (text.size() > longest_name) return "is longer than 128 characters";
  if (trimmed(text) != text) return "has blanks around it";
  if (find_non_text(text) || text.find_first_of("\t\r\n") != std::string_view::npos)
    return "has control characters in it";
  return std::nullopt;
}

struct NumberRule {
  std::size_t count;
  bool (*fits)(double);
  const char* otherwise;
};

constexpr bool is_any(double) { return true; }
constexpr bool is_positive(double v) { return v > 0; }
constexpr bool is_not_negative(double v) { return v >= 0; }
constexpr bool is_not_zero(double v) { return v != 0; }
constexpr bool is_fraction(double v) { return v >= 0 && v <= 1; }

constexpr NumberRule rules[] = {
    // in the order of UrdfValue, from `number`
    {1, is_any, ""},
    {1, is_positive, "must be > 0"},
    {1, is_not_negative, "must be >= 0"},
    {3, is_any, ""},
    {3, is_positive, "must be > 0 in every direction"},
    {3, is_not_zero, "must not be 0 in any direction"},
    {4, is_fraction, "must be red, green, blue and opacity in 0..1"},
};

}  // namespace

std::optional<std::string> read_value(UrdfValue kind, std::string_view text, double* numbers) {
  if (kind == UrdfValue::text) return std::nullopt;
  if (kind == UrdfValue::name) return name_defect(text);
  const NumberRule& rule = rules[static_cast<std::size_t>(kind) - static_cast<std::size_t>(UrdfValue::number)];
  std::array<double, 4> room{};
  const std::span<double> values(room.data(), rule.count);
  if (Defect defect = rule.count == 1 ? read_number(trimmed(text), values[0]) : read_numbers(text, values))
    return defect;
  if (!std::all_of(values.begin(), values.end(), rule.fits)) return rule.otherwise;
  if (numbers != nullptr) std::copy(values.begin(), values.end(), numbers);
  return std::nullopt;
}

}  // namespace kadans
