#include "kadans/exchange/latest.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>

#include <doctest/doctest.h>

#include "exchange/payload.h"

namespace kadans {
namespace {

using test::is_whole;
using test::make_payload;
using test::Payload;

static_assert(std::is_trivially_copyable_v<Latest<Payload, 3>>);
static_assert(std::is_standard_layout_v<Latest<Payload, 3>>);
static_assert(noexcept(std::declval<Latest<Payload>&>().publish(Payload{})));
static_assert(noexcept(std::declval<Latest<Payload>&>().read()));
// Nothing can be kept of a reading that has no name.
template <typename Reading>
concept KeepsOfNameless = requires(Reading (*read)()) {
  *read();
}
|| requires(Reading (*read)()) { read()->sequence; };
static_assert(!KeepsOfNameless<Latest<Payload>::Reading>);
// Three slots and three indices a reader, each on lines of its own, with any word size.
static_assert(sizeof(Latest<std::uint32_t, 2>) == std::size_t{2} * 6 * 64);

TEST_CASE("Latest gives the first value, which is not news, before anything is published") {
  Latest<int> latest(7);
  CHECK_FALSE(latest.has_news());
  CHECK(latest.newest() == 7);
  CHECK(latest.newest() == 7);
}

TEST_CASE("Latest gives the newest value and forgets those that nobody read") {
  Latest<int> latest;
  for (int i = 1; i <= 100; ++i) latest.publish(i);
  CHECK(latest.has_news());
  CHECK(latest.newest() == 100);
}

TEST_CASE("Latest has news once a value published, and keeps the value afterwards") {
  Latest<int> latest;
  latest.publish(1);
  CHECK(latest.has_news());
  CHECK(latest.has_news());
  CHECK(latest.newest() == 1);
  CHECK_FALSE(latest.has_news());
  CHECK(latest.newest() == 1);
  latest.publish(1);
  CHECK(latest.has_news());
}

TEST_CASE("what a reader of Latest puts in its place it finds until news are published, other readers do not") {
  Latest<int, 2> latest(1);
  latest.publish(2);
  latest.replace(5);
  CHECK_FALSE(latest.has_news());
  CHECK(latest.newest() == 5);
  CHECK(latest.newest(1) == 2);
  latest.publish(3);
  CHECK(latest.newest() == 3);
}

TEST_CASE("Latest never falls back to an older value, however reads and writes interleave") {
  for (unsigned pattern = 0; pattern < 1U << 12U; ++pattern) {
    Latest<int> latest;
    int published = 0;
    bool newest = true;
    for (unsigned bit = 0; bit < 12; ++bit) {
      if ((pattern >> bit & 1U) != 0) latest.publish(++published);
      if ((pattern >> bit & 1U) == 0) newest = newest && latest.newest() == published;
    }
    CHECK(newest);
  }
}

TEST_CASE("Latest serves each reader by itself") {
  Latest<int, 3> latest;
  CHECK(Latest<int, 3>::readers() == 3);
  latest.publish(1);
  CHECK(latest.newest(0) == 1);
  latest.publish(2);
  CHECK(latest.newest(1) == 2);
  CHECK_FALSE(latest.has_news(1));
  CHECK(latest.has_news(0));
  CHECK(latest.has_news(2));
  latest.publish(3);
  CHECK(latest.newest(2) == 3);
  CHECK(latest.newest(1) == 3);
  CHECK(latest.newest(0) == 3);
}

TEST_CASE("what a reader of Latest looks at stays, whatever is written and however often it reads again meanwhile") {
  Latest<Payload, 2> latest;
  latest.publish(make_payload(1));
  {
    const auto held = latest.read(0);
    for (std::uint64_t i = 2; i < 20; ++i) {
      latest.publish(make_payload(i));
      CHECK(latest.newest(1).sequence == i);
      CHECK(held->sequence == 1);
      CHECK(is_whole(*held));
      const auto again = latest.read(0);  // as a function does that is called meanwhile
      CHECK(&*again == &*held);
      CHECK(latest.newest(0).sequence == 1);
    }
  }
  const auto next = latest.read(0);
  CHECK(next->sequence == 19);
}

TEST_CASE("a copy of Latest made byte by byte goes on from the same state by itself") {
  auto original = std::make_unique<Latest<Payload, 2>>();
  original->publish(make_payload(1));
  CHECK(original->newest(0).sequence == 1);
  original->publish(make_payload(2));

  auto copy = std::make_unique<Latest<Payload, 2>>();
  std::memcpy(static_cast<void*>(copy.get()), original.get(), sizeof *original);
  std::memset(static_cast<void*>(original.get()), 0xff, sizeof *original);
  original.reset();

  CHECK(copy->has_news(0));
  CHECK(copy->newest(0).sequence == 2);
  CHECK(copy->newest(1).sequence == 2);
  copy->publish(make_payload(3));
  CHECK(copy->newest(0).sequence == 3);
  CHECK(is_whole(copy->newest(1)));
}

}  // namespace
}  // namespace kadans
