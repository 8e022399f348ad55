// The exchange primitives with 512 bytes, alone and with a thread on each side, in turns with Boost's queue from one
// producer to one consumer. Boost's storage of the newest value does not exist; a queue of one place would be none.
#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include <boost/lockfree/spsc_queue.hpp>

#include "kadans/exchange/latest.h"
#include "kadans/exchange/ring.h"
#include "report.h"

namespace kadans::bench {
namespace {

constexpr std::size_t places = 64;
constexpr int rounds = 15, calls = 10000, transfers = 50000;

using Payload = std::array<std::uint64_t, 64>;
using OurQueue = Ring<Payload, places>;
using BoostQueue = boost::lockfree::spsc_queue<Payload, boost::lockfree::capacity<places>>;

bool push(OurQueue& queue, const Payload& value) { return queue.try_push(value); }
bool pop(OurQueue& queue, Payload& value) { return queue.try_pop(value); }
bool push(BoostQueue& queue, const Payload& value) { return queue.push(value); }
bool pop(BoostQueue& queue, Payload& value) { return queue.pop(value); }

// One thread: an element in, an element out.
template <typename Queue>
double alone_ns(Queue& queue) {
  Payload in{}, out{};
  return time_ns([&] { keep(in), (void)push(queue, in), (void)pop(queue, out), keep(out); }, calls / 10, 10);
}

// Two threads: as fast as one pushes and the other pops; time an element.
template <typename Queue>
double between_threads_ns(Queue& queue) {
  std::atomic<bool> begun = false;
  std::thread producer([&] {
    Payload in{};
    begun = true;
    for (int i = 0; i < transfers; ++i) {
      keep(in);
      while (!push(queue, in)) std::this_thread::yield();
    }
  });
  while (!begun) std::this_thread::yield();
  Payload out{};
  const double began = now_ns();
  for (int i = 0; i < transfers; ++i) {
    while (!pop(queue, out)) std::this_thread::yield();
    keep(out);
  }
  const double each_ns = (now_ns() - began) / transfers;
  producer.join();
  return each_ns;
}

struct Turns {
  std::vector<double> ours_ns, boost_ns, ratios;
};

template <typename Measure>
Turns in_turns(Measure&& measure) {
  const auto ours = std::make_unique<OurQueue>();
  const auto boosts = std::make_unique<BoostQueue>();
  Turns turns;
  for (int round = 0; round < rounds; ++round) {
    turns.ours_ns.push_back(measure(*ours));
    turns.boost_ns.push_back(measure(*boosts));
    turns.ratios.push_back(turns.ours_ns.back() / turns.boost_ns.back());
  }
  return turns;
}

void add(Report& report, const std::string& key, const std::string& text, const Turns& turns) {
  report.add("exchange_ns.ring_" + key, "queue, " + text, median(turns.ours_ns), "ns");
  report.add("exchange_ns.boost_" + key, "  Boost's spsc_queue", median(turns.boost_ns), "ns");
  report.add("exchange_ratio." + key, "  ours to Boost's", median(turns.ratios), "x");
}

void take(Latest<Payload>& latest, Payload& out) {
  const auto reading = latest.read();
  out = *reading;
  keep(out);
}

void newest_value(Report& report) {
  Payload in{}, out{};
  const auto latest = std::make_unique<Latest<Payload>>();
  const double copy_ns = time_ns([&] { keep(in), out = in, keep(out); }, calls);
  const double write_ns = time_ns([&] { keep(in), latest->publish(in); }, calls);
  const double both_ns = time_ns([&] { latest->publish(in), take(*latest, out); }, calls);
  report.add("exchange_ns.copy", "plain copy, 512 bytes", copy_ns, "ns");
  report.add("exchange_ns.latest_write", "newest value, write 512 bytes", write_ns, "ns");
  report.add("exchange_ns.latest_read", "newest value, read and copy 512 bytes", both_ns - write_ns, "ns");
}

// A writer that never rests beside a reader that never rests.
void newest_value_contended(Report& report) {
  const auto latest = std::make_unique<Latest<Payload>>();
  std::atomic<bool> ended = false;
  std::vector<double> writes_ns;
  std::thread writer([&] {
    Payload in{};
    while (!ended) writes_ns.push_back(time_ns([&] { keep(in), latest->publish(in); }, 1000, 1));
  });
  Payload out{};
  const double read_ns = time_ns([&] { take(*latest, out); }, calls);
  ended = true;
  writer.join();
  report.add("exchange_ns.latest_write_contended", "newest value, write while another thread reads", median(writes_ns),
             "ns");
  report.add("exchange_ns.latest_read_contended", "newest value, read while another thread writes", read_ns, "ns");
}

}  // namespace

void bench_exchange(Report& report) {
  newest_value(report);
  newest_value_contended(report);
  add(report, "alone", "push and pop of 512 bytes, one thread", in_turns([](auto& queue) { return alone_ns(queue); }));
  add(report, "between_threads", "one thread pushes, one pops",
      in_turns([](auto& queue) { return between_threads_ns(queue); }));
  bench_latency(report);
}

}  // namespace kadans::bench
