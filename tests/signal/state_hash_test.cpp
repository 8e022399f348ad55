#include "kadans/signal/state_hash.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include <doctest/doctest.h>

namespace kadans {
namespace {

std::uint64_t hash_of(double value) {
  StateHash hash;
  hash.add(value);
  return hash.value();
}

TEST_CASE("StateHash is the same number on every machine, for ever") {
  StateHash hash;
  hash.add(std::uint64_t{1});
  CHECK(hash.value() == 0x5a8419103ebe48e4U);
  hash.add(std::uint64_t{2});
  hash.add(0.5);
  CHECK(hash.value() == 0x5181443b00c95c2fU);
}

TEST_CASE("StateHash counts what an integer is worth, not how wide its type is") {
  StateHash wide, narrow;
  wide.add(std::uint64_t{17});
  narrow.add(std::uint8_t{17});
  CHECK(wide.value() == narrow.value());
  wide.add(std::int64_t{-5});
  narrow.add(-5);
  CHECK(wide.value() == narrow.value());
  wide.add(std::uint64_t{1});
  narrow.add(true);
  CHECK(wide.value() == narrow.value());
}

TEST_CASE("StateHash takes both zeros for one state, and every NaN for one") {
  CHECK(hash_of(0.0) == hash_of(-0.0));
  CHECK(hash_of(std::nan("1")) == hash_of(-std::nan("2")));
  CHECK(hash_of(std::nan("1")) != hash_of(std::numeric_limits<double>::infinity()));
  CHECK(hash_of(std::numeric_limits<double>::infinity()) != hash_of(-std::numeric_limits<double>::infinity()));
}

TEST_CASE("StateHash sees the last bit of a number") {
  CHECK(hash_of(1.0) != hash_of(std::nextafter(1.0, 2.0)));
  CHECK(hash_of(0.0) != hash_of(std::numeric_limits<double>::denorm_min()));
}

TEST_CASE("StateHash sees the order of the numbers") {
  StateHash one, other;
  one.add(std::array{1.0, 2.0});
  other.add(std::array{2.0, 1.0});
  CHECK(one.value() != other.value());
}

TEST_CASE("StateHash of a row is that of its numbers one by one, and an empty row changes nothing") {
  StateHash row, singly;
  row.add(std::array{1.0, -2.0, 3.5});
  for (const double value : {1.0, -2.0, 3.5}) singly.add(value);
  CHECK(row.value() == singly.value());
  row.add(std::span<const double>());
  CHECK(row.value() == singly.value());
}

TEST_CASE("StateHash remembers a single flipped bit however long the run goes on") {
  std::set<std::uint64_t> ends;
  for (unsigned bit = 0; bit <= 64; ++bit) {
    StateHash hash;
    hash.add(bit < 64 ? std::uint64_t{1} << bit : 0);
    for (std::uint64_t tick = 0; tick < 1000; ++tick) hash.add(tick);
    ends.insert(hash.value());
  }
  CHECK(ends.size() == 65);
}

}  // namespace
}  // namespace kadans
