#include "kadans/signal/members.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <string>

#include <doctest/doctest.h>

namespace kadans {
namespace {

struct Three {
  int number = 1;
  std::array<double, 2> pair{2, 3};
  struct Inner {
    bool flag = true;
  } inner;
};
struct Sixteen {
  int a = 1, b = 2, c = 3, d = 4, e = 5, f = 6, g = 7, h = 8, i = 9, j = 10, k = 11, l = 12, m = 13, n = 14, o = 15,
      p = 16;
};

TEST_CASE("with_members hands out each member once, in their order, to be read or written") {
  Three three;
  with_members(three, [](int& number, std::array<double, 2>& pair, Three::Inner& inner) {
    CHECK(number == 1);
    CHECK(pair[1] == 3);
    number = 5;
    inner.flag = false;
  });
  CHECK(three.number == 5);
  CHECK_FALSE(three.inner.flag);
  const Three constant;
  with_members(constant, [](const auto&... members) { CHECK(sizeof...(members) == 3); });
}

TEST_CASE("with_members knows structs of one member and of the most that there may be") {
  Three::Inner one;
  with_members(one, [](auto&... members) { CHECK(sizeof...(members) == 1); });
  Sixteen sixteen;
  std::string order;
  with_members(sixteen, [&](auto&... members) { ((order += std::to_string(members) + " "), ...); });
  CHECK(order == "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 ");
}

TEST_CASE("take_members takes each member out of bytes from outside, and a bool is false or true") {
  Three given;
  given.pair = {7, 8};
  std::array<std::byte, sizeof(Three)> bytes{};
  std::memcpy(bytes.data(), &given, sizeof given);
  bytes[offsetof(Three, inner)] = std::byte{0x42};
  Three taken{.number = 0, .pair = {}, .inner = {false}};
  take_members(taken, bytes.data());
  CHECK(taken.number == 1);
  CHECK(taken.pair[1] == 8);
  std::memcpy(bytes.data(), &taken, sizeof taken);
  CHECK(bytes[offsetof(Three, inner)] == std::byte{1});
}

}  // namespace
}  // namespace kadans
