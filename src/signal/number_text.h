// Numbers and lists as text, and numbers back, in the same way everywhere: the locale has no influence. A text that is
// a number only in part is no number, and neither is nan.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace kadans {

// As std::printf prints; at most 511 characters. The compiler compares the values with the pattern.
[[gnu::format(printf, 1, 2)]] std::string printed(const char* pattern, ...);

// As few digits as name the number exactly; up to 1e9 an integer is written in full: 1000000, 1e-09.
inline std::string number_text(double value) {
  if (std::abs(value) < 1e9 && value == std::floor(value)) return std::to_string(static_cast<long>(value));
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::string("?");
}

// "kp = 900 is outside its range 0..500 Nm/rad".
inline std::string outside_range(const std::string& name, double value, double min, double max,
                                 const std::string& unit) {
  return name + " = " + number_text(value) + " is outside its range " + number_text(min) + ".." + number_text(max) +
         (unit.empty() ? "" : " " + unit);
}

// A hash as 16 digits.
inline std::string hash_text(std::uint64_t hash) { return printed("%016llx", static_cast<unsigned long long>(hash)); }

// Two digits a byte.
inline std::string hexadecimal(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) text += printed("%02x", std::to_integer<unsigned>(byte));
  return text;
}

// The finite number that the whole text is, integers to a base; nothing when it is none.
template <typename Number, typename... Base>
std::optional<Number> number_of(std::string_view text, Base... base) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, base...);
  if (error != std::errc{} || stop != end) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(number)) return std::nullopt;
  }
  return number;
}

// "a, b, c": what `text` makes of each; `last`, when it is given, stands before the last in place of `between`.
template <typename List, typename Text = std::identity>
std::string listed(const List& list, Text text = {}, std::string_view between = ", ", std::string_view last = {}) {
  std::string all;
  for (auto at = std::begin(list); at != std::end(list); ++at) {
    const bool ends = !last.empty() && std::next(at) == std::end(list);
    if (at != std::begin(list)) all += ends ? last : between;
    all += std::invoke(text, *at);
  }
  return all;
}

// Rounded to so many digits.
inline double with_digits(double value, int digits) {
  return number_of<double>(printed("%.*g", digits, value)).value_or(value);
}

}  // namespace kadans
