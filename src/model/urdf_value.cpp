#include "urdf_value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "source_text.h"

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

Defect number_defect(std::string_view text) {
  double value = 0;
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

std::string spaced(std::string_view text) {
  std::string result(text);
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  std::string single;
  for (const std::string_view piece : pieces(result)) single += (single.empty() ? "" : " ") + std::string(piece);
  return single;
}

Defect numbers_defect(std::string_view text, std::size_t count);

// ", did you mean '0 1 0'?" when commas or semicolons between the numbers were all that is wrong.
std::string spaces_meant(std::string_view text, std::size_t count) {
  if (text.size() > 4 * longest_number || text.find_first_of(",;") == std::string_view::npos) return {};
  const std::string better = spaced(text);
  return numbers_defect(better, count) ? "" : ", did you mean '" + better + "'?";
}

Defect numbers_defect(std::string_view text, std::size_t count) {
  const std::vector<std::string_view> parts = pieces(text);
  if (parts.size() != count) {
    const std::string hint = spaces_meant(text, count);
    if (!hint.empty()) return "is not separated by spaces" + hint;
    return "has " + std::to_string(parts.size()) + (parts.size() == 1 ? " number, " : " numbers, ") +
           std::to_string(count) + " were expected";
  }
  for (const std::string_view part : parts) {
    if (const Defect defect = number_defect(part)) {
      const std::string hint = spaces_meant(text, count);
      return hint.empty() ? "has a part '" + shown(part) + "' that " + *defect : "is not separated by spaces" + hint;
    }
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

double number(std::string_view text) {
  double value = 0;
  return parse(text, value) == std::errc() ? value : std::nan("");
}

template <typename Fits>
Defect all_fit(std::string_view text, const char* message, Fits fits) {
  for (const std::string_view piece : pieces(text)) {
    if (!fits(number(piece))) return message;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> value_defect(UrdfValue kind, std::string_view text) {
  const auto positive = [](double v) { return v > 0; };
  const auto checked = [&](Defect first, const char* message, auto fits) {
    return first ? first : all_fit(text, message, fits);
  };
  switch (kind) {
    case UrdfValue::name:
      return name_defect(text);
    case UrdfValue::number:
      return number_defect(trimmed(text));
    case UrdfValue::positive:
      return checked(number_defect(trimmed(text)), "must be > 0", positive);
    case UrdfValue::not_negative:
      return checked(number_defect(trimmed(text)), "must be >= 0", [](double v) { return v >= 0; });
    case UrdfValue::vector:
      return numbers_defect(text, 3);
    case UrdfValue::positive_vector:
      return checked(numbers_defect(text, 3), "must be > 0 in every direction", positive);
    case UrdfValue::scale:
      return checked(numbers_defect(text, 3), "must not be 0 in any direction", [](double v) { return v != 0; });
    case UrdfValue::color:
      return checked(numbers_defect(text, 4), "must be red, green, blue and opacity in 0..1",
                     [](double v) { return v >= 0 && v <= 1; });
    case UrdfValue::text:
      break;
  }
  return std::nullopt;
}

std::optional<double> read_number(std::string_view text) {
  if (number_defect(trimmed(text))) return std::nullopt;
  return number(trimmed(text));
}

std::optional<std::array<double, 3>> read_vector(std::string_view text) {
  if (numbers_defect(text, 3)) return std::nullopt;
  const std::vector<std::string_view> parts = pieces(text);
  return std::array<double, 3>{number(parts[0]), number(parts[1]), number(parts[2])};
}

}  // namespace kadans
