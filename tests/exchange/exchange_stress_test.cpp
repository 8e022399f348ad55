// Real threads at full speed. Bounded counts, no clock: a thread ends when it has seen the last value. Run these under
// ThreadSanitizer too (preset tsan); KADANS_SOAK=1 makes them long.
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include "exchange/payload.h"
#include "kadans/exchange/latest.h"
#include "kadans/exchange/ring.h"

namespace kadans {
namespace {

using test::is_whole;
using test::make_payload;
using test::Payload;
using test::stress_count;

struct ReaderReport {
  std::uint64_t torn = 0;       // values that do not keep their checksum
  std::uint64_t backwards = 0;  // values older than one seen before
  std::uint64_t stale = 0;      // news that was not new
  std::uint64_t seen = 0;
};

template <std::size_t Readers>
void read_until(Latest<Payload, Readers>& latest, std::size_t reader, std::uint64_t last, ReaderReport& report) {
  std::uint64_t newest = 0;
  while (newest != last) {
    if (!latest.has_news(reader)) {
      std::this_thread::yield();
      continue;
    }
    const auto reading = latest.read(reader);
    const Payload& payload = *reading;
    if (!is_whole(payload)) ++report.torn;
    if (payload.sequence < newest) ++report.backwards;
    if (payload.sequence == newest) ++report.stale;
    newest = payload.sequence;
    ++report.seen;
  }
}

TEST_CASE("Latest between threads: no value is torn, older than the last, or seen twice as news") {
  constexpr std::size_t readers = 3;
  const std::uint64_t count = stress_count(30'000);
  const auto latest = std::make_unique<Latest<Payload, readers>>(make_payload(0));
  std::array<ReaderReport, readers> reports;

  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < readers; ++i) {
    threads.emplace_back([&, i] { read_until(*latest, i, count, reports[i]); });
  }
  for (std::uint64_t i = 1; i <= count; ++i) latest->publish(make_payload(i));
  for (std::thread& thread : threads) thread.join();

  for (const ReaderReport& report : reports) {
    CHECK(report.torn == 0);
    CHECK(report.backwards == 0);
    CHECK(report.stale == 0);
    CHECK(report.seen >= 1);
    CHECK(report.seen <= count);
  }
}

TEST_CASE("Latest: a reader that holds a reference finds it whole while the writer goes on") {
  const std::uint64_t rounds = stress_count(3'000) / 10;
  const auto latest = std::make_unique<Latest<Payload>>(make_payload(0));
  std::atomic<bool> done = false;
  std::uint64_t torn = 0;
  std::thread reader([&] {
    for (std::uint64_t i = 0; i < rounds; ++i) {
      const auto reading = latest->read();
      const Payload& held = *reading;
      for (int look = 0; look < 10; ++look) {
        if (!is_whole(held)) ++torn;
      }
    }
    done = true;
  });
  for (std::uint64_t i = 1; !done; ++i) latest->publish(make_payload(i));
  reader.join();
  CHECK(torn == 0);
}

struct Item {
  std::uint32_t transaction = 0;  // counted from 1
  std::uint32_t place = 0;        // 0 is the header
  std::uint32_t count = 0;        // items that follow the header
  std::uint32_t check = 0;
};

Item make_item(std::uint32_t transaction, std::uint32_t place, std::uint32_t count) {
  return {transaction, place, count, transaction * 2654435761U ^ place * 40503U ^ count};
}

std::uint32_t count_of(std::uint32_t transaction) { return transaction * 7 % 20; }

bool is_transaction(const Ring<Item, 32>& ring, std::uint32_t transaction) {
  const std::uint32_t count = count_of(transaction);
  if (ring.size() < count + 1) return false;
  for (std::uint32_t place = 0; place <= count; ++place) {
    const Item expected = make_item(transaction, place, count);
    const Item& item = ring.peek(place);
    if (item.transaction != expected.transaction || item.place != place || item.count != count) return false;
    if (item.check != expected.check) return false;
  }
  return true;
}

TEST_CASE("Ring between threads: transactions arrive whole, in order, and none is lost") {
  const auto transactions = static_cast<std::uint32_t>(stress_count(200'000) / 10);
  const auto ring = std::make_unique<Ring<Item, 32>>();
  std::uint64_t broken = 0;
  std::thread consumer([&] {
    for (std::uint32_t expected = 1; expected <= transactions; ++expected) {
      while (ring->size() == 0) std::this_thread::yield();
      if (!is_transaction(*ring, expected)) ++broken;
      ring->drop(count_of(expected) + 1);
    }
  });
  std::array<Item, 20> batch;
  for (std::uint32_t transaction = 1; transaction <= transactions; ++transaction) {
    const std::uint32_t count = count_of(transaction);
    for (std::uint32_t place = 0; place <= count; ++place) batch[place] = make_item(transaction, place, count);
    while (!ring->try_push(std::span(batch).first(count + 1))) std::this_thread::yield();
  }
  consumer.join();
  CHECK(broken == 0);
  CHECK(ring->size() == 0);
}

TEST_CASE("Ring between threads: single elements of 512 bytes arrive whole and in order") {
  const std::uint64_t count = stress_count(30'000);
  const auto ring = std::make_unique<Ring<Payload, 4>>();
  std::uint64_t wrong = 0;
  std::thread consumer([&] {
    Payload payload;
    for (std::uint64_t expected = 1; expected <= count; ++expected) {
      while (!ring->try_pop(payload)) std::this_thread::yield();
      if (payload.sequence != expected || !is_whole(payload)) ++wrong;
    }
  });
  for (std::uint64_t i = 1; i <= count; ++i) {
    const Payload payload = make_payload(i);
    while (!ring->try_push(payload)) std::this_thread::yield();
  }
  consumer.join();
  CHECK(wrong == 0);
}

}  // namespace
}  // namespace kadans
