#include <array>
#include <memory>

#include "kadans/exchange/latest.h"
#include "kadans/exchange/ring.h"
#include "report.h"

namespace kadans::bench {

void bench_exchange(Report& report) {
  using Payload = std::array<std::uint64_t, 64>;  // 512 bytes
  Payload payload{}, copy{};
  const double copy_ns = time_ns([&] { keep(payload), copy = payload, keep(copy); }, 10000);
  const auto latest = std::make_unique<Latest<Payload>>();
  const double write_ns = time_ns([&] { keep(payload), latest->publish(payload); }, 10000);
  const double read_ns =
      time_ns([&] { latest->publish(payload), copy = latest->read(), keep(copy); }, 10000) - write_ns;
  const auto ring = std::make_unique<Ring<Payload, 8>>();
  const double queue_ns = time_ns([&] { (void)ring->try_push(payload), (void)ring->try_pop(copy), keep(copy); }, 10000);
  report.add("exchange_ns.copy_512", "plain copy, 512 bytes", copy_ns, "ns");
  report.add("exchange_ns.latest_write", "newest value, write 512 bytes", write_ns, "ns");
  report.add("exchange_ns.latest_read", "newest value, read and copy 512 bytes", read_ns, "ns");
  report.add("exchange_ns.ring_push_pop", "queue, push and pop 512 bytes", queue_ns, "ns");
}

}  // namespace kadans::bench
