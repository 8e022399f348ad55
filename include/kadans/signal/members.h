// The data members of an aggregate, without a list of their names.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace kadans {

inline constexpr std::size_t members_max = 16;

namespace detail {

struct AnyMember {
  template <typename T>
  operator T() const noexcept;
};

template <typename T, std::size_t count>
constexpr bool takes_members() noexcept {
  return []<std::size_t... i>(std::index_sequence<i...>) {
    return requires { T{(static_cast<void>(i), AnyMember{})...}; };
  }
  (std::make_index_sequence<count>());
}

template <typename T, std::size_t most = members_max + 1>
constexpr std::size_t member_count() noexcept {
  if constexpr (takes_members<T, most>())
    return most;
  else
    return member_count<T, most - 1>();
}

}  // namespace detail

// Calls `take` once, with a reference to each data member of `of`, in their order. For an aggregate of at most
// members_max members without a base class and without a plain array (std::array is none); all else does not compile.
template <typename T, typename Take>
constexpr void with_members(T& of, Take take) {
  static_assert(std::is_aggregate_v<T>, "only an aggregate shows its members");
  constexpr std::size_t count = detail::member_count<std::remove_const_t<T>>();
  static_assert(count <= members_max, "too many members: group them");
  // clang-format off
  if constexpr (count == 1) { auto& [a] = of; take(a); }
  if constexpr (count == 2) { auto& [a, b] = of; take(a, b); }
  if constexpr (count == 3) { auto& [a, b, c] = of; take(a, b, c); }
  if constexpr (count == 4) { auto& [a, b, c, d] = of; take(a, b, c, d); }
  if constexpr (count == 5) { auto& [a, b, c, d, e] = of; take(a, b, c, d, e); }
  if constexpr (count == 6) { auto& [a, b, c, d, e, f] = of; take(a, b, c, d, e, f); }
  if constexpr (count == 7) { auto& [a, b, c, d, e, f, g] = of; take(a, b, c, d, e, f, g); }
  if constexpr (count == 8) { auto& [a, b, c, d, e, f, g, h] = of; take(a, b, c, d, e, f, g, h); }
  if constexpr (count == 9) { auto& [a, b, c, d, e, f, g, h, i] = of; take(a, b, c, d, e, f, g, h, i); }
  if constexpr (count == 10) { auto& [a, b, c, d, e, f, g, h, i, j] = of; take(a, b, c, d, e, f, g, h, i, j); }
  if constexpr (count == 11) { auto& [a, b, c, d, e, f, g, h, i, j, k] = of; take(a, b, c, d, e, f, g, h, i, j, k); }
  if constexpr (count == 12) { auto& [a, b, c, d, e, f, g, h, i, j, k, l] = of; take(a, b, c, d, e, f, g, h, i, j, k, l); }
  if constexpr (count == 13) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = of; take(a, b, c, d, e, f, g, h, i, j, k, l, m); }
  if constexpr (count == 14) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = of; take(a, b, c, d, e, f, g, h, i, j, k, l, m, n); }
  if constexpr (count == 15) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o] = of; take(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o); }
  if constexpr (count == 16) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = of; take(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p); }
  // clang-format on
}

// A value out of bytes from outside, which lie as they do in memory: each member by itself, so a bool is false or true
// whatever its byte is. For what with_members takes, numbers, enumerations and ranges of these.
template <typename T>
void take_members(T& value, const std::byte* bytes) noexcept {
  static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
  const auto of = [&value, bytes](const auto& part) {
    return bytes + (reinterpret_cast<const std::byte*>(&part) - reinterpret_cast<const std::byte*>(&value));
  };
  if constexpr (std::is_same_v<T, bool>) {
    value = *bytes != std::byte{0};
  } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    std::memcpy(&value, bytes, sizeof value);
  } else if constexpr (requires { value.begin(); }) {
    for (auto& one : value) take_members(one, of(one));
  } else {
    with_members(value, [&of](auto&... members) { (take_members(members, of(members)), ...); });
  }
}

}  // namespace kadans
